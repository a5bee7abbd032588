"""Numbers of a ground task: functions that actions change, and costs as sums of function values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.conventions import agent_state_functions
from hrcplan.pddl.model import (
    TOTAL_COST,
    TRUE,
    Action,
    Arithmetic,
    Constant,
    Domain,
    Effect,
    Expr,
    FluentKey,
    Formula,
    Function,
)
from hrcplan.pddl.semantics import Binding, ground_key
from hrcplan.pddl.walks import formula_functions, functions_in

Linear = Mapping[FluentKey, Number]
"""Coefficients by function; the constant stands under the empty key."""


def check_supported(domain: Domain) -> None:
    """Raise unless bits can hold the task.

    Raises:
        UnsupportedError: naming the first function that an action changes and that is neither
            total-cost nor agent state, or a use of total-cost other than increasing it.
    """
    state = agent_state_functions(domain)
    for action in domain.actions:
        for effect in numeric_effects(action):
            name = effect.target.name
            if name not in state:
                message = f"'{action.name}' changes ({name} …), which is not agent state"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
        for effect in action.effects:
            if effect.target.name == TOTAL_COST and not _is_cost(effect, domain):
                message = f"'{action.name}' does more with total-cost than increase it"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such costs")
        amounts = (f for effect in action.effects for f in functions_in(effect.value))
        if any(function.name == TOTAL_COST for function in (*functions_read(action), *amounts)):
            message = f"'{action.name}' looks at total-cost"
            raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")


def _is_cost(effect: Effect, domain: Domain) -> bool:
    """Return whether an effect on total-cost only adds to it, in a way that bits can hold.

    Where actions change agent state, whether it adds may depend on nothing.
    """
    if effect.kind != "increase" or (effect.condition == TRUE and not effect.params):
        return effect.kind == "increase"
    names = {function.name for function in functions_in(effect.value)}
    changes = any(True for action in domain.actions for _ in numeric_effects(action))
    return not changes and names.isdisjoint(agent_state_functions(domain))


def numeric_effects(action: Action, when: str | None = None) -> Iterator[Effect]:
    """Yield the effects that change a function other than total-cost (at a given time)."""
    for effect in action.effects:
        is_number = effect.value is not None and effect.target.name != TOTAL_COST
        if is_number and when in (None, effect.when):
            yield effect


def functions_read(action: Action) -> Iterator[Function]:
    """Yield the functions that an action looks at, costs apart: they shape what it does."""
    formulas: list[Formula] = [c.formula for c in action.conditions]
    formulas += [effect.condition for effect in action.effects]
    for formula in formulas:
        yield from formula_functions(formula)
    for _, duration in action.durations:
        yield from functions_in(duration)
    for effect in numeric_effects(action):
        yield from functions_in(effect.value)


def ground_expression(
    expression: Expr, binding: Binding, constants: Mapping[FluentKey, Expr]
) -> Expr:
    """Return an expression over ground functions, with those in ``constants`` replaced."""
    match expression:
        case Function(name):
            key = ground_key(expression, binding)
            return constants.get(key, Function(name, key[1:]))
        case Arithmetic(op, parts):
            return Arithmetic(
                op, tuple(ground_expression(part, binding, constants) for part in parts)
            )
        case _:
            return expression


def divisors(expression: Expr | None) -> Iterator[Function]:
    """Yield the functions that something is divided by."""
    if isinstance(expression, Arithmetic):
        for position, part in enumerate(expression.parts):
            inner = functions_in if expression.op == "/" and position else divisors
            yield from inner(part)


def linear(expression: Expr, binding: Binding) -> Linear | None:
    """Return an expression as a weighted sum of functions, or None if it is not linear.

    >>> f, g = Function("f"), Function("g")
    >>> linear(Arithmetic("+", (f, Arithmetic("*", (Constant(2), g)), Constant(1))), {})
    {('f',): 1, ('g',): 2, (): 1}
    """
    match expression:
        case Constant(value):
            return {(): value}
        case Function():
            return {ground_key(expression, binding): 1}
        case Arithmetic(op, parts):
            sums = [linear(part, binding) for part in parts]
            terms = [part for part in sums if part is not None]
            return _combine(op, terms) if len(terms) == len(sums) else None


def _combine(op: str, parts: list[Linear]) -> Linear | None:
    if op == "-" and len(parts) == 1:
        return _scale(parts[0], -1)
    total = parts[0]
    for part in parts[1:]:
        if op in "+-":
            total = _sum(total, _scale(part, 1 if op == "+" else -1))
            continue
        factor, rest = (part, total) if _is_constant(part) else (total, part)
        if not _is_constant(factor) or (op == "/" and (rest is part or not factor.get((), 0))):
            return None
        number = factor.get((), 0)
        total = _scale(rest, number if op == "*" else 1 / Fraction(number))
    return total


def _is_constant(part: Linear) -> bool:
    return all(key == () for key in part)


def _scale(part: Linear, factor: Number) -> Linear:
    return {key: coefficient * factor for key, coefficient in part.items()}


def _sum(one: Linear, other: Linear) -> Linear:
    total = dict(one)
    for key, coefficient in other.items():
        total[key] = total.get(key, 0) + coefficient
    return total
