"""The best that any classifier of done steps can do: Bayes' rule over the counts of plan graphs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.bank import Bank
from hrcplan.inference.belief import Floats


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
        if world is None:
            return found
        for goal, graph in enumerate(self.bank.graphs):
            node = graph.node_of(world)
            if node is not None and self._depth[goal][graph.layer_of[node]] == len(steps):
                found[goal] = self._weights[goal][node]
        return found

    def accuracy(self, prefixes: Sequence[Sequence[int]], goals: Sequence[int]) -> float:
        """Return how often the likeliest goal is right; of equals each counts its part."""
        right = 0.0
        for steps, goal in zip(prefixes, goals, strict=True):
            weights = self.weights(steps)
            best = np.isclose(weights, weights.max(), rtol=1e-9, atol=0)
            right += float(best[goal]) / int(best.sum())
        return right / max(1, len(goals))


def _weights(bank: Bank, goal: int) -> Floats:
    graph = bank.graphs[goal]
    if not graph.n_steps:
        return np.zeros(graph.n_nodes)
    passing = graph.so_far.astype(np.float64) * graph.to_go.astype(np.float64)
    found: Floats = passing / float(graph.plans) / graph.n_steps
    return found
