"""A clock that no jump of the machine's clock turns back."""

from __future__ import annotations

import math
import time
from collections.abc import Callable


class SteadyClock:
    """Seconds of another clock, as far as they make sense.

    A jump back counts as no time. So does what is beyond ``most_s`` between two readings, for those
    who read it often: the machine slept, or its clock was set.

    Args:
        real: The other clock.
        most_s: The most time between two readings that counts.
    """

    def __init__(
        self, real: Callable[[], float] = time.monotonic, most_s: float = math.inf
    ) -> None:
        self._real, self._most_s = real, most_s
        self._read_s = self._now_s = real()

    def __call__(self) -> float:
        """Return the time, which is never before that of the last call."""
        read_s = self._real()
        self._now_s += min(max(0.0, read_s - self._read_s), self._most_s)
        self._read_s = read_s
        return self._now_s
