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
from hrcplan.bank.search import BuildLimits, StateSpaceLayers
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
    ops, literals = relevant(table.ops, goal)
    packing = FactPacking.of_facts(literals.facts)
    marks = landmarks(ops, state, goal)
    if price is None or marks is None:
        return empty_graph(name, packing)
    bound, max_ties = table.bound(price, factor)
    search = _ShadowSearch(ops, literals, goal, marks, bound, max_ties)
    return assemble(table, search.run(state & literals.facts, packing, limits, name), packing, name)


@dataclass(slots=True)
class _Arrival:
    """How a node was reached: the landmarks that all ways to it met, and the last edges."""

    landmarks: int
    edges: list[tuple[int, int]]


class _ShadowSearch:
    """Forward search over states with shadows, in order of cost."""

    def __init__(
        self, ops: Sequence[Operator], literals: Literals, goal: Tests,
        marks: Sequence[Landmark], bound: int, max_ties: int,
    ) -> None:  # fmt: skip
        self.literals, self.goal, self.bound, self.max_ties = literals, goal, bound, max_ties
        self.marks = marks
        self.ways: dict[int, list[tuple[Operator, int]]] = {}
        for i, op in sorted(enumerate(ops), key=lambda pair: pair[1].cost):
            marks_of_op = sum(1 << m for m, mark in enumerate(marks) if i in mark.ops)
            self.ways.setdefault(op.step, []).append((op, marks_of_op))
        self.pending: dict[int, dict[ShadowNode, _Arrival]] = {}
        self.still: dict[int, int] = {}

    def run(
        self, state: int, packing: FactPacking, limits: BuildLimits, name: str
    ) -> StateSpaceLayers:
        """Return what can be reached without a step that is certainly one too many."""
        self._push(0, (state, frozenset()), 0, [])
        states: list[int] = []
        layers: list[tuple[int, int]] = []
        goals: list[bool] = []
        edges: list[tuple[int, int, int]] = []
        while self.pending:
            cost = min(self.pending)
            layers.append((cost, len(states)))
            for (now, shadows), arrival in self.pending.pop(cost).items():
                if cost + self._to_pay(arrival.landmarks) > self.bound:
                    continue
                node = len(states)
                states.append(now)
                goals.append(meets(now, self.goal))
                edges += [(source, step, node) for source, step in arrival.edges]
                if not goals[-1]:
                    self._follow(cost, now, shadows, arrival.landmarks, node)
                if node % CHECK_EVERY == 0:
                    waiting = sum(map(len, self.pending.values()))
                    limits.check(name, NODE_BYTES * (node + waiting), node)
        return _as_layers(packing, states, layers, goals, edges)

    def _follow(
        self, cost_so_far: int, now: int, shadows: frozenset[int], landmark_bits: int, node: int
    ) -> None:
        for step, ways in self.ways.items():
            way = next(((op, more) for op, more in ways if meets(now, op.tests)), None)
            if way is None:
                continue
            op, more = way
            after = op.apply(now) & self.literals.facts
            cost = cost_so_far + op.cost
            if after == now or cost + self._to_pay(landmark_bits | more) > self.bound:
                continue
            if cost & MAX_TIES > self.max_ties:
                continue
            without = frozenset([now, *self._shadows_after(shadows, ways)])
            if not any(self._serves(shadow, after) for shadow in without):
                self._push(cost, (after, without), landmark_bits | more, [(node, step)])

    def _shadows_after(
        self, shadows: frozenset[int], ways: Sequence[tuple[Operator, int]]
    ) -> Iterator[int]:
        """Yield where the shadows are after a step; those that cannot follow are gone."""
        for shadow in shadows:
            op = next((op for op, _ in ways if meets(shadow, op.tests)), None)
            if op is not None:
                yield op.apply(shadow) & self.literals.facts

    def _serves(self, shadow: int, state: int) -> bool:
        """Whether whatever can be done from ``state`` to reach the goal can be from a shadow.

        At a goal state that means that a step too many was taken.
        """
        loss = state & ~shadow & self.literals.true | shadow & ~state & self.literals.false
        return not loss or (meets(state, self.goal) and meets(shadow, self.goal))

    def _to_pay(self, landmark_bits: int) -> int:
        rest = self.still.get(landmark_bits)
        if rest is None:
            rest = sum(mark.cost for i, mark in enumerate(self.marks) if not landmark_bits >> i & 1)
            self.still[landmark_bits] = rest
        return rest

    def _push(
        self, cost: int, node: ShadowNode, landmark_bits: int, edges: list[tuple[int, int]]
    ) -> None:
        layer = self.pending.setdefault(cost, {})
        arrival = layer.get(node)
        if arrival is None:
            layer[node] = _Arrival(landmark_bits, edges)
        else:
            arrival.landmarks &= landmark_bits
            arrival.edges += edges


def _as_layers(
    packing: FactPacking, states: list[int], layers: list[tuple[int, int]], goals: list[bool],
    edges: list[tuple[int, int, int]],
) -> StateSpaceLayers:  # fmt: skip
    table = np.array(edges, dtype=np.int64).reshape(-1, 3)
    layers = [(cost, first) for cost, first in layers if first < len(states)]
    starts = np.searchsorted(table[:, 2], [first for _, first in layers[1:]])
    parts = tuple(
        (part[:, 0], part[:, 1].astype(np.int32), part[:, 2]) for part in np.split(table, starts)
    )
    return StateSpaceLayers(
        packing.rows(states), tuple(layers), parts, np.array(goals, dtype=np.bool_), None, None
    )
