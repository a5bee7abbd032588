"""A small tree of future steps: a robot step, the human's response, and so on (IV-B.1, IV-C.2).

From each position only the few likeliest steps are tried.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, field
from typing import Generic, cast

import numpy as np

from hrcplan.assistance.assistant import AssistantState, BeliefAssistant, S
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.imagined_steps import BRANCHING, Branching, ImaginedSteps
from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import BatchBelief, Belief
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.pddl.conventions import people

StepSequence = tuple[int, ...]
"""Steps in turn, the robot's first."""


@dataclass(frozen=True, slots=True)
class TreePosition:
    """A position in the tree: the goals' progress and next steps, and the step that led there.

    ``positions`` is shared by the whole tree: steps in another order lead to the same states.
    """

    progress: Progress
    next_steps: NextSteps
    last: int | None
    positions: dict[int, tuple[Progress, NextSteps]] = field(default_factory=dict)


def shares(position: TreePosition, belief: Floats) -> Floats:
    """Return for each step the probability that the human's goal has it next, up to the last."""
    next_steps = position.next_steps
    sums: Floats = np.bincount(next_steps.steps, belief.take(next_steps.goals)).astype(np.float64)
    return sums


class Lookahead:
    """Expands the tree.

    Args:
        step_values: Knows the goals' next steps, and the robots.
        bigrams: How often a step follows another; without them the belief decides alone.
        width: How many steps are tried from each position, at most.

    Raises:
        UsageError: if ``width`` is less than 1.
    """

    def __init__(
        self, step_values: StepValues, bigrams: Bigrams | None = None, width: int = BRANCHING
    ) -> None:
        self._agents, self._humans = step_values.agents, people(step_values.bank.goals.problem)
        self._future, self._branching = (
            ImaginedSteps(step_values),
            Branching(step_values, bigrams, width),
        )

    def root(self, state: AssistantState[S]) -> TreePosition:
        """Return the position of an assistant."""
        progress = self._future.begin(state.progress)
        return TreePosition(progress, self._future.next_steps(progress), state.last)

    def after(self, position: TreePosition, step: int) -> TreePosition:
        """Return the position after an applicable step."""
        world = self._future.bank.table.successor(position.progress.world, step)
        key = position.progress.world if world is None else world
        if key not in position.positions:
            progress = self._future.after(position.progress, step)
            position.positions[key] = progress, self._future.next_steps(progress)
        return TreePosition(*position.positions[key], step, position.positions)

    def steps(self, position: TreePosition, belief: Floats) -> list[int]:
        """Return the likeliest steps that the robot can do at a position, likeliest first."""
        return self._able(position, belief, self._agents)

    def responses(self, position: TreePosition, belief: Floats) -> list[tuple[int, float]]:
        """Return the human's likeliest steps at a position, with probabilities that sum to one.

        A goal's plans are followed by any of their next steps alike.
        """
        steps = self._able(position, belief, self._humans)
        next_steps = position.next_steps
        n_next = np.bincount(next_steps.goals, minlength=len(belief))
        weights = (belief / np.maximum(1, n_next)).take(next_steps.goals)
        chances = np.bincount(next_steps.steps, weights).take(steps) if steps else np.zeros(0)
        total = chances.sum()
        if total <= 0:  # what is believed in has nothing to do
            chances, total = np.ones(len(steps)), len(steps)
        return list(zip(steps, (chances / total).tolist(), strict=True))

    def _able(self, position: TreePosition, belief: Floats, agents: Set[str]) -> list[int]:
        return self._branching.expand(
            position.progress, position.next_steps, position.last, agents, lambda: belief
        )


def futures(belief: Belief[S], state: S, branches: Sequence[StepSequence]) -> Floats:
    """Return the posterior after each of several branches, a row for each.

    Args:
        belief: The belief. A `BatchBelief` judges all branches in one call.
        state: Its state at the root.
        branches: The branches.
    """
    if isinstance(belief, BatchBelief):
        rows: Floats = belief.posteriors_after(state, branches)
        return rows
    states: dict[StepSequence, S] = {(): state}
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
    bits: Floats = 0.0 - (beliefs * logs).sum(axis=-1)
    return bits


class LookaheadAssistant(BeliefAssistant[S], Generic[S]):
    """A base for assistants that look ahead in a tree; ``options`` is left to write.

    Args:
        bank: The plans.
        belief: What is believed about the goal; by default a forest, which is trained first.
        bigrams: How often a step follows another; by default counted in sampled plans.
        width: How many steps are tried from each position of the tree.

    Raises:
        UsageError: if ``width`` is less than 1.
    """

    needs_training = True

    def __init__(
        self, bank: Bank, belief: Belief[S] | None, bigrams: Bigrams | None, width: int
    ) -> None:
        super().__init__(bank, cast(Belief[S], ForestBelief(bank)) if belief is None else belief)
        self.lookahead = Lookahead(self.step_values, bigrams or Bigrams(bank), width)
