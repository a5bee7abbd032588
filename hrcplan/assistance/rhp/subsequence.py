"""Steps in their order: whether they are a subsequence of some plan of a goal."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np

from hrcplan.assistance.rhp.consistency import Subset
from hrcplan.assistance.rhp.maximal_subsets import largest_first
from hrcplan.bank import Bank, PlanGraph, walk
from hrcplan.core.bits import positions

MAX_REMEMBERED = 100_000  # sequences


class Ordered(ABC):
    """Tests the goals that the steps in any order leave, one by one, and remembers."""

    def __init__(self, bank: Bank) -> None:
        self.subset = Subset(bank)
        self.label, self.everything = self.subset.label, self.subset.everything
        self._memo: dict[tuple[int, ...], int] = {}

    def goals(self, steps: Sequence[int]) -> int:
        """Return the goals of which some plan has these steps in this order, as bits."""
        labels = tuple(self.label[step] for step in steps)
        fits = self._memo.get(labels)
        if fits is None:
            if len(self._memo) >= MAX_REMEMBERED:
                self._memo.clear()
            # What does not fit without its last step does not fit with it.
            before = self._memo.get(labels[:-1], self.everything)
            goals = self.subset.goals(steps) & before
            fits = sum(1 << goal for goal in positions(goals) if self._fits(goal, labels))
            self._memo[labels] = fits
        return fits

    @abstractmethod
    def _fits(self, goal: int, labels: tuple[int, ...]) -> bool:
        """Return whether some plan of a goal has these labels in this order."""


class Subsequence(Ordered):
    """The steps in their order, in any plan of the graphs: the paper's exact definition."""

    def __init__(self, bank: Bank) -> None:
        super().__init__(bank)
        self._orders = lru_cache(maxsize=None)(lambda goal: _orders(self.subset.graphs[goal]))

    def _fits(self, goal: int, labels: tuple[int, ...]) -> bool:
        orders = self._orders(goal)
        for place, label in enumerate(labels):
            if _set_of(labels[:place]) & ~orders[label]:
                return False
        return walk.is_subsequence(self.subset.graphs[goal], labels)

    def largest(
        self, earlier: Sequence[int], latest: int, worth: Sequence[int], n: int
    ) -> list[tuple[int, ...]]:
        """Return the first ``n`` parts of a history that are consistent with a goal."""
        covers = set(self._covers(earlier, latest))
        return largest_first(covers, earlier, latest, worth, n, lambda s: self.goals(s) != 0)

    def _covers(self, earlier: Sequence[int], latest: int) -> Iterator[int]:
        """Yield parts of a history of which any two steps have the order that some plan has."""
        labels, last = [self.label[step] for step in earlier], self.label[latest]
        for cover, goals in self.subset.covers(earlier, latest):
            for goal in positions(goals):
                orders = self._orders(goal)
                part = sum(1 << i for i in positions(cover) if orders[last] >> labels[i] & 1)
                yield from _without_conflicts(part, labels, orders)


def _set_of(labels: Sequence[int]) -> int:
    bits = 0
    for label in labels:
        bits |= 1 << label
    return bits


def _orders(graph: PlanGraph) -> dict[int, int]:
    """Return for each label, as bits, those that stand before it in some plan."""
    used = sorted(graph.used_steps)
    column = {label: i for i, label in enumerate(used)}
    width = len(used)
    earlier = np.zeros((graph.n_nodes, width), dtype=np.bool_)
    before = np.zeros((width, width), dtype=np.bool_)
    lookup = np.zeros(max(used, default=0) + 1, dtype=np.int64)
    lookup[used] = np.arange(width)
    for edges, sources in graph.edges_by_layer():
        own = lookup[graph.steps[edges]]
        so_far = earlier[sources]
        np.logical_or.at(before, own, so_far)
        so_far[np.arange(len(own)), own] = True
        np.logical_or.at(earlier, graph.targets[edges], so_far)
    return {label: _set_of([used[i] for i in np.flatnonzero(before[row])])
            for label, row in column.items()}  # fmt: skip


def _without_conflicts(part: int, labels: Sequence[int], orders: dict[int, int]) -> Iterator[int]:
    """Yield the parts that are left when one step of each impossible pair is dropped."""
    waiting, parts = [part], {part}
    while waiting:
        rest = waiting.pop()
        places = list(positions(rest))
        pairs = ((a, b) for k, b in enumerate(places) for a in places[:k])
        conflict = next(((a, b) for a, b in pairs if not orders[labels[b]] >> labels[a] & 1), None)
        if conflict is None:
            yield rest
            continue
        for place in conflict:
            less = rest ^ 1 << place
            if less not in parts:
                parts.add(less)
                waiting.append(less)
