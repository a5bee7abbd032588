"""A real scheduler and real workers on this machine, which never outlive a test."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

# The kernel kills the process if the one that runs the tests is killed; its own tasks end with it.
_SCRIPT = """import ctypes, sys
ctypes.CDLL(None).prctl(1, 9)
from dask.__main__ import main
main()
"""

# Each episode appends its number to a log; what a run does is read from a file of that number.
TOY = """
import os, signal, sys, time
from pathlib import Path
from hrcplan.studies.study import Findings, Study, StudyTable

HERE = Path(__file__).parent

def episode(options, cell, seed):
    orders = HERE / f"run-{seed.run}"
    order = orders.read_text() if orders.exists() else ""
    if order == "raise":
        raise ZeroDivisionError("broken")
    if order == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if order == "leave":
        sys.exit(3)
    time.sleep(float(order or 0))
    with (HERE / "log").open("a") as log:
        log.write(f"{cell[0]} {seed.run}\\n")
    return {"x": seed.run * len(cell[0]), "text": str(seed)}

TABLE = StudyTable(
    "rows", ("cell",), ("x", "text"), lambda options: [("one",), ("three",)], episode)
STUDY = Study(
    "toy", "Toy", (TABLE,), ("x",), lambda options, rows: Findings("", (), ()),
    lambda options: (HERE / "input").read_text())
"""


def toy_study(folder: Path) -> None:
    """Write a study of two cells, ``toy:STUDY``, that reads one file."""
    (folder / "toy.py").write_text(TOY)
    (folder / "input").write_text("input")


class Cluster:
    """A scheduler, and workers; a context manager that kills all of them."""

    def __init__(self, folder: Path, n_workers: int = 2) -> None:
        self.folder = folder
        self._file = folder / "scheduler.json"
        self.processes: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0",
                                     "--scheduler-file", str(self._file))  # fmt: skip
        self.workers = [self.add_worker() for _ in range(n_workers)]
        wait_until(self._file.exists)

    def __enter__(self) -> "Cluster":
        return self

    def __exit__(self, *_: object) -> None:
        for process in self.processes:
            kill_group(process)

    @property
    def address(self) -> str:
        return str(json.loads(self._file.read_text())["address"])

    def add_worker(self, *options: str, **env: str) -> "subprocess.Popen[bytes]":
        """Start a worker with one thread; ``options`` are of ``dask worker``."""
        folder = self.folder / f"worker-{len(self.processes)}"
        return self._start("worker", "--scheduler-file", str(self._file), "--no-nanny",
                           "--nthreads", "1", "--local-directory", str(folder), *options,
                           **env)  # fmt: skip

    def _start(self, *words: str, **env: str) -> "subprocess.Popen[bytes]":
        process = subprocess.Popen(
            [sys.executable, "-c", _SCRIPT, *words, "--no-dashboard"], cwd=self.folder,
            env={**os.environ, **env}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True,
        )  # fmt: skip
        self.processes.append(process)
        return process


def kill_group(process: "subprocess.Popen[bytes]") -> None:
    """Kill a process with all that it has started, and wait for its end."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def wait_until(is_so: Callable[[], bool], s: float = 60.0) -> None:
    """Return when something is so."""
    deadline = time.monotonic() + s
    while not is_so():
        assert time.monotonic() < deadline, "it has not come to be"
        time.sleep(0.02)
