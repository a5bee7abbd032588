"""The clock of a run with a robot: it never goes back, and can stand still."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from hrcplan.core.steady_clock import SteadyClock


class RunClock:
    """Seconds of a run since `begin`, from a clock that may jump; ``speed`` of them in a second."""

    def __init__(self, speed: float = 1.0, real: Callable[[], float] = time.monotonic) -> None:
        self.speed = speed
        self._real = SteadyClock(real)
        self._last_s = self._begun_s = 0.0
        self._stopped_s: float | None = None

    def begin(self, t: float = 0.0) -> None:
        """Let the time of the run be ``t`` now."""
        self._begun_s = self._real() - t / self.speed
        self._last_s = t

    @property
    def now_s(self) -> float:
        """The time of the run, in hundredths of a second: instants are not shorter."""
        if self._stopped_s is None:
            now_s = (self._real() - self._begun_s) * self.speed
            self._last_s = max(self._last_s, round(now_s, 2))
        return self._last_s

    @property
    def real_s(self) -> float:
        """The time of the real clock, for limits on a robot's answers."""
        return self._real()

    def real_until(self, t: float) -> float:
        """Return how many real seconds are left until a time of the run."""
        return math.inf if self.is_stopped else max(0.0, (t - self.now_s) / self.speed)

    @property
    def is_stopped(self) -> bool:
        """Whether the clock stands still."""
        return self._stopped_s is not None

    def stop(self) -> None:
        """Stand still."""
        self._stopped_s = self.now_s

    def go_on(self) -> None:
        """Go on from where it stopped."""
        if self._stopped_s is not None:
            self._begun_s = self._real() - self._stopped_s / self.speed
            self._stopped_s = None
