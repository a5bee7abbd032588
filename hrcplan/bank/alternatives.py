"""Plans of which no single step can be dropped, up to a multiple of the optimal cost: exactly.

A node is a state, the cost so far, and its *shadows*: the states in which one would be had one step
been left out, as far as the steps since could still be done there. A plan can do without a step if
a shadow reaches the goal, so ways that end in the same node go on alike and can be counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from hrcplan.bank.construct import NO_LIMITS, assemble, empty_graph, optimal_with_price
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits, Explored
from hrcplan.search.lm_cut import Landmark, landmarks
from hrcplan.search.packed_states import FactPacking
from hrcplan.search.relevance import Literals, relevant
from hrcplan.task.conditions import Tests, meets
from hrcplan.task.steps import MAX_TIES, Operator, StepTable

NODE_BYTES = 600  # measured, with its share of edges; what a Python node takes
CHECK_EVERY = 256  # nodes between two looks at the limits

ShadowNode = tuple[int, frozenset[int]]
"""A state and its shadows."""


def alternatives_graph(
    table: StepTable, goal: Tests, state: int, factor: Fraction, *, name: str = "goal",
    limits: BuildLimits = NO_LIMITS,
) -> PlanGraph:  # fmt: skip
    """Return the graph of plans up to ``factor`` times the optimal cost that need all their steps.

    Whichever one step is left out, the rest cannot be done, or does not reach the goal.

    Raises:
        LimitError: if time or memory runs out.
    """
    _, price = optimal_with_price(table, goal, state, name=name, limits=limits)
    ops, needed = relevant(table.ops, goal)
    packing = FactPacking.of_facts(needed.facts)
    marks = landmarks(ops, state, goal)
    if price is None or marks is None:
        return empty_graph(name, packing)
    bound, max_ties = table.bound(price, factor)
    search = _Search(ops, needed, goal, marks, bound, max_ties)
    return assemble(table, search.run(state & needed.facts, packing, limits, name), packing, name)


@dataclass(slots=True)
class _Arrival:
    """How a node was reached: the landmarks that all ways to it met, and the last edges."""

    met: int
    edges: list[tuple[int, int]]


class _Search:
    """Forward search over states with shadows, in order of cost."""

    def __init__(
        self, ops: Sequence[Operator], needed: Literals, goal: Tests,
        marks: Sequence[Landmark], bound: int, max_ties: int,
    ) -> None:  # fmt: skip
        self.needed, self.goal, self.bound, self.max_ties = needed, goal, bound, max_ties
        self.marks = marks
        self.ways: dict[int, list[tuple[Operator, int]]] = {}
        for i, op in sorted(enumerate(ops), key=lambda pair: pair[1].cost):
            met = sum(1 << m for m, mark in enumerate(marks) if i in mark.ops)
            self.ways.setdefault(op.step, []).append((op, met))
        self.pending: dict[int, dict[ShadowNode, _Arrival]] = {}
        self.still: dict[int, int] = {}

    def run(self, state: int, packing: FactPacking, limits: BuildLimits, name: str) -> Explored:
        """Return what can be reached without a step that is certainly one too many."""
        self._push(0, (state, frozenset()), 0, [])
        states: list[int] = []
        layers: list[tuple[int, int]] = []
        goals: list[bool] = []
        edges: list[tuple[int, int, int]] = []
        while self.pending:
            paid = min(self.pending)
            layers.append((paid, len(states)))
            for (now, shadows), arrival in self.pending.pop(paid).items():
                if paid + self._to_pay(arrival.met) > self.bound:
                    continue
                node = len(states)
                states.append(now)
                goals.append(meets(now, self.goal))
                edges += [(source, step, node) for source, step in arrival.edges]
                if not goals[-1]:
                    self._follow(paid, now, shadows, arrival.met, node)
                if node % CHECK_EVERY == 0:
                    waiting = sum(map(len, self.pending.values()))
                    limits.check(name, NODE_BYTES * (node + waiting), node)
        return _explored(packing, states, layers, goals, edges)

    def _follow(self, paid: int, now: int, shadows: frozenset[int], met: int, node: int) -> None:
        for step, ways in self.ways.items():
            way = next(((op, more) for op, more in ways if meets(now, op.tests)), None)
            if way is None:
                continue
            op, more = way
            after = op.apply(now) & self.needed.facts
            cost = paid + op.cost
            if after == now or cost + self._to_pay(met | more) > self.bound:
                continue
            if cost & MAX_TIES > self.max_ties:
                continue
            without = frozenset([now, *self._moved(shadows, ways)])
            if not any(self._serves(shadow, after) for shadow in without):
                self._push(cost, (after, without), met | more, [(node, step)])

    def _moved(
        self, shadows: frozenset[int], ways: Sequence[tuple[Operator, int]]
    ) -> Iterator[int]:
        """Yield where the shadows are after a step; those that cannot follow are gone."""
        for shadow in shadows:
            op = next((op for op, _ in ways if meets(shadow, op.tests)), None)
            if op is not None:
                yield op.apply(shadow) & self.needed.facts

    def _serves(self, shadow: int, state: int) -> bool:
        """Whether whatever can be done from ``state`` to reach the goal can be from a shadow.

        At a goal state that means that a step too many was taken.
        """
        lost = state & ~shadow & self.needed.true | shadow & ~state & self.needed.false
        return not lost or (meets(state, self.goal) and meets(shadow, self.goal))

    def _to_pay(self, met: int) -> int:
        known = self.still.get(met)
        if known is None:
            known = sum(mark.cost for i, mark in enumerate(self.marks) if not met >> i & 1)
            self.still[met] = known
        return known

    def _push(self, paid: int, node: ShadowNode, met: int, edges: list[tuple[int, int]]) -> None:
        layer = self.pending.setdefault(paid, {})
        arrival = layer.get(node)
        if arrival is None:
            layer[node] = _Arrival(met, edges)
        else:
            arrival.met &= met
            arrival.edges += edges


def _explored(
    packing: FactPacking, states: list[int], layers: list[tuple[int, int]], goals: list[bool],
    edges: list[tuple[int, int, int]],
) -> Explored:  # fmt: skip
    table = np.array(edges, dtype=np.int64).reshape(-1, 3)
    layers = [(paid, first) for paid, first in layers if first < len(states)]
    starts = np.searchsorted(table[:, 2], [first for _, first in layers[1:]])
    parts = tuple(
        (part[:, 0], part[:, 1].astype(np.int32), part[:, 2]) for part in np.split(table, starts)
    )
    return Explored(
        packing.rows(states), tuple(layers), parts, np.array(goals, dtype=np.bool_), None, None
    )
