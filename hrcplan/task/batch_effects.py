"""What ground actions do to many states at once: bits of rows of words, cleared and set."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.core.arrays import Bools, Ids, Words
from hrcplan.core.bit_rows import Ragged, SparseRows
from hrcplan.task.conditions import ALWAYS
from hrcplan.task.transitions import Effects


class BatchEffects:
    """Effects of one instant, for every action; they all look at the states before it.

    An effect with alternative conditions becomes one row for each of them, since two rows that
    write the same do what one does.

    Args:
        effects: The effects of each action.
    """

    def __init__(self, effects: Sequence[Effects]) -> None:
        rows = [[(test, e) for e in part for test in e.tests] for part in effects]
        flat = [row for part in rows for row in part]
        sizes = [*map(len, rows), 0]  # the last list is that of no action, -1
        self._rows = Ragged.of_sizes(np.array(sizes, dtype=np.int64))
        self._is_certain = all(test in ALWAYS for test, _ in flat)
        tests = [test for test, _ in flat] if not self._is_certain else []
        self._needs = SparseRows.of([value for _, value in tests])
        self._forbids = SparseRows.of([mask & ~value for mask, value in tests])
        self._deletes = SparseRows.of([effect.deletes for _, effect in flat])
        self._adds = SparseRows.of([effect.adds for _, effect in flat])

    def apply(self, states: Words, actions: Ids) -> None:
        """Change states in place, each by one action; -1 changes nothing.

        Args:
            states: Rows of words, contiguous.
            actions: One action for each state.
        """
        owners, rows = self._rows.expand(actions)
        if not self._is_certain:
            holds = self._holds(states, owners, rows)
            owners, rows = owners[holds], rows[holds]
        flat, width = states.reshape(-1), states.shape[1]
        for writes, is_add in ((self._deletes, False), (self._adds, True)):  # an add wins
            which, entries = writes.lists.expand(rows)
            places = owners[which] * width + writes.places[entries]
            if is_add:
                np.bitwise_or.at(flat, places, writes.words[entries])
            else:
                np.bitwise_and.at(flat, places, ~writes.words[entries])

    def _holds(self, states: Words, owners: Ids, rows: Ids) -> Bools:
        """Return for pairs of a state and a row whether the row's condition holds."""
        holds = np.ones(len(rows), dtype=np.bool_)
        for facts, truth in ((self._needs, True), (self._forbids, False)):
            which, entries = facts.lists.expand(rows)
            words = facts.words[entries]
            present = states[owners[which], facts.places[entries]] & words
            holds[which[present != (words if truth else 0)]] = False
        return holds
