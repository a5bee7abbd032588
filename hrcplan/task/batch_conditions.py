"""Conditions looked at in many states at once, fact by fact.

A *fact row* says of all states, one bit each, whether a fact holds in them; a condition is then
the conjunction of a few rows.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.core.arrays import Ids, Words
from hrcplan.core.bit_rows import RowSets, SparseRows
from hrcplan.task.actions import GroundAction
from hrcplan.task.conditions import Tests


class LiteralSets:
    """The literals that sets of conditions or effects name, as rows after those of the facts."""

    def __init__(self, true: Sequence[int], false: Sequence[int], n_facts: int) -> None:
        owners, facts = SparseRows.of(true, n_facts).positions()
        other_owners, other_facts = SparseRows.of(false, n_facts).positions()
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
        index = {test: i for i, test in enumerate(dict.fromkeys(t for c in conditions for t in c))}
        values = [value for _, value in index]
        self._literals = LiteralSets(values, [mask & ~value for mask, value in index], n_facts)
        owners = [i for i, tests in enumerate(conditions) for _ in tests]
        members = [index[test] for tests in conditions for test in tests]
        self._alternatives = RowSets(_ids(owners), _ids(members), len(conditions))

    def enabled(self, facts: Words) -> Words:
        """Return for each condition in which states it holds."""
        rows = self._literals.rows(facts)
        return self._alternatives.combine(self._literals.sets.combine(rows, "all"), "any")


class ActionConditions:
    """When actions can run and change something; conditional effects are left to the caller.

    Args:
        actions: The ground actions.
        n_facts: Bits of a state.
    """

    def __init__(self, actions: Sequence[GroundAction], n_facts: int) -> None:
        keys = [(a.tests, None if _is_change(a) else (a.adds, a.deletes)) for a in actions]
        index = {key: i for i, key in enumerate(dict.fromkeys(keys))}
        self._groups = _ids([index[key] for key in keys])
        self._tests = BatchConditions([tests for tests, _ in index], n_facts)
        writes = {i: write for (_, write), i in index.items() if write is not None}
        self._doubtful = _ids(list(writes))
        deletes, adds = [d for _, d in writes.values()], [a for a, _ in writes.values()]
        self._changes = LiteralSets(deletes, adds, n_facts)

    def applicable(self, facts: Words) -> Words:
        """Return for each action in which states it can run and changes something."""
        rows = self._tests.enabled(facts)
        if self._doubtful.size:
            changes = self._changes.sets.combine(self._changes.rows(facts), "any")
            rows[self._doubtful] &= changes
        return rows[self._groups]


def _is_change(action: GroundAction) -> bool:
    """Return whether the condition alone says that something changes, or that is not known."""
    adds, deletes = action.adds, action.deletes
    return action.conditional or all(
        mask & ~value & adds or value & deletes for mask, value in action.tests
    )


def _ids(numbers: Sequence[int]) -> Ids:
    return np.array(numbers, dtype=np.int64)
