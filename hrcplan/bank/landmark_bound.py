"""What is still to be paid at least, from the landmarks that all ways to a state have met."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hrcplan.core.arrays import Ids, Words
from hrcplan.core.bit_rows import pack
from hrcplan.core.bits import positions, union
from hrcplan.search.lm_cut import Landmark
from hrcplan.search.packed_states import any_word
from hrcplan.task.conditions import ALWAYS, Tests
from hrcplan.task.steps import Operator
from hrcplan.task.transitions import net_effect


class LandmarkBound:
    """The cost of the landmarks that are not met, and of those that are due again.

    A landmark that holds all ops by which a literal of the goal becomes true is due again while
    another one is not met whose ops all make it false: what is served before the last ingredient
    is in has to be served once more.

    Args:
        ops: What can be done.
        marks: Landmarks, as indices of ``ops``; their costs share out those of the ops.
        goal: The goal's alternatives.
    """

    def __init__(self, ops: Sequence[Operator], marks: Sequence[Landmark], goal: Tests) -> None:
        self.costs = np.array([mark.cost for mark in marks], dtype=np.int64)
        self._are_equal = bool((self.costs == self.costs[:1]).all())
        marks_of = [0] * len(ops)
        for i, mark in enumerate(marks):
            for op in mark.ops:
                marks_of[op] |= 1 << i
        self.marks_of = pack(marks_of, len(marks))
        self.n_words = self.marks_of.shape[1]
        due: dict[int, int] = {}
        for i, spoilers in _due_again(ops, marks, goal):
            due[i] = due.get(i, 0) | spoilers
        self._due = pack([1 << i for i in due], len(marks))
        self._spoilers = pack(list(due.values()), len(marks))

    def of(self, landmarks: Words) -> Ids:
        """Return what is still to be paid at least, for rows of landmarks that were met."""
        if not len(self.costs):
            return np.zeros(len(landmarks), dtype=np.int64)
        met = landmarks
        for due, spoilers in zip(self._due, self._spoilers, strict=True):
            is_due = any_word(landmarks & spoilers != spoilers)
            met = met & ~(due * is_due[:, None])
        if self._are_equal:
            counts = np.bitwise_count(met)
            n_met = counts[:, 0] if self.n_words == 1 else counts.sum(axis=1)
            return np.asarray(self.costs[0] * (len(self.costs) - n_met.astype(np.int64)))
        bits = np.unpackbits(met.view(np.uint8), axis=1, bitorder="little", count=len(self.costs))
        return np.asarray(self.costs.sum() - bits.astype(np.int64) @ self.costs)


def _due_again(
    ops: Sequence[Operator], marks: Sequence[Landmark], goal: Tests
) -> Iterator[tuple[int, int]]:
    """Yield landmarks that are due again, with those that, not met, make them so (as bits)."""
    for bit, truth in _goal_literals(goal):
        makers = {i for i, op in enumerate(ops) if _makes(op, bit, truth)}
        spoilers = union(
            1 << j for j, mark in enumerate(marks)
            if all(_spoils(ops[op], bit, truth) for op in mark.ops)
        )  # fmt: skip
        for i, mark in enumerate(marks):
            if spoilers & ~(1 << i) and makers <= mark.ops:
                yield i, spoilers & ~(1 << i)


def _goal_literals(goal: Tests) -> Iterator[tuple[int, bool]]:
    """Yield the facts, as bits, that all alternatives of a goal want true, or all want false."""
    for fact in positions(union(mask for mask, _ in goal)):
        bit = 1 << fact
        for truth in (True, False):
            if all(mask & bit and bool(value & bit) == truth for mask, value in goal):
                yield bit, truth


def _makes(op: Operator, bit: int, truth: bool) -> bool:
    """Return whether an op may make a literal true."""
    return any((effect.adds if truth else effect.deletes) & bit for effect in op.effects)


def _spoils(op: Operator, bit: int, truth: bool) -> bool:
    """Return whether a literal is false after an op, whatever the state before it."""
    if any(effect.tests != ALWAYS for effect in op.effects):
        return False
    net = net_effect(op.at_start, op.at_end)
    return bool((net.deletes if truth else net.adds) & bit)
