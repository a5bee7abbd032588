"""LM-cut (Helmert and Domshlak, ICAPS 2009): sets of steps of which every plan holds one.

Each set has a cost, and the costs of the sets that a step is in never add up to more than the
step costs. So the sets that a sequence has not met yet bound from below what it still has to pay.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from heapq import heapify, heappop, heappush

from hrcplan.core.records import record
from hrcplan.search.delete_relaxation import RelaxedRule, literals, relaxed_rules
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator

MAX_LANDMARKS = 256
UNREACHABLE = 1 << 300
"""Above every cost: not reachable even if nothing true ever becomes false."""


@record
class Landmark:
    """Ops of which every plan holds one, and its share of the cost."""

    ops: frozenset[int]
    cost: int


def landmarks(ops: Sequence[Operator], state: int, goal: Tests) -> tuple[Landmark, ...] | None:
    """Return landmarks of all plans from a state to a goal; None if there is no plan at all.

    The largest costs first, at most ``MAX_LANDMARKS``. None is only returned if the goal is out
    of reach even if nothing true ever becomes false.
    """
    relaxation = RelaxedTask(ops, goal)
    start = relaxation.start(state)
    costs = [*(op.cost for op in ops), 0]
    if relaxation.h_max(start, costs) == UNREACHABLE:
        return None
    cuts = sorted(relaxation.cuts(start, costs), key=lambda landmark: -landmark.cost)
    return tuple(cuts[:MAX_LANDMARKS])


def longest_chain(ops: Sequence[Operator], state: int, goal: Tests) -> int | None:
    """Return the cost of the most expensive chain of ops that the goal needs (h-max).

    None if the goal is out of reach even if nothing true ever becomes false.
    """
    relaxation = RelaxedTask(ops, goal)
    bound = relaxation.h_max(relaxation.start(state), [*(op.cost for op in ops), 0])
    return None if bound == UNREACHABLE else bound


class RelaxedTask:
    """Operators without what they make false, and a goal; states and costs come with each question.

    Costs are lists with one entry per operator and a last one, 0, for reaching the goal.
    """

    def __init__(self, ops: Sequence[Operator], goal: Tests) -> None:
        rules = list(relaxed_rules(ops, admissible=True))
        goals = [literals(test) for test in goal]
        literals_in_rules = [x for rule in rules for x in (*rule.needs, *rule.gives)]
        n_literals = max([0, *(x + 2 & ~1 for x in (*literals_in_rules, *sum(goals, ())))])
        self.goal, self.true = n_literals, n_literals + 1
        rules += [RelaxedRule(len(ops), needs, (self.goal,)) for needs in goals]
        # What needs nothing needs the literal that is always true, so that it has a supporter.
        rules = [replace(rule, needs=rule.needs or (self.true,)) for rule in rules]
        needs = {self.goal}.union(*(rule.needs for rule in rules))
        self.rules = [rule for rule in rules if not needs.isdisjoint(rule.gives)]
        self.op = [rule.op for rule in self.rules]
        self.gives = [tuple(x for x in rule.gives if x in needs) for rule in self.rules]
        self.n_needs = [len(rule.needs) for rule in self.rules]
        self.users: list[list[int]] = [[] for _ in range(n_literals + 2)]
        self.makers: list[list[int]] = [[] for _ in range(n_literals + 2)]
        for i, rule in enumerate(self.rules):
            for literal in rule.needs:
                self.users[literal].append(i)
            for literal in self.gives[i]:
                self.makers[literal].append(i)
        self._supporter: list[int] = []
        self._values: list[int] = []

    def start(self, state: int) -> list[int]:
        """Return the literals that hold in a state and that some rule needs, in order."""
        true = (2 * i + (not state >> i & 1) for i in range(self.goal // 2))
        return [literal for literal in (*true, self.true) if self.users[literal]]

    def is_free(self, start: Sequence[int], costs: Sequence[int]) -> bool:
        """Return whether steps that cost nothing lead to the goal."""
        users, op, gives, waiting = self.users, self.op, self.gives, self.n_needs[:]
        is_reached = bytearray(len(users))
        for literal in start:
            is_reached[literal] = 1
        stack = list(start)
        while stack:
            for i in users[stack.pop()]:
                waiting[i] -= 1
                if waiting[i] or costs[op[i]]:
                    continue
                for effect in gives[i]:
                    if not is_reached[effect]:
                        is_reached[effect] = 1
                        stack.append(effect)
        return bool(is_reached[self.goal])

    def h_max(self, start: Sequence[int], costs: Sequence[int]) -> int:
        """Return the cost of the costliest precondition chain to the goal, or ``UNREACHABLE``."""
        users, op, gives, waiting = self.users, self.op, self.gives, self.n_needs[:]
        values = self._values = [UNREACHABLE] * len(users)
        supporter = self._supporter = [-1] * len(op)
        for literal in start:
            values[literal] = 0
        size = len(users)  # an entry of the queue is a value and a literal in one number
        queue = list(start)
        heapify(queue)
        while queue:
            value, literal = divmod(heappop(queue), size)
            if value > values[literal]:
                continue
            for i in users[literal]:
                waiting[i] -= 1
                if waiting[i]:
                    continue
                supporter[i] = literal  # the last to come is the most expensive
                cost = value + costs[op[i]]
                for effect in gives[i]:
                    if cost < values[effect]:
                        values[effect] = cost
                        heappush(queue, cost * size + effect)
        return values[self.goal]

    @property
    def reaches_goal(self) -> bool:
        """Whether the goal could be reached when `h_max` or `cuts` last looked."""
        return self._values[self.goal] < UNREACHABLE

    def cuts(self, start: Sequence[int], costs: list[int]) -> Iterator[Landmark]:
        """Yield landmarks until the goal costs nothing; their costs are taken off ``costs``.

        None is found where the goal is out of reach (see ``reaches_goal``).
        """
        while 0 < self.h_max(start, costs) < UNREACHABLE:
            crossing = self._crossing(start, costs)
            cost = min(costs[op] for op in crossing)
            for op in crossing:
                costs[op] -= cost
            yield Landmark(frozenset(crossing), cost)

    def _crossing(self, start: Sequence[int], costs: Sequence[int]) -> set[int]:
        """Return the steps that lead into the part of the task from which the goal is free."""
        users, op, gives, supporter = self.users, self.op, self.gives, self._supporter
        zone = self._zone(costs)
        entering = {i for literal in zone for i in self.makers[literal]}
        before = set(start) - zone
        stack = list(before)
        crossing: set[int] = set()
        while stack:
            literal = stack.pop()
            for i in users[literal]:
                if supporter[i] != literal:
                    continue
                if i in entering:
                    crossing.add(op[i])
                    continue
                for effect in gives[i]:
                    if effect not in before:
                        before.add(effect)
                        stack.append(effect)
        return crossing

    def _zone(self, costs: Sequence[int]) -> set[int]:
        """Return the literals from which zero-cost steps lead to the goal."""
        zone, waiting = {self.goal}, [self.goal]
        while waiting:
            literal = waiting.pop()
            for i in self.makers[literal]:
                need = self._supporter[i]
                if need >= 0 and need not in zone and not costs[self.op[i]]:
                    zone.add(need)
                    waiting.append(need)
        return zone
