"""One way to give up in time."""

from __future__ import annotations

import time

from hrcplan.errors import LimitError


def check_time(deadline: float, when: str) -> None:
    """Raise once a deadline, by ``time.monotonic()``, has passed.

    Raises:
        LimitError: naming when: "out of time ...".
    """
    if time.monotonic() > deadline:
        raise LimitError(f"out of time {when}")
