"""Which steps and facts matter to a goal: a fixpoint backwards from its literals.

No plan that is optimal, or of which no step can be dropped, holds an irrelevant step: without the
last one, every relevant literal that was true stays true.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_

from hrcplan.task import BitEffect
from hrcplan.task.conditions import ALWAYS, Test, Tests
from hrcplan.task.steps import Operator


@dataclass(slots=True)
class Literals:
    """Facts that are needed true, and facts that are needed false, as bits."""

    true: int = 0
    false: int = 0

    def add_tests(self, tests: Iterable[Test]) -> None:
        """Add the literals that tests look at."""
        for mask, value in tests:
            self.true |= value
            self.false |= mask & ~value

    def add_negated_tests(self, tests: Iterable[Test]) -> None:
        """Add the literals that keep tests from holding."""
        for mask, value in tests:
            self.true |= mask & ~value
            self.false |= value

    def helped_by(self, effect: BitEffect) -> bool:
        """Whether an effect makes a needed literal true."""
        return bool(effect.adds & self.true or effect.deletes & self.false)

    def hurt_by(self, effect: BitEffect) -> bool:
        """Whether an effect makes a needed literal false."""
        return bool(effect.adds & self.false or effect.deletes & self.true)

    @property
    def facts(self) -> int:
        """The facts of the literals, as bits."""
        return self.true | self.false


def relevant(ops: Sequence[Operator], goal: Tests) -> tuple[tuple[Operator, ...], Literals]:
    """Return the ops that can help to reach a goal, in order, and the literals that matter."""
    literals = Literals()
    literals.add_tests(goal)
    useful: set[int] = set()
    before = (-1, -1)
    while before != (literals.true, literals.false):
        before = (literals.true, literals.false)
        for i, op in enumerate(ops):
            if i in useful or any(literals.helped_by(effect) for effect in op.effects):
                useful.add(i)
                _add_operator(literals, op)
    return tuple(op for i, op in enumerate(ops) if i in useful), literals


def _add_operator(literals: Literals, op: Operator) -> None:
    literals.add_tests(op.tests)
    for effect in op.effects:
        if effect.tests == ALWAYS:
            continue
        if literals.helped_by(effect):
            literals.add_tests(effect.tests)
        if literals.hurt_by(effect):
            literals.add_negated_tests(effect.tests)


def read_by(ops: Iterable[Operator], goal: Tests) -> int:
    """Return the facts that conditions of ``ops`` and a goal look at, as bits."""
    literals = Literals()
    literals.add_tests(goal)
    for op in ops:
        literals.add_tests(op.tests)
        for effect in op.effects:
            literals.add_tests(effect.tests)
    return literals.facts


def overwritten_facts(ops: Sequence[Operator]) -> int:
    """Return the facts that every op sets, whatever the state, and that none looks at, as bits.

    States that differ in these alone have the same plans, unless one of them is a goal state: such
    a fact only matters to the goal, and then the last step decides.
    """
    facts = -1
    for op in ops:
        sure = (effect for effect in op.effects if effect.tests == ALWAYS)
        facts &= reduce(or_, (effect.writes for effect in sure), 0)
    return facts & ~read_by(ops, ()) if ops else 0
