"""Which step is likely to follow which: 2-grams of sampled plans, to prune a search tree.

Ghose et al. (RA-L 2025, IV-C2): "an offline 2-gram approach, which counts how often an action
follows a given past action".
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core.arrays import Ids
from hrcplan.core.bits import positions

N_PLANS = 10_000  # for each goal
BANK, PLAUSIBLE = "bank", "plausible"
MAX_REMEMBERED = 20_000


class Bigrams:
    """How often a label follows a label in plans that were sampled uniformly for each goal.

    A label is what a step is called without its agent.

    Args:
        bank: The plans to sample from.
        n_plans: How many for each goal.
        seed: Of the samples.

    >>> from hrcplan.bank import build_bank
    >>> bank = build_bank("kitchen", only=["parfait-nut"])
    >>> found = Bigrams(bank, n_plans=100)
    >>> get, pour = (bank.table.find(words) for words in (("get", "nuts"), ("get", "yogurt")))
    >>> 0 < found.share(get, pour) < 1, found.share(get, get)
    (True, 0.0)
    """

    def __init__(self, bank: Bank, n_plans: int = N_PLANS, seed: int = 0) -> None:
        label = np.array([*bank.table.labels, -1])
        self.n_labels = bank.table.n_labels
        rng = np.random.default_rng(seed)
        parts = [
            self._count(goal, label[bank.sampler(goal).draw(n_plans, rng)])
            for goal, graph in enumerate(bank.graphs)
            if graph.n_nodes
        ]
        rows = np.concatenate([np.zeros((0, 4), dtype=np.int64), *parts])
        rows = rows[np.lexsort((rows[:, 2], rows[:, 1]))]
        self._goal, self._after, self._times = rows[:, 0], rows[:, 2], rows[:, 3]
        self._first = np.searchsorted(rows[:, 1], np.arange(self.n_labels + 1))
        self._n_goals = len(bank.names)
        self._last_weights: tuple[tuple[int, ...], Ids] = (
            (),
            np.zeros(self._n_goals, dtype=np.int64),
        )
        self._memo: dict[tuple[int, tuple[int, ...]], list[int]] = {}

    def _count(self, goal: int, plans: Ids) -> Ids:
        """Return rows of goal, label, label after it, and how often."""
        before, after = plans[:, :-1], plans[:, 1:]
        both = after >= 0
        pairs, times = np.unique(before[both] * self.n_labels + after[both], return_counts=True)
        goals = np.full(len(pairs), goal)
        return np.stack([goals, pairs // self.n_labels, pairs % self.n_labels, times], axis=1)

    def times(self, label: int, weights: Sequence[int] | Ids | None = None) -> Ids:
        """Return how often each label follows one, with goals weighted; all alike by default."""
        rows = slice(self._first[label], self._first[label + 1])
        times = self._times[rows]
        if weights is not None:
            times = times * np.asarray(weights)[self._goal[rows]]
        counts = np.zeros(self.n_labels, dtype=np.int64)
        np.add.at(counts, self._after[rows], times)
        return counts

    def share(self, label: int, after: int) -> float:
        """Return the probability of a label right after another; 0 if that was never seen."""
        times = self.times(label)
        return float(times[after] / max(1, times.sum()))

    def followers(self, label: int, goals: Sequence[int] = ()) -> list[int]:
        """Return the labels that were seen after one, the most frequent first, then in order.

        Args:
            label: The label before.
            goals: Sets of goals as bits, each of which counts its goals once; without any, all
                plans of the bank count.
        """
        goals = tuple(goals)
        key = (label, goals)
        labels = self._memo.get(key)
        if labels is None:
            if len(self._memo) >= MAX_REMEMBERED:
                self._memo.clear()
            times = self.times(label, self._weights(goals) if goals else None)
            order = np.argsort(-times, kind="stable")
            labels = self._memo[key] = order[: np.count_nonzero(times)].tolist()
        return labels

    def _weights(self, goals: tuple[int, ...]) -> Ids:
        if goals != self._last_weights[0]:  # one look ahead asks for the same ones again and again
            weights = np.zeros(self._n_goals, dtype=np.int64)
            for mask in goals:
                weights[list(positions(mask))] += 1
            self._last_weights = goals, weights
        return self._last_weights[1]
