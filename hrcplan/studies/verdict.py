"""Verdicts on claims: holds, fails, or too few runs to tell; judged by intervals, not by means."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from hrcplan.studies.estimate import Interval

HOLDS, FAILS, TOO_FEW = "holds", "fails", "too-few"
MOST_RUNS = 10_000_000
"""If more runs than these would tell, their number is not said: the value may be the bound."""


@dataclass(frozen=True, slots=True)
class BoundTest:
    """Whether a value lies between bounds, judged by its interval.

    Attributes:
        interval: Of the value.
        least: The lower bound.
        most: The upper bound.
        is_strict: Whether the value must differ from the bounds.
    """

    interval: Interval
    least: float = -math.inf
    most: float = math.inf
    is_strict: bool = False

    @property
    def holds(self) -> bool | None:
        """Whether the interval lies wholly inside or outside of the bounds; None if neither."""
        low, high, least, most = self.interval.low, self.interval.high, self.least, self.most
        if not self.interval.is_known:
            return None
        if high < least or low > most or (self.is_strict and (high <= least or low >= most)):
            return False
        return True if low >= least and high <= most else None

    @property
    def n_telling(self) -> float:
        """How many runs would tell, if the mean stays and the error falls as for independent runs.

        Infinite where the mean is on a bound, or the error is not known.
        """
        gap = min(abs(self.interval.mean - self.least), abs(self.interval.mean - self.most))
        if not self.interval.is_known or gap == 0:
            return math.inf
        return self.interval.n * ((self.interval.high - self.interval.low) / 2 / gap) ** 2


def judge(tests: Iterable[BoundTest]) -> tuple[bool | None, str]:
    """Return whether all tests hold (None: too few runs to tell), and how many runs would tell.

    One test that fails is enough for False.

    >>> judge([BoundTest(Interval(1.0, -1.0, 3.0, 50), least=0.0)])
    (None, ' Too few runs to tell; about 200 would (an estimate).')
    >>> judge([BoundTest(Interval(1.0, 0.5, 1.5, 50), least=0.0)])
    (True, '')
    """
    tests = list(tests)
    verdicts = [test.holds for test in tests]
    if False in verdicts:
        return False, ""
    if None not in verdicts:
        return True, ""
    n = max(test.n_telling for test in tests if test.holds is None)
    if n > MOST_RUNS:
        return None, " Too few runs to tell; how many would cannot be said."
    return None, f" Too few runs to tell; about {_round(n):,} would (an estimate)."


def _round(n: float) -> int:
    """Return a number of runs, rounded up to two digits."""
    unit = int("1" + "0" * (len(str(math.ceil(n))) - 2))
    return math.ceil(n / unit) * unit


def verdict_of(holds: bool | None) -> str:
    """Return the verdict as ``report.json`` has it.

    >>> verdict_of(True), verdict_of(False), verdict_of(None)
    ('holds', 'fails', 'too-few')
    """
    return TOO_FEW if holds is None else HOLDS if holds else FAILS
