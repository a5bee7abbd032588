"""How far long work has come: one line that goes away on a terminal, else a line now and then."""

from __future__ import annotations

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import TextIO

from hrcplan.core import progress
from hrcplan.core.text import cut, harmless

DELAY_S = 2.0
"""Work that ends earlier shows nothing."""
EVERY_S = 0.2
"""How often the line is written again at most."""
COLUMNS = 80
"""The width of a terminal that does not tell it."""
LOG_DELAY_S = 5.0
LOG_EVERY_S = 10.0


class _ProgressWriter(ABC):
    """Decides when progress is written; a copy of the process (a planner's worker) writes nothing.

    Args:
        stream: Where to.
        clock: Seconds that only grow.
    """

    delay_s: float
    every_s: float

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream = stream
        self._clock = clock
        self._pid = os.getpid()
        self._next_s: float | None = None

    def __call__(self, what: str, count: int | None) -> None:
        """Show how much there is if it is time for that; None ends the work."""
        now = self._clock()
        if os.getpid() != self._pid or self._stream.closed:
            return
        with suppress(OSError):  # the work goes on where its progress cannot be shown
            if count is None:
                self._end()
            elif self._next_s is None:
                self._next_s = now + self.delay_s
            elif now >= self._next_s:
                self._next_s = now + self.every_s
                self._write(harmless(f"{count:,} {what} …"))

    @abstractmethod
    def _write(self, text: str) -> None:
        """Write how much there is, or nothing."""

    @abstractmethod
    def _end(self) -> None:
        """Do what the end of some work needs."""


class ProgressLine(_ProgressWriter):
    """Rewrites one line of a terminal, and clears it when the work has ended."""

    delay_s = DELAY_S
    every_s = EVERY_S
    _width = 0

    def _write(self, text: str) -> None:
        text = cut(text, max(1, self._columns() - 1))
        if text or self._width:
            self._stream.write(f"\r{text:{self._width}}{'' if text else chr(13)}")
            self._stream.flush()
            self._width = len(text)

    def _end(self) -> None:
        self._next_s = None
        self._write("")

    def _columns(self) -> int:
        try:
            return os.get_terminal_size(self._stream.fileno()).columns or COLUMNS
        except OSError:
            return COLUMNS


class ProgressLog(_ProgressWriter):
    """Writes a line now and then, where standard error is a file or a pipe."""

    delay_s = LOG_DELAY_S
    every_s = LOG_EVERY_S

    def _write(self, text: str) -> None:
        self._stream.write(f"{text}\n")
        self._stream.flush()

    def _end(self) -> None:
        """Write nothing: the lines stay."""


def show_progress(stream: TextIO | None) -> None:
    """Show the progress of work on a stream; None is a closed one."""
    if stream is None:
        progress.listen(None)
    else:
        progress.listen(ProgressLine(stream) if stream.isatty() else ProgressLog(stream))
