"""Means with their standard errors, and differences between paired runs."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import combinations

CONFIDENCE = 0.95
"""How often the interval of a mean holds the true mean."""

Clusters = tuple[Hashable, ...]
"""Of a value, its cluster in each way of clustering: such as first and second goal."""


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

    @property
    def negative(self) -> Interval:
        """The interval of the same difference the other way round."""
        return Interval(-self.mean, -self.high, -self.low, self.n)

    def clipped(self, least: float, most: float) -> Interval:
        """Return the interval without what lies outside of the possible values."""
        return Interval(self.mean, max(least, self.low), min(most, self.high), self.n)


@dataclass(frozen=True, slots=True)
class MeanEstimate:
    """A mean over ``n`` values, and its standard error.

    ``df`` is the number of degrees of freedom of the error; by default the values are independent.
    """

    mean: float
    se: float
    n: int
    df: int | None = field(default=None, repr=False)

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom of the standard error; below 1 it says nothing."""
        return self.n - 1 if self.df is None else self.df

    @property
    def is_known(self) -> bool:
        """Whether there are enough values for a standard error."""
        return self.degrees > 0

    @property
    def half(self) -> float:
        """Half the width of the 95 % interval, by Student's t; infinite if it is not known."""
        return t_quantile(self.degrees) * self.se if self.is_known else math.inf

    @property
    def interval(self) -> Interval:
        """The 95 % interval of the mean."""
        return Interval(self.mean, self.mean - self.half, self.mean + self.half, self.n)

    @property
    def is_above_zero(self) -> bool:
        """Whether the mean is larger than 0 with 95 % confidence; never for fewer than 2 values."""
        return self.interval.is_above_zero

    @property
    def is_below_zero(self) -> bool:
        """Whether the mean is smaller than 0 with 95 % confidence."""
        return self.interval.is_below_zero

    def se_of(self, n: int) -> float:
        """Return the standard error that a mean over ``n`` values would have."""
        return self.se * math.sqrt(self.n / n)


def estimate(values: Iterable[float]) -> MeanEstimate:
    """Return mean and standard error of independent values; zeros without values.

    >>> estimate([1, 3])
    MeanEstimate(mean=2.0, se=1.0, n=2)
    """
    return estimate_clustered(((i,), value) for i, value in enumerate(values))


def difference(ours: Mapping[int, float], theirs: Mapping[int, float]) -> MeanEstimate:
    """Return the mean of the first minus the second over the runs that both have.

    >>> difference({0: 5, 1: 7, 2: 9}, {0: 4, 1: 6})
    MeanEstimate(mean=1.0, se=0.0, n=2)
    """
    return estimate(ours[run] - theirs[run] for run in sorted(ours.keys() & theirs.keys()))


def estimate_by(values: Iterable[tuple[Clusters, float]]) -> MeanEstimate:
    """Return the mean over units of their mean values: values of one unit do not count twice.

    A unit is what shares all clusters; units that share some are not independent.

    >>> estimate_by([(("a",), 1), (("a",), 3), (("b",), 4)])
    MeanEstimate(mean=3.0, se=1.0, n=2)
    """
    of_unit: dict[Clusters, list[float]] = {}
    for unit, value in values:
        of_unit.setdefault(unit, []).append(value)
    return estimate_clustered((u, math.fsum(of) / len(of)) for u, of in of_unit.items())


def estimate_clustered(values: Iterable[tuple[Clusters, float]]) -> MeanEstimate:
    """Return the mean of values that belong to clusters, with its cluster-robust standard error.

    Values that share a cluster in any way of clustering may depend on each other (Cameron, Gelbach
    and Miller, 2011): the variance is that by each way alone, minus that by the ways together where
    it would count twice. Sums by pair of ways are over few values and may come out too large by
    chance, so the variance is at least the smallest of those by one way. The error has as many
    degrees of freedom as the way with the fewest clusters, minus one. A way in which all values are
    of the cluster None is none.

    >>> found = estimate_clustered([(("a", "x"), 1), (("a", "y"), 2), (("b", "x"), 6)])
    >>> found.mean, found.n, found.degrees
    (3.0, 3, 1)
    """
    pairs = [(clusters, float(value)) for clusters, value in values]
    n = len(pairs)
    if n == 0:
        return MeanEstimate(0.0, 0.0, 0)
    mean = math.fsum(value for _, value in pairs) / n
    ways = [
        way
        for way in range(len(pairs[0][0]))
        if any(clusters[way] is not None for clusters, _ in pairs)
    ]
    sums = {
        some: _sums([(tuple(clusters[way] for way in some), v - mean) for clusters, v in pairs])
        for size in range(1, len(ways) + 1)
        for some in combinations(ways, size)
    }
    df = min((len(of) for some, of in sums.items() if len(some) == 1), default=1) - 1
    if df < 1:
        return MeanEstimate(mean, 0.0, n, 0)
    parts = {some: _variance(of, n) for some, of in sums.items()}
    variance = math.fsum(part if len(some) % 2 else -part for some, part in parts.items())
    least = min(part for some, part in parts.items() if len(some) == 1)
    return MeanEstimate(mean, math.sqrt(max(variance, least)), n, df)


def _sums(values: Iterable[tuple[Clusters, float]]) -> list[float]:
    """Return the sum of the values of each cluster."""
    by_cluster: dict[Clusters, list[float]] = {}
    for cluster, value in values:
        by_cluster.setdefault(cluster, []).append(value)
    return [math.fsum(of) for of in by_cluster.values()]


def _variance(sums: Sequence[float], n: int) -> float:
    """Return the variance of the mean of n values, from the sums of their clusters."""
    return math.fsum(x * x for x in sums) * len(sums) / (len(sums) - 1) / n**2


@lru_cache(maxsize=1024)
def t_quantile(df: int, confidence: float = CONFIDENCE) -> float:
    """Return how many standard errors around a mean hold it with a confidence (Student's t).

    >>> round(t_quantile(1), 3), round(t_quantile(29), 3), round(t_quantile(10**6), 3)
    (12.706, 2.045, 1.96)
    """
    low, high = 0.0, 1e3
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _t_within(middle, df) < confidence else (low, middle)
    return high


MANY = 500
"""Degrees of freedom from which on Student's t is taken as normal, with its first correction."""


def _t_within(t: float, df: int) -> float:
    """Return the probability that |T| < t for Student's T (Abramowitz and Stegun, 26.7.3-4)."""
    if df > MANY:  # 26.7.8
        return math.erf(t * (1 - 1 / (4 * df)) / math.sqrt(1 + t * t / (2 * df)) / math.sqrt(2))
    angle = math.atan(t / math.sqrt(df))
    square, odd = math.cos(angle) ** 2, df % 2
    term = total = math.cos(angle) if odd else 1.0
    for k in range(2 + odd, df - 1, 2):
        term *= square * (k - 1) / k
        total += term
    if not odd:
        return math.sin(angle) * total
    return 2 / math.pi * (angle + (math.sin(angle) * total if df > 1 else 0.0))
