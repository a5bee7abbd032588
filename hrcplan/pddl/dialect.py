"""The same domain and problem for readers that know less PDDL: no numbers, no long sums."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import reduce

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    Action,
    Arithmetic,
    Compare,
    Constant,
    Domain,
    Effect,
    Expr,
    Formula,
    Problem,
)
from hrcplan.pddl.renaming import renamed
from hrcplan.pddl.semantics import instances
from hrcplan.pddl.walks import formula_functions, functions_in, with_parts

_NUMERIC = frozenset([":fluents", ":numeric-fluents", ":action-costs"])


def without_numbers(problem: Problem) -> Problem:
    """Return a problem and its domain without functions, values and metric.

    Raises:
        UnsupportedError: if a condition, a duration or the goal needs the numbers.
    """
    _check_symbolic(problem.goal, "the goal")
    return replace(problem, domain=symbolic(problem.domain), values={}, metric=None)


def symbolic(domain: Domain) -> Domain:
    """Return a domain without functions and numeric effects.

    Raises:
        UnsupportedError: if a condition or a duration needs the numbers.
    """
    for action in domain.actions:
        for condition in action.conditions:
            _check_symbolic(condition.formula, f"'{action.name}'")
        for effect in action.effects:
            _check_symbolic(effect.condition, f"'{action.name}'")
        if any(True for _, expr in action.durations for _ in functions_in(expr)):
            raise UnsupportedError(f"the duration of '{action.name}' needs numbers")
    flags = tuple(flag for flag in domain.requirements if flag not in _NUMERIC)
    actions = with_effects(domain, lambda effect: effect.value is None).actions
    return replace(domain, requirements=flags, functions={}, actions=actions)


def _check_symbolic(formula: Formula, where: str) -> None:
    for function in formula_functions(formula):
        raise UnsupportedError(f"{where} compares {function}, which cannot be left out")


def with_effects(domain: Domain, keep: Callable[[Effect], bool]) -> Domain:
    """Return a domain with only some of its effects."""
    actions = tuple(replace(a, effects=tuple(filter(keep, a.effects))) for a in domain.actions)
    return replace(domain, actions=actions)


def with_binary_sums(problem: Problem) -> Problem:
    """Return a problem whose arithmetic has two operands each, in its domain, goal and metric."""
    domain = problem.domain
    return replace(
        problem,
        domain=replace(
            domain,
            actions=tuple(map(_binary_action, domain.actions)),
            processes=tuple(map(_binary_action, domain.processes)),
            events=tuple(map(_binary_action, domain.events)),
        ),
        goal=_binary_formula(problem.goal),
        metric=None if problem.metric is None else _binary(problem.metric),
    )


def with_ground_sums(problem: Problem) -> Problem:
    """Return a problem whose effects on numbers stand for one object each, not for all of a type.

    Raises:
        LimitError: if a quantifier has too many instances.
    """
    actions = (
        replace(a, effects=tuple(e for effect in a.effects for e in _instances(effect, problem)))
        for a in problem.domain.actions
    )
    return replace(problem, domain=replace(problem.domain, actions=tuple(actions)))


def _instances(effect: Effect, problem: Problem) -> Iterator[Effect]:
    if effect.value is None or not effect.params:
        yield effect
        return
    for binding in instances(effect.params, {}, problem):
        yield replace(renamed(effect, binding), params=())


def _binary_action(action: Action) -> Action:
    return replace(
        action,
        conditions=tuple(replace(c, formula=_binary_formula(c.formula)) for c in action.conditions),
        effects=tuple(
            replace(
                effect,
                value=None if effect.value is None else _binary(effect.value),
                condition=_binary_formula(effect.condition),
            )
            for effect in action.effects
        ),
        durations=tuple((op, _binary(expr)) for op, expr in action.durations),
    )


def _binary_formula(formula: Formula) -> Formula:
    match formula:
        case Compare(op, left, right):
            return Compare(op, _binary(left), _binary(right))
        case _:
            return with_parts(formula, _binary_formula)


def _binary(expression: Expr) -> Expr:
    if not isinstance(expression, Arithmetic):
        return expression
    op = expression.op
    parts = [_binary(part) for part in expression.parts]
    if len(parts) == 1:
        return Arithmetic("-", (Constant(0), parts[0])) if op == "-" else parts[0]
    return reduce(lambda left, right: Arithmetic(op, (left, right)), parts)
