"""How far long work has come: functions that work report it, and at most one listener shows it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[str, int | None], None]
"""Is called with what is counted and how much there is; with None once the work has ended."""

_listeners: list[Listener] = []


def listen(listener: Listener | None) -> None:
    """Call a listener for all work from now on; None for no listener."""
    _listeners[:] = [] if listener is None else [listener]


@contextmanager
def counting(what: str) -> Iterator[Callable[[int], None]]:
    """Yield a function that reports how much there is; the end is reported in any case.

    >>> heard = []
    >>> listen(lambda what, count: heard.append((what, count)))
    >>> with counting("steps") as tell:
    ...     tell(256)
    >>> heard
    [('steps', 256), ('steps', None)]
    >>> listen(None)
    """
    try:
        yield lambda count: report(what, count)
    finally:
        hide(what)


def report(what: str, count: int | None) -> None:
    """Report how much there is of something, outside of `counting`."""
    for listener in _listeners:
        listener(what, count)


def hide(what: str = "") -> None:
    """Let the listener take away what it shows, before something else is printed."""
    report(what, None)
