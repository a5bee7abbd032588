"""How servers over standard input and output end at a signal."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_SHELL_CODE = 128  # what a shell adds to the number of a signal


def end_at_signals(clean: Callable[[], None] = lambda: None) -> None:
    """Let Ctrl-C, SIGTERM and SIGHUP end the process at once, with 128 plus the signal's number.

    A thread of the server waits for standard input, and Python would wait for this thread. Child
    processes end with their parent.

    Args:
        clean: Removes what would be left.
    """

    def end(number: int, frame: FrameType | None) -> None:
        try:
            clean()
        finally:
            os._exit(_SHELL_CODE + number)

    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:  # as nohup sets it
            signal.signal(number, end)
