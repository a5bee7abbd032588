"""The grounded task for many states at once: applicable, step, goal, over arrays of states.

A state is a row of 64-bit words with one bit per fact. Conditions are looked at fact by fact: the
states are transposed, so that one word says of 64 states whether a fact holds in them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from hrcplan.core import bit_rows
from hrcplan.core.arrays import Bools, Ids, Words
from hrcplan.errors import UsageError
from hrcplan.task.batch_conditions import ActionConditions, BatchConditions
from hrcplan.task.batch_effects import BatchEffects
from hrcplan.task.task import Task

BITS = 1 << 20  # states times facts and actions that are looked at together


class BatchSimulator:
    """A task over arrays of states; it says of every row what the task says of one state.

    States are rows of words (``uint64``, one bit per fact, in the order of ``task.facts``), which
    are indexed, copied and compared like any array. Actions are indices into ``task.actions``.
    As in `Task`, an action with a duration is done at once: its start, then its end.

    Args:
        task: The grounded task. What `hrcplan.ground` refuses, such as fuel that is counted,
            cannot be simulated either; derived predicates are compiled away.

    >>> import numpy as np
    >>> from hrcplan import BatchSimulator, ground
    >>> simulator = BatchSimulator(ground("kitchen", "stew-lentil"))
    >>> states = simulator.initial(1000)
    >>> simulator.applicable(states).shape
    (1000, 340)
    >>> actions = simulator.draw(states, np.random.default_rng(0))
    >>> after = simulator.step(states, actions)
    >>> simulator.is_goal(after).any()
    np.False_
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self.n_facts = len(task.facts)
        self.n_actions = len(task.actions)
        self.n_words = bit_rows.n_words(self.n_facts)
        effects = [action.sequential for action in task.actions]
        self._at_start = BatchEffects([start for start, _ in effects])
        self._at_end = (
            BatchEffects([end for _, end in effects]) if any(end for _, end in effects) else None
        )
        self._conditions = ActionConditions(task.actions, self.n_facts)
        self._conditional = np.flatnonzero([action.conditional for action in task.actions])
        self._goal = BatchConditions([task.goal], self.n_facts)
        per_state = self.n_actions + self.n_facts
        self._chunk = bit_rows.WORD * bit_rows.n_words(BITS // max(1, per_state))

    def __repr__(self) -> str:
        return f"<BatchSimulator of {self.task!r}>"

    def initial(self, n_states: int) -> Words:
        """Return the initial state as often as asked for."""
        return np.repeat(self.pack([self.task.initial]), n_states, axis=0)

    def pack(self, states: Sequence[int]) -> Words:
        """Return states of the task, integers, as rows."""
        return bit_rows.pack(states, self.n_facts)

    def unpack(self, states: Words) -> list[int]:
        """Return rows as states of the task."""
        return bit_rows.unpack(self._checked(states))

    def facts(self, states: Words) -> Bools:
        """Return which facts hold: a matrix of states by facts, in the order of ``task.facts``."""
        return bit_rows.bools(self._checked(states), self.n_facts)

    def applicable(self, states: Words) -> Bools:
        """Return which actions can run and change something: a matrix of states by actions."""
        return bit_rows.bools(self._applicable(self._checked(states)), self.n_actions)

    def step(self, states: Words, actions: ArrayLike) -> Words:
        """Return the states after one action each; -1 leaves a state as it is.

        As in `Task.successor`, whether the action can run is not asked.

        Raises:
            UsageError: if there is not one action for each state, or no such action.
        """
        states = self._checked(states)
        return self._after(states, self._checked_actions(actions, len(states)))

    def is_goal(self, states: Words) -> Bools:
        """Return for each state whether the goal holds."""
        states = self._checked(states)
        holds = self._goal.enabled(bit_rows.transpose(states))
        return bit_rows.bools(holds, len(states)).reshape(len(states))

    def draw(self, states: Words, rng: np.random.Generator, among: Bools | None = None) -> Ids:
        """Return for each state an applicable action, each as probable; -1 where there is none.

        Args:
            states: The states.
            rng: Where chance comes from.
            among: Which actions to draw from; all if not given.
        """
        applicable = self._applicable(self._checked(states))
        if among is not None:
            applicable &= bit_rows.of_bools(np.atleast_2d(among))
        return bit_rows.draw_bits(applicable, rng)

    def walk(self, states: Words, n_steps: int, rng: np.random.Generator) -> tuple[Ids, Words]:
        """Return random walks: the actions, one row per step, and the last states.

        A walk that has come to an end stays there, with -1 for an action.
        """
        states = self._checked(states)
        actions = np.empty((n_steps, len(states)), dtype=np.int64)
        for t in range(n_steps):
            actions[t] = self.draw(states, rng)
            states = self._after(states, actions[t])
        return actions, states

    def _after(self, states: Words, actions: Ids) -> Words:
        after = states.copy()
        self._at_start.apply(after, actions)
        if self._at_end is not None:
            self._at_end.apply(after, actions)
        return after

    def _applicable(self, states: Words) -> Words:
        """Return the applicable actions of each state as bits."""
        parts = [self._applicable_part(part) for part in self._parts(states)]
        return np.concatenate(parts) if len(parts) > 1 else parts[0]

    def _applicable_part(self, states: Words) -> Words:
        rows = self._conditions.applicable(bit_rows.transpose(states))
        if self._conditional.size:
            rows[self._conditional] = self._changing(states, rows[self._conditional])
        return bit_rows.transpose(rows)[: len(states), : bit_rows.n_words(self.n_actions)]

    def _changing(self, states: Words, rows: Words) -> Words:
        """Return which conditional actions change a state, of those that ``rows`` say can run."""
        can_run = bit_rows.bools(rows, len(states))
        which, owners = np.nonzero(can_run)
        before = states[owners]
        after = self._after(before, self._conditional[which])
        can_run[which, owners] = (after != before).any(axis=1)
        return bit_rows.of_bools(can_run)

    def _parts(self, states: Words) -> Iterator[Words]:
        for begin in range(0, max(1, len(states)), self._chunk):
            yield states[begin : begin + self._chunk]

    def _checked(self, states: Words) -> Words:
        if states.dtype != np.uint64 or states.ndim != 2 or states.shape[1] != self.n_words:
            shape = f"{states.dtype} of shape {states.shape}"
            message = f"states are rows of {self.n_words} words (uint64), not {shape}"
            raise UsageError(message, hint="simulator.pack makes them of integers")
        return states

    def _checked_actions(self, actions: ArrayLike, n_states: int) -> Ids:
        ids = np.asarray(actions, dtype=np.int64)
        if ids.shape != (n_states,):
            raise UsageError(f"{n_states} states take as many actions, not shape {ids.shape}")
        if ids.size and (ids.min() < -1 or ids.max() >= self.n_actions):
            raise UsageError(f"actions are numbers from 0 to {self.n_actions - 1}, or -1 for none")
        return ids
