"""Operators without what they make false: what each makes true, and what that needs.

A *literal* is a number: ``2 i`` says that fact ``i`` is true, ``2 i + 1`` that it is false.
Negative conditions are so relaxed like positive ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrcplan.core.bits import positions
from hrcplan.core.records import record
from hrcplan.task.conditions import Test, conjunction
from hrcplan.task.steps import Operator
from hrcplan.task.transitions import BitEffect


@record
class RelaxedRule:
    """One effect of an operator: the operator's index, literals before, and literals after."""

    op: int
    needs: tuple[int, ...]
    gives: tuple[int, ...]


def relaxed_rules(ops: Sequence[Operator], *, admissible: bool) -> Iterator[RelaxedRule]:
    """Yield what operators can make true, in order.

    Args:
        ops: The operators.
        admissible: Leave out the conditions of effects at the end, which the start may have made
            true. Without them no cost is ever overestimated.
    """
    for index, op in enumerate(ops):
        for test in op.tests:
            for effect in op.at_start:
                for condition in effect.tests:
                    both = conjunction(test, condition)
                    if both is not None:
                        yield RelaxedRule(index, literals(both), _gives(effect))
            for effect in op.at_end:
                for mask, value in ((0, 0),) if admissible else effect.tests:
                    needs = literals((test[0] | mask, test[1] | value))
                    yield RelaxedRule(index, needs, _gives(effect))


def literals(test: Test) -> tuple[int, ...]:
    """Return the literals of a test, in order of their facts.

    >>> literals((0b101, 0b001))
    (0, 5)
    """
    mask, value = test
    return tuple(2 * i + (not value >> i & 1) for i in positions(mask))


def _gives(effect: BitEffect) -> tuple[int, ...]:
    true = (2 * i for i in positions(effect.adds))
    return (*true, *(2 * i + 1 for i in positions(effect.deletes)))
