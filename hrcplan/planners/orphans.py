"""Processes that lost their supervisor: found below a process or as adopted children, and ended."""

from __future__ import annotations

import ctypes
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_PR_SET_CHILD_SUBREAPER = 36
_PATIENCE_S = 5.0
_PAUSE_S = 0.01

_lock = threading.Lock()
_families: list[Family] = []


def _forget_families() -> None:
    """Begin without families: they are the parent's, and so is a thread that holds the lock."""
    global _lock
    _lock = threading.Lock()
    _families.clear()


os.register_at_fork(after_in_child=_forget_families)


class Family:
    """The children that this process had before it started a supervisor."""

    def __init__(self) -> None:
        self._before = _children() if _has_children() else set()

    def end_orphans(self) -> None:
        """Kill the programs that became children of this process when all above them were killed.

        They are new and lead, or belong to, another session; other children of the caller share
        its session or were there before.
        """
        session, until = os.getsid(0), time.monotonic() + _PATIENCE_S
        while time.monotonic() < until:
            orphans = [pid for pid in self._orphans() if _session(pid) not in (session, None)]
            if not orphans:
                return
            for pid in orphans:
                end_tree(pid)
            time.sleep(_PAUSE_S)
            for pid in orphans:
                with suppress(ChildProcessError):
                    os.waitpid(pid, os.WNOHANG)

    def _orphans(self) -> list[int]:
        with _lock:
            if len(_families) > 1:  # supervisors of other threads are new children, too
                return []
        own = [pid for pid, parent in _parents("X").items() if parent == os.getpid()]
        return [pid for pid in own if pid not in self._before]


@contextmanager
def adoption() -> Iterator[Family]:
    """Let this process adopt what loses its parent; yield what tells adopted children apart."""
    family = Family()
    with _lock:
        _families.append(family)
        _set_subreaper(True)
    try:
        yield family
    finally:
        with _lock:
            if family in _families:  # not in a copy of the process that began
                _families.remove(family)
            if not _families:
                _set_subreaper(False)


def end_tree(pid: int) -> None:
    """Kill a process and all below it, the lowest first; a stopped process dies, too."""
    until = time.monotonic() + _PATIENCE_S
    while (below := _running_below(pid)) and time.monotonic() < until:
        for one in reversed(below):
            _kill(one)
        time.sleep(_PAUSE_S)
    _kill(pid)


def _kill(pid: int) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.kill(pid, signal.SIGKILL)


def _set_subreaper(value: bool) -> None:
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, int(value), 0, 0, 0)


def _running_below(pid: int) -> list[int]:
    """Return what can still run below a process, the highest first."""
    children: dict[int, list[int]] = {}
    for child, parent in _parents().items():
        children.setdefault(parent, []).append(child)
    ids = list(children.get(pid, ()))
    for one in ids:  # grows while it is walked
        ids.extend(children.get(one, ()))
    return ids


def _parents(dead: str = "XZ") -> dict[int, int]:
    """Return the parent of every process whose state is not one of ``dead``."""
    parents = {}
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError, ValueError):
            state, parent = (folder / "stat").read_text().rpartition(")")[2].split()[:2]
            if state not in dead:
                parents[int(folder.name)] = int(parent)
    return parents


def _has_children() -> bool:
    """Return whether this process has children; that is known at once."""
    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return False
    return True


def _children() -> set[int]:
    return {pid for pid, parent in _parents().items() if parent == os.getpid()}


def _session(pid: int) -> int | None:
    try:
        return os.getsid(pid)
    except OSError:
        return None
