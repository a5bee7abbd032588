"""Conditions looked at in many states at once, fact by fact.

A *fact row* says of all states, one bit each, whether a fact holds in them; a condition is then
the conjunction of a few rows.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.core.arrays import Words
from hrcplan.core.bit_rows import RowSets, bit_positions
from hrcplan.task.actions import GroundAction
from hrcplan.task.conditions import Tests


class LiteralSets:
    """The literals that sets of conditions or effects name, as rows after those of the facts."""

    def __init__(self, true: Sequence[int], false: Sequence[int], n_facts: int) -> None:
        owners, facts = bit_positions(true)
        other_owners, other_facts = bit_positions(false)
        self._negated, rows = np.unique(other_facts, return_inverse=True)
        self._n_rows = n_facts
        members = np.concatenate([facts, rows + n_facts])
        self.sets = RowSets(np.concatenate([owners, other_owners]), members, len(true))

    def rows(self, facts: Words) -> Words:
        """Return the rows of facts, then those of the facts that must not hold."""
        facts = facts[: self._n_rows]
        return np.concatenate([facts, ~facts[self._negated]]) if self._negated.size else facts


class BatchConditions:
    """Conditions, each of them alternatives of literals.

    Args:
        conditions: The conditions.
        n_facts: Bits of a state.
    """

    def __init__(self, conditions: Sequence[Tests], n_facts: int) -> None:
        alternatives = [test for tests in conditions for test in tests]
        values = [value for _, value in alternatives]
        forbids = [mask & ~value for mask, value in alternatives]
        self._literals = LiteralSets(values, forbids, n_facts)
        owners = np.repeat(np.arange(len(conditions)), [len(tests) for tests in conditions])
        self._alternatives = RowSets(owners, np.arange(len(alternatives)), len(conditions))

    def enabled(self, facts: Words) -> Words:
        """Return for each condition in which states it holds."""
        rows = self._literals.rows(facts)
        return self._alternatives.combine(self._literals.sets.combine(rows, "all"), "any")


_Key = tuple[Tests, tuple[int, int] | None]
"""What an action needs, and what it adds and deletes; None if that depends on the state."""


class ActionConditions:
    """When actions can run and change something; conditional effects are left to the caller.

    Args:
        actions: The ground actions.
        n_facts: Bits of a state.
    """

    def __init__(self, actions: Sequence[GroundAction], n_facts: int) -> None:
        distinct: list[_Key] = []
        by_step: dict[tuple[str, ...], list[int]] = {}
        groups = [_group_of(action, distinct, by_step) for action in actions]
        self._groups = np.array(groups, dtype=np.int64)
        self._tests = BatchConditions([tests for tests, _ in distinct], n_facts)
        doubtful = {
            i: writes for i, (tests, writes) in enumerate(distinct)
            if writes is not None and not _is_change(tests, *writes)
        }  # fmt: skip
        self._doubtful = np.array(list(doubtful), dtype=np.int64)
        adds = [writes[0] for writes in doubtful.values()]
        deletes = [writes[1] for writes in doubtful.values()]
        self._changes = LiteralSets(deletes, adds, n_facts)

    def applicable(self, facts: Words) -> Words:
        """Return for each action in which states it can run and changes something."""
        rows = self._tests.enabled(facts)
        if self._doubtful.size:
            changes = self._changes.sets.combine(self._changes.rows(facts), "any")
            rows[self._doubtful] &= changes
        return rows[self._groups]


def _group_of(
    action: GroundAction, distinct: list[_Key], by_step: dict[tuple[str, ...], list[int]]
) -> int:
    """Return the index in ``distinct`` of what an action needs and does.

    Actions that need and do the same are those of one step, as a rule; to hash all that they need
    and do takes long in large tasks. Conditional effects are left out.
    """
    key = (action.tests, None if action.conditional else (action.adds, action.deletes))
    alike = by_step.setdefault(action.step, [])
    for i in alike:
        if distinct[i] == key:
            return i
    alike.append(len(distinct))
    distinct.append(key)
    return alike[-1]


def _is_change(tests: Tests, adds: int, deletes: int) -> bool:
    """Return whether a condition alone says that something changes."""
    return all(mask & ~value & adds or value & deletes for mask, value in tests)
