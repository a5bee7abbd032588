"""One line on a terminal that says how far long work has come, and goes away when it is done."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TextIO

from hrcplan.core import progress

DELAY_S = 2.0
"""Work that ends earlier shows nothing."""
EVERY_S = 0.2
"""How often the line is written again at most."""


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
        if os.getpid() != self._pid:
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
        if text or self._width:
            self._stream.write(f"\r{text:{self._width}}{'' if text else chr(13)}")
            self._stream.flush()
            self._width = len(text)


def show_progress(stream: TextIO | None) -> None:
    """Show the progress of work on a stream if it is a terminal; None is a closed stream."""
    is_terminal = stream is not None and stream.isatty()
    progress.listen(ProgressLine(stream) if stream is not None and is_terminal else None)
