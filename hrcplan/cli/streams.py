"""Standard streams that are closed, full, or of another encoding: no reason for a traceback."""

from __future__ import annotations

import io
import os
import sys
from typing import TextIO


def prepare() -> None:
    """Make standard streams safe to use, before anything else opens a file.

    A descriptor below 3 that is free would go to the next file that is opened, and what a child
    process prints would land there. A stream that is closed becomes one without content, and
    characters that a stream cannot show become escapes.
    """
    while (handle := os.open(os.devnull, os.O_RDWR)) < 3:
        os.set_inheritable(handle, True)
    os.close(handle)
    # Python has None in place of a stream that was closed.
    sys.stdin = sys.stdin or os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdout = sys.stdout or os.fdopen(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(2, "w", encoding="utf-8", closefd=False)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def flush() -> OSError | None:
    """Write out what is left; return why the result cannot be, after which nothing is left.

    What is said on standard error is no result: that it cannot be written is not reported.
    """
    fault = None
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, ValueError) as error:
            if isinstance(error, OSError) and stream is sys.stdout:
                fault = error
            _discard(stream)
    return fault


def _discard(stream: TextIO) -> None:
    """Send the rest of a stream nowhere, so that the end of the program does not fail."""
    try:
        number = stream.fileno()
    except (OSError, ValueError):
        return
    handle = os.open(os.devnull, os.O_WRONLY)
    os.dup2(handle, number)
    os.close(handle)
