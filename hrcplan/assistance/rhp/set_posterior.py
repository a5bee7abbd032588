"""The best that any classifier of done steps can do: Bayes' rule over the counts of plan graphs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.inference.probabilities import weights_to_posterior

ERROR = 0.01  # probability of a step that a goal has no use for


class PrefixPosterior:
    """The exact posterior of goals given which steps were done, in whatever order.

    It is exact for beginnings of optimal plans, of uniform length, where one set of steps leads to
    one state: of the plans of g, ``n_paths_from_root * n_paths_to_goal`` pass through the node of
    the set, and one in ``n_steps`` beginnings has its length.
    """

    def __init__(self, bank: Bank) -> None:
        self.bank = bank
        self._depth = [[cost for cost, _ in graph.layers] for graph in bank.graphs]
        self._weights = [_weights(bank, goal) for goal in range(len(bank.graphs))]

    def weights(self, steps: Sequence[int]) -> Floats:
        """Return weights of goals, in order, in proportion to their probabilities."""
        world: int | None = self.bank.initial
        for step in steps:
            world = None if world is None else self.bank.table.successor(world, step)
        weights = np.zeros(len(self.bank.graphs))
        if world is not None:
            weights = self.beginnings(world, [len(steps)] * len(weights))
        return weights

    def beginnings(self, world: int, n_steps: Sequence[int]) -> Floats:
        """Return the weight of each goal in a state that so many of its steps led to."""
        weights = np.zeros(len(self.bank.graphs))
        for goal, (graph, n) in enumerate(zip(self.bank.graphs, n_steps, strict=True)):
            node = graph.node_of(world)
            if node is not None and self._depth[goal][graph.layer_of[node]] == n:
                weights[goal] = self._weights[goal][node]
        return weights

    def accuracy(self, prefixes: Sequence[Sequence[int]], goals: Sequence[int]) -> float:
        """Return how often the likeliest goal is right; of equals each counts its part."""
        right = 0.0
        for steps, goal in zip(prefixes, goals, strict=True):
            weights = self.weights(steps)
            best = np.isclose(weights, weights.max(), rtol=1e-9, atol=0)
            right += float(best[goal]) / int(best.sum())
        return right / max(1, len(goals))


class SetPosterior:
    """The exact posterior for any set of done steps, where no forest is to be trained.

    A step that a goal has no use for is an error of probability ``error``. The others are weighed
    as `PrefixPosterior` does if they are the beginning of a plan; if they are none, as when steps
    that opened them are forgotten, all sets of as many of the goal's steps are alike.
    """

    def __init__(self, bank: Bank, error: float = ERROR) -> None:
        self.bank, self.error, self._ceiling = bank, error, PrefixPosterior(bank)
        self._label = bank.table.labels
        self._steps_by_label: dict[int, list[int]] = {}
        for step, label in enumerate(self._label):
            self._steps_by_label.setdefault(label, []).append(step)
        self._uses = np.zeros((len(bank.graphs), len(self._steps_by_label)), dtype=np.int64)
        for goal, graph in enumerate(bank.graphs):
            self._uses[goal, [self._label[step] for step in graph.used_steps]] = 1
        self._sizes = [
            max(g.n_steps, int(n)) for g, n in zip(bank.graphs, self._uses.sum(axis=1), strict=True)
        ]
        self._has_plan = np.array([graph.n_nodes > 0 for graph in bank.graphs])
        self._alike = self._any_order()

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    def posteriors(self, rows: NDArray[np.uint8]) -> Floats:
        """Return the probability of each goal for each row of done labels."""
        posteriors = np.zeros((len(rows), len(self.names)))
        for place, row in enumerate(rows):
            weights = self._weights(row) if row.any() else np.ones(len(self.names))
            posteriors[place] = weights_to_posterior(weights)
        return posteriors

    def _weights(self, row: NDArray[np.uint8]) -> Floats:
        labels = np.flatnonzero(row)
        n_used = self._uses @ row
        prefixes = self._ceiling.beginnings(self._world(labels.tolist()), n_used.tolist())
        prefixes = np.where(prefixes, prefixes, self._alike[np.arange(len(prefixes)), n_used])
        errors = np.array([self.error**n for n in range(len(labels) + 1)])
        weights: Floats = np.where(self._has_plan, prefixes * errors[len(labels) - n_used], 0.0)
        return weights

    def _any_order(self) -> Floats:
        """Return for each goal and number of its steps the weight of one set among all alike."""
        most = max(self._sizes, default=0)
        rows = {
            size: [1 / math.comb(size, min(n, size)) / max(1, size) for n in range(most + 1)]
            for size in set(self._sizes)
        }
        return np.array([rows[size] for size in self._sizes]).reshape(-1, most + 1)

    def _world(self, labels: Sequence[int]) -> int:
        """Return the state after steps in an order in which they can be done, if there is one."""
        world, waiting = self.bank.initial, list(labels)
        while waiting:
            rest = []
            for label in waiting:
                successors = (
                    self.bank.table.successor(world, s) for s in self._steps_by_label[label]
                )
                after = next((w for w in successors if w is not None), None)
                if after is None:
                    rest.append(label)
                else:
                    world = after
            if len(rest) == len(waiting):
                break
            waiting = rest
        return world


def _weights(bank: Bank, goal: int) -> Floats:
    graph = bank.graphs[goal]
    if not graph.n_steps:
        return np.zeros(graph.n_nodes)
    passing = graph.n_paths_from_root.astype(np.float64) * graph.n_paths_to_goal.astype(np.float64)
    weights: Floats = passing / float(graph.plans) / graph.n_steps
    return weights
