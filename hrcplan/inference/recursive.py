"""Recursive Bayes (Jain and Argall, THRI 2019): the goal may change a little at every step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import IMPOSSIBLE, PlanFollower
from hrcplan.inference.probabilities import weights_to_posterior

STAY = 0.9
EPSILON = 0.01
RATIO = 3.0
BETA = 4.0


class Likelihood(Protocol):
    """How likely a human step is under each goal; a wait, where agents take turns, is None."""

    def __call__(self, tracker: ProgressTracker, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood by goal."""
        ...


@dataclass(frozen=True)
class Needed:
    """One over the number of steps that a goal needs; ``epsilon`` over the rest if it is none.

    It ignores earlier steps, as the attractor fields of Jain and Argall do.
    """

    epsilon: float = EPSILON

    def __call__(self, tracker: ProgressTracker, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood by goal."""
        if step is None:
            return Next(self.epsilon)(tracker, step, evidence)
        needs = tracker.combined_graph.needs
        sizes = needs.sum(axis=1)
        rest = np.maximum(1, tracker.combined_graph.n_labels - sizes)
        helps = needs[:, tracker.combined_graph.label[step]]
        likelihood: Floats = np.where(
            helps, (1 - self.epsilon) / np.maximum(1, sizes), self.epsilon / rest
        )
        return likelihood


@dataclass(frozen=True)
class Attractor:
    """``ratio`` times as likely if the goal needs the step: the soft attractor field."""

    ratio: float = RATIO

    def __call__(self, tracker: ProgressTracker, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood by goal."""
        if step is None:
            return Next(1 / (1 + self.ratio))(tracker, step, evidence)
        needs = tracker.combined_graph.needs
        weights = np.where(needs, self.ratio, 1.0)
        likelihood: Floats = weights[:, tracker.combined_graph.label[step]] / weights.sum(axis=1)
        return likelihood


@dataclass(frozen=True)
class Next:
    """One over the number of steps that could come next; ``epsilon`` over the others that can."""

    epsilon: float = EPSILON

    def __call__(self, tracker: ProgressTracker, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood by goal."""
        likelihood: Floats = self.epsilon / np.maximum(1, evidence.n_doable - evidence.n_next)
        likelihood[evidence.goals] = (1 - self.epsilon) / evidence.n_next[evidence.goals]
        return likelihood


@dataclass(frozen=True)
class Rational:
    """A Boltzmann policy: a step that no plan has next is exp(-beta) times as likely as one."""

    beta: float = BETA

    def __call__(self, tracker: ProgressTracker, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood by goal."""
        others = np.maximum(0, evidence.n_doable - evidence.n_next) * math.exp(-self.beta)
        likelihood: Floats = math.exp(-self.beta) / np.maximum(evidence.n_next + others, 1e-9)
        likelihood[evidence.goals] *= math.exp(self.beta)
        return likelihood


LIKELIHOODS: dict[str, Callable[[float], Likelihood]] = {
    "needed": Needed,
    "attractor": Attractor,
    "next": Next,
    "rational": Rational,
}
"""Likelihoods by the names that scenarios of studies use; each is made from its number."""


@dataclass(frozen=True, slots=True)
class RecursiveState:
    """The state of `RecursiveBelief`: the goals' progress, and the probability of each goal."""

    progress: Progress
    weights: Floats
    n_human: int = 0
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world


class RecursiveBelief(PlanFollower):
    """Bayes' rule after each human step, with a goal that stays with probability ``stay``.

    Args:
        bank: The plans.
        stay: The probability that the goal stays; the rest is spread over the others.
        likelihood: The likelihood of a step under each goal; Jain and Argall leave it open.
        own_steps: Whether the robot's own steps are evidence, too, as those of the human are.
    """

    def __init__(
        self, bank: Bank, stay: float = STAY, likelihood: Likelihood | None = None,
        own_steps: bool = False,
    ) -> None:  # fmt: skip
        self.tracker, self.own_steps = ProgressTracker(bank), own_steps
        self.stay = stay if len(bank.names) > 1 else 1.0
        self.likelihood = likelihood or Needed()

    def start(self) -> RecursiveState:
        """Return the uniform belief in the initial state."""
        n = len(self.names)
        return RecursiveState(self.tracker.start, np.full(n, 1 / n))

    def observe(self, state: RecursiveState, step: int, *, robot: bool = False) -> RecursiveState:
        """Return the belief after one more step."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, ignored=IMPOSSIBLE)
        if robot and not self.own_steps:
            return replace(state, progress=move[0], ignored=None)
        return self._after(state, step, *move)

    def observe_wait(self, state: RecursiveState) -> RecursiveState:
        """Return the belief after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        if move is None:
            return state
        if self.tracker.is_intervention(state.progress):
            return replace(state, progress=move[0])
        return self._after(state, None, *move)

    def _after(
        self, state: RecursiveState, step: int | None, progress: Progress, evidence: Evidence
    ) -> RecursiveState:
        weights = state.weights
        if state.n_human:
            others = (weights.sum() - weights) / max(1, len(weights) - 1)
            weights = self.stay * weights + (1 - self.stay) * others
        weights = weights * self.likelihood(self.tracker, step, evidence)
        return RecursiveState(progress, weights / weights.sum(), state.n_human + 1)

    def posterior(self, state: RecursiveState) -> Floats:
        """Return the probability of each goal, in order."""
        return weights_to_posterior(state.weights)
