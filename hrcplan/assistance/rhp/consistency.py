"""Goals that are consistent with some steps: is there a plan that holds them all?

Ghose et al. (RA-L 2025, III-C2) say it twice: a policy "could have generated the observed sequence
or any of the permutations" (`Subset`), and "the observed sequence is a subsequence" of a policy
(`Subsequence` and `Sampled`, see subsequence.py).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from hrcplan.assistance.rhp.maximal_subsets import largest_first
from hrcplan.bank import Bank, PlanGraph, multisets

MAX_REMEMBERED = 100_000  # answers about goals that are tested one by one


class Consistency(Protocol):
    """Says which goals steps are consistent with; goals are bits, the first goal the lowest.

    Steps are compared by what is done, not by who does it.
    """

    @property
    def everything(self) -> int:
        """The goals that have a plan."""
        ...

    def goals(self, steps: Sequence[int]) -> int:
        """Return the goals of which some plan is consistent with steps in this order."""
        ...

    def largest(
        self, earlier: Sequence[int], latest: int, worth: Sequence[int], n: int
    ) -> list[tuple[int, ...]]:
        """Return the first ``n`` parts of a history that are consistent with a goal.

        See maximal_subsets.py for their order and the arguments; each ends with the latest step.
        """
        ...


class Subset:
    """The steps in any order: they fit one of the multisets of steps that a goal's plans have.

    The multisets, *kinds*, of all goals are numbered through; for every n-th occurrence of a step
    there is one integer whose bits are the kinds that have it. Goals of too many kinds are tested
    one by one (see ``multisets.is_subset``); where that gives up, the goal counts as consistent.

    >>> from hrcplan.bank import build_bank
    >>> subset = Subset(build_bank("kitchen", only=["pasta-bean", "pasta-tomato"]))
    >>> step = subset.bank.table.find
    >>> [subset.goals([step(words)]) for words in (("get", "beans"), ("get", "pasta"))]
    [1, 3]
    """

    def __init__(self, bank: Bank) -> None:
        self.bank, self.label = bank, bank.table.labels
        self.graphs = [relabel(graph, self.label) for graph in bank.graphs]
        self.everything = sum(1 << g for g, graph in enumerate(self.graphs) if graph.n_nodes)
        self._spans: list[tuple[int, int, int]] = []
        self._large: list[int] = []
        self._number_kinds()
        self._memo: dict[tuple[int, tuple[int, ...]], bool] = {}

    def _number_kinds(self) -> None:
        owners: dict[tuple[int, int], list[int]] = {}
        n = 0
        for goal, graph in enumerate(self.graphs):
            kinds = multisets.step_multisets(graph)
            if kinds is None:
                self._large.append(goal)
                continue
            if kinds:
                self._spans.append((n, (1 << len(kinds)) - 1, goal))
            for number, kind in enumerate(kinds, n):
                for label, times in kind:
                    for nth in range(1, times + 1):
                        owners.setdefault((label, nth), []).append(number)
            n += len(kinds)
        self._kinds = {occurrence: _mask(numbers, n) for occurrence, numbers in owners.items()}
        self._all_kinds = (1 << n) - 1
        # One kind for each goal, as where plans differ in order alone: kinds are goals.
        self._alike = [(start, goal) for start, _, goal in self._spans] == [
            (goal, goal) for goal in range(n)
        ]

    def goals(self, steps: Sequence[int]) -> int:
        """Return the goals of which some plan has all these steps, as bits."""
        labels = [self.label[step] for step in steps]
        kinds = self._all_kinds
        for occurrence in _occurrences(labels):
            kinds &= self._kinds.get(occurrence, 0)
        goals = self._goals_of(kinds)
        for goal in self._large:
            if self._may_fit(goal, tuple(sorted(labels))):
                goals |= 1 << goal
        return goals

    def _goals_of(self, kinds: int) -> int:
        if self._alike:
            return kinds
        return sum(1 << goal for start, span, goal in self._spans if kinds >> start & span)

    def _may_fit(self, goal: int, labels: tuple[int, ...]) -> bool:
        fits = self._memo.get((goal, labels))
        if fits is None:
            if len(self._memo) >= MAX_REMEMBERED:
                self._memo.clear()
            fits = multisets.is_subset(self.graphs[goal], labels) is not False
            self._memo[goal, labels] = fits
        return fits

    def largest(
        self, earlier: Sequence[int], latest: int, worth: Sequence[int], n: int
    ) -> list[tuple[int, ...]]:
        """Return the first ``n`` parts of a history that are consistent with a goal."""
        covers = [cover for cover, _ in self.covers(earlier, latest)]
        return largest_first(covers, earlier, latest, worth, n, lambda s: self.goals(s) != 0)

    def covers(self, earlier: Sequence[int], latest: int) -> Iterator[tuple[int, int]]:
        """Yield parts of a history, as bits, and the goals of whose plans they are all there is.

        Every part that is consistent, with the latest step, is a part of one of them.
        """
        last, labels = self.label[latest], [self.label[step] for step in earlier]
        parts = [(0, self._kinds.get((last, 1), 0))]
        for place, label in enumerate(labels):
            has = self._kinds.get((label, 2 if label == last else 1), 0)
            parts = [
                (part | bit, kinds)
                for before, all_kinds in parts
                for part, bit, kinds in (
                    (before, 1 << place, all_kinds & has),
                    (before, 0, all_kinds & ~has),
                )
                if kinds
            ]
        yield from ((part, self._goals_of(kinds)) for part, kinds in parts if kinds)
        for goal in self._large:
            used = self.graphs[goal].used_steps
            if last in used:
                yield sum(1 << i for i, label in enumerate(labels) if label in used), 1 << goal


def relabel(graph: PlanGraph, label: Sequence[int]) -> PlanGraph:
    """Return a graph whose steps are labels; then several edges of a node may read alike."""
    if all(step == label[step] for step in graph.used_steps):
        return graph
    return replace(graph, steps=np.array(label, dtype=np.int32)[graph.steps])


def _occurrences(labels: Sequence[int]) -> Iterable[tuple[int, int]]:
    """Return each label with its number of occurrences: who has the last one has them all."""
    if len(set(labels)) == len(labels):
        return ((label, 1) for label in labels)
    return Counter(labels).items()


def _mask(numbers: Sequence[int], n: int) -> int:
    """Return an integer with bits set, of ``n``; one by one would copy it each time."""
    flags = np.zeros(n, dtype=np.uint8)
    flags[list(numbers)] = 1
    return int.from_bytes(np.packbits(flags, bitorder="little").tobytes(), "little")
