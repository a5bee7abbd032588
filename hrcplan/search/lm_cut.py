"""LM-cut (Helmert and Domshlak, ICAPS 2009): sets of steps of which every plan holds one.

Each set has a cost, and the costs of the sets that a step is in never add up to more than the
step costs. So the sets that a sequence has not met yet bound from below what it still has to pay.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass

from hrcplan.core.bits import positions
from hrcplan.task import BitEffect
from hrcplan.task.conditions import Test, Tests, conjunction
from hrcplan.task.steps import Operator

MAX_LANDMARKS = 256

_INFINITE = float("inf")


@dataclass(frozen=True, slots=True)
class Landmark:
    """Ops of which every plan holds one, and its share of the cost."""

    ops: frozenset[int]
    cost: int


@dataclass(slots=True)
class _Relaxed:
    """What one op can make true: literals before, literals after; ``group`` is its op."""

    group: int
    needs: tuple[int, ...]
    gives: tuple[int, ...]


def landmarks(ops: Sequence[Operator], state: int, goal: Tests) -> tuple[Landmark, ...] | None:
    """Return landmarks of all plans from a state to a goal; None if there is no plan at all.

    The largest costs first, at most ``MAX_LANDMARKS``. None is only returned if the goal is out
    of reach even if nothing true ever becomes false.
    """
    relaxation = _Relaxation(ops, state, goal)
    found: list[Landmark] = []
    while True:
        values = relaxation.h_max()
        bound = values[relaxation.goal]
        if bound == _INFINITE:
            return None
        if not bound:
            break
        found.append(relaxation.cut(values))
    found.sort(key=lambda landmark: -landmark.cost)
    return tuple(found[:MAX_LANDMARKS])


class _Relaxation:
    """The task without deletes: ``2 i`` says that fact i is true, ``2 i + 1`` that it is false."""

    def __init__(self, ops: Sequence[Operator], state: int, goal: Tests) -> None:
        self.costs = [op.cost for op in ops]
        changes = [change for op in ops for change in op.effects]
        tests = [*goal, *(test for op in ops for test in op.tests)]
        tests += [test for change in changes for test in change.tests]
        facts = [state, *(mask for mask, _ in tests), *(c.touched for c in changes)]
        n_facts = max(facts).bit_length()
        self.goal, self.true, top = 2 * n_facts, 2 * n_facts + 1, 2 * n_facts + 2
        self.start = {2 * i + (not state >> i & 1) for i in range(n_facts)} | {self.true}
        self.relaxed: list[_Relaxed] = []
        for group, op in enumerate(ops):
            for test in op.tests:
                for change in op.at_start:
                    for given in change.tests:
                        self._add(group, conjunction(test, given), change)
                for change in op.at_end:  # what it depends on may have been made at the start
                    self._add(group, test, change)
        for test in goal:
            self.relaxed.append(_Relaxed(len(ops), _needs(test, self.true), (self.goal,)))
        self.costs.append(0)
        self.users: list[list[int]] = [[] for _ in range(top)]
        for i, relaxed in enumerate(self.relaxed):
            for literal in relaxed.needs:
                self.users[literal].append(i)
        self.makers: list[list[int]] = [[] for _ in range(top)]
        for i, relaxed in enumerate(self.relaxed):
            for literal in relaxed.gives:
                self.makers[literal].append(i)
        self.start = {literal for literal in self.start if self.users[literal]}
        self.supporter: list[int] = []

    def _add(self, group: int, test: Test | None, change: BitEffect) -> None:
        if test is not None:
            true = (2 * i for i in positions(change.adds))
            false = (2 * i + 1 for i in positions(change.deletes))
            self.relaxed.append(_Relaxed(group, _needs(test, self.true), (*true, *false)))

    def h_max(self) -> list[float]:
        """Return the cost of the dearest precondition chain to every literal; keeps supporters."""
        values = [_INFINITE] * len(self.users)
        waiting = [len(relaxed.needs) for relaxed in self.relaxed]
        self.supporter = [-1] * len(self.relaxed)
        queue: list[tuple[float, int]] = [(0, literal) for literal in sorted(self.start)]
        for literal in self.start:
            values[literal] = 0
        while queue:
            value, literal = heapq.heappop(queue)
            if value > values[literal]:
                continue
            for i in self.users[literal]:
                waiting[i] -= 1
                if waiting[i]:
                    continue
                self.supporter[i] = literal  # the last to come is the dearest
                reached = value + self.costs[self.relaxed[i].group]
                for given in self.relaxed[i].gives:
                    if reached < values[given]:
                        values[given] = reached
                        heapq.heappush(queue, (reached, given))
        return values

    def cut(self, values: list[float]) -> Landmark:
        """Return the steps that lead into the part of the task from which the goal is free."""
        zone = self._zone()
        before = self._before(zone)
        crossing = {
            self.relaxed[i].group
            for literal in before
            for i in self.users[literal]
            if self.supporter[i] == literal and any(g in zone for g in self.relaxed[i].gives)
        }
        cost = min(self.costs[group] for group in crossing)
        for group in crossing:
            self.costs[group] -= cost
        return Landmark(frozenset(crossing), cost)

    def _zone(self) -> set[int]:
        """Return the literals from which zero-cost steps lead to the goal."""
        zone, waiting = {self.goal}, [self.goal]
        while waiting:
            literal = waiting.pop()
            for i in self.makers[literal]:
                needed = self.supporter[i]
                if needed >= 0 and needed not in zone and not self.costs[self.relaxed[i].group]:
                    zone.add(needed)
                    waiting.append(needed)
        return zone

    def _before(self, zone: set[int]) -> set[int]:
        """Return the literals reached from the start without entering the zone."""
        found = set(self.start) - zone
        waiting = list(found)
        while waiting:
            literal = waiting.pop()
            for i in self.users[literal]:
                if self.supporter[i] != literal:
                    continue
                gives = self.relaxed[i].gives
                if any(given in zone for given in gives):
                    continue
                for given in gives:
                    if given not in found:
                        found.add(given)
                        waiting.append(given)
        return found


def _needs(test: Test, true: int) -> tuple[int, ...]:
    mask, value = test
    return tuple(2 * i + (not value >> i & 1) for i in positions(mask)) or (true,)
