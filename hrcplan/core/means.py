"""The mean of numbers and its standard error."""

from __future__ import annotations

import math
from collections.abc import Sequence


def mean_and_error(numbers: Sequence[float]) -> tuple[float, float]:
    """Return the mean and its standard error; zeros without numbers.

    >>> mean_and_error([1.0, 3.0]), mean_and_error([])
    ((2.0, 1.0), (0.0, 0.0))
    """
    n = len(numbers)
    if n == 0:
        return 0.0, 0.0
    mean = math.fsum(numbers) / n
    variance = math.fsum((x - mean) ** 2 for x in numbers) / (n - 1) if n > 1 else 0.0
    return mean, math.sqrt(variance / n)
