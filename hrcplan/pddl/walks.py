"""Walks over formulas and expressions: what they name, their parts, and copies with other parts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from hrcplan.pddl.model import (
    And,
    Arithmetic,
    Atom,
    Compare,
    Expr,
    Formula,
    Function,
    Not,
    Or,
    Quantified,
)


def functions_in(expression: Expr | None) -> Iterator[Function]:
    """Yield every function of an expression, from left to right."""
    if isinstance(expression, Function):
        yield expression
    elif isinstance(expression, Arithmetic):
        for part in expression.parts:
            yield from functions_in(part)


def parts_of(formula: Formula) -> tuple[Formula, ...]:
    """Return the formulas directly inside a formula."""
    match formula:
        case Not(body) | Quantified(_, _, body):
            return (body,)
        case And(parts) | Or(parts):
            return parts
        case _:
            return ()


def formula_functions(formula: Formula) -> Iterator[Function]:
    """Yield every function that a condition compares."""
    if isinstance(formula, Compare):
        yield from functions_in(formula.left)
        yield from functions_in(formula.right)
    for part in parts_of(formula):
        yield from formula_functions(part)


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of nested conjunctions."""
    if isinstance(formula, And):
        for part in formula.parts:
            yield from conjuncts(part)
    else:
        yield formula


def lifted_names(formula: Formula) -> Iterator[str]:
    """Yield the names of the predicates and functions that a formula looks at."""
    if isinstance(formula, Atom):
        yield formula.name
    elif isinstance(formula, Compare):
        yield from (function.name for function in formula_functions(formula))
    for part in parts_of(formula):
        yield from lifted_names(part)


def compares(formula: Formula) -> bool:
    """Return whether a condition compares numbers anywhere; quantifiers are not expanded."""
    return isinstance(formula, Compare) or any(map(compares, parts_of(formula)))


def with_parts(formula: Formula, change: Callable[[Formula], Formula]) -> Formula:
    """Return a formula whose direct parts are changed; one without parts stays as it is.

    >>> p, q = Atom("p", ()), Atom("q", ())
    >>> print(with_parts(And((p, Not(p))), lambda part: q if part == p else part))
    (and (q) (not (p)))
    """
    match formula:
        case Not(body):
            return Not(change(body))
        case And(parts):
            return And(tuple(map(change, parts)))
        case Or(parts):
            return Or(tuple(map(change, parts)))
        case Quantified(universal, params, body):
            return Quantified(universal, params, change(body))
        case _:
            return formula
