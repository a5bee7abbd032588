"""Steps as arrays: which rows of states a step applies to, and what becomes of them, all at once.

A state is a row of 64-bit words that hold only the facts that matter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hrcplan.core.arrays import Bools, Ids, SmallIds, Words
from hrcplan.core.bits import positions
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator
from hrcplan.task.transitions import Effects

WORD = 64
PAIRS = 1 << 20  # rows times steps that are looked at together
BLOCK = 1 << 16  # of these, whose conditions are: they stay in the cache
_LOW = (1 << WORD) - 1


@dataclass(frozen=True)
class FactPacking:
    """Task facts to bits of a row of words, in order."""

    positions: tuple[int, ...]

    @classmethod
    def of_facts(cls, facts: int) -> FactPacking:
        """Return the packing that holds the given facts (bits of the task), lowest first."""
        return cls(tuple(positions(facts)))

    @cached_property
    def _index(self) -> dict[int, int]:
        return {1 << position: 1 << i for i, position in enumerate(self.positions)}

    @cached_property
    def mask(self) -> int:
        """The facts that are kept, as bits of the task."""
        return sum(self._index)

    @property
    def n_words(self) -> int:
        """Words in a row; at least one."""
        return max(1, -(-len(self.positions) // WORD))

    def small(self, state: int) -> int:
        """Return the kept facts of a state as a dense integer."""
        number, rest = 0, state & self.mask
        while rest:
            low = rest & -rest
            number |= self._index[low]
            rest ^= low
        return number

    def row(self, state: int) -> Words:
        """Return the kept facts of a state as words."""
        small = self.small(state)
        return np.array([small >> WORD * i & _LOW for i in range(self.n_words)], dtype=np.uint64)

    def rows(self, states: Sequence[int]) -> Words:
        """Return the kept facts of states, one row each."""
        if not states:
            return np.zeros((0, self.n_words), dtype=np.uint64)
        return np.stack([self.row(state) for state in states])

    def states(self, rows: Words) -> list[int]:
        """Return rows as states of the task; facts that are not kept are false."""
        bits = np.unpackbits(rows.view(np.uint8), axis=1, bitorder="little")
        n_bytes = -(-(max(self.positions, default=0) + 1) // 8)
        wide = np.zeros((len(rows), 8 * n_bytes), dtype=np.uint8)
        wide[:, list(self.positions)] = bits[:, : len(self.positions)]
        raw = np.packbits(wide, axis=1, bitorder="little").tobytes()
        return [int.from_bytes(raw[i : i + n_bytes], "little") for i in range(0, len(raw), n_bytes)]


def any_word(words: Bools) -> Bools:
    """Return for each row whether any of its words, the last axis, is true."""
    return np.asarray(words[..., 0] if words.shape[-1] == 1 else words.any(axis=-1))


class PackedRules:
    """Ops over packed states; ``expand`` applies all of them to all rows.

    Args:
        ops: What can be done; only facts of ``packing`` are looked at and changed.
        packing: Which facts of the task the rows hold.
    """

    def __init__(self, ops: Sequence[Operator], packing: FactPacking) -> None:
        self.ops = tuple(ops)
        self.packing = packing
        self._packed_tests: dict[Tests, list[tuple[Words, Words]]] = {}
        rules = {i: rule for i, op in enumerate(ops) if (rule := op.simple_rule) is not None}
        self._simple = np.array(list(rules), dtype=np.int32)
        self._complex = [i for i in range(len(ops)) if i not in rules]
        self._masks = packing.rows([rule.mask for rule in rules.values()])
        self._values = packing.rows([rule.value for rule in rules.values()])
        self._adds = packing.rows([rule.adds for rule in rules.values()])
        self._keeps = ~packing.rows([rule.writes for rule in rules.values()])
        deletes = ~self._keeps & ~self._adds
        changes = self._values & deletes | self._masks & ~self._values & self._adds
        self._doubtful = np.flatnonzero(~any_word(changes != 0))
        """Rules whose condition does not say that they change the state."""

    def expand(
        self, states: Words, admits: Callable[[Ids, SmallIds], Bools] | None = None
    ) -> Iterator[tuple[Ids, SmallIds, Words]]:
        """Yield (row, op, successor) arrays for all changes that can be made to ``states``.

        Args:
            states: The states.
            admits: Says which changes are wanted, from their rows and ops; all if not given.
        """
        chunk = max(1, PAIRS // max(1, len(self._simple)))
        for begin in range(0, len(states), chunk):
            rows, rules = self._changing(states[begin : begin + chunk])
            rows, ops = rows + begin, self._simple.take(rules)
            if admits is not None:
                wanted = np.flatnonzero(admits(rows, ops))
                rows, rules, ops = rows.take(wanted), rules.take(wanted), ops.take(wanted)
            yield rows, ops, self._after(states, rows, rules)
        for i in self._complex:
            rows, ops, after = self._expand_complex(states, i)
            if admits is not None:
                wanted = np.flatnonzero(admits(rows, ops))
                rows, ops, after = rows[wanted], ops[wanted], after[wanted]
            yield rows, ops, after

    def _changing(self, states: Words) -> tuple[Ids, Ids]:
        """Return the pairs of a row and a simple rule that can run and changes the state."""
        n_rules = len(self._simple)
        block = max(1, BLOCK // max(1, n_rules))
        parts = [
            np.flatnonzero(self._fits(states[begin : begin + block])) + begin * n_rules
            for begin in range(0, len(states), block)
        ]
        pairs = np.concatenate(parts) if len(parts) > 1 else parts[0]
        rows = pairs // max(1, n_rules)
        rules = pairs - rows * n_rules
        return rows, rules

    def _fits(self, states: Words) -> Bools:
        """Return a matrix of states by rules: whether a rule can run and changes the state."""
        columns = states.T[:, :, None]
        fits = (columns[0] & self._masks[:, 0]) == self._values[:, 0]
        for word in range(1, self.packing.n_words):
            fits &= (columns[word] & self._masks[:, word]) == self._values[:, word]
        doubtful = self._doubtful
        if doubtful.size:
            writes, adds = ~self._keeps[doubtful], self._adds[doubtful]
            fits[:, doubtful] &= any_word((states[:, None] & writes) != adds)
        return np.asarray(fits)

    def _after(self, states: Words, rows: Ids, rules: Ids) -> Words:
        after = states.take(rows, axis=0)
        after &= self._keeps.take(rules, axis=0)
        after |= self._adds.take(rules, axis=0)
        return after

    def _expand_complex(self, states: Words, index: int) -> tuple[Ids, SmallIds, Words]:
        op = self.ops[index]
        rows = np.flatnonzero(self.meets(states, op.tests))
        before = states[rows]
        after = self._apply(self._apply(before, op.at_start), op.at_end)
        is_change = any_word(after != before)
        ops = np.full(int(is_change.sum()), index, dtype=np.int32)
        return rows[is_change], ops, after[is_change]

    def meets(self, states: Words, tests: Tests) -> Bools:
        """Return for each row whether any of the tests holds."""
        if tests not in self._packed_tests:
            self._packed_tests[tests] = [
                (self.packing.row(m), self.packing.row(v)) for m, v in tests
            ]
        holds = np.zeros(len(states), dtype=np.bool_)
        for mask, value in self._packed_tests[tests]:
            holds |= ~any_word((states & mask) != value)
        return holds

    def _apply(self, states: Words, effects: Effects) -> Words:
        adds, deletes = np.zeros_like(states), np.zeros_like(states)
        for effect in effects:
            holds = self.meets(states, effect.tests)
            adds[holds] |= self.packing.row(effect.adds)
            deletes[holds] |= self.packing.row(effect.deletes)
        return states & ~deletes | adds
