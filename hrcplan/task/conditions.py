"""Ground conditions as bit tests: a formula becomes alternatives of literals over fluents."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from functools import cached_property

from hrcplan.core.bits import single_bits
from hrcplan.core.records import record
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    Action,
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
from hrcplan.pddl.semantics import (
    Binding,
    LiftedState,
    Values,
    holds,
    instances,
)

MAX_ALTERNATIVES = 256

Test = tuple[int, int]
"""``(mask, value)``: true in a state if ``state & mask == value``."""
Tests = tuple[Test, ...]
"""Alternatives: true in a state if any of them is."""

NEVER: Tests = ()
ALWAYS: Tests = ((0, 0),)


@record
class Grounder:
    """Formulas of one problem over the bits of its fluents.

    ``fixed`` are the facts that hold and never change; any other fact without a bit never holds.
    """

    problem: Problem
    bits: Mapping[Fact, int]
    fixed: Set[Fact]

    def bit(self, fact: Fact) -> int:
        """Return a state in which only this fact holds; 0 if it never changes."""
        return self.powers.get(fact, 0)

    @cached_property
    def powers(self) -> Mapping[Fact, int]:
        """The state in which only a fact holds, for each fluent; in large tasks they are large."""
        return {fact: 1 << position for fact, position in self.bits.items()}

    def conditions(self, action: Action, when: str, binding: Binding, values: Values) -> Tests:
        """Return the alternatives that mean an action's conditions of one phase."""
        parts = (c.formula for c in action.conditions if c.when == when)
        return all_of(self.tests(part, binding, values) for part in parts)

    def tests(
        self, formula: Formula, binding: Binding, values: Values, positive: bool = True
    ) -> Tests:
        """Return the alternatives that mean ``formula`` (or its negation) under a binding.

        A comparison of a function without a value holds in neither sense.

        Raises:
            UnsupportedError: if there are more than ``MAX_ALTERNATIVES``.
        """
        if isinstance(formula, Atom):  # most formulas; a match takes longer
            fact = (formula.name, *[binding.get(arg, arg) for arg in formula.args])
            bit = self.powers.get(fact)
            if bit is not None:
                return ((bit, bit if positive else 0),)
            return ALWAYS if (fact in self.fixed) == positive else NEVER
        match formula:
            case And(parts) | Or(parts):
                inner = (self.tests(part, binding, values, positive) for part in parts)
                return all_of(inner) if isinstance(formula, And) == positive else any_of(inner)
            case Not(body):
                return self.tests(body, binding, values, not positive)
            case Equal() | Compare():
                state = LiftedState(frozenset(), values)
                return _constant_tests(holds(formula, state, binding, self.problem, positive))
            case Quantified(universal, params, body):
                inner = (
                    self.tests(body, bound, values, positive)
                    for bound in instances(params, binding, self.problem)
                )
                return all_of(inner) if universal == positive else any_of(inner)


def _constant_tests(truth: bool) -> Tests:
    return ALWAYS if truth else NEVER


def meets(state: int, tests: Tests) -> bool:
    """Return whether any of the alternatives holds in a state."""
    for mask, value in tests:  # noqa: SIM110  (any() takes three times as long)
        if state & mask == value:
            return True
    return False


def any_of(parts: Iterable[Tests]) -> Tests:
    """Return alternatives of which one holds where any part holds."""
    alternatives: list[Test] = []
    for part in parts:
        if (0, 0) in part:
            return ALWAYS
        alternatives += part
    return _distinct(alternatives)


def all_of(parts: Iterable[Tests]) -> Tests:
    """Return alternatives of which one holds where all parts hold."""
    tests = ALWAYS
    for part in parts:
        if len(tests) == len(part) == 1:
            pair = conjunction(tests[0], part[0])
            tests = NEVER if pair is None else (pair,)
        elif tests == ALWAYS or part == NEVER:
            tests = part
        elif part != ALWAYS:
            pairs = [conjunction(one, other) for one in tests for other in part]
            tests = _distinct([pair for pair in pairs if pair is not None])
        if tests == NEVER:
            return NEVER
    return tests


def conjunction(one: Test, other: Test) -> Test | None:
    """Return the test that holds where both do, or None if they contradict each other."""
    mask, value = one
    other_mask, other_value = other
    if (value ^ other_value) & mask & other_mask:
        return None
    both, both_values = mask | other_mask, value | other_value
    # One object for mask and value saves half the memory where they are equal.
    return both, both if both_values == both else both_values


def negation(tests: Tests) -> Tests:
    """Return alternatives of which one holds where none of ``tests`` does."""
    return all_of(tuple((bit, ~value & bit) for bit in single_bits(mask)) for mask, value in tests)


def _distinct(tests: Sequence[Test]) -> Tests:
    """Return each alternative once."""
    if len(tests) < 2:
        return tuple(tests)
    distinct = tuple(dict.fromkeys(tests))
    if len(distinct) > MAX_ALTERNATIVES:
        raise UnsupportedError(f"a condition has more than {MAX_ALTERNATIVES} alternatives")
    return distinct
