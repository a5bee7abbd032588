"""What the numbers of a task allow to be believed: of planners that count in floating point."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import lcm

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
        effect.kind == "increase" and _never_negative(effect.value, problem)
        for action in problem.domain.actions
        for effect in action.effects
        if effect.target.name == TOTAL_COST
    )


def _never_negative(expression: Expr | None, problem: Problem) -> bool:
    match expression:
        case Constant(value):
            return value >= 0
        case Function(name):
            values = (v for key, v in problem.values.items() if key[0] == name)
            return name not in problem.domain.changed_functions and all(v >= 0 for v in values)
        case Arithmetic(op, parts) if op != "-":
            return all(_never_negative(part, problem) for part in parts)
    return False


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
