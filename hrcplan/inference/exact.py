"""The exact posterior: the share of each goal's plans that begin with the observed steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import IMPOSSIBLE, UNEXPLAINED, PlanFollower
from hrcplan.inference.probabilities import normalized

MISTAKE_RATE = 0.01
IMPROBABLE = -50.0  # the least logarithm of the share of a mistake


@dataclass(frozen=True, slots=True)
class ExactState:
    """The state of `ExactBelief`: the goals' progress, and the log score of each goal."""

    progress: Progress
    scores: Floats
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world


class ExactBelief(PlanFollower):
    """Bayes over plans that are all equally likely, with a rate of mistakes.

    A step that a share s of a goal's remaining plans begins with has likelihood (1 - p) s. A
    mistake has likelihood p, divided by the number of applicable steps that the goal does not need.
    A step that no goal explains leaves the posterior as it is; a step that changes nothing is one.
    Where agents take turns, all next steps of a goal are equally likely, and so are mistakes that
    lose the team as much time.

    >>> from hrcplan.bank import build_bank
    >>> belief = ExactBelief(build_bank("kitchen", only=["pasta-bean", "pasta-tomato"]))
    >>> step = belief.steps.find(("get", "beans"))
    >>> belief.posterior(belief.observe(belief.start(), step)).round(3).tolist()
    [0.996, 0.004]
    """

    def __init__(self, bank: Bank, mistake_rate: float = MISTAKE_RATE) -> None:
        self.tracker = ProgressTracker(bank)
        self.mistake_rate = mistake_rate
        self._right, self._wrong = math.log1p(-mistake_rate), math.log(mistake_rate)
        n_most = self.tracker.combined_graph.n_labels
        # By the number of steps that would be mistakes; the observed one is at least one of them.
        self._mistakes = self._wrong - np.log(np.maximum(1, np.arange(n_most + 1)))

    def start(self) -> ExactState:
        """Return the uniform belief in the initial state."""
        return ExactState(self.tracker.start, np.zeros(len(self.names)))

    def observe(self, state: ExactState, step: int, *, robot: bool = False) -> ExactState:
        """Return the belief after one more step; the robot's own steps are no evidence."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, ignored=IMPOSSIBLE)
        progress, evidence = move
        if robot:
            return ExactState(progress, state.scores)
        if not len(evidence.goals):
            return ExactState(progress, state.scores, UNEXPLAINED)
        return ExactState(progress, state.scores + self.log_likelihood(evidence))

    def observe_wait(self, state: ExactState) -> ExactState:
        """Return the belief after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        if move is None:
            return state
        progress, evidence = move
        if self.tracker.is_intervention(state.progress) or not len(evidence.goals):
            return ExactState(progress, state.scores)
        return ExactState(progress, state.scores + self.log_likelihood(evidence))

    def log_likelihood(self, evidence: Evidence) -> Floats:
        """Return the log likelihood of a step under each goal."""
        if evidence.log_odds is None:
            log_likelihood = self._mistakes.take(evidence.n_doable - evidence.n_next)
        else:
            log_likelihood = self._wrong + np.maximum(evidence.log_odds, IMPROBABLE)
        log_likelihood[evidence.goals] = self._right + evidence.log_shares
        return log_likelihood

    def posterior(self, state: ExactState) -> Floats:
        """Return the probability of each goal, in order."""
        return normalized(state.scores)
