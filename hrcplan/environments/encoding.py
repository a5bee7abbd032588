"""Steps and states as numbers and arrays; nothing here needs Gymnasium."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from typing import Any, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.core.bits import positions, single_bits
from hrcplan.episodes.turns import Mover
from hrcplan.errors import UsageError
from hrcplan.task.transitions import Rule

Bits = NDArray[np.int8]
"""Zeros and ones."""
WAIT = 0
"""The action that does nothing; action k is the k-th step of the agent, counted from 1."""


class ActionEncoding:
    """The steps of some agents as actions: 0 waits, k does the k-th step.

    Args:
        bank: The plans; their table numbers the steps.
        agents: The agents who share these actions, such as all robots.

    Attributes:
        steps: The steps that one of the agents can do in some state, in order.
        names: What each action is called, ``wait`` first.
    """

    def __init__(self, bank: Bank, agents: Iterable[str]) -> None:
        table, actions = bank.table, bank.goals.task.actions
        self._bank, who = bank, {*agents, None}
        self.steps = tuple(
            step
            for step in range(len(table))
            if any(actions[index].agent in who for index in table[step].actions)
        )
        self.names = ("wait", *(" ".join(table[step].words) for step in self.steps))
        self._action_of = {step: place + 1 for place, step in enumerate(self.steps)}
        self._able: dict[frozenset[str], _AbleSteps] = {}

    @property
    def n_actions(self) -> int:
        """The number of actions, waiting included."""
        return len(self.steps) + 1

    def valid(self, action: SupportsIndex) -> int:
        """Return an action as a number.

        Raises:
            UsageError: if there is no such action.
        """
        try:
            number = operator.index(action)
        except TypeError:
            number = -1
        if not 0 <= number < self.n_actions:
            message = f"{action!r} is no action from 0 to {self.n_actions - 1}"
            raise UsageError(message, code="bad-action")
        return number

    def step(self, action: int) -> int | None:
        """Return the step of an action; None if it waits."""
        return None if action == WAIT else self.steps[action - 1]

    def action(self, step: int | None) -> int:
        """Return the action that does a step, or waits."""
        return WAIT if step is None else self._action_of[step]

    def able(self, state: int, agents: frozenset[str]) -> int:
        """Return which actions one of ``agents`` can do in a state, as bits; waiting always."""
        able = self._able.get(agents)
        if able is None:
            able = self._able[agents] = _AbleSteps(self._bank, self.steps, agents)
        return able.of(state) << 1 | 1

    def mask(self, state: int, agents: frozenset[str]) -> Bits:
        """Return which actions one of ``agents`` can do in a state: 1 for each that it can do."""
        return as_bits(self.able(state, agents), self.n_actions)


class _AbleSteps:
    """Which of some steps agents can do in a state; quick if it differs little from the last one.

    The answer depends on the state alone.
    """

    def __init__(self, bank: Bank, steps: Sequence[int], agents: frozenset[str]) -> None:
        self._table, self._steps, self._agents = bank.table, steps, agents
        rules = bank.table.rules_of(agents)
        self._rules = [rules[step] for step in steps]
        self._looks_at = dict[int, int]()  # for each fact the steps that depend on it
        for place, (step, rule) in enumerate(zip(steps, self._rules, strict=True)):
            for fact in single_bits(_footprint(bank, step, rule)):
                self._looks_at[fact] = self._looks_at.get(fact, 0) | 1 << place
        self._state, self._able = 0, self._update(0, 0, (1 << len(steps)) - 1)

    def of(self, state: int) -> int:
        """Return the steps that can be done in a state, as bits."""
        changes = self._state ^ state
        if changes:
            doubtful = 0
            for fact in single_bits(changes):
                doubtful |= self._looks_at.get(fact, 0)
            self._able = self._update(state, self._able & ~doubtful, doubtful)
            self._state = state
        return self._able

    def _update(self, state: int, able: int, doubtful: int) -> int:
        for place in positions(doubtful):
            rule = self._rules[place]
            if rule is None:
                can = self._table.doer(state, self._steps[place], self._agents) is not None
            else:
                mask, value, writes, adds = rule
                can = state & mask == value and state & writes != adds
            if can:
                able |= 1 << place
        return able


def _footprint(bank: Bank, step: int, rule: Rule | None) -> int:
    """Return the facts on which it depends whether a step can be done, as bits."""
    if rule is not None:
        return rule.mask | rule.writes
    facts = 0
    for index in bank.table[step].actions:
        facts |= bank.goals.task.actions[index].footprint
    return facts


def as_bits(number: int, n: int) -> Bits:
    """Return the lowest ``n`` bits of a number, the lowest first.

    >>> as_bits(0b1101, 6).tolist()
    [1, 0, 1, 1, 0, 0]
    """
    raw = np.frombuffer(number.to_bytes((n + 7) // 8 or 1, "little"), np.uint8)
    return np.unpackbits(raw, bitorder="little", count=n).view(np.int8)


class ObservationEncoding:
    """States as arrays: a bit for each fact, and after them what else an agent observes.

    Args:
        bank: The plans; the bits are those of their task's facts, in order.
        more: What the numbers after the bits mean.
        is_real: Whether these are no bits; then observations are floats.

    Attributes:
        names: What each number of an observation means, as text.
        dtype: The type of an observation's numbers.
    """

    def __init__(self, bank: Bank, more: Iterable[str] = (), *, is_real: bool = False) -> None:
        self.n_facts = len(bank.goals.task.facts)
        facts = (f"({' '.join(fact)})" for fact in bank.goals.task.facts)
        self.names = (*facts, *more)
        self.dtype: type[np.float32 | np.int8] = np.float32 if is_real else np.int8

    @property
    def size(self) -> int:
        """The length of an observation."""
        return len(self.names)

    def of(self, state: int, more: Iterable[float] = ()) -> NDArray[Any]:
        """Return the observation of a state: a new array in each call."""
        bits = as_bits(state, self.n_facts)
        if self.size == self.n_facts:
            return bits
        return np.concatenate([bits, np.fromiter(more, self.dtype)], dtype=self.dtype)


class RobotObservations(ObservationEncoding):
    """What robots observe: facts, which of several robots acts, and the probability of each goal.

    Args:
        bank: The plans.
        robots: The robots, in the order of their turns.
        n_probabilities: How many probabilities they observe: one for each goal (and human), or 0.
    """

    def __init__(self, bank: Bank, robots: Sequence[Mover], n_probabilities: int = 0) -> None:
        self._robots = [robot.name for robot in robots] if len(robots) > 1 else []
        turns = [f"{name} acts" for name in self._robots]
        goals = [f"goal {bank.names[i % len(bank.names)]}" for i in range(n_probabilities)]
        super().__init__(bank, [*turns, *goals], is_real=bool(goals))

    def encode(self, state: int, mover: Mover, probabilities: Iterable[float]) -> NDArray[Any]:
        """Return what the robot observes whose turn it is."""
        if self.size == self.n_facts:
            return self.of(state)
        acts = [float(mover.name == name) for name in self._robots]
        return self.of(state, [*acts, *probabilities])
