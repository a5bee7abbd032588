"""Means with their standard errors, and differences between paired runs."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

CONFIDENT = 1.96
"""Standard errors on either side of a mean that hold it with 95 % confidence."""


@dataclass(frozen=True, slots=True)
class MeanEstimate:
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
        return MeanEstimate(-self.mean, self.se, self.n).is_above_zero

    def se_of(self, n: int) -> float:
        """Return the standard error that a mean over ``n`` values would have."""
        return self.se * math.sqrt(self.n / n)


def estimate(values: Iterable[float]) -> MeanEstimate:
    """Return mean and standard error; zeros without values.

    >>> estimate([1, 3])
    MeanEstimate(mean=2.0, se=1.0, n=2)
    """
    numbers = [float(value) for value in values]
    n = len(numbers)
    if n == 0:
        return MeanEstimate(0.0, 0.0, 0)
    mean = math.fsum(numbers) / n
    variance = math.fsum((x - mean) ** 2 for x in numbers) / (n - 1) if n > 1 else 0.0
    return MeanEstimate(mean, math.sqrt(variance / n), n)


def difference(ours: Mapping[int, float], theirs: Mapping[int, float]) -> MeanEstimate:
    """Return the mean of ours minus theirs over the runs that both have.

    >>> difference({0: 5, 1: 7, 2: 9}, {0: 4, 1: 6})
    MeanEstimate(mean=1.0, se=0.0, n=2)
    """
    return estimate(ours[run] - theirs[run] for run in sorted(ours.keys() & theirs.keys()))


def estimate_by(values: Iterable[tuple[Hashable, float]]) -> MeanEstimate:
    """Return the mean over units of their mean values: values of one unit do not count twice.

    >>> estimate_by([("a", 1), ("a", 3), ("b", 4)])
    MeanEstimate(mean=3.0, se=1.0, n=2)
    """
    found: dict[Hashable, list[float]] = {}
    for unit, value in values:
        found.setdefault(unit, []).append(value)
    return estimate(math.fsum(of_unit) / len(of_unit) for of_unit in found.values())


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and the ends of its 95 % interval, over ``n`` values."""

    mean: float
    low: float
    high: float
    n: int

    @property
    def is_known(self) -> bool:
        """Whether the values say where the interval ends; else they show nothing."""
        return self.low > -math.inf

    @property
    def is_above_zero(self) -> bool:
        """Whether the whole interval is above 0."""
        return self.low > 0

    @property
    def is_below_zero(self) -> bool:
        """Whether the whole interval is below 0."""
        return self.high < 0


N_RESAMPLED = 2000
ResampleCounts = npt.NDArray[np.float64]


def two_way_bootstrap(values: Sequence[tuple[Hashable, Hashable, float]]) -> Interval:
    """Return the mean of values that each belong to a row and a column, with a 95 % interval.

    Rows and columns are drawn anew with replacement, each independently (the two-way cluster
    bootstrap; Cameron, Gelbach and Miller, 2011, name the problem): values of one row or one
    column are not independent. The draws are always the same. Values that all share one row and
    one column say nothing of others: their interval is endless. With one column for all values
    rows alone are drawn.

    >>> two_way_bootstrap([("a", None, 1), ("b", None, 1), ("b", None, 4)])
    Interval(mean=2.0, low=1.0, high=2.5, n=3)
    """
    if not values:
        return Interval(0.0, 0.0, 0.0, 0)
    row_of, column_of = (
        {key: i for i, key in enumerate(dict.fromkeys(value[at] for value in values))}
        for at in (0, 1)
    )
    mean = math.fsum(value for _, _, value in values) / len(values)
    if len(row_of) == len(column_of) == 1:
        return Interval(mean, -math.inf, math.inf, len(values))
    sums, counts = (np.zeros((len(row_of), len(column_of))) for _ in range(2))
    for row, column, value in values:
        sums[row_of[row], column_of[column]] += value
        counts[row_of[row], column_of[column]] += 1
    rows, columns = _drawn(*sums.shape)
    total, n_drawn = (np.einsum("dr,rc,dc->d", rows, of, columns) for of in (sums, counts))
    means = total[n_drawn > 0] / n_drawn[n_drawn > 0]
    low, high = np.quantile(means, [0.025, 0.975])
    return Interval(mean, float(low), float(high), len(values))


@lru_cache(maxsize=16)
def _drawn(n_rows: int, n_columns: int) -> tuple[ResampleCounts, ResampleCounts]:
    """Return how often each row and each column is drawn, a line per sample."""
    rng = np.random.default_rng(0)
    rows, columns = (
        rng.multinomial(n, np.full(n, 1 / n), N_RESAMPLED).astype(np.float64)
        for n in (n_rows, n_columns)
    )
    return rows, columns
