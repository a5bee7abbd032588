"""What the numbers of a task allow to be believed: of planners that count in floating point."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce
from math import lcm
from types import MappingProxyType

from hrcplan.core.numbers import Number
from hrcplan.pddl.model import (
    TOTAL_COST,
    Arithmetic,
    Compare,
    Constant,
    Expr,
    Formula,
    Function,
    Problem,
)
from hrcplan.pddl.walks import parts_of
from hrcplan.task.changing import ValueSets

_MARGIN = 8
"""Bits that are left for sums and products of the numbers in the files."""


def decides_exactly(problem: Problem, bits: int) -> bool:
    """Return whether floats with ``bits`` binary digits decide right which actions can run.

    They do if all numbers that conditions, durations and effects look at are whole and small, and
    nothing is divided: then nothing is rounded.
    """
    expressions = list(_deciding(problem))
    parts = (part for expression in expressions for part in _parts(expression))
    if any(isinstance(part, Arithmetic) and part.op == "/" for part in parts):
        return False
    effects = (effect for action in problem.domain.actions for effect in action.effects)
    if any(effect.kind in ("scale-up", "scale-down") for effect in effects):
        return False
    most = 1 << bits - _MARGIN
    return all(
        n.denominator == 1 and abs(Fraction(n)) < most for n in _numbers(problem, expressions)
    )


def prices_exactly(problem: Problem, bits: int, metric: Number) -> bool:
    """Return whether floats with ``bits`` binary digits tell costs apart, up to that of a plan.

    They do if all costs are multiples of one number, and the largest is a small multiple: then
    rounding is less than what two costs can differ by.
    """
    numbers = [metric, *_numbers(problem, list(_pricing(problem)))]
    scale = lcm(*(number.denominator for number in numbers))
    return all(abs(Fraction(number)) * scale < 1 << bits - _MARGIN for number in numbers)


def _numbers(problem: Problem, expressions: Sequence[Expr]) -> Iterator[Number]:
    """Yield the constants of expressions, and the values of the functions that they name."""
    parts = [part for expression in expressions for part in _parts(expression)]
    names = {part.name for part in parts if isinstance(part, Function)}
    yield from (part.value for part in parts if isinstance(part, Constant))
    yield from (value for key, value in problem.values.items() if key[0] in names)


def never_lowers_cost(problem: Problem) -> bool:
    """Return whether no action can lower total-cost, as far as the files show it."""
    return all(
        effect.kind == "increase" and not signs(effect.value, problem)[0]
        for action in problem.domain.actions
        for effect in action.effects
        if effect.target.name == TOTAL_COST
    )


def signs(
    expression: Expr | None, problem: Problem, value_sets: ValueSets = MappingProxyType({})
) -> tuple[bool, bool]:
    """Return whether an expression can be below zero, and whether it can be above.

    A function that actions change can be both, unless ``value_sets`` has all its values.
    """
    match expression:
        case Constant(value):
            return value < 0, value > 0
        case Function(name):
            values = [value for key, value in problem.values.items() if key[0] == name]
            if name in problem.domain.changed_functions:
                sets = [known for key, known in value_sets.items() if key[0] == name]
                values = [value for known in sets for value in known]
                if not sets:
                    return True, True
            return any(v < 0 for v in values), any(v > 0 for v in values)
        case Arithmetic("+", parts):
            return _sum([signs(part, problem, value_sets) for part in parts])
        case Arithmetic("-", parts):
            first, *rest = (signs(part, problem, value_sets) for part in parts)
            turned = [(above, below) for below, above in (rest or [first])]
            return _sum([first, *turned] if rest else turned)
        case Arithmetic(_, parts):
            return reduce(_product, (signs(part, problem, value_sets) for part in parts))
    return True, True


def _sum(parts: Sequence[tuple[bool, bool]]) -> tuple[bool, bool]:
    return any(below for below, _ in parts), any(above for _, above in parts)


def _product(one: tuple[bool, bool], other: tuple[bool, bool]) -> tuple[bool, bool]:
    (below, above), (low, high) = one, other
    return (below and high) or (above and low), (below and low) or (above and high)


def _pricing(problem: Problem) -> Iterator[Expr]:
    """Yield what the metric is made of."""
    yield from () if problem.metric is None else (problem.metric,)
    for action in problem.domain.actions:
        for effect in action.effects:
            if effect.value is not None and effect.target.name == TOTAL_COST:
                yield effect.value


def _deciding(problem: Problem) -> Iterator[Expr]:
    """Yield the expressions that decide which actions can run, and whether the goal holds."""
    yield from _comparisons(problem.goal)
    for action in problem.domain.actions:
        for condition in action.conditions:
            yield from _comparisons(condition.formula)
        yield from (duration for _, duration in action.durations)
        for effect in action.effects:
            yield from _comparisons(effect.condition)
            if effect.value is not None and effect.target.name != TOTAL_COST:
                yield effect.value


def _comparisons(formula: Formula) -> Iterator[Expr]:
    if isinstance(formula, Compare):
        yield from (formula.left, formula.right)
    for part in parts_of(formula):
        yield from _comparisons(part)


def _parts(expression: Expr) -> Iterator[Expr]:
    yield expression
    if isinstance(expression, Arithmetic):
        for part in expression.parts:
            yield from _parts(part)
