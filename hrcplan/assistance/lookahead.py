"""A small tree of what may come: a robot step, the human's response, and so on (IV-B.1, IV-C.2).

Of all that could come next, only the few likeliest steps are looked at.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hrcplan.assistance.ahead import ImaginedSteps
from hrcplan.assistance.assistant import AssistantState
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.children import BRANCHING, Branching
from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import Belief
from hrcplan.pddl.conventions import people

StepSequence = tuple[int, ...]
"""Steps in turn, the robot's first."""


@dataclass(frozen=True, slots=True)
class TreePosition:
    """A place in the tree: where all goals stand, what they want, and the step that led there.

    ``known`` is shared by the whole tree: steps in another order lead to the same states.
    """

    track: Progress
    wanted: NextSteps
    last: int | None
    known: dict[int, tuple[Progress, NextSteps]] = field(default_factory=dict)


def shares(place: TreePosition, belief: Floats) -> Floats:
    """Return for each step the probability that the human's goal has it next, up to the last."""
    wanted = place.wanted
    found: Floats = np.bincount(wanted.steps, belief.take(wanted.goals)).astype(np.float64)
    return found


class Lookahead:
    """Expands the tree.

    Args:
        outlook: Looks for what the robot could do.
        bigrams: Which steps follow which; without them the belief decides what is looked at.
        width: How many steps are looked at from each place, at most.

    Raises:
        UsageError: if ``width`` is less than 1.
    """

    def __init__(
        self, outlook: StepValues, bigrams: Bigrams | None = None, width: int = BRANCHING
    ) -> None:
        self._agents, self._humans = outlook.agents, people(outlook.bank.goals.problem)
        self._ahead, self._children = ImaginedSteps(outlook), Branching(outlook, bigrams, width)

    def root(self, state: AssistantState[Any]) -> TreePosition:
        """Return the place where an assistant is."""
        track = self._ahead.begin(state.track)
        return TreePosition(track, self._ahead.wanted(track), state.last)

    def after(self, place: TreePosition, step: int) -> TreePosition:
        """Return the place after a step that can be done."""
        world = self._ahead.tracker.bank.table.successor(place.track.world, step)
        key = place.track.world if world is None else world
        if key not in place.known:
            track = self._ahead.after(place.track, step)
            place.known[key] = track, self._ahead.wanted(track)
        return TreePosition(*place.known[key], step, place.known)

    def steps(self, place: TreePosition, belief: Floats) -> list[int]:
        """Return the likeliest steps that the robot can do at a place; likeliest first."""
        return self._able(place, belief, self._agents)

    def responses(self, place: TreePosition, belief: Floats) -> list[tuple[int, float]]:
        """Return the human's likeliest steps at a place, with probabilities that sum to one.

        A goal's plans are followed by any of their next steps alike.
        """
        steps = self._able(place, belief, self._humans)
        wanted = place.wanted
        n_next = np.bincount(wanted.goals, minlength=len(belief))
        weights = (belief / np.maximum(1, n_next)).take(wanted.goals)
        chances = np.bincount(wanted.steps, weights).take(steps) if steps else np.zeros(0)
        total = chances.sum()
        if total <= 0:  # what is believed in has nothing to do
            chances, total = np.ones(len(steps)), len(steps)
        return list(zip(steps, (chances / total).tolist(), strict=True))

    def _able(self, place: TreePosition, belief: Floats, agents: Set[str]) -> list[int]:
        return self._children.of(place.track, place.wanted, place.last, agents, lambda: belief)


def futures(belief: Belief[Any], state: Any, branches: Sequence[StepSequence]) -> Floats:
    """Return what will be believed after each of several branches, a row for each.

    Args:
        belief: The belief. One that does not look at the order of steps can have a method
            ``extended``, which answers for all branches at once; see `Forest`.
        state: Its state at the root.
        branches: The branches.
    """
    extended = getattr(belief, "extended", None)
    if extended is not None:
        rows: Floats = extended(state.row, branches)
        return rows
    states: dict[StepSequence, Any] = {(): state}
    for branch in branches:
        for i, step in enumerate(branch):
            if branch[: i + 1] not in states:
                before = states[branch[:i]]
                states[branch[: i + 1]] = belief.observe(before, step, robot=i % 2 == 0)
    return np.array([belief.posterior(states[branch]) for branch in branches])


def entropy(beliefs: Floats) -> Floats:
    """Return the entropy of each row, in bits.

    >>> entropy(np.array([[0.5, 0.5, 0.0], [0.0, 1.0, 0.0]])).tolist()
    [1.0, 0.0]
    """
    logs = np.log2(np.where(beliefs > 0, beliefs, 1.0))
    found: Floats = 0.0 - (beliefs * logs).sum(axis=-1)
    return found
