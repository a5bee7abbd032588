"""The race of planners in a process of its own, for callers that have several threads.

A copy of a process with several threads may hang: locks that other threads hold stay locked in it.
So a fresh process with one thread makes the copies. It runs below the guard of planners, which
ends it and all its copies when this process ends, also by SIGKILL.
"""

from __future__ import annotations

import os
import pickle
import selectors
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

from hrcplan.errors import HrcplanError, LimitError, PlannerError
from hrcplan.planners.choice import Job
from hrcplan.planners.contract import Replays, Request, ignore_plan
from hrcplan.planners.messages import Inbox, send
from hrcplan.planners.portfolio import Portfolio
from hrcplan.planners.process import ProcessLimits, guarded_program, job_message
from hrcplan.planners.race import OnBetter, race
from hrcplan.planners.result import Result

_CODE = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from hrcplan.planners.race_process import run_race; run_race()"
)
_PATIENCE_S = 5.0
"""How long after the deadline the process may go on before the guard ends it."""
_LAST_WORDS = 300
_CHUNK = 1 << 16


def race_in_process(
    request: Request, waiting: Iterable[Job], lanes: bool, on_better: OnBetter
) -> Portfolio:
    """Return what jobs say that run side by side in another process; see `race.race`.

    Raises:
        LimitError: if the process does not end soon after the deadline.
        PlannerError: if the process is lost, for example for want of memory.
    """
    limits = ProcessLimits(request.time_left_s + _PATIENCE_S, memory_bytes=None)
    plain_request = replace(request, replays=Replays(), on_plan=ignore_plan)
    with TemporaryFile() as file:
        pickle.dump(sys.path, file)
        pickle.dump((plain_request, tuple(waiting), lanes), file)
        file.seek(0)
        argv = [sys.executable, "-P", "-W", "ignore", "-c", _CODE]
        job = job_message(argv, limits, None, file.fileno())
        with guarded_program(job, Path(), file.fileno()) as (guard, report):
            assert guard.stdout
            assert guard.stderr
            answers = _Answers(guard.stdout, guard.stderr, report)
            portfolio = answers.read(on_better)
    if portfolio is None and request.time_left_s <= 0:
        raise LimitError("the race of planners did not end in time")
    if portfolio is None:
        raise PlannerError(f"the race of planners was lost: {answers.last_words}")
    portfolio.problem = request.problem
    return portfolio


class _Answers:
    """What the process sends, and the end of what it writes to standard error."""

    def __init__(self, stdout: IO[bytes], stderr: IO[bytes], report: int) -> None:
        self._inbox = Inbox(stdout.fileno())
        self._stderr, self._report = stderr.fileno(), report
        self._words = b""

    @property
    def last_words(self) -> str:
        """The end of its standard error, for a message."""
        words = self._words.decode("utf-8", "replace").strip()
        return words or "its process was killed"

    def read(self, on_better: OnBetter) -> Portfolio | None:
        """Return the last answer; None if the process ends without one."""
        with selectors.PollSelector() as ready:
            for fd in (self._inbox.fd, self._stderr, self._report):
                ready.register(fd, selectors.EVENT_READ)
            while True:
                woken = {key.fd for key, _ in ready.select()}
                if self._stderr in woken and not self._read_words():
                    ready.unregister(self._stderr)
                for message in self._inbox.receive() if self._inbox.fd in woken else ():
                    if isinstance(message, Portfolio):
                        return message
                    if isinstance(message, HrcplanError):
                        raise message
                    if isinstance(message, Result):
                        on_better(message)
                if self._inbox.is_over or woken == {self._report}:
                    return None

    def _read_words(self) -> bool:
        piece = os.read(self._stderr, _CHUNK)
        self._words = (self._words + piece)[-_LAST_WORDS:]
        return bool(piece)


def run_race() -> None:
    """Do what standard input asks for, and answer on standard output: what the process does."""
    answers = os.dup(sys.stdout.fileno())
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    request, waiting, lanes = pickle.load(sys.stdin.buffer)
    try:
        message: object = race(request, waiting, lanes, lambda result: send(answers, result))
    except HrcplanError as error:
        message = error
    send(answers, message)
