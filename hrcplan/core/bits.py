"""Sets of facts or actions as the bits of an integer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import reduce
from operator import and_, or_


def single_bits(bits: int) -> Iterator[int]:
    """Yield the powers of two that add up to a number, lowest first.

    >>> list(single_bits(0b1010))
    [2, 8]
    """
    while bits:
        low = bits & -bits
        yield low
        bits ^= low


def positions(bits: int) -> Iterator[int]:
    """Yield the positions of the bits that are set, lowest first.

    >>> list(positions(0b1010))
    [1, 3]
    """
    while bits:
        low = bits & -bits
        yield low.bit_length() - 1
        bits ^= low


def union(sets: Iterable[int]) -> int:
    """Return the bits of any of ``sets``."""
    return reduce(or_, sets, 0)


def common(sets: Iterable[int]) -> int:
    """Return the bits of all ``sets``, of which there must be one."""
    return reduce(and_, sets)


def holders(sets: Sequence[int], size: int) -> list[int]:
    """Return for each of ``size`` bits which of the ``sets`` hold it, again as bits.

    >>> holders([0b01, 0b11], 2)
    [3, 2]
    """
    by_bit = [0] * size
    for i, bits in enumerate(sets):
        for position in positions(bits):
            by_bit[position] |= 1 << i
    return by_bit
