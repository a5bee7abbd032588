"""Every sequence up to a cost, as layers of states: forward search over arrays, exact.

Layers hold the states of one cost so far. A state is not followed if what it has paid and what it
must still pay (landmarks that no sequence to it can do without) exceed the bound.
"""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.landmark_bound import LandmarkBound
from hrcplan.bank.state_tables import SeenStates, group_rows
from hrcplan.core.arrays import Bools, Ids, SmallIds, Words
from hrcplan.errors import LimitError
from hrcplan.search.lm_cut import Landmark
from hrcplan.search.packed_states import PackedRules
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import MAX_TIES

MAX_MIB = 2048
Edges = tuple[Ids, SmallIds, Ids]
Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True, slots=True)
class BuildLimits:
    """What building may use: MiB of arrays, and the time (of ``time.monotonic``) to stop at.

    ``hint`` says in errors what to lower.
    """

    mib: int = MAX_MIB
    deadline: float = float("inf")
    hint: str = "lower --quality or --alternatives, or build from enumerated plans with --sample N"

    def check(self, goal: str, n_bytes: int, n_nodes: int) -> None:
        """Hold a search to its limits.

        Raises:
            LimitError: naming what to lower.
        """
        if n_bytes > self.mib << 20:
            so_far = f"{n_nodes} states so far"
            message = f"the plan graph of '{goal}' needs more than {self.mib} MiB ({so_far})"
            raise LimitError(message, code="memory", hint=f"{self.hint}; or raise --memory")
        if time.monotonic() > self.deadline:
            message = f"no time left for the plan graph of '{goal}' ({n_nodes} states so far)"
            raise LimitError(message, code="timeout", hint=f"{self.hint}; or raise --timeout")


@dataclass(frozen=True)
class StateSpaceLayers:
    """Layered states and the steps between them; ids count states in order of cost so far.

    ``layers`` are (cost so far, first id); ``edges`` are (sources, steps, targets), one entry for
    each layer that they lead into; ``cost`` is that of the cheapest goal state, None if none was
    met; ``next_bound`` the smallest bound that would have shown more, None if none would.
    """

    states: Words
    layers: tuple[tuple[int, int], ...]
    edges: tuple[Edges, ...]
    is_goal: Bools
    cost: int | None
    next_bound: int | None


@dataclass(slots=True)
class _Pending:
    """States of one cost that wait to be looked at, and the steps that led to them."""

    states: list[Words] = field(default_factory=list)
    landmarks: list[Words] = field(default_factory=list)
    sources: list[Ids] = field(default_factory=list)
    steps: list[SmallIds] = field(default_factory=list)


class Explorer:
    """One forward search.

    Args:
        rules: What can be done.
        goal: The goal's alternatives.
        marks: Landmarks over the ops of ``rules``; none makes the search blind.
        bound: The largest cost of a sequence.
        max_ties: The largest number of steps where zero-cost steps are counted below the cost.
        optimal: Whether only cheapest sequences are wanted: a state is then followed from its
            cheapest cost only, and the search ends with the layer that reaches the goal.
        limits: Time and memory.
        name: The goal's name, for messages.
    """

    def __init__(
        self, rules: PackedRules, goal: Tests, marks: Sequence[Landmark], bound: int,
        *, optimal: bool, limits: BuildLimits, name: str, max_ties: int = MAX_TIES,
    ) -> None:  # fmt: skip
        self.max_ties = max_ties
        self.rules, self.goal, self.bound, self.optimal = rules, goal, bound, optimal
        self.limits, self.name = limits, name
        self.bounds = LandmarkBound(rules.ops, marks, goal)
        self.costs = np.array([op.cost for op in rules.ops], dtype=np.int64)
        self.prices = sorted({op.cost for op in rules.ops})
        self.step_of = np.array([op.step for op in rules.ops], dtype=np.int32)
        self.one_way = len({op.step for op in rules.ops}) == len(rules.ops)
        self.pending: dict[int, _Pending] = {}
        self.queue: list[int] = []
        self.visited_states = SeenStates()
        self.next_bound: int | None = None
        self.n_bytes = self.n_waiting = 0
        self.layers: list[tuple[int, Words]] = []
        self.edges: list[Edges] = []
        self.goals: list[Bools] = []
        self.n_nodes = 0

    def run(self, start: Words) -> StateSpaceLayers:
        """Return what a search from one state finds.

        Raises:
            LimitError: if time or memory runs out.
        """
        landmarks = np.zeros((1, self.bounds.n_words), dtype=np.uint64)
        self._push(
            0, start.reshape(1, -1), landmarks, np.array([-1]), np.array([-1], dtype=np.int32)
        )
        cost: int | None = None
        while self.queue:
            cost_so_far = heapq.heappop(self.queue)
            states, landmarks, is_goal = self._take(cost_so_far)
            if is_goal.any():
                cost = cost_so_far if cost is None else cost
                if self.optimal:
                    break
            first = self.n_nodes - len(states)
            self._follow(
                cost_so_far, states[~is_goal], landmarks[~is_goal], first + np.flatnonzero(~is_goal)
            )
        return self._result(cost)

    def _take(self, cost: int) -> tuple[Words, Words, Bools]:
        """Return the distinct states of a cost, what all ways to them met, and which are goals."""
        pending = self.pending.pop(cost)
        states, landmarks = _joined(pending.states), _joined(pending.landmarks)
        sources, steps = _joined(pending.sources), _joined(pending.steps)
        self.n_waiting -= _n_bytes(states, landmarks, sources, steps)
        distinct, which, order, starts = group_rows(states)
        common = _common(landmarks.take(order, axis=0), starts)
        totals = cost + self.bounds.of(common)
        new = (
            ~self.visited_states.contains(distinct)
            if self.optimal
            else np.ones(len(distinct), np.bool_)
        )
        keep = new & (totals <= self.bound)
        self._note_pruned(totals[new & ~keep])
        ids = np.where(keep, self.n_nodes + np.cumsum(keep) - 1, -1)
        targets = ids.take(which)
        edge = (sources, steps, targets)
        if sources[0] < 0 or not keep.all():  # the initial state has no source
            real = np.flatnonzero((targets >= 0) & (sources >= 0))
            edge = (sources.take(real), steps.take(real), targets.take(real))
        states, common = distinct[keep], common[keep]
        is_goal = self.rules.meets(states, self.goal)
        self.layers.append((cost, states))
        self.edges.append(edge)
        self.goals.append(is_goal)
        self.n_nodes += len(states)
        self.n_bytes += _n_bytes(states, *edge)
        if self.optimal:
            self.visited_states.add(states)
            self.n_bytes += states.nbytes + 8 * len(states)
        return states, common, is_goal

    def _note_pruned(self, totals: Ids) -> None:
        if len(totals):
            low = int(totals.min())
            self.next_bound = low if self.next_bound is None else min(low, self.next_bound)

    def _follow(self, cost_so_far: int, states: Words, landmarks: Words, ids: Ids) -> None:
        def admits(rows: Ids, ops: SmallIds) -> Bools:
            totals = cost_so_far + self.costs.take(ops) + self.bounds.of(met(rows, ops))
            fits = totals <= self.bound
            self._note_pruned(totals[~fits])
            return fits

        def met(rows: Ids, ops: SmallIds) -> Words:
            return landmarks.take(rows, axis=0) | self.bounds.marks_of.take(ops, axis=0)

        for rows, ops, after in self._changes(states, admits):
            now, sources, steps = met(rows, ops), ids.take(rows), self.step_of.take(ops)
            for cost in self.prices:
                if (cost_so_far + cost) & MAX_TIES > self.max_ties:
                    continue
                part = slice(None) if len(self.prices) == 1 else self.costs[ops] == cost
                self._push(cost_so_far + cost, after[part], now[part], sources[part], steps[part])
            # Sorting the waiting states will take about as much again as they do, twice over.
            self.limits.check(self.name, self.n_bytes + 3 * self.n_waiting, self.n_nodes)

    def _changes(
        self, states: Words, admits: Callable[[Ids, SmallIds], Bools]
    ) -> Iterator[tuple[Ids, SmallIds, Words]]:
        """Yield what can follow; where a step can be done in several ways, the cheapest."""
        if self.one_way or not len(states):
            yield from self.rules.expand(states, admits)
            return
        parts = list(self.rules.expand(states))
        rows, ops, after = (np.concatenate([part[i] for part in parts]) for i in range(3))
        order = np.lexsort((ops, self.costs[ops], self.step_of[ops], rows))
        rows, ops = rows[order], ops[order]
        first = np.ones(len(rows), dtype=np.bool_)
        first[1:] = (rows[1:] != rows[:-1]) | (self.step_of[ops[1:]] != self.step_of[ops[:-1]])
        rows, ops, order = rows[first], ops[first], order[first]
        fits = admits(rows, ops)
        yield rows[fits], ops[fits], after[order[fits]]

    def _push(
        self, cost: int, states: Words, landmarks: Words, sources: Ids, steps: SmallIds
    ) -> None:
        if not len(states):
            return
        if cost not in self.pending:
            self.pending[cost] = _Pending()
            heapq.heappush(self.queue, cost)
        self.n_waiting += _n_bytes(states, landmarks, sources, steps)
        pending = self.pending[cost]
        pending.states.append(states)
        pending.landmarks.append(landmarks)
        pending.sources.append(sources)
        pending.steps.append(steps)

    def _result(self, cost: int | None) -> StateSpaceLayers:
        layers: list[tuple[int, int]] = []
        first = 0
        for layer_cost, states in self.layers:
            layers.append((layer_cost, first))
            first += len(states)
        states = np.concatenate([states for _, states in self.layers])
        is_goal = np.concatenate(self.goals)
        return StateSpaceLayers(
            states, tuple(layers), tuple(self.edges), is_goal, cost, self.next_bound
        )


def _joined(parts: Sequence[NDArray[Scalar]]) -> NDArray[Scalar]:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _common(rows: Words, starts: Ids) -> Words:
    """Return the bits that all rows of a group have, for groups that begin at ``starts``."""
    if rows.shape[1] == 1:  # several times as fast
        return np.bitwise_and.reduceat(rows[:, 0], starts)[:, None]
    return np.bitwise_and.reduceat(rows, starts, axis=0)


def _n_bytes(*arrays: NDArray[np.generic]) -> int:
    return sum(array.nbytes for array in arrays)
