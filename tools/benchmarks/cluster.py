"""A study on a Dask cluster of two workers on this machine, side by side with joblib."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from rows import Row, interleaved, milliseconds, worked

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from hrcplan.studies import run_study
from hrcplan.studies.cluster import backlog
from hrcplan.studies.runner import StudyWork, results_of
from hrcplan.studies.store import Store
from hrcplan.studies.study import episodes, find
from tests.studies.clusters import Cluster, toy_study

N_WORKERS, N_ROUNDS = 2, 1
NAME, RUNS, TABLE = "failure-anticipation", 60, "rows"
N_TOY = 400  # episodes of next to no work: what remains is the way there and back
MOST_SHARE = 0.15
TICKS = os.sysconf("SC_CLK_TCK")


def rows() -> Iterator[Row]:
    """Yield times of equal rows with joblib and Dask, and what scheduler and parent pay a batch."""
    with tempfile.TemporaryDirectory() as text, Cluster(Path(text), N_WORKERS) as cluster:
        folder = Path(text)
        yield from _overhead(cluster, folder)
        yield from _cost_of_batches(cluster, folder)
        yield from _cost_of_rows(folder)


def _overhead(cluster: Cluster, folder: Path) -> Iterator[Row]:
    """Yield the processor time of all processes that take part, for the same rows."""
    names, far = iter(range(1_000)), [cluster.scheduler, *cluster.workers]

    def run(*where: str) -> Callable[[], float]:
        def seconds() -> float:
            argv = [sys.executable, "-m", "hrcplan", "study", "run", NAME, "--runs", str(RUNS),
                    "--table", TABLE, *where, "-o", str(folder / f"out-{next(names)}")]  # fmt: skip
            before = sum(_used_s(process.pid) for process in far)
            near_s = worked(lambda: subprocess.run(argv, check=True, capture_output=True))
            return near_s + sum(_used_s(process.pid) for process in far) - before

        return seconds

    ways = {"joblib": run("--jobs", str(N_WORKERS)), "dask": run("--cluster", cluster.address)}
    used_s = interleaved(ways, N_ROUNDS, typical=min)
    study = find(NAME)
    n = sum(1 for _ in episodes(study, study.options, RUNS, tables=[TABLE]))
    share = used_s["dask"] / used_s["joblib"] - 1
    yield Row(f"{n} rows of {NAME}, {N_WORKERS} workers", f"{used_s['dask']:.1f} s",
              f"joblib: {used_s['joblib']:.1f} s, added {100 * share:.0f} %",
              f"<= {100 * MOST_SHARE:.0f} %", share > MOST_SHARE)  # fmt: skip


def _cost_of_batches(cluster: Cluster, folder: Path) -> Iterator[Row]:
    """Yield the processor time that batches of one episode take of scheduler and parent."""
    toy_study(folder)
    here, n_batches = Path.cwd(), 0

    def count(n_done: int, n_all: int) -> None:
        nonlocal n_batches
        n_batches += n_done > 0

    backlog.BATCH_S = backlog.PER_SLOT_S = 0.0  # so that batches do not grow
    os.chdir(folder)  # the module of the study is there
    try:
        scheduler_s, parent_s = _used_s(cluster.scheduler.pid), time.process_time()
        run_study("toy:STUDY", folder / "toy-rows", runs=N_TOY // 2, cluster=cluster.address,
                  progress=count)  # fmt: skip
    finally:
        os.chdir(here)
    scheduler_s = _used_s(cluster.scheduler.pid) - scheduler_s
    yield Row("scheduler, one batch", milliseconds(scheduler_s / n_batches))
    parent_s = time.process_time() - parent_s
    yield Row("parent, one batch", milliseconds(parent_s / n_batches))


def _cost_of_rows(folder: Path) -> Iterator[Row]:
    """Yield what an episode and the writing of its row take, and how large the row is."""
    study = find(NAME)
    some = list(episodes(study, study.options, RUNS, 400, [TABLE]))
    work = StudyWork.of(NAME, study.options, 0)
    results_of(work, some)  # plans are in the caches now
    began = time.process_time()
    results = results_of(work, some)
    yield Row("worker, one episode", milliseconds((time.process_time() - began) / len(some)))
    pairs = [(one.episode, one.row) for one in results]
    with Store.to_write(folder / "sizes", {"study": NAME}, study.tables) as store:
        began = time.process_time()
        for at in range(0, len(pairs), 100):
            store.add(study.table(TABLE), pairs[at : at + 100])
        written_s = (time.process_time() - began) / len(pairs)
        store.compact()
    yield Row("parent, to write one row", f"{written_s * 1e6:.0f} µs")
    in_file = (folder / "sizes" / "rows.sqlite").stat().st_size / len(some)
    yield Row("a row on the way", f"{len(pickle.dumps(results)) / len(some):,.0f} bytes")
    yield Row("a row in the file", f"{in_file:,.0f} bytes")


def _used_s(pid: int) -> float:
    """Return the processor time of a process, in seconds."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:15])) / TICKS  # with its children that have ended
