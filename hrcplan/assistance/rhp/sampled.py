"""Consistency with sampled plans, steps in their order: the "many but not all" policies of RA-L.

The more steps are seen, the less likely it is that one of the sampled plans has them all in their
order, even if some plan has. So this test rules goals out that the exact one keeps.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import nlargest

import numpy as np
from numpy.typing import NDArray

from hrcplan.assistance.rhp.maximal_subsets import largest_first
from hrcplan.assistance.rhp.subsequence import Ordered
from hrcplan.bank import Bank
from hrcplan.core.arrays import Bools, Ids, SmallIds
from hrcplan.core.bits import positions

N_PLANS = 10_000  # for each goal (Ghose et al., IV-C)
_KEY_BITS = 62

Places = NDArray[np.int16]


class Sampled(Ordered):
    """The steps in their order, in one of the plans that were sampled uniformly for each goal.

    Args:
        bank: The plans to sample from.
        n_plans: How many for each goal.
        seed: Of the samples.
    """

    def __init__(self, bank: Bank, n_plans: int = N_PLANS, seed: int = 0) -> None:
        super().__init__(bank)
        rng = np.random.default_rng(seed)
        self.plans = {
            goal: Plans(_as_labels(bank.sampler(goal).draw(n_plans, rng), self.label))
            for goal in positions(self.everything)
        }

    def _fits(self, goal: int, labels: tuple[int, ...]) -> bool:
        return self.plans[goal].hold(labels)

    def largest(
        self, earlier: Sequence[int], latest: int, worth: Sequence[int], n: int
    ) -> list[tuple[int, ...]]:
        """Return the first ``n`` parts of a history that are consistent with a goal."""
        labels, last = [self.label[step] for step in earlier], self.label[latest]
        bounds = sorted(self._bounds(labels, last, worth), reverse=True)
        best: list[tuple[int, int, int]] = []
        for bound, goal in bounds:
            if len(best) >= n and bound < best[n - 1]:
                break
            more = self.plans[goal].best(labels, last, worth, bound[2], n)
            if more is None or len(set(earlier)) < len(earlier):  # parts that read alike
                covers = {cover for (_, _, cover), _ in bounds}
                return largest_first(
                    covers, earlier, latest, worth, n, lambda s: self.goals(s) != 0
                )
            best = sorted({*best, *more}, reverse=True)
        return [(*(earlier[i] for i in positions(part)), latest) for _, _, part in best[:n]]

    def _bounds(
        self, labels: Sequence[int], last: int, worth: Sequence[int]
    ) -> Iterator[tuple[tuple[int, int, int], int]]:
        for goal, plans in self.plans.items():
            if last in plans.places:
                places = [i for i, label in enumerate(labels) if label in plans.places]
                part = sum(1 << i for i in places)
                yield (len(places), sum(worth[i] for i in places), part), goal


class Plans:
    """Sampled plans of one goal: the position of each label in each plan, -1 if it is absent.

    Args:
        plans: Plans as rows of labels, shorter ones filled up with -1.
    """

    def __init__(self, plans: SmallIds) -> None:
        self.places: dict[int, list[Places]] = {}
        for label in np.unique(plans[plans >= 0]).tolist():
            self.places[label] = list(_occurrences(plans == label))

    def hold(self, labels: Sequence[int]) -> bool:
        """Return whether one of the plans has these labels in this order."""
        rows: Ids | None = None
        now: Places | None = None
        for label in labels:
            columns = self.places.get(label, [])
            if not columns:
                return False
            if rows is not None:
                columns = [column.take(rows) for column in columns]
            if now is None:
                now = np.full(len(columns[0]), -1, dtype=np.int16)
            after = columns[-1]
            for column in reversed(columns[:-1]):  # the first one that is still ahead
                after = np.where(column > now, column, after)
            rows_that_fit = np.flatnonzero(after > now)
            if not len(rows_that_fit):
                return False
            rows = rows_that_fit if rows is None else rows.take(rows_that_fit)
            now = after.take(rows_that_fit)
        return True

    def best(
        self, labels: Sequence[int], last: int, worth: Sequence[int], part: int, n: int
    ) -> list[tuple[int, int, int]] | None:
        """Return the ``n`` best parts of a history that some plan has, with ``last`` behind them.

        Each as its size, what it is worth and its places as bits; the better ones are larger.
        None if numbers of 64 bits cannot hold these three.

        Args:
            labels: The labels of the history.
            last: The latest label.
            worth: What each is worth.
            part: The places that are looked at; all labels there occur in plans.
            n: How many to return.
        """
        places = list(positions(part))
        total = sum(worth[i] for i in places)
        shift = len(places) + total.bit_length()
        if shift + len(places).bit_length() > _KEY_BITS:
            return None
        keys = [(1 << shift) + (worth[i] << len(places)) + (1 << k) for k, i in enumerate(places)]
        columns = [self.places[labels[i]] for i in places]
        end = np.max(self.places[last], axis=0)
        tops = _tops(columns, keys, end)
        best_keys: set[int] = set()
        tried: set[tuple[int, ...]] = set()
        for row in np.argsort(-tops, kind="stable").tolist():
            least = min(best_keys) if len(best_keys) >= n else -1
            if tops[row] < 0 or tops[row] < least:
                break
            own = [[int(c[row]) for c in column] for column in columns]
            order = _order(own, int(end[row]))
            if order not in tried:
                tried.add(order)
                best_keys = set(nlargest(n, best_keys | _best_of(own, keys, int(end[row]), n)))
        return [_unpack(key, places, worth) for key in sorted(best_keys, reverse=True)]


def _tops(columns: Sequence[Sequence[Places]], keys: Sequence[int], end: Places) -> Ids:
    """Return for each plan the largest sum of keys of labels that it has in their order."""
    columns_before: list[tuple[Places, Ids]] = []
    for column, key in zip(columns, keys, strict=True):
        now = [(place, _extend(columns_before, place) + key) for place in column]
        columns_before += [(place, np.where(place >= 0, sums, -1)) for place, sums in now]
    sums_at_end = _extend(columns_before, end)
    return np.where(end >= 0, sums_at_end, -1)


def _extend(columns_before: Sequence[tuple[Places, Ids]], end: Places) -> Ids:
    """Return for each plan the largest of the sums that stand before a place, at least 0."""
    best_sums = np.zeros(len(end), dtype=np.int64)
    for place, sums in columns_before:
        np.maximum(best_sums, np.where(place < end, sums, 0), out=best_sums)
    return best_sums


def _best_of(own: Sequence[Sequence[int]], keys: Sequence[int], end: int, n: int) -> set[int]:
    """Return the ``n`` largest sums of keys of labels that one plan has in their order."""
    columns_before: list[tuple[int, list[int]]] = []
    for places, key in zip(own, keys, strict=True):
        now = [
            (p, [key + s for s in _largest_before(columns_before, p, n)]) for p in places if p >= 0
        ]
        columns_before += now
    return set(_largest_before(columns_before, end, n))


def _largest_before(columns_before: Sequence[tuple[int, list[int]]], end: int, n: int) -> list[int]:
    return nlargest(n, {0, *(s for place, sums in columns_before if place < end for s in sums)})


def _order(own: Sequence[Sequence[int]], end: int) -> tuple[int, ...]:
    """Return in which order a plan has labels; what is alike holds the same parts."""
    flat = [p if 0 <= p < end else -1 for places in own for p in places]
    ranks = {p: rank for rank, p in enumerate(sorted({*flat, -1}))}
    return tuple(ranks[p] for p in flat)


def _unpack(key: int, places: Sequence[int], worth: Sequence[int]) -> tuple[int, int, int]:
    places_used = [i for k, i in enumerate(places) if key >> k & 1]
    return len(places_used), sum(worth[i] for i in places_used), sum(1 << i for i in places_used)


def _as_labels(plans: SmallIds, label: Sequence[int]) -> SmallIds:
    labels: SmallIds = np.array([*label, -1], dtype=np.int32)[plans]
    return labels


def _occurrences(here: Bools) -> Iterator[Places]:
    """Yield the position of the first, second, ... true value of each row, -1 if there is none."""
    rest = here.copy()
    rows = np.arange(len(rest))
    while rest.any():
        place = rest.argmax(axis=1)
        has = rest[rows, place]
        yield np.where(has, place, -1).astype(np.int16)
        rest[rows, place] = False
