"""A program that is spoken to in lines while it runs, below the same guard as planners.

It ends with this process, even if that is killed. Reading and writing never block for longer than
their time limit, however the program behaves: deaf, flooding, or without an end of line.
"""

from __future__ import annotations

import contextlib
import marshal
import os
import selectors
import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType

from hrcplan.planners.process import ProcessLimits, guarded_program, job_message

MAX_LINE = 1 << 20  # bytes; a longer line is dropped
WRITE_S = 2.0  # how long a program may take to read what is written
_CHUNK = 1 << 16
_LAST_WORDS = 2000  # bytes of standard error that are kept


class LineProcess:
    """A running program: lines to its standard input, lines from its standard output.

    Attributes:
        n_bytes: How many bytes it has written so far.
        ending: How it ended, such as "exit code 1"; None while it runs.
    """

    def __init__(
        self, argv: Sequence[str], *, cwd: Path, env: Mapping[str, str] | None = None,
        memory_bytes: int | None = 4 << 30,
    ) -> None:  # fmt: skip
        """Start a program.

        Raises:
            ValueError: if ``argv`` is empty.
            OSError: if ``cwd`` is no folder, or no further process can be started.
        """
        self.n_bytes = 0
        self.ending: str | None = None
        self._part, self._is_cut = bytearray(), False
        self._stderr: deque[int] = deque(maxlen=_LAST_WORDS)
        self._exits = contextlib.ExitStack()
        read_end, self._input = os.pipe()
        os.set_blocking(self._input, False)
        try:
            self._exits.callback(os.close, self._input)
            limits = ProcessLimits(float("inf"), memory_bytes)
            job = job_message(argv, limits, env, read_end)
            program = guarded_program(job, cwd, read_end)
            self._guard, self._report = self._exits.enter_context(program)
        except BaseException:
            self._exits.close()
            raise
        finally:
            os.close(read_end)
        self._ready = self._exits.enter_context(selectors.PollSelector())
        assert self._guard.stdout
        assert self._guard.stderr
        self._stdout_fd, self._stderr_fd = self._guard.stdout.fileno(), self._guard.stderr.fileno()
        for fd in (self._stdout_fd, self._stderr_fd, self._report):
            self._ready.register(fd, selectors.EVENT_READ)

    def write_line(self, line: str) -> bool:
        """Write a line; return whether the program has room for it within `WRITE_S` seconds."""
        data = line.encode() + b"\n"
        until = time.monotonic() + WRITE_S
        with selectors.PollSelector() as writable:
            writable.register(self._input, selectors.EVENT_WRITE)
            while data:
                left_s = until - time.monotonic()
                if left_s <= 0 or not writable.select(left_s):
                    return False
                try:
                    data = data[os.write(self._input, data) :]
                except BlockingIOError:
                    continue
                except BrokenPipeError:
                    return False
        return True

    def read_lines(self, timeout_s: float) -> list[str | None]:
        """Return the lines that arrive next, none after a time; None for a line that is too long.

        Bytes that are no UTF-8 are replaced. When the program has ended, ``ending`` says how.
        """
        lines: list[str | None] = []
        until = time.monotonic() + timeout_s
        while not lines and self.ending is None:
            woken = {key.fd for key, _ in self._ready.select(max(0.0, until - time.monotonic()))}
            if self._stderr_fd in woken:
                self._stderr.extend(self._read(self._stderr_fd))
            if self._stdout_fd in woken:
                lines = self._split(self._read(self._stdout_fd))
            elif woken == {self._report}:
                self._end(os.read(self._report, _CHUNK))
            if time.monotonic() >= until:
                break
        return lines

    def _read(self, fd: int) -> bytes:
        piece = os.read(fd, _CHUNK)
        if not piece:
            self._ready.unregister(fd)
        return piece

    def _split(self, piece: bytes) -> list[str | None]:
        self.n_bytes += len(piece)
        *whole, rest = piece.split(b"\n")
        lines: list[str | None] = []
        for end in whole:
            self._part += end
            too_long = self._is_cut or len(self._part) > MAX_LINE
            lines.append(None if too_long else self._part.decode("utf-8", "replace"))
            self._part.clear()
            self._is_cut = False
        self._part += rest
        if len(self._part) > MAX_LINE:
            self._part.clear()
            self._is_cut = True
        return lines

    def _end(self, answer: bytes) -> None:
        reason, code, message = marshal.loads(answer) if answer else ("lost", None, "")
        if reason == "exited" and code is not None:
            self.ending = f"exit code {code}" if code >= 0 else f"signal {-code}"
        else:
            self.ending = message or f"ended: {reason}"

    @property
    def last_words(self) -> str:
        """The end of what the program wrote to standard error."""
        return bytes(self._stderr).decode("utf-8", "replace").strip()

    def close(self) -> None:
        """End the program and all that it started; return when nothing is left of it."""
        self._exits.close()
        self.ending = self.ending or "closed"

    def __enter__(self) -> LineProcess:
        """Return the process itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        """End the program."""
        self.close()
