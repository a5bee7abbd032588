"""Work in a copy of this process: it can be ended at any time, and ends with this process.

A fork shares what was grounded already, and starts within milliseconds. What the copy finds comes
back through a pipe.
"""

from __future__ import annotations

import contextlib
import ctypes
import faulthandler
import gc
import os
import signal
import time
from collections.abc import Callable, Sequence
from itertools import chain
from types import FrameType
from typing import Any, Generic, NoReturn, TypeVar

from hrcplan.planners.guard import PR_SET_PDEATHSIG, below, children, proportional, resident
from hrcplan.planners.messages import Inbox, send

M = TypeVar("M")
Work = Callable[[Callable[[M], None]], None]
"""What a copy does: it sends what it finds with the function that it is given."""

GRACE_S = 0.5
"""Between the request to end, in which a planner's processes are cleared up, and a kill."""
SHORTEST_S = 0.0005
"""How soon it is looked at first whether workers have ended."""
_DEATH = signal.SIGUSR1
_BLOCKED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Worker(Generic[M]):
    """A copy of this process that does some work; ``fd`` can be waited for.

    Use it from a process with one thread: locks that other threads hold stay locked in the copy.
    """

    def __init__(self, work: Work[M], group: int = 0) -> None:
        """Start the work in a process group, by default in one of its own."""
        self.fd, write = os.pipe()
        self._inbox = Inbox(self.fd)
        parent = os.getpid()
        # In the copy, a handler of the caller would leave through the code of the caller.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, _BLOCKED)
        try:
            self.pid = os.fork()
            if self.pid == 0:
                _become(work, write, parent, group, mask)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        os.close(write)

    def receive(self) -> list[object]:
        """Return what has arrived; at the end of the work ``is_over`` is set."""
        return self._inbox.receive()

    @property
    def is_over(self) -> bool:
        """Whether the work has ended and all its messages are read."""
        return self._inbox.is_over

    @property
    def is_running(self) -> bool:
        """Whether the worker has not ended; one that was waited for elsewhere has ended."""
        try:
            state = os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        except ChildProcessError:
            return False
        return state is None

    def signal(self, number: int) -> None:
        """Send a signal, unless it has ended."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, number)

    def close(self) -> None:
        """Forget a worker that has ended."""
        os.close(self.fd)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.pid, 0)


class Watch:
    """A copy of this process that ends a process group if this process dies, also by SIGKILL.

    Workers get SIGTERM then anyway; this is for those that ignore it. ``group`` is the group.
    """

    def __init__(self) -> None:
        parent = os.getpid()
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, (*_BLOCKED, _DEATH))
        try:
            self.group = os.fork()
            if self.group == 0:
                _stand_by(parent)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        with contextlib.suppress(OSError):  # it may have done so already
            os.setpgid(self.group, self.group)

    def close(self) -> None:
        """End the watch, after the workers."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.group, signal.SIGKILL)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.group, 0)


def _stand_by(parent: int) -> NoReturn:
    """Wait for the death of the parent; then end the process group, this process included."""
    try:
        os.setpgid(0, 0)
        _close_streams()
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, _DEATH, 0, 0, 0)
        if os.getppid() == parent:
            signal.sigwait([_DEATH])
        os.killpg(0, signal.SIGTERM)  # blocked here
        time.sleep(GRACE_S)
        os.killpg(0, signal.SIGKILL)
    finally:
        os._exit(0)


def end(workers: Sequence[Worker[Any]]) -> bool:
    """End workers and all that they have started: asked first, killed after ``GRACE_S``.

    Returns:
        Whether each has ended by itself, and so has cleared up.
    """
    for worker in workers:
        worker.signal(signal.SIGTERM)
    deadline = time.monotonic() + GRACE_S
    waiting, pause_s = list(workers), SHORTEST_S
    while waiting and time.monotonic() < deadline:
        waiting = [worker for worker in waiting if worker.is_running]
        time.sleep(pause_s if waiting else 0)
        pause_s = min(10 * SHORTEST_S, 2 * pause_s)
    for worker in waiting:
        worker.signal(signal.SIGKILL)
    for worker in workers:
        worker.close()
    return not waiting


def largest_beyond(workers: Sequence[Worker[M]], memory_bytes: int) -> Worker[M] | None:
    """Return the worker that uses most memory, if all together use more than they may.

    What they have started counts, too; shared memory counts in part.
    """
    tree = children()
    pids = [[worker.pid, *below(worker.pid, tree)] for worker in workers]
    if sum(map(resident, chain.from_iterable(pids))) <= memory_bytes:
        return None
    sizes = [sum(map(proportional, group)) for group in pids]
    return None if sum(sizes) <= memory_bytes else workers[sizes.index(max(sizes))]


class _EndRequest(BaseException):
    """The worker was asked to end; not an Exception, so that nothing on the way handles it."""


def _become(work: Work[M], write: int, parent: int, group: int, mask: set[int]) -> NoReturn:
    """Do the work in this forked copy, and end; ``mask`` are the signals that it blocks."""
    try:
        gc.freeze()  # what is shared stays shared
        faulthandler.disable()  # a request to end may abort an extension that is being imported
        os.setpgid(0, group)  # Ctrl-C in a terminal is for the parent alone
        _close_streams()
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, _raise)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
        if os.getppid() == parent:
            work(lambda message: send(write, message))
    except BaseException:  # noqa: BLE001  the parent sees that the work has ended
        pass
    finally:
        os._exit(0)


def _close_streams() -> None:
    """Let nothing be read or printed: what libraries print while they are ended is of no use."""
    quiet = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(quiet, stream)


def _raise(number: int, frame: FrameType | None) -> NoReturn:
    raise _EndRequest
