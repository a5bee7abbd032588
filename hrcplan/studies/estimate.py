"""Means with their standard errors, and differences between paired runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

CONFIDENT = 1.96
"""Standard errors on either side of a mean that hold it with 95 % confidence."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A mean over ``n`` independent values, and its standard error."""

    mean: float
    se: float
    n: int

    @property
    def is_above_zero(self) -> bool:
        """Whether the mean is larger than 0 with 95 % confidence; never for fewer than 2 values."""
        return self.n > 1 and self.mean > CONFIDENT * self.se and self.mean > 0

    @property
    def is_below_zero(self) -> bool:
        """Whether the mean is smaller than 0 with 95 % confidence."""
        return Estimate(-self.mean, self.se, self.n).is_above_zero

    def se_of(self, n: int) -> float:
        """Return the standard error that a mean over ``n`` values would have."""
        return self.se * math.sqrt(self.n / n)


def estimate(values: Iterable[float]) -> Estimate:
    """Return mean and standard error; zeros without values.

    >>> estimate([1, 3])
    Estimate(mean=2.0, se=1.0, n=2)
    """
    numbers = [float(value) for value in values]
    n = len(numbers)
    if n == 0:
        return Estimate(0.0, 0.0, 0)
    mean = math.fsum(numbers) / n
    variance = math.fsum((x - mean) ** 2 for x in numbers) / (n - 1) if n > 1 else 0.0
    return Estimate(mean, math.sqrt(variance / n), n)


def difference(ours: Mapping[int, float], theirs: Mapping[int, float]) -> Estimate:
    """Return the mean of ours minus theirs over the runs that both have.

    >>> difference({0: 5, 1: 7, 2: 9}, {0: 4, 1: 6})
    Estimate(mean=1.0, se=0.0, n=2)
    """
    return estimate(ours[run] - theirs[run] for run in sorted(ours.keys() & theirs.keys()))
