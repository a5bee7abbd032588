"""Lines that people type, or that a program sends: whatever comes is text that harms nothing."""

from __future__ import annotations

import sys
from typing import BinaryIO

from hrcplan.cli import output

MAX_LINE = 2000  # bytes; a longer line is no step
_CHUNK = 1 << 16


class EndOfInputError(Exception):
    """There are no more lines: the terminal is closed, or the pipe has ended."""


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

    def next(self, prompt: str = "") -> str:
        """Return the next line, without spaces around it.

        Raises:
            EndOfInputError: if there is none.
        """
        if self.is_terminal and not output.JSON:
            output.prompt(prompt)
        raw = self._read()
        text = raw.decode("utf-8", "replace").replace("\ufffd", " ")
        return " ".join("".join(c if c.isprintable() else " " for c in text).split())

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
