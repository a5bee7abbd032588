"""Lines that people type, or that a program sends: whatever comes is text that harms nothing."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, Queue
from threading import Thread
from typing import BinaryIO

from hrcplan.cli import output

MAX_LINE = 2000  # bytes; a longer line is no step
_CHUNK = 1 << 16
_TICK_S = 0.05  # between two looks at what is typed


class EndOfInputError(Exception):
    """There are no more lines: the terminal is closed, or the pipe has ended."""


class InterruptedInputError(Exception):
    """Something has happened while a line was waited for; what is typed is not lost."""


class InputLines:
    """The lines of standard input.

    Bytes that are no UTF-8 and control characters become spaces; a line that is too long is empty
    and ``is_too_long``.
    """

    def __init__(self, stream: BinaryIO | None = None) -> None:
        stdin = sys.stdin
        self._stream = stream or (None if stdin is None else stdin.buffer)
        self.is_terminal = stream is None and stdin is not None and stdin.isatty()
        self.is_too_long = False
        self._queue: Queue[tuple[bytes | None, bool]] | None = None

    def next(self, prompt: str = "", interrupt: Callable[[float], bool] | None = None) -> str:
        """Return the next line, without spaces around it.

        Args:
            prompt: Stands before what is typed.
            interrupt: Waits for some seconds, and returns whether something has happened.

        Raises:
            EndOfInputError: if there is none.
            InterruptedInputError: if something has happened.
        """
        if self.is_terminal and not output.JSON:
            output.prompt(prompt)
        raw = self._read() if interrupt is None else self._read_or_interrupt(interrupt)
        text = raw.decode("utf-8", "replace").replace("\ufffd", " ")
        return " ".join("".join(c if c.isprintable() else " " for c in text).split())

    def _read_or_interrupt(self, interrupt: Callable[[float], bool]) -> bytes:
        """Return the next line, which a thread reads."""
        if self._queue is None:
            self._queue = Queue()
            if self._stream is not None:
                # Python waits at its end for who reads standard input itself.
                self._stream = os.fdopen(os.dup(self._stream.fileno()), "rb")
            Thread(target=self._fill, args=[self._queue], daemon=True).start()
        while True:
            with suppress(Empty):
                line, self.is_too_long = self._queue.get_nowait()
                if line is None:
                    self._queue.put((None, False))
                    raise EndOfInputError
                return line
            if interrupt(_TICK_S):
                if self.is_terminal and not output.JSON:
                    output.prompt("\n")
                raise InterruptedInputError

    def _fill(self, queue: Queue[tuple[bytes | None, bool]]) -> None:
        try:
            while True:
                line = self._read()
                queue.put((line, self.is_too_long))
        except EndOfInputError:
            queue.put((None, False))

    def _read(self) -> bytes:
        if self._stream is None:
            raise EndOfInputError
        try:
            raw = self._stream.readline(MAX_LINE + 1)
        except (OSError, ValueError) as error:
            raise EndOfInputError from error
        if not raw:
            raise EndOfInputError
        self.is_too_long = len(raw) > MAX_LINE and not raw.endswith(b"\n")
        if not self.is_too_long:
            return raw
        while raw and not raw.endswith(b"\n"):
            raw = self._stream.readline(_CHUNK)
        return b""
