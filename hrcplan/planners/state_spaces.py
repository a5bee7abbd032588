"""The states of a classical task for searches of our own: as bits, or lifted with any numbers."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from fractions import Fraction
from typing import Protocol

from hrcplan.core.numbers import Number, exact
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, TRUE, FluentKey, Formula, Problem
from hrcplan.pddl.semantics import LiftedState, Undefined, changes, evaluate, holds
from hrcplan.pddl.walks import formula_functions, functions_in
from hrcplan.planners.number_range import never_lowers_cost
from hrcplan.plans import PlannedAction
from hrcplan.task import Task
from hrcplan.task.numbers import functions_read
from hrcplan.task.reachable import reachable

_COST: FluentKey = (TOTAL_COST,)


class StateSpace(Protocol):
    """What a search needs to know of a task. Costs of actions are amounts added to total-cost."""

    initial: Hashable
    has_negative_costs: bool

    def successors(self, state: Hashable) -> Iterator[tuple[PlannedAction, Number, Hashable]]:
        """Yield the actions that can run in a state, what each costs, and the state after it."""

    def is_goal(self, state: Hashable) -> bool:
        """Return whether the goal holds."""

    def value(self, state: Hashable) -> Number:
        """Return the problem's metric in a state, with no time passed and the initial cost."""


class BitSpace:
    """States of a grounded task."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self.initial: Hashable = task.initial
        self._costs = task.costs if TOTAL_COST in task.problem.domain.functions else None
        self._actions = [PlannedAction(a.name, a.args) for a in task.actions]
        self.has_negative_costs = any(cost < 0 for cost in task.costs)

    def successors(self, state: Hashable) -> Iterator[tuple[PlannedAction, Number, Hashable]]:
        """Yield the actions that change a state, what each costs, and the state after it."""
        assert isinstance(state, int)
        for index in self._task.applicable(state):
            cost = self._costs[index] if self._costs is not None else 0
            yield self._actions[index], cost, self._task.successor(state, index)

    def is_goal(self, state: Hashable) -> bool:
        """Return whether the goal holds."""
        assert isinstance(state, int)
        return self._task.is_goal(state)

    def value(self, state: Hashable) -> Number:
        """Return the problem's metric in a state, with no time passed and the initial cost."""
        assert isinstance(state, int)
        problem = self._task.problem
        values = dict(problem.values)
        if self._task.value_sets:
            for fact in self._task.facts_of(state):
                if fact[0] == "=":
                    values[fact[1:-1]] = exact(Fraction(fact[-1]))
        return metric_of(problem, values)


class LiftedSpace:
    """States with any numbers, for tasks that bits cannot hold.

    A state is the facts and the values, without total-cost unless something looks at it.
    """

    def __init__(self, problem: Problem, deadline: float) -> None:
        self._problem = problem
        self._instances = reachable(problem, deadline)[0]
        self._counts_cost = _looks_at_cost(problem)
        self.has_negative_costs = not never_lowers_cost(problem)
        values = {k: v for k, v in problem.values.items() if self._is_part(k)}
        self.initial: Hashable = (frozenset(problem.facts), frozenset(values.items()))
        self._cost = problem.values.get(_COST, 0)

    def _is_part(self, key: FluentKey) -> bool:
        return key != _COST or self._counts_cost

    def _lifted_state(self, state: Hashable) -> LiftedState:
        assert isinstance(state, tuple)
        facts, values = state
        all_values: dict[FluentKey, Number] = dict(values)
        if TOTAL_COST in self._problem.domain.functions:
            all_values.setdefault(_COST, self._cost)
        return LiftedState(facts, all_values)

    def successors(self, state: Hashable) -> Iterator[tuple[PlannedAction, Number, Hashable]]:
        """Yield the actions that can run in a state, what each costs, and the state after it."""
        before, problem = self._lifted_state(state), self._problem
        for instance in self._instances:
            action, binding = instance.action, instance.binding
            try:
                if not all(holds(c.formula, before, binding, problem) for c in action.conditions):
                    continue
                after = changes(action.effects, before, binding, problem).apply(before)
            except Undefined:
                continue
            cost = after.values.get(_COST, 0) - before.values.get(_COST, 0)
            values = frozenset((k, v) for k, v in after.values.items() if self._is_part(k))
            yield PlannedAction(action.name, instance.args), cost, (frozenset(after.facts), values)

    def is_goal(self, state: Hashable) -> bool:
        """Return whether the goal holds."""
        try:
            return holds(self._problem.goal, self._lifted_state(state), {}, self._problem)
        except Undefined:
            return False

    def value(self, state: Hashable) -> Number:
        """Return the problem's metric in a state, with no time passed and the initial cost."""
        values = dict(self._lifted_state(state).values)
        return metric_of(self._problem, {**values, _COST: self._cost})


def metric_of(problem: Problem, values: dict[FluentKey, Number]) -> Number:
    """Return the metric of a problem for the values of a state, 0 if there is no metric.

    Raises:
        Undefined: if the metric looks at a function that has no value.
    """
    if problem.metric is None:
        return problem.values.get(_COST, 0) if TOTAL_COST in problem.domain.functions else 0
    all_values = {**values, (TOTAL_TIME,): 0}
    all_values.setdefault(_COST, 0)
    return exact(evaluate(problem.metric, all_values, {}))


def _looks_at_cost(problem: Problem) -> bool:
    """Return whether total-cost decides more than the metric: it is read, or not only added to."""
    formulas: list[Formula] = [problem.goal]
    for action in problem.domain.actions:
        read = [f.name for f in functions_read(action)]
        read += [f.name for effect in action.effects for f in functions_in(effect.value)]
        of_cost = [e for e in action.effects if e.target.name == TOTAL_COST]
        if TOTAL_COST in read or any(e.kind not in ("increase", "decrease") for e in of_cost):
            return True
        formulas += [effect.condition for effect in action.effects if effect.condition != TRUE]
    return any(f.name == TOTAL_COST for formula in formulas for f in formula_functions(formula))
