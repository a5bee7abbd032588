"""Goals that are composed of the goal facts of a bank, for people who want none of its goals.

A composed goal is named after its facts (``box-at red wp2 + box-at blue wp4``), so that its name is
all that has to be written down. Facts that every goal of the bank needs belong to each.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from itertools import combinations, islice

import numpy as np

from hrcplan.bank.bank import Bank
from hrcplan.bank.construct import empty_graph, optimal_graph
from hrcplan.bank.cost_to_go import NEVER, cost_to_go_of
from hrcplan.bank.goals import Goals
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits
from hrcplan.core.arrays import Bools, Floats
from hrcplan.errors import LimitError
from hrcplan.pddl.model import And, Atom, Fact, Formula
from hrcplan.search.relaxed_plans import RelaxedPlans
from hrcplan.task.conditions import Test

MOST_FACTS = 100  # goal facts of a bank that are looked at
MOST_BEGUN = 6  # facts that were brought nearer most: composed goals have one of them
MOST_OF_FAMILY = 3  # facts of one predicate in a composed goal
MOST_MOVES = 12  # of people's last steps that goals are to explain
HALF_STEP = 0.5  # what brings a fact nearer by less does not serve it
FACT_PRICE = 0.1  # the share of steps that one more fact has to explain
MOST_LOOKED_AT = 500_000  # actions between states of a team, for goals composed at once
GRAPH_MIB = 4  # of the plan graph of a composed goal
PLUS = " + "

FactSet = frozenset[Fact]


def composed_name(facts: FactSet) -> str:
    """Return the name of a goal, by its facts.

    >>> composed_name(frozenset({("box-at", "red", "wp2"), ("box-at", "blue", "wp4")}))
    'box-at blue wp4 + box-at red wp2'
    """
    return PLUS.join(sorted(" ".join(fact) for fact in facts))


def composed_formula(name: str) -> Formula:
    """Return the goal that a name stands for."""
    words = (fact.split() for fact in name.split(PLUS))
    return And(tuple(Atom(first, tuple(args)) for first, *args in words))


def with_composed(bank: Bank, names: Sequence[str]) -> Bank:
    """Return a bank with composed goals after its own; without those that have no plan in reach.

    The costs to go of a team, and the graphs of the bank's own goals, are not made again.
    """
    goals = bank.goals.plus(names, [composed_formula(name) for name in names])
    graphs = tuple(_graph(bank, goals, goal) for goal in range(len(bank.names), len(goals)))
    n_composed = bank.n_composed + len(names)
    larger = replace(bank, goals=goals, graphs=(*bank.graphs, *graphs), n_composed=n_composed)
    if bank.team:
        costs = cost_to_go_of(larger, like=bank)
        larger = replace(larger, shared_costs=costs)
    left = [name for goal, name in enumerate(names, len(bank.names)) if _has_plan(larger, goal)]
    return larger if len(left) == len(names) else with_composed(bank, left)


def _graph(bank: Bank, goals: Goals, goal: int) -> PlanGraph:
    """Return the plan graph of a goal; an empty one where it is too large, or none is needed."""
    name, packing = goals.names[goal], bank.graphs[0].packing
    if bank.team:  # whose turn it is decides: the team's costs to go say what comes next
        return replace(empty_graph(name, packing), team=bank.graphs[0].team)
    limits = BuildLimits(GRAPH_MIB)
    try:
        return optimal_graph(bank.table, goals.tests[goal], bank.initial, name=name, limits=limits)
    except LimitError:
        return empty_graph(name, packing)


def _has_plan(bank: Bank, goal: int) -> bool:
    if bank.team:
        costs = cost_to_go_of(bank)
        return bool(costs.of(costs.place(bank.initial), 0)[goal] < NEVER)
    is_there = bank.graphs[goal].n_nodes and bank.graphs[goal].node_of(bank.initial) is not None
    return bank.goals.is_reached(goal, bank.initial) or bool(is_there)


class GoalComposer:
    """Composes goals of the goal facts of a bank.

    What a step brings nearer is measured by relaxed plans: a look at all states of a team would
    take too long while people wait for an answer.

    Args:
        bank: The bank, of goals that people seem not to have.
    """

    def __init__(self, bank: Bank) -> None:
        self.bank = bank
        self._costs = cost_to_go_of(bank) if bank.team and not bank.is_solo else None
        facts = [fact for goal in map(_facts, bank.goals.formulas) if goal for fact in goal]
        sets = [frozenset(goal) for goal in map(_facts, bank.goals.formulas) if goal]
        self._known = set(sets)
        self._shared = frozenset.intersection(*sets) if sets else FactSet()
        free = [fact for fact in dict.fromkeys(facts) if fact not in self._shared]
        self._free = free[:MOST_FACTS] if not bank.is_solo else []
        tests = [self._tests(self._with_shared(fact)) for fact in self._free]
        self._plans = RelaxedPlans(bank.table.ops, tests)
        self._steps_left: dict[int, Floats] = {}

    def _with_shared(self, *facts: Fact) -> FactSet:
        return self._shared | frozenset(facts)

    def _tests(self, facts: FactSet) -> tuple[Test, ...]:
        formula = composed_formula(composed_name(facts))
        return self.bank.goals.task.with_goal(formula).goal

    @property
    def n_at_once(self) -> int:
        """How many goals are added to the bank while people wait for one answer; at least one."""
        return 1 if self._costs is None else max(1, MOST_LOOKED_AT // self._costs.n_actions)

    def compose(
        self, moves: Sequence[tuple[int, int]], most: int, without: Collection[str] = ()
    ) -> list[str]:
        """Return the names of goals that people may have by what they did, the best first.

        A goal explains a step that brings one of its facts nearer; it should explain many steps
        with few facts.

        Args:
            moves: The states before and after each step of people, as bits.
            most: How many goals at most.
            without: Names of goals that are left out.
        """
        if not self._free or not moves:
            return []
        explains = self._explained(moves[-MOST_MOVES:])
        share = {f: float(steps.mean()) for f, steps in explains.items() if steps.any()}
        begun = sorted(share, key=lambda fact: -share[fact])[:MOST_BEGUN]
        sets = dict.fromkeys(self._candidates(begun))
        worth = {
            goal: float(np.any([explains[f] for f in goal - self._shared], axis=0).mean())
            - FACT_PRICE * len(goal)
            for goal in sets if goal not in self._known
        }  # fmt: skip
        best = sorted(worth, key=lambda goal: -worth[goal])
        new = (goal for goal in best if composed_name(goal) not in without)
        return [composed_name(goal) for goal in islice(filter(self._can_hold, new), most)]

    def _explained(self, moves: Sequence[tuple[int, int]]) -> dict[Fact, Bools]:
        """Return for each goal fact which steps have brought it nearer."""
        gains = np.zeros((len(moves), len(self._free)))
        for place, (before, after) in enumerate(moves):
            nearer, farther = self._left(after), self._left(before)
            is_known = np.isfinite(nearer)
            gains[place, is_known] = farther[is_known] - nearer[is_known]
        return dict(zip(self._free, (gains > HALF_STEP).T, strict=True))

    def _left(self, world: int) -> Floats:
        """Return how many steps relaxed plans need to each free fact; infinite if there is none."""
        steps = self._steps_left.get(world)
        if steps is None:
            shares = self._plans.shares(world)
            steps = np.where(np.isfinite(shares.costs), shares.ops.sum(axis=0), np.inf)
            self._steps_left[world] = steps
        return steps

    def _can_hold(self, facts: FactSet) -> bool:
        """Return whether facts can hold together, as far as that is seen at once."""
        if self._costs is None:
            return True
        return self._costs.can_hold(self._tests(facts))

    def _candidates(self, begun: Sequence[Fact]) -> Iterator[FactSet]:
        """Yield facts that were brought nearer: several together, alone, and with their family."""
        for n in range(2, len(begun) + 1):
            for facts in combinations(begun, n):
                yield self._with_shared(*facts)
        for fact in begun:
            yield self._with_shared(fact)
            family = [other for other in self._free
                      if other[0] == fact[0] and other != fact]  # fmt: skip
            for n in range(1, MOST_OF_FAMILY):
                for others in combinations(family, n):
                    yield self._with_shared(fact, *others)


def _facts(formula: Formula) -> tuple[Fact, ...] | None:
    """Return the facts of a conjunction; None if it is more than that."""
    parts = formula.parts if isinstance(formula, And) else (formula,)
    facts = [(part.name, *part.args) for part in parts if isinstance(part, Atom)]
    return tuple(facts) if len(facts) == len(parts) else None
