"""Run a study: episodes that have no row yet, in parallel; only the parent writes."""

from __future__ import annotations

import hashlib
import os
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from hrcplan import __version__
from hrcplan.core.extras import require
from hrcplan.core.safe_path import safe_path
from hrcplan.errors import UsageError
from hrcplan.inference.traces import ActionTrace
from hrcplan.studies.store import Store
from hrcplan.studies.study import Episode, Say, Seed, Study, StudyOptions, StudyRow, episodes, find
from hrcplan.studies.trace_files import EpisodeResult, TraceFiles

FIRST_RUNS = 10  # of each cell, before what others need is prepared
_FEW = 16  # episodes that one process has done before others have prepared what they need
_CHUNK = 32  # episodes a worker does before its rows are written: what a kill can lose
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
) -> int:
    """Run what a study has no rows of yet, and return how many are new.

    The rows depend on ``seed`` and ``options`` alone, not on ``jobs`` or on interruptions.

    Args:
        name: A study, as in ``failure-anticipation``.
        folder: Where ``rows.sqlite`` is or will be.
        runs: Runs per cell; by default as many as the study says.
        seed: From which everything random is derived.
        jobs: Worker processes, if there are enough episodes for more than one.
        limit: Episodes of the study's first table, spread evenly over its cells, and at most as
            many of all its other tables together.
        options: The study's own options; None values stand for its defaults.
        tables: The only tables that are run; all by default.
        traces: A folder to which a trace of each episode is written, too; episodes that have a row
            but no trace are run again.
        progress: Called with the numbers of rows done and wanted.
        say: Called with what is going on, where that takes long.

    Raises:
        UsageError: if the study, a table or an option is unknown, the folder holds other rows, or
            the extra ``studies`` is not installed.
        InputError: if a file that the study needs is missing or has faults.
    """
    if any(n is not None and n < 1 for n in (runs, jobs, limit)):
        raise UsageError("runs, jobs and limit are at least 1")
    for module in ("joblib", "matplotlib", "sklearn"):
        require(module, "a study")
    study = find(name)
    choice = study.with_defaults(options or {})
    all_episodes = list(episodes(study, choice, runs or study.runs(choice), limit, tables))
    say("the study's inputs are read")
    digest = hashlib.sha256(study.inputs(choice).encode()).hexdigest()
    about = {"study": name, "version": __version__, "seed": seed, "options": choice,
             "inputs_sha256": digest}  # fmt: skip
    files = None if traces is None else TraceFiles(Path(traces), study, all_episodes)
    with Store.to_write(Path(folder), about, study.tables) as store:
        missing = store.missing(study.tables, all_episodes)
        if files is not None:
            missing = files.missing(all_episodes, missing)
        n_done = len(all_episodes) - len(missing)
        if progress is not None:
            progress(n_done, len(all_episodes))
        for part, needs_more in _parts(study, missing):
            if needs_more:
                study.prepare(choice, jobs, say)
            for results in _results(name, choice, seed, part, jobs, files is not None):
                if files is not None:
                    files.write(choice, seed, results)
                for table, group in groupby(results, lambda result: result.episode.table):
                    store.add(study.table(table), [(one.episode, one.row) for one in group])
                n_done += len(results)
                if progress is not None:
                    progress(n_done, len(all_episodes))
        if not store.is_compact:
            store.compact()
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


def _results(
    name: str, options: StudyOptions, seed: int, missing: list[Episode], jobs: int,
    is_traced: bool,
) -> Iterator[list[EpisodeResult]]:  # fmt: skip
    """Yield results in the order of the episodes, not in that of their ends."""
    chunks = _chunks(missing)
    if jobs == 1 or len(missing) < _FEW:
        yield from (_rows(name, options, seed, chunk, is_traced) for chunk in chunks)
        return
    from joblib import Parallel, delayed

    workers = Parallel(n_jobs=jobs, return_as="generator", batch_size=1,
                       initializer=_end_with, initargs=(os.getpid(),))  # fmt: skip
    with safe_path():
        yield from workers(
            delayed(_rows)(name, options, seed, chunk, is_traced) for chunk in chunks
        )


def _chunks(missing: list[Episode]) -> list[list[Episode]]:
    """Return episodes in chunks that grow, so that progress shows after the first episode."""
    chunks, at = [], 0
    while at < len(missing):
        size = min(_CHUNK, max(1, at))
        chunks.append(missing[at : at + size])
        at += size
    return chunks


def _end_with(parent: int) -> None:
    """End this worker soon after its parent was killed: it would wait for work for minutes."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _rows(
    name: str, options: StudyOptions, seed: int, chunk: list[Episode], is_traced: bool
) -> list[EpisodeResult]:
    study = find(name)
    return [EpisodeResult(e, *_row(study, options, seed, e, is_traced)) for e in chunk]


def _row(
    study: Study, options: StudyOptions, seed: int, episode: Episode, is_traced: bool
) -> tuple[StudyRow, ActionTrace | None]:
    table = study.table(episode.table)
    try:
        if is_traced and table.traced is not None:
            return table.traced(options, episode.cell, Seed(seed, episode.run))
        return table.episode(options, episode.cell, Seed(seed, episode.run)), None
    except Exception as error:
        error.add_note(f"in {episode.table}, cell {episode.cell}, run {episode.run}")
        raise
