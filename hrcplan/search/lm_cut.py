"""LM-cut (Helmert and Domshlak, ICAPS 2009): sets of steps of which every plan holds one.

Each set has a cost, and the costs of the sets that a step is in never add up to more than the
step costs. So the sets that a sequence has not met yet bound from below what it still has to pay.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass, replace

from hrcplan.search.delete_relaxation import RelaxedRule, literals, relaxed_rules
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator

MAX_LANDMARKS = 256

_INFINITE = float("inf")


@dataclass(frozen=True, slots=True)
class Landmark:
    """Ops of which every plan holds one, and its share of the cost."""

    ops: frozenset[int]
    cost: int


def landmarks(ops: Sequence[Operator], state: int, goal: Tests) -> tuple[Landmark, ...] | None:
    """Return landmarks of all plans from a state to a goal; None if there is no plan at all.

    The largest costs first, at most ``MAX_LANDMARKS``. None is only returned if the goal is out
    of reach even if nothing true ever becomes false.
    """
    relaxation = _Relaxation(ops, state, goal)
    cuts: list[Landmark] = []
    while True:
        values = relaxation.h_max()
        bound = values[relaxation.goal]
        if bound == _INFINITE:
            return None
        if not bound:
            break
        cuts.append(relaxation.cut(values))
    cuts.sort(key=lambda landmark: -landmark.cost)
    return tuple(cuts[:MAX_LANDMARKS])


def longest_chain(ops: Sequence[Operator], state: int, goal: Tests) -> int | None:
    """Return the cost of the most expensive chain of ops that the goal needs (h-max).

    None if the goal is out of reach even if nothing true ever becomes false.
    """
    relaxation = _Relaxation(ops, state, goal)
    bound = relaxation.h_max()[relaxation.goal]
    return None if bound == _INFINITE else int(bound)


class _Relaxation:
    """The relaxed task, whose costs are used up by the landmarks that are cut out of it."""

    def __init__(self, ops: Sequence[Operator], state: int, goal: Tests) -> None:
        self.costs = [*(op.cost for op in ops), 0]
        rules = list(relaxed_rules(ops, admissible=True))
        goals = [literals(test) for test in goal]
        literals_in_rules = [x for rule in rules for x in (*rule.needs, *rule.gives)]
        n_literals = max(
            [2 * state.bit_length(), *(x + 2 & ~1 for x in (*literals_in_rules, *sum(goals, ())))]
        )
        self.goal, self.true = n_literals, n_literals + 1
        rules += [RelaxedRule(len(ops), needs, (self.goal,)) for needs in goals]
        # What needs nothing needs the literal that is always true, so that it has a supporter.
        self.rules = [replace(rule, needs=rule.needs or (self.true,)) for rule in rules]
        self.users: list[list[int]] = [[] for _ in range(n_literals + 2)]
        self.makers: list[list[int]] = [[] for _ in range(n_literals + 2)]
        for i, rule in enumerate(self.rules):
            for literal in rule.needs:
                self.users[literal].append(i)
            for literal in rule.gives:
                self.makers[literal].append(i)
        start = {2 * i + (not state >> i & 1) for i in range(n_literals // 2)} | {self.true}
        self.start = {literal for literal in start if self.users[literal]}
        self.supporter: list[int] = []

    def h_max(self) -> list[float]:
        """Return the cost of the costliest precondition chain to every literal."""
        values = [_INFINITE] * len(self.users)
        waiting = [len(rule.needs) for rule in self.rules]
        self.supporter = [-1] * len(self.rules)
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
                self.supporter[i] = literal  # the last to come is the most expensive
                cost = value + self.costs[self.rules[i].op]
                for effect in self.rules[i].gives:
                    if cost < values[effect]:
                        values[effect] = cost
                        heapq.heappush(queue, (cost, effect))
        return values

    def cut(self, values: list[float]) -> Landmark:
        """Return the steps that lead into the part of the task from which the goal is free."""
        zone = self._zone()
        before = self._before(zone)
        crossing = {
            self.rules[i].op
            for literal in before
            for i in self.users[literal]
            if self.supporter[i] == literal and any(g in zone for g in self.rules[i].gives)
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
                need = self.supporter[i]
                if need >= 0 and need not in zone and not self.costs[self.rules[i].op]:
                    zone.add(need)
                    waiting.append(need)
        return zone

    def _before(self, zone: set[int]) -> set[int]:
        """Return the literals reached from the start without entering the zone."""
        literals = set(self.start) - zone
        waiting = list(literals)
        while waiting:
            literal = waiting.pop()
            for i in self.users[literal]:
                if self.supporter[i] != literal:
                    continue
                gives = self.rules[i].gives
                if any(effect in zone for effect in gives):
                    continue
                for effect in gives:
                    if effect not in literals:
                        literals.add(effect)
                        waiting.append(effect)
        return literals
