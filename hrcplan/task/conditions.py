"""Ground conditions as bit tests: a formula becomes alternatives of literals over fluents."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    And,
    Atom,
    Compare,
    Equal,
    Fact,
    Formula,
    Not,
    Or,
    Problem,
    Quantified,
)
from hrcplan.pddl.semantics import Binding, State, Values, ground_key, holds, instances

MAX_ALTERNATIVES = 256

Literals = dict[Fact, bool]
Test = tuple[int, int]
"""``(mask, value)``: true in a state if ``state & mask == value``."""

NEVER: tuple[Literals, ...] = ()
ALWAYS: tuple[Literals, ...] = ({},)


@dataclass(frozen=True)
class Grounder:
    """Formulas of one problem over its fluents: the facts that can change.

    ``fixed`` says of a fact that cannot change whether it holds.
    """

    problem: Problem
    fluents: frozenset[Fact]
    fixed: Callable[[Fact], bool]

    def alternatives(
        self, formula: Formula, binding: Binding, values: Values, positive: bool = True
    ) -> tuple[Literals, ...]:
        """Return a disjunction of conjunctions of literals that means ``formula`` (or its
        negation); empty if it is never true.

        Raises:
            UnsupportedError: if there are more than ``MAX_ALTERNATIVES``.
        """
        match formula:
            case Atom():
                return self._atom(ground_key(formula, binding), positive)
            case Not(body):
                return self.alternatives(body, binding, values, not positive)
            case Equal() | Compare():
                state = State(frozenset(), values)
                return _constant(holds(formula, state, binding, self.problem) == positive)
            case And(parts) | Or(parts):
                inner = (self.alternatives(part, binding, values, positive) for part in parts)
                return _all(inner) if isinstance(formula, And) == positive else _any(inner)
            case Quantified(universal, params, body):
                inner = (
                    self.alternatives(body, bound, values, positive)
                    for bound in instances(params, binding, self.problem)
                )
                return _all(inner) if universal == positive else _any(inner)

    def _atom(self, fact: Fact, positive: bool) -> tuple[Literals, ...]:
        if fact in self.fluents:
            return ({fact: positive},)
        return _constant(self.fixed(fact) == positive)


def _constant(value: bool) -> tuple[Literals, ...]:
    return ALWAYS if value else NEVER


def _any(parts: Iterable[tuple[Literals, ...]]) -> tuple[Literals, ...]:
    found: list[Literals] = []
    for part in parts:
        found += [literals for literals in part if literals not in found]
        if {} in found:
            return ALWAYS
    return _bounded(found)


def _all(parts: Iterable[tuple[Literals, ...]]) -> tuple[Literals, ...]:
    found: list[Literals] = [{}]
    for part in parts:
        merged = [merge(one, other) for one in found for other in part]
        found = [literals for literals in merged if literals is not None]
        _bounded(found)
    return tuple(found)


def merge(one: Literals, other: Literals) -> Literals | None:
    """Return both conjunctions in one, or None if they contradict each other."""
    if any(one.get(fact, value) != value for fact, value in other.items()):
        return None
    return {**one, **other}


def _bounded(found: list[Literals]) -> tuple[Literals, ...]:
    if len(found) > MAX_ALTERNATIVES:
        raise UnsupportedError(f"a condition has more than {MAX_ALTERNATIVES} alternatives")
    return tuple(found)
