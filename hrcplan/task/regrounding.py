"""A task again, for the problem as it is now: grounded again only where that matters.

While a plan is carried out, facts and agent state change, but not what is possible. Bits, actions
and everything that hangs on them (``Task.structure``) then stay; only the initial state and the
costs are new. That includes the agent state that interactions change: its value facts stand for
*roles* (the value now, the value that an interaction leaves), and a role may take another number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise, product

from hrcplan.core.numbers import Number
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TRUE,
    Action,
    Compare,
    Constant,
    Expr,
    FluentKey,
    Formula,
    Function,
    Problem,
)
from hrcplan.pddl.semantics import (
    Binding,
    LiftedState,
    Undefined,
    Values,
    evaluate,
    ground_key,
    holds,
)
from hrcplan.pddl.walks import conjuncts, formula_functions, functions_in
from hrcplan.task.actions import GroundAction
from hrcplan.task.changing import ValueSets, value_fact
from hrcplan.task.grounding import Grounding
from hrcplan.task.numbers import divisors, ground_expression, numeric_effects
from hrcplan.task.task import Task

MAX_KEPT = 32
Roles = Mapping[FluentKey, tuple[Number, ...]]
"""Values of each function that actions change, in the order of their bits."""


class Structure:
    """One structure: a task, and what it takes to say whether another problem has it, too."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self._static_facts = task.problem.facts - task.bits.keys()
        self._assignments = None if _goal_reads_changes(task) else _assignments(task)
        actions = task.problem.domain.actions
        self._shaping = frozenset(f.name for action in actions for f in _shaping(action))
        self._truths = self._possible(task.problem.values, task.value_sets)

    def again(self, problem: Problem) -> Task | None:
        """Return the task of ``problem`` with this structure; None if that does not hold it.

        >>> from hrcplan import ground
        >>> task = ground("transport", "two-boxes")
        >>> moved = {("at", "human", "wp4")} | task.problem.facts - {("at", "human", "wp1")}
        >>> now = Structure(task).again(replace(task.problem, facts=moved))
        >>> now.structure is task.structure, ("at", "human", "wp4") in now.facts_of(now.initial)
        (True, True)
        """
        if not self._has_shape(problem):
            return None
        roles = self._roles(problem)
        if roles is None:
            return None
        return Task(problem, grounding=_renumbered_grounding(self.task, roles))

    def _has_shape(self, problem: Problem) -> bool:
        """Return whether the same facts and actions are possible, numbers that change aside.

        What can follow a state that can follow the initial one was grounded with it.
        """
        before, value_sets = self.task.problem, self.task.value_sets
        if (problem.domain is not before.domain or problem.objects != before.objects
                or problem.goal != before.goal):  # fmt: skip
            return False
        if problem.facts - self.task.bits.keys() != self._static_facts:
            return False
        old, new = before.values, problem.values
        if old.keys() != new.keys():
            return False
        changes = [key for key in old if old[key] != new[key]]
        return all(key in value_sets or key[0] not in self._shaping for key in changes)

    def _roles(self, problem: Problem) -> Roles | None:
        """Return the numbers of all roles now; None if other or more roles are needed."""
        if self._assignments is None:
            return None
        old, new = self.task.problem.values, problem.values
        roles: dict[FluentKey, tuple[Number, ...]] = {}
        for key, values in self.task.value_sets.items():
            numbers_after = {
                evaluate(e, old, b): evaluate(e, new, b) for e, b in self._assignments.get(key, ())
            }
            after = {evaluate(e, new, b) for e, b in self._assignments.get(key, ())}
            numbers = _renumber(tuple(values), numbers_after, new[key])
            if numbers is None or after.difference(numbers):
                return None
            roles[key] = numbers
        return roles if self._possible(new, roles) == self._truths else None

    def _possible(self, values: Values, roles: ValueSets) -> list[bool]:
        """Return what the comparisons of each interaction say, for each choice of roles."""
        return [
            _is_true(comparison, {**values, **choice}, mover.binding, self.task.problem)
            for mover in self.task.grounding.movers
            for comparison in _comparisons(mover.action)
            for choice in _choices(comparison, mover.binding, roles)
        ]


class Groundings:
    """The groundings of one running task: one for each set of agent states that can be bettered."""

    def __init__(self) -> None:
        self._structures: list[Structure] = []

    def task(self, problem: Problem) -> Task:
        """Return the task of a problem, with the structure of an earlier one if any holds it.

        Raises:
            UnsupportedError: if bits cannot hold it.
            LimitError: if there are too many ground actions.
        """
        for structure in self._structures:
            task = structure.again(problem)
            if task is not None:
                return task
        new = Structure(Task(problem))
        # The smallest that holds a problem is the quickest.
        structures = [*self._structures[-MAX_KEPT:], new]
        self._structures = sorted(structures, key=lambda grounding: len(grounding.task.actions))
        return new.task


def _shaping(action: Action) -> Iterator[Function]:
    """Yield the functions on which more depends than costs, roles, and ``_comparisons``."""
    simple = {id(comparison) for comparison in _comparisons(action)}
    for formula in (*_parts(action), *(e.condition for e in action.effects)):
        if id(formula) not in simple:
            yield from formula_functions(formula)
    for _, duration in action.durations:
        yield from functions_in(duration)
    for effect in action.effects:
        yield from divisors(effect.value)  # a cost that divides by zero is none


def _comparisons(action: Action) -> list[Formula]:
    """Return the plain comparisons among the conditions of an interaction at its start.

    Whether they hold may depend on the role of a value but not on its number.
    """
    starts = (c.formula for c in action.conditions if c.when == "start")
    parts = (part for formula in starts for part in conjuncts(formula))
    return [part for part in parts if isinstance(part, Compare)] if any(
        numeric_effects(action)) else []  # fmt: skip


def _parts(action: Action) -> Iterator[Formula]:
    for condition in action.conditions:
        yield from conjuncts(condition.formula)


def _is_true(comparison: Formula, values: Values, binding: Binding, problem: Problem) -> bool:
    try:
        return holds(comparison, LiftedState(frozenset(), values), binding, problem)
    except Undefined:
        return False


def _choices(
    comparison: Formula, binding: Binding, roles: ValueSets
) -> Iterator[dict[FluentKey, Number]]:
    """Yield every choice of the numbers, in the order of their roles, that a comparison reads."""
    read = sorted({ground_key(f, binding) for f in formula_functions(comparison)} & roles.keys())
    for choice in product(*(roles[key] for key in read)):
        yield dict(zip(read, choice, strict=True))


def _renumber(
    values: tuple[Number, ...], new_numbers: Mapping[Number, Number], now: Number
) -> tuple[Number, ...] | None:
    """Return the number of each role: what is left is known, the free role takes the value now."""
    free = [v for v in values if v not in new_numbers]
    numbers_in_use = set(new_numbers.values())
    if len(numbers_in_use) < len(new_numbers):
        return None
    if now in numbers_in_use or not free:
        numbers = tuple(new_numbers.get(v, v) for v in values)
    else:
        numbers = tuple(new_numbers.get(v, now if v == free[0] else v) for v in values)
    # In order, so that actions come in the order in which a new grounding would have them.
    is_ascending = all(a < b for a, b in pairwise(numbers))
    return numbers if is_ascending and now in numbers else None


def _assignments(task: Task) -> dict[FluentKey, list[tuple[Expr, Binding]]] | None:
    """Return what interactions leave each function at; None if actions do more with them."""
    assignments: dict[FluentKey, list[tuple[Expr, Binding]]] = {}
    schema = task.problem.domain.action
    moving = {key[0] for key in task.value_sets}
    used = {action.name for action in task.actions}
    if any(_looks_closer(schema(name), moving) for name in used):
        return None
    for name, args in dict.fromkeys((a.name, a.args) for a in task.actions):
        action = schema(name)
        for effect in numeric_effects(action):
            assert effect.value is not None
            plain = effect.kind == "assign" and effect.condition == TRUE and not effect.params
            if not plain or any(f.name == DURATION for f in functions_in(effect.value)):
                return None
            binding = _binding(action, args)
            key = ground_key(effect.target, binding)
            assignments.setdefault(key, []).append((effect.value, binding))
    return assignments


def _goal_reads_changes(task: Task) -> bool:
    """Return whether the goal compares a function that actions change."""
    read = {function.name for function in formula_functions(task.problem.goal)}
    return not read.isdisjoint(key[0] for key in task.value_sets)


def _looks_closer(action: Action, moving: set[str]) -> bool:
    """Return whether an action does with changing functions more than count them as a cost."""
    names = {function.name for function in _shaping(action)}
    if any(numeric_effects(action)):
        names.update(f.name for effect in action.effects for f in functions_in(effect.value))
    return not moving.isdisjoint(names)


def _binding(action: Action, args: tuple[str, ...]) -> Binding:
    return {param.name: arg for param, arg in zip(action.params, args, strict=True)}


def _renumbered_grounding(task: Task, roles: Roles) -> Grounding:
    """Return the grounding of a task with other numbers in its roles."""
    if roles == task.value_sets:
        return task.grounding
    new = {
        (key, old): number
        for key, values in task.value_sets.items()
        for old, number in zip(values, roles[key], strict=True)
    }
    n_plain = len(task.facts) - len(new)
    values = (value_fact(key, number) for key, numbers in roles.items() for number in numbers)
    facts = (*task.facts[:n_plain], *values)
    domain = task.problem.domain
    actions = tuple(
        _reprice(action, domain.action(action.name), new) if action.values else action
        for action in task.actions
    )
    bits = {fact: i for i, fact in enumerate(facts)}
    return replace(task.grounding, facts=facts, bits=bits, value_sets=roles, actions=actions)


def _reprice(
    action: GroundAction, schema: Action, new: Mapping[tuple[FluentKey, Number], Number]
) -> GroundAction:
    values = {key: new[key, old] for key, old in action.values.items()}
    constants: dict[FluentKey, Expr] = {key: Constant(value) for key, value in values.items()}
    binding = _binding(schema, action.args)
    if schema.fixed_duration is not None:
        constants[DURATION,] = ground_expression(schema.fixed_duration, binding, constants)
    costs = tuple(
        ground_expression(effect.value, binding, constants)
        for effect in schema.effects
        if effect.target.name == TOTAL_COST and effect.value is not None
    )
    return replace(action, values=values, costs=costs)
