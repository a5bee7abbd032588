"""Run a study: episodes that have no row yet, in parallel; only the parent writes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from hrcplan import __version__
from hrcplan.core.extras import require
from hrcplan.errors import UsageError
from hrcplan.studies.quarantine import end_with_quarantine
from hrcplan.studies.runner import EpisodeRunner, LocalRunner, StudyWork
from hrcplan.studies.store import Store
from hrcplan.studies.study import Episode, Say, Study, episodes, find
from hrcplan.studies.trace_files import TraceFiles

FIRST_RUNS = 10  # of each cell, before what others need is prepared
ReportProgress = Callable[[int, int], None]


def run_study(
    name: str,
    folder: str | Path,
    *,
    runs: int | None = None,
    seed: int = 0,
    jobs: int = 1,
    limit: int | None = None,
    options: Mapping[str, str | None] | None = None,
    tables: Sequence[str] = (),
    traces: str | Path | None = None,
    progress: ReportProgress | None = None,
    say: Say = lambda text: None,
    cluster: str | None = None,
) -> int:
    """Run what a study has no rows of yet, and return how many are new.

    The rows depend on ``seed`` and ``options`` alone, not on who runs the episodes, or on
    interruptions.

    Args:
        name: A study, as in ``failure-anticipation``.
        folder: Where ``rows.sqlite`` is or will be.
        runs: Runs per cell; by default as many as the study says.
        seed: From which everything random is derived.
        jobs: Worker processes, if there are enough episodes for more than one.
        limit: Episodes of all tables together, spread evenly over cells: one run of every cell of
            the first table, then half of them of that table and half of all others.
        options: The study's own options; None values stand for its defaults.
        tables: The only tables that are run; all by default.
        traces: A folder to which a trace of each episode is written, too; episodes that have a row
            but no trace are run again.
        progress: Called with the numbers of rows done and wanted.
        say: Called with what is going on, where that takes long.
        cluster: The address of a Dask scheduler, whose workers run the episodes instead of
            processes of this machine.

    Raises:
        UsageError: if the study, a table or an option is unknown, the folder holds other rows, an
            extra is not installed, or a worker of the cluster differs from this process.
        InputError: if a file that the study needs is missing or has faults.
        PlannerError: if the scheduler does not answer, or is gone.
        LimitError: if episodes are in quarantine since they failed on the cluster time and again,
            after all other rows were written; or if the cluster has no workers.
    """
    if any(n is not None and n < 1 for n in (runs, jobs, limit)):
        raise UsageError("runs, jobs and limit are at least 1")
    if cluster is not None and jobs != 1:
        raise UsageError("jobs are processes of this machine: name jobs or a cluster, not both")
    if cluster is not None:
        require("distributed", "--cluster")
    for module in ("joblib", "matplotlib", "sklearn"):
        require(module, "a study")
    if cluster is not None:
        from hrcplan.studies.cluster.connection import find_scheduler
        from hrcplan.studies.cluster.runner import ClusterRunner

        cluster = find_scheduler(cluster)  # now, since to read the inputs may take long
    study = find(name)
    choice = study.with_defaults(options or {})
    all_episodes = list(episodes(study, choice, runs or study.runs(choice), limit, tables))
    say("the study's inputs are read")
    digest = hashlib.sha256(study.inputs(choice).encode()).hexdigest()
    about = {"study": name, "version": __version__, "seed": seed, "options": choice,
             "inputs_sha256": digest}  # fmt: skip
    files = None if traces is None else TraceFiles(Path(traces), study, all_episodes)
    work = StudyWork.of(name, choice, seed, is_traced=files is not None)
    runner: EpisodeRunner = LocalRunner(work, jobs)
    if cluster is not None:
        runner = ClusterRunner(cluster, work, digest, lambda: study.files(choice), say)
        jobs = len(os.sched_getaffinity(0))
    with runner, Store.to_write(Path(folder), about, study.tables) as store:
        missing = store.missing(study.tables, all_episodes)
        if files is not None:
            missing = files.missing(all_episodes, missing)
            files.write_pddl(choice)
        n_done = len(all_episodes) - len(missing)
        if progress is not None:
            progress(n_done, len(all_episodes))
        for part, needs_more in _parts(study, missing):
            if needs_more:
                study.prepare(choice, jobs, say)
            for results in runner.run(part):
                if files is not None:
                    files.write(choice, seed, results)
                for table, group in groupby(results, lambda result: result.episode.table):
                    store.add(study.table(table), [(one.episode, one.row) for one in group])
                n_done += len(results)
                if progress is not None:
                    progress(n_done, len(all_episodes))
        if not store.is_compact:
            store.compact()
        end_with_quarantine(Path(folder), runner.failures)
    return len(missing)


def _parts(study: Study, missing: list[Episode]) -> Iterator[tuple[list[Episode], bool]]:
    """Yield the episodes in parts, and whether a part needs what the study prepares.

    The first runs of cells that are ready come first, so that there is a page to look at soon.
    """
    first = [e for e in missing if e.run < FIRST_RUNS and study.is_ready(e.cell)]
    rest = missing if not first else [e for e in missing if e not in set(first)]
    if first:
        yield first, False
    if rest:
        yield rest, any(not study.is_ready(episode.cell) for episode in rest)
