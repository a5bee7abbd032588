"""The largest parts of a history that still make sense, in order of size and of generality.

Parts are sets of places in the history, as bits: a larger number keeps later steps. Parts are
ordered by size, then by the sum of what their steps are worth, then later steps first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from heapq import heapify, heappop, heappush

from hrcplan.core.bits import positions


def largest_first(
    covers: Iterable[int], earlier: Sequence[int], latest: int, worth: Sequence[int], n: int,
    fits: Callable[[Sequence[int]], bool],
) -> list[tuple[int, ...]]:  # fmt: skip
    """Return the first ``n`` parts of a history that fit, each with the latest step behind it.

    Every part is made from a larger one by leaving one step out, so that parts come in order and
    only those are looked at that are as large as what is found. Parts that read alike count once.

    Args:
        covers: Parts of which every part that may fit is a part.
        earlier: The history, without its latest step.
        latest: The latest step.
        worth: What each step of the history is worth.
        n: How many to return.
        fits: Whether a sequence fits.
    """
    covers_so_far = set(covers)
    waiting = [(-m.bit_count(), -sum(worth[i] for i in positions(m)), -m) for m in covers_so_far]
    heapify(waiting)
    sequences: dict[tuple[int, ...], None] = {}
    while waiting and len(sequences) < n:
        size, total, negative = heappop(waiting)
        part = -negative
        places = list(positions(part))
        sequence = (*(earlier[i] for i in places), latest)
        if sequence not in sequences and fits(sequence):
            sequences[sequence] = None
        for i in places:
            smaller = part ^ 1 << i
            if smaller not in covers_so_far:
                covers_so_far.add(smaller)
                heappush(waiting, (size + 1, total + worth[i], -smaller))
    return list(sequences)
