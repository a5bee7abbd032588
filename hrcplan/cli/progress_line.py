"""How far long work has come: one line that goes away on a terminal, else a line now and then."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TextIO

from hrcplan.core import progress
from hrcplan.core.text import cut

DELAY_S = 2.0
"""Work that ends earlier shows nothing."""
EVERY_S = 0.2
"""How often the line is written again at most."""
COLUMNS = 80
"""The width of a terminal that does not tell it."""
LOG_DELAY_S = 5.0
LOG_EVERY_S = 10.0


class ProgressLine:
    """Rewrites one line of a terminal; a copy of the process (a planner's worker) writes nothing.

    Args:
        stream: The terminal.
        clock: Seconds that only grow.
    """

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream = stream
        self._clock = clock
        self._pid = os.getpid()
        self._next_s: float | None = None
        self._width = 0

    def __call__(self, what: str, count: int | None) -> None:
        """Show how much there is, or clear the line if the work has ended."""
        now = self._clock()
        if os.getpid() != self._pid or self._stream.closed:
            return
        if count is None:
            self._next_s = None
            self._write("")
        elif self._next_s is None:
            self._next_s = now + DELAY_S
        elif now >= self._next_s:
            self._next_s = now + EVERY_S
            self._write(f"{count:,} {what} …")

    def _write(self, text: str) -> None:
        text = cut(text, max(1, self._columns() - 1))
        if text or self._width:
            self._stream.write(f"\r{text:{self._width}}{'' if text else chr(13)}")
            self._stream.flush()
            self._width = len(text)

    def _columns(self) -> int:
        try:
            return os.get_terminal_size(self._stream.fileno()).columns or COLUMNS
        except OSError:
            return COLUMNS


class ProgressLog:
    """Writes a line now and then, where standard error is a file or a pipe.

    Args:
        stream: Where to.
        clock: Seconds that only grow.
    """

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream = stream
        self._clock = clock
        self._pid = os.getpid()
        self._next_s: float | None = None

    def __call__(self, what: str, count: int | None) -> None:
        """Write how much there is, if it is time for that; an end of some work says nothing."""
        now = self._clock()
        if os.getpid() != self._pid or self._stream.closed or count is None:
            return
        if self._next_s is None:
            self._next_s = now + LOG_DELAY_S
        elif now >= self._next_s:
            self._next_s = now + LOG_EVERY_S
            self._stream.write(f"{count:,} {what} …\n")
            self._stream.flush()


def show_progress(stream: TextIO | None) -> None:
    """Show the progress of work on a stream; None is a closed one."""
    if stream is None:
        progress.listen(None)
    else:
        progress.listen(ProgressLine(stream) if stream.isatty() else ProgressLog(stream))
