"""Tables of states: which were met, and equal rows brought together."""

from __future__ import annotations

import numpy as np

from hrcplan.core.arrays import Bools, Ids, Words
from hrcplan.search.packed_states import any_word

SALT = np.uint64(0x9E3779B97F4A7C15)


class SeenStates:
    """States met so far, as few tables of distinct sizes, each sorted by a hash."""

    def __init__(self) -> None:
        self._tables: list[tuple[Words, Words]] = []

    def add(self, states: Words) -> None:
        """Take in states, all of them new."""
        hashes = _hash(states)
        while self._tables and len(self._tables[-1][0]) <= 2 * len(hashes):
            more, rows = self._tables.pop()
            hashes, states = np.concatenate([more, hashes]), np.concatenate([rows, states])
        if (hashes[1:] < hashes[:-1]).any():
            order = np.argsort(hashes)
            hashes, states = hashes.take(order), states.take(order, axis=0)
        self._tables.append((hashes, states))

    def contains(self, states: Words) -> Bools:
        """Return for each row whether it was taken in."""
        hashes = _hash(states)
        is_member = np.zeros(len(states), dtype=np.bool_)
        for table, rows in self._tables:
            place = np.searchsorted(table, hashes)
            open_ = np.flatnonzero(place < len(table))
            while len(open_):  # goes on only where different states share a hash
                open_ = open_[table[place[open_]] == hashes[open_]]
                same = ~any_word(rows[place[open_]] != states[open_])
                is_member[open_[same]] = True
                open_ = open_[~same]
                place[open_] += 1
                open_ = open_[place[open_] < len(table)]
        return is_member


def _hash(rows: Words) -> Words:
    hashes = rows[:, 0].copy()
    for word in range(1, rows.shape[1]):
        hashes = (hashes ^ (hashes >> np.uint64(29))) * SALT + rows[:, word]
    return hashes


def group_rows(rows: Words) -> tuple[Words, Ids, Ids, Ids]:
    """Return the distinct rows, sorted, and how to get from all rows to them.

    That is: for each row the index of its equal; the order that brings equal rows together; and
    where each group begins in that order.
    """
    single = rows.shape[1] == 1
    order = np.argsort(rows[:, 0]) if single else np.lexsort(rows.T[::-1])
    in_order = rows.take(order, axis=0)
    first = np.ones(len(rows), dtype=np.bool_)
    first[1:] = any_word(in_order[1:] != in_order[:-1])
    which = np.empty(len(rows), dtype=np.int64)
    which[order] = np.cumsum(first) - 1
    return in_order[first], which, order, np.flatnonzero(first)
