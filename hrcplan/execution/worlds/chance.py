"""Chance, drawn up front: a number depends on what it is for, never on the order of asking.

So two runs with one seed meet the same human whatever plan they follow: variants are paired.
"""

from __future__ import annotations

import hashlib
import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


def uniform(seed: str | int, *purpose: str | int) -> float:
    """Return a number in [0, 1) that depends on the seed and the purpose only.

    >>> uniform(7, "outcome") == uniform(7, "outcome") != uniform(8, "outcome")
    True
    """
    return _stream(seed, *purpose).random()


def choice(options: Sequence[T], seed: str | int, *purpose: str | int) -> T:
    """Return one of ``options``, all equally likely."""
    return options[int(uniform(seed, *purpose) * len(options))]


def _stream(*words: str | int) -> random.Random:
    text = "/".join(map(str, words)).encode()
    return random.Random(int.from_bytes(hashlib.sha256(text).digest()[:8]))
