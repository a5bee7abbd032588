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

    def take(self, tests: Iterable[Test]) -> None:
        """Take in what tests look at."""
        for mask, value in tests:
            self.true |= value
            self.false |= mask & ~value

    def take_negated(self, tests: Iterable[Test]) -> None:
        """Take in what keeps tests from holding."""
        for mask, value in tests:
            self.true |= mask & ~value
            self.false |= value

    def wants(self, change: BitEffect) -> bool:
        """Whether a change makes a needed literal true."""
        return bool(change.adds & self.true or change.deletes & self.false)

    def fears(self, change: BitEffect) -> bool:
        """Whether a change makes a needed literal false."""
        return bool(change.adds & self.false or change.deletes & self.true)

    @property
    def facts(self) -> int:
        """The facts of the literals, as bits."""
        return self.true | self.false


def relevant(ops: Sequence[Operator], goal: Tests) -> tuple[tuple[Operator, ...], Literals]:
    """Return the ops that can help to reach a goal, in order, and the literals that matter."""
    needed = Literals()
    needed.take(goal)
    useful: set[int] = set()
    before = (-1, -1)
    while before != (needed.true, needed.false):
        before = (needed.true, needed.false)
        for i, op in enumerate(ops):
            if i in useful or any(needed.wants(change) for change in op.effects):
                useful.add(i)
                _take_op(needed, op)
    return tuple(op for i, op in enumerate(ops) if i in useful), needed


def _take_op(needed: Literals, op: Operator) -> None:
    needed.take(op.tests)
    for change in op.effects:
        if change.tests == ALWAYS:
            continue
        if needed.wants(change):
            needed.take(change.tests)
        if needed.fears(change):
            needed.take_negated(change.tests)


def read_by(ops: Iterable[Operator], goal: Tests) -> int:
    """Return the facts that conditions of ``ops`` and a goal look at, as bits."""
    found = Literals()
    found.take(goal)
    for op in ops:
        found.take(op.tests)
        for change in op.effects:
            found.take(change.tests)
    return found.facts


def fleeting(ops: Sequence[Operator]) -> int:
    """Return the facts that every op sets, whatever the state, and that none looks at, as bits.

    States that differ in these alone have the same plans, unless one of them is a goal state: such
    a fact only matters to the goal, and then the last step decides.
    """
    found = -1
    for op in ops:
        sure = (change for change in op.effects if change.tests == ALWAYS)
        found &= reduce(or_, (change.touched for change in sure), 0)
    return found & ~read_by(ops, ()) if ops else 0
