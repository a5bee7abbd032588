"""The largest parts of a history that still make sense, in order of size and of generality.

Parts are sets of places in the history, as bits: a larger number keeps later steps. Parts are
ordered by size, then by the sum of what their steps are worth, then later steps first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from heapq import heapify, heappop, heappush

from hrcplan.core.bits import positions

MAX_PARTS = 10_000
"""Parts that are looked at: a long history that repeats steps has too many."""


def largest_first(
    covers: Iterable[int], earlier: Sequence[int], latest: int, worth: Sequence[int], n: int,
    fits: Callable[[Sequence[int]], bool],
) -> list[tuple[int, ...]]:  # fmt: skip
    """Return the first ``n`` parts of a history that fit, each with the latest step behind it.

    Every part is made from a larger one by leaving one step out, so that parts come in order and
    only those are looked at that are as large as what is found. Parts that read alike count once.
    After `MAX_PARTS` parts the search ends: the latest step alone is returned if nothing else fits.

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
    n_parts = 0
    while waiting and len(sequences) < n:
        n_parts += 1
        if n_parts > MAX_PARTS:
            return list(sequences) or [(latest,)] * fits((latest,))
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
