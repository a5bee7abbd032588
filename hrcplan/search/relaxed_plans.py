"""Many relaxed plans at once: how often the plans of a goal make a fact true or hold an operator.

A relaxed plan (Hoffmann and Nebel, JAIR 2001) reaches a goal if nothing true ever becomes false.
There are many: a fact can be made true by each of its *first achievers*, the operators that can do
so in the earliest layer in which it can be true. Here each of `N_PLANS` plans takes one of them, in
equal shares. Plans are the bits of an integer, so that all of them are followed together.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hrcplan.core.arrays import Floats
from hrcplan.search.delete_relaxation import literals, relaxed_rules
from hrcplan.task.conditions import Test
from hrcplan.task.steps import Operator

N_PLANS = 64
FAR = -1
"""The layer of a literal that is out of reach."""


@dataclass(frozen=True)
class RelaxedPlanShares:
    """What the relaxed plans of several goals from one state have in common.

    Attributes:
        facts: (facts, goals): the share of a goal's plans that make a fact true.
        ops: (operators, goals): the share of them that hold an operator.
        costs: (goals,): their mean cost; infinite where a goal is out of reach.
    """

    facts: Floats
    ops: Floats
    costs: Floats


class RelaxedPlans:
    """Relaxed plans of several goals, from any state.

    The same state always has the same plans: what is taken at random depends on the literal alone.

    Args:
        ops: What can be done.
        goals: The alternatives of each goal.
        n_plans: How many plans of a goal are followed.
    """

    def __init__(
        self, ops: Sequence[Operator], goals: Sequence[Sequence[Test]], n_plans: int = N_PLANS
    ) -> None:
        self._prices = np.array([op.cost for op in ops], dtype=np.float64)
        self._rules = list(relaxed_rules(ops, admissible=False))
        self._goals = [[literals(test) for test in tests] for tests in goals]
        sizes = [x for rule in self._rules for x in (*rule.needs, *rule.gives)]
        sizes += [x for tests in self._goals for test in tests for x in test]
        self.n_facts = max(sizes, default=0) // 2 + 1
        self.n_plans, self._all = n_plans, (1 << n_plans) - 1
        self._users: list[list[int]] = [[] for _ in range(2 * self.n_facts)]
        for i, rule in enumerate(self._rules):
            for literal in rule.needs:
                self._users[literal].append(i)
        self._parts: dict[tuple[int, int], tuple[int, ...]] = {}

    @cached_property
    def _n_needs(self) -> list[int]:
        return [len(rule.needs) for rule in self._rules]

    def shares(self, state: int) -> RelaxedPlanShares:
        """Return the shares of facts and operators in the relaxed plans from a state."""
        layers, achievers = self._layers(state)
        facts = np.zeros((self.n_facts, len(self._goals)))
        ops = np.zeros((len(self._prices), len(self._goals)))
        costs = np.full(len(self._goals), np.inf)
        for goal, tests in enumerate(self._goals):
            within_reach = [test for test in tests if all(layers[x] != FAR for x in test)]
            if not within_reach:
                continue
            needs, uses = self._follow(within_reach, layers, achievers)
            for literal, plans in needs.items():
                if not literal & 1:
                    facts[literal >> 1, goal] = plans.bit_count() / self.n_plans
            for op, plans in uses.items():
                ops[op, goal] = plans.bit_count() / self.n_plans
            costs[goal] = float(self._prices @ ops[:, goal])
        return RelaxedPlanShares(facts, ops, costs)

    def _layers(self, state: int) -> tuple[list[int], list[list[int]]]:
        """Return the first layer of each literal, and the rules that can make it true there."""
        layers = [FAR] * (2 * self.n_facts)
        fresh = [2 * fact + (not state >> fact & 1) for fact in range(self.n_facts)]
        for literal in fresh:
            layers[literal] = 0
        n_open, achievers = self._n_needs.copy(), [[] for _ in layers]  # type: list[int], list[list[int]]
        ready = [i for i, n in enumerate(n_open) if not n]
        layer = 0
        while fresh or ready:
            for literal in fresh:
                for i in self._users[literal]:
                    n_open[i] -= 1
                    if not n_open[i]:
                        ready.append(i)
            layer, fresh = layer + 1, []
            for i in sorted(ready):
                for literal in self._rules[i].gives:
                    if layers[literal] == FAR:
                        layers[literal] = layer
                        fresh.append(literal)
                    if layers[literal] == layer:
                        achievers[literal].append(i)
            ready = []
        return layers, achievers

    def _follow(
        self, tests: Sequence[tuple[int, ...]], layers: Sequence[int],
        achievers: Sequence[Sequence[int]],
    ) -> tuple[dict[int, int], dict[int, int]]:  # fmt: skip
        """Return which plans make each literal true, and which hold each operator, as bits."""
        needs: dict[int, int] = {}
        by_layer: dict[int, list[int]] = {}
        uses: dict[int, int] = {}

        def need(literals: Sequence[int], plans: int) -> None:
            for literal in literals:
                if layers[literal]:
                    if literal not in needs:
                        by_layer.setdefault(layers[literal], []).append(literal)
                    needs[literal] = needs.get(literal, 0) | plans

        for test, plans in zip(tests, self._split(-1, len(tests)), strict=True):
            need(test, plans)
        for layer in range(max(by_layer, default=0), 0, -1):
            for literal in by_layer.get(layer, ()):
                rules = achievers[literal]
                for i, part in zip(rules, self._split(literal, len(rules)), strict=True):
                    plans = needs[literal] & part
                    if plans:
                        rule = self._rules[i]
                        uses[rule.op] = uses.get(rule.op, 0) | plans
                        need(rule.needs, plans)
        return needs, uses

    def _split(self, literal: int, n: int) -> tuple[int, ...]:
        """Return which plans take each of ``n`` achievers: equal shares, at random."""
        if n == 1:
            return (self._all,)
        if (literal, n) not in self._parts:
            order = list(range(self.n_plans))
            random.Random(literal).shuffle(order)
            parts = [0] * n
            for place, plan in enumerate(order):
                parts[place * n // self.n_plans] |= 1 << plan
            self._parts[literal, n] = tuple(parts)
        return self._parts[literal, n]
