"""A human who may change goals and make mistakes: exact filtering over plan graphs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import IMPOSSIBLE, GoalChange, PlanFollower
from hrcplan.inference.changes import (
    HAZARD,
    NEVER,
    SETTLES,
    ChangeFilter,
    FilterState,
    change_points,
    changes_before,
)
from hrcplan.inference.probabilities import weights_to_posterior

MISTAKE_RATES = (0.002, 0.1)
IMPROBABLE = 1e-12  # the least share of a step among the mistakes


@dataclass(frozen=True, slots=True)
class SwitchingState:
    """The state of `SwitchingBelief`: the goals' progress, and the filter.

    ``is_human`` says whether the last observation was an applicable step of the human.
    """

    progress: Progress
    filter_state: FilterState
    is_human: bool = False
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world

    @property
    def n_declared(self) -> int:
        """How many changes of goal were declared so far."""
        return self.filter_state.n_declared


class SwitchingBelief(PlanFollower):
    """The posterior of the present goal.

    A step of the goal has likelihood (1 - p) over the number of steps that could come next in its
    plans; a mistake p over the number of steps that could be done and would not. Where agents take
    turns, a mistake is the less likely the more time it loses the team, and a wait is evidence.

    Args:
        bank: The plans.
        hazard: The probability of a change before each human step.
        mistake_rates: Equally likely rates of mistakes p.
        never: The prior probability that the goal never changes.
        settles: The probability that a goal that was changed to is kept to the end.
    """

    def __init__(
        self, bank: Bank, hazard: float = HAZARD,
        mistake_rates: Sequence[float] = MISTAKE_RATES, never: float = NEVER,
        settles: float = SETTLES,
    ) -> None:  # fmt: skip
        self.tracker = ProgressTracker(bank)
        self.filter = ChangeFilter(len(bank.names), len(mistake_rates), hazard, never, settles)
        self.rates = np.array(mistake_rates)[:, None]

    def start(self) -> SwitchingState:
        """Return the uniform belief in the initial state."""
        return SwitchingState(self.tracker.start, self.filter.start())

    def observe(self, state: SwitchingState, step: int, *, robot: bool = False) -> SwitchingState:
        """Return the belief after one more step; the robot's own steps are no evidence."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, is_human=False, ignored=IMPOSSIBLE)
        progress, evidence = move
        if robot:
            return SwitchingState(progress, state.filter_state)
        filter_state = self.filter.step(state.filter_state, self.likelihood(evidence))
        return SwitchingState(progress, filter_state, is_human=True)

    def observe_wait(self, state: SwitchingState) -> SwitchingState:
        """Return the belief after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        if move is None:
            return state
        progress, evidence = move
        if self.tracker.is_robots_turn(state.progress):
            return SwitchingState(progress, state.filter_state)
        filter_state = self.filter.step(state.filter_state, self.likelihood(evidence))
        return SwitchingState(progress, filter_state, is_human=True)

    def likelihood(self, evidence: Evidence) -> Floats:
        """Return the likelihood of a step, by mistake rate and goal."""
        likelihood: Floats = (
            self.rates / np.maximum(1, evidence.n_doable - evidence.n_next)
            if evidence.log_odds is None
            else self.rates * np.maximum(np.exp(evidence.log_odds), IMPROBABLE)
        )
        likelihood[:, evidence.goals] = (1 - self.rates) / evidence.n_next[evidence.goals]
        return likelihood

    def posterior(self, state: SwitchingState) -> Floats:
        """Return the probability of each goal, in order."""
        return weights_to_posterior(self.filter.goals(state.filter_state))

    def changes(self, states: Sequence[SwitchingState]) -> tuple[GoalChange, ...]:
        """Return the changes that are probable given all observations.

        Args:
            states: The belief after each observation, in order.
        """
        return changes_before(states)

    def changed(self, states: Sequence[SwitchingState]) -> float:
        """Return the probability, given all observations, that the goal has changed at all."""
        return change_points(states)[1].changed
