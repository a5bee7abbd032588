"""Processes of a worker in which tasks are run, one for each of its threads.

A task has a process of its own, and so the code and the files as they are when the study begins,
the current folder of the parent, and no thread next to it. What kills it does not kill the worker.
It ends with the worker, when the study is over, and after a time without tasks.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import select
import subprocess
import sys
import threading
from collections.abc import Callable
from functools import partial
from typing import BinaryIO, Concatenate, ParamSpec, TypeVar

from hrcplan.studies.cluster.tasks import (
    ClusterJob,
    DifferenceError,
    WorkerError,
    check_software,
)
from hrcplan.studies.runner import end_with

P = ParamSpec("P")
T = TypeVar("T")

IDLE_S = 60.0
"""How long a process waits for its next task."""
_SCRIPT = """import sys
sys.path += [path for path in sys.argv[1:] if path not in sys.path]
from hrcplan.studies.cluster.process import serve
serve()
"""

_processes: dict[int, TaskProcess] = {}
"""The process of each thread of this worker."""


def call(function: Callable[Concatenate[ClusterJob, P], T], job: ClusterJob,
         *args: P.args, **more: P.kwargs) -> T:  # fmt: skip
    """Return the value of a function of ``tasks``, called in the process of this thread.

    Raises:
        DifferenceError: if this worker differs from the parent.
        WorkerError: if the function raises, or the process ends.
    """
    check_software(job)
    thread = threading.get_ident()
    process = _processes.get(thread)
    if process is None or process.job != job or not process.is_alive:
        if process is not None:
            process.end()
        process = _processes[thread] = TaskProcess(job)
    return process.call(function, *args, **more)


def end_processes(job: ClusterJob) -> None:
    """End the processes of this worker that run tasks of a job."""
    for process in [process for process in _processes.values() if process.job == job]:
        process.end()


class TaskProcess:
    """A process that runs tasks of one job, in the parent's folder where that is there.

    Args:
        job: The job.
    """

    def __init__(self, job: ClusterJob) -> None:
        self.job = job
        folder = job.folder if os.path.isdir(job.folder) else None
        self._process = subprocess.Popen(
            [sys.executable, "-c", _SCRIPT, *map(os.path.abspath, sys.path)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder,
            env={**os.environ, "PYTHONSAFEPATH": "1"},
        )  # fmt: skip

    @property
    def is_alive(self) -> bool:
        """Whether the process can take a task."""
        return self._process.poll() is None

    def call(self, function: Callable[Concatenate[ClusterJob, P], T],
             *args: P.args, **more: P.kwargs) -> T:  # fmt: skip
        """Return the value of a function.

        Raises:
            DifferenceError: if this worker differs from the parent.
            WorkerError: if the function raises, or the process ends.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            pickle.dump((function, self.job, args, more), self._process.stdin)
            self._process.stdin.flush()
            value, fault = pickle.load(self._process.stdout)
        except (OSError, EOFError, ValueError):
            code = self._process.wait()
            how = f"was killed by signal {-code}" if code < 0 else f"ended with exit code {code}"
            raise WorkerError(f"its process {how}") from None
        if fault is not None:
            raise fault
        result: T = value
        return result

    def end(self) -> None:
        """Kill the process, whatever it does."""
        self._process.kill()
        self._process.wait()


def serve() -> None:
    """Run tasks that come on standard input, until it ends or none comes for long."""
    end_with(os.getppid())
    tasks, answers = _private_streams()
    while select.select([tasks], [], [], IDLE_S)[0]:
        try:
            function, job, args, more = pickle.load(tasks)
        except EOFError:
            return
        answer = _answer(partial(function, job, *args, **more))
        with contextlib.suppress(BrokenPipeError):
            pickle.dump(answer, answers)
            answers.flush()


def _private_streams() -> tuple[BinaryIO, BinaryIO]:
    """Return the standard streams; what tasks read is empty, and what they print an error text."""
    tasks = os.fdopen(os.dup(0), "rb", buffering=0)
    answers = os.fdopen(os.dup(1), "wb")
    empty = os.open(os.devnull, os.O_RDONLY)
    os.dup2(empty, 0)
    os.dup2(2, 1)
    return tasks, answers


def _answer(task: Callable[[], T]) -> tuple[T | None, Exception | None]:
    """Return the value of a task, or why there is none."""
    try:
        return _with_plain_errors(task), None
    except (DifferenceError, WorkerError) as error:
        return None, error


def _with_plain_errors(task: Callable[[], T]) -> T:
    """Return the value of a task; what it raises may be of a class that the parent cannot read."""
    try:
        return task()
    except (DifferenceError, WorkerError):
        raise
    except (Exception, SystemExit) as error:
        text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        notes = "".join(f" ({note})" for note in getattr(error, "__notes__", ()))
        raise WorkerError(text + notes) from error
