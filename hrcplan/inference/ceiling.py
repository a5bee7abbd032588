"""The best that any classifier of done steps can do: Bayes' rule over the counts of plan graphs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.inference.belief import Floats, weights_to_posterior
from hrcplan.inference.consistency import labels

ERROR = 0.01  # probability of a step that a goal has no use for


class Ceiling:
    """The exact posterior of goals given which steps were done, in whatever order.

    It is exact for beginnings of optimal plans, of uniform length, where one set of steps leads to
    one state: of the plans of g, ``so_far * to_go`` pass through the node of the set, and one in
    ``n_steps`` beginnings has its length.
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
        found = np.zeros(len(self.bank.graphs))
        if world is not None:
            for goal in range(len(found)):
                found[goal] = self.weight(goal, world, len(steps))
        return found

    def weight(self, goal: int, world: int, n: int) -> float:
        """Return the weight of a goal in a state that ``n`` of its steps led to."""
        graph = self.bank.graphs[goal]
        node = graph.node_of(world)
        if node is None or self._depth[goal][graph.layer_of[node]] != n:
            return 0.0
        return float(self._weights[goal][node])

    def accuracy(self, prefixes: Sequence[Sequence[int]], goals: Sequence[int]) -> float:
        """Return how often the likeliest goal is right; of equals each counts its part."""
        right = 0.0
        for steps, goal in zip(prefixes, goals, strict=True):
            weights = self.weights(steps)
            best = np.isclose(weights, weights.max(), rtol=1e-9, atol=0)
            right += float(best[goal]) / int(best.sum())
        return right / max(1, len(goals))


class Presence:
    """The exact posterior for any set of done steps, where no forest is to be trained.

    A step that a goal has no use for is an error of probability ``error``. The others are weighed
    as `Ceiling` does if they are the beginning of a plan; if they are none, as when steps that
    opened them are forgotten, all sets of as many of the goal's steps are alike.
    """

    def __init__(self, bank: Bank, error: float = ERROR) -> None:
        self.bank, self.error, self._ceiling = bank, error, Ceiling(bank)
        self._label = labels(bank.table)
        self._called: dict[int, list[int]] = {}
        for step, label in enumerate(self._label):
            self._called.setdefault(label, []).append(step)
        self._uses = np.zeros((len(bank.graphs), len(self._called)), dtype=np.int64)
        for goal, graph in enumerate(bank.graphs):
            self._uses[goal, [self._label[step] for step in graph.used_steps]] = 1
        self._sizes = [
            max(g.n_steps, n) for g, n in zip(bank.graphs, self._uses.sum(axis=1), strict=True)
        ]

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    def many(self, rows: NDArray[np.uint8]) -> Floats:
        """Return the probability of each goal for each row of done labels."""
        found = np.zeros((len(rows), len(self.names)))
        for place, row in enumerate(rows):
            weights = self._weights(row) if row.any() else np.ones(len(self.names))
            found[place] = weights_to_posterior(weights)
        return found

    def _weights(self, row: NDArray[np.uint8]) -> Floats:
        done = np.flatnonzero(row)
        world = self._world(done.tolist())
        found = np.zeros(len(self.names))
        for goal, n in enumerate((self._uses @ row).tolist()):
            if self.bank.graphs[goal].n_nodes:
                weight = self._ceiling.weight(goal, world, n)
                size = int(self._sizes[goal])
                found[goal] = weight or 1 / math.comb(size, n) / max(1, size)
                found[goal] *= self.error ** (len(done) - n)
        return found

    def _world(self, done: Sequence[int]) -> int:
        """Return the state after steps in an order in which they can be done, if there is one."""
        world, waiting = self.bank.initial, list(done)
        while waiting:
            left = []
            for label in waiting:
                found = (self.bank.table.successor(world, s) for s in self._called[label])
                after = next((w for w in found if w is not None), None)
                if after is None:
                    left.append(label)
                else:
                    world = after
            if len(left) == len(waiting):
                break
            waiting = left
        return world


def _weights(bank: Bank, goal: int) -> Floats:
    graph = bank.graphs[goal]
    if not graph.n_steps:
        return np.zeros(graph.n_nodes)
    passing = graph.so_far.astype(np.float64) * graph.to_go.astype(np.float64)
    found: Floats = passing / float(graph.plans) / graph.n_steps
    return found
