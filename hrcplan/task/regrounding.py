"""A task again, for the problem as it is now: grounded anew only where that matters.

While a plan is carried out, facts and agent state change but not what is possible. Bits, actions and
everything that hangs on them (``Task.structure``) then stay, and only the initial state and the
costs are new. That includes the agent state that interactions change: its value facts stand for
*roles* (the value now, the value that an interaction leaves), and a role may take another number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TRUE,
    Action,
    Constant,
    Expr,
    FluentKey,
    Function,
    Number,
    Problem,
    formula_functions,
    functions_in,
)
from hrcplan.pddl.semantics import Binding, evaluate, ground_key
from hrcplan.task.actions import GroundAction
from hrcplan.task.changing import value_fact
from hrcplan.task.numbers import grounded, numeric_effects
from hrcplan.task.task import Task

MAX_KEPT = 32
Roles = Mapping[FluentKey, tuple[Number, ...]]
"""Values of each function that actions change, in the order of their bits."""


def regrounded(task: Task, problem: Problem) -> Task | None:
    """Return the task of ``problem`` with the structure of ``task``; None if that does not hold it.

    >>> from hrcplan import load
    >>> task = load("transport", "two-boxes")
    >>> moved = {("at", "human", "wp4")} | task.problem.facts - {("at", "human", "wp1")}
    >>> now = regrounded(task, replace(task.problem, facts=moved))
    >>> now.structure is task.structure, ("at", "human", "wp4") in now.facts_of(now.initial)
    (True, True)
    """
    if not _same_shape(task, problem):
        return None
    roles = _roles(task, problem)
    return None if roles is None else _with(task, problem, roles)


class Groundings:
    """The groundings of one running task: one for each set of agent states that can be bettered."""

    def __init__(self) -> None:
        self._kept: list[Task] = []

    def task(self, problem: Problem) -> Task:
        """Return the task of a problem, with the structure of an earlier one if any holds it.

        Raises:
            UnsupportedError: if bits cannot hold it.
            LimitError: if there are too many ground actions.
        """
        for kept in self._kept:
            found = regrounded(kept, problem)
            if found is not None:
                return found
        new = Task(problem)
        # The smallest that holds a problem is the quickest.
        self._kept = sorted([*self._kept[-MAX_KEPT:], new], key=lambda task: len(task.actions))
        return new


def _same_shape(task: Task, problem: Problem) -> bool:
    """Return whether the same facts and actions are possible, numbers that change aside.

    What can follow a state that can follow the initial one was grounded with it.
    """
    before = task.problem
    if (problem.domain is not before.domain or problem.objects != before.objects
            or problem.goal != before.goal):  # fmt: skip
        return False
    if problem.facts - task.bits.keys() != before.facts - task.bits.keys():
        return False
    old, new = before.values, problem.values
    changed = [k for k in old.keys() | new.keys() if old.get(k) != new.get(k)]
    shaping = {f.name for a in problem.domain.actions for f in _shaping(a)}
    return all(k in old and k in new and (k in task.reached or k[0] not in shaping)
               for k in changed)  # fmt: skip


def _shaping(action: Action) -> Iterator[Function]:
    """Yield the functions on which more than costs and values of roles depends."""
    for formula in (*(c.formula for c in action.conditions), *(e.given for e in action.effects)):
        yield from formula_functions(formula)
    for _, duration in action.durations:
        yield from functions_in(duration)


def _roles(task: Task, problem: Problem) -> Roles | None:
    """Return the numbers of all roles now; None if other or more roles are needed."""
    if not task.reached:
        return task.reached  # type: ignore[return-value]
    left = _assignments(task)
    if left is None:
        return None
    found: dict[FluentKey, tuple[Number, ...]] = {}
    for key, values in task.reached.items():
        before = [evaluate(e, task.problem.values, b) for e, b in left.get(key, ())]
        after = [evaluate(e, problem.values, b) for e, b in left.get(key, ())]
        numbers = _renumbered(tuple(values), dict(zip(before, after, strict=True)),
                              problem.values[key])  # fmt: skip
        if numbers is None or set(after) - set(numbers):
            return None
        found[key] = numbers
    return found


def _renumbered(
    values: tuple[Number, ...], left: Mapping[Number, Number], now: Number
) -> tuple[Number, ...] | None:
    """Return the number of each role: what is left is known, the free role takes the value now."""
    free = [v for v in values if v not in left]
    taken = set(left.values())
    if len(taken) < len(left):
        return None
    if now in taken or not free:
        numbers = tuple(left.get(v, v) for v in values)
    else:
        numbers = tuple(left.get(v, now if v == free[0] else v) for v in values)
    # In order, so that actions come in the order in which a new grounding would have them.
    ordered = all(a < b for a, b in pairwise(numbers))
    return numbers if ordered and now in numbers else None


def _assignments(task: Task) -> dict[FluentKey, list[tuple[Expr, Binding]]] | None:
    """Return what interactions leave each function at; None if that depends on more than costs do."""
    found: dict[FluentKey, list[tuple[Expr, Binding]]] = {}
    schemas = {action.name: action for action in task.problem.domain.actions}
    moving = {key[0] for key in task.reached}
    for name, args in dict.fromkeys((a.name, a.args) for a in task.actions):
        action = schemas[name]
        changes = any(numeric_effects(action))
        costs = {f.name for e in action.effects for f in functions_in(e.value)} if changes else set()
        if (costs | {f.name for f in _shaping(action)}) & moving:
            return None
        for effect in numeric_effects(action):
            assert effect.value is not None
            plain = effect.kind == "assign" and effect.given == TRUE and not effect.params
            if not plain or any(f.name == DURATION for f in functions_in(effect.value)):
                return None
            binding = _binding(action, args)
            found.setdefault(ground_key(effect.target, binding), []).append((effect.value, binding))
    return found


def _binding(action: Action, args: tuple[str, ...]) -> Binding:
    return {param.name: arg for param, arg in zip(action.params, args, strict=True)}


def _with(task: Task, problem: Problem, roles: Roles) -> Task:
    """Return the task with another initial state, and other numbers in costs and roles."""
    other = object.__new__(Task)
    other.__dict__.update(task.__dict__)
    other.__dict__.pop("costs", None)
    other.problem = problem
    if roles != task.reached:
        _renumber(other, task, roles)
    given = [value_fact(key, problem.values[key]) for key in roles]
    other.initial = other.state_of([*problem.facts, *given])
    return other


def _renumber(other: Task, task: Task, roles: Roles) -> None:
    new = {
        (key, old): number
        for key, values in task.reached.items()
        for old, number in zip(values, roles[key], strict=True)
    }
    n_plain = len(task.facts) - len(new)
    facts = [value_fact(key, number) for key, numbers in roles.items() for number in numbers]
    other.facts = (*task.facts[:n_plain], *facts)
    other.bits = {fact: i for i, fact in enumerate(other.facts)}
    other.reached = roles
    schemas = {action.name: action for action in task.problem.domain.actions}
    other.actions = tuple(
        _repriced(action, schemas[action.name], new) if action.values else action
        for action in task.actions
    )


def _repriced(
    action: GroundAction, schema: Action, new: Mapping[tuple[FluentKey, Number], Number]
) -> GroundAction:
    values = {key: new[key, old] for key, old in action.values.items()}
    known: dict[FluentKey, Expr] = {key: Constant(value) for key, value in values.items()}
    binding = _binding(schema, action.args)
    fixed = [expression for op, expression in schema.durations if op == "="]
    if len(fixed) == 1:
        known[DURATION,] = grounded(fixed[0], binding, known)
    costs = tuple(
        grounded(effect.value, binding, known)
        for effect in schema.effects
        if effect.target.name == TOTAL_COST and effect.value is not None
    )
    return replace(action, values=values, costs=costs)
