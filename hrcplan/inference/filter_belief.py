"""What beliefs that filter changes of goal share: progress through plan graphs, and a filter."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Generic, Protocol, TypeVar

from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import IMPOSSIBLE, GoalChange, PlanFollower
from hrcplan.inference.changes import change_points, changes_before
from hrcplan.inference.probabilities import weights_to_posterior


class GoalFilterState(Protocol):
    """The state of a filter of changing goals."""

    @property
    def likelihood(self) -> Floats | None:
        """The likelihood of the last human step, by kind of human and goal; None before any."""

    @property
    def n_declared(self) -> int:
        """How many changes of goal were declared so far."""

    @property
    def marginal(self) -> float:
        """The probability of the last human step, as it was predicted; 1 before any."""


F = TypeVar("F", bound=GoalFilterState)


class GoalFilter(Protocol[F]):
    """A filter of changing goals: `ChangeFilter` or `PairedFilters`."""

    def start(self) -> F:
        """Return the prior."""

    def step(self, before: F, likelihood: Floats) -> F:
        """Return the filter after a human step with this likelihood, by kind of human and goal."""

    def weigh(self, before: F, goals: Floats) -> F:
        """Return the filter after evidence that is no step, by its likelihood for each goal."""

    def goals(self, state: F) -> Floats:
        """Return the probability of each goal."""


@dataclass(frozen=True, slots=True)
class FilterBeliefState(Generic[F]):
    """The state of a `FilterBelief`: the goals' progress, and the filter.

    ``is_human`` says whether the last observation was an applicable step of the human.
    """

    progress: Progress
    filter_state: F
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

    @property
    def marginal(self) -> float:
        """How probable the last human step was before it was seen; 1 before any."""
        return self.filter_state.marginal


class FilterBelief(PlanFollower, ABC, Generic[F]):
    """The posterior of a goal that may change; a subclass says how likely steps are.

    Args:
        tracker: The progress of all goals.
        goal_filter: What is known of the goal and its changes.
    """

    def __init__(self, tracker: ProgressTracker, goal_filter: GoalFilter[F]) -> None:
        self.tracker = tracker
        self.filter = goal_filter

    @abstractmethod
    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood of a step by kind of human and goal.

        Args:
            progress: The progress before the step.
            step: The step; None for a wait.
            evidence: What the step says.
        """

    def start(self) -> FilterBeliefState[F]:
        """Return the uniform belief in the initial state."""
        return FilterBeliefState(self.tracker.start, self.filter.start())

    def observe(
        self, state: FilterBeliefState[F], step: int, *, robot: bool = False
    ) -> FilterBeliefState[F]:
        """Return the belief after one more step; the robot's own steps are no evidence."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, is_human=False, ignored=IMPOSSIBLE)
        return self._after(state, step, robot, *move)

    def observe_wait(self, state: FilterBeliefState[F]) -> FilterBeliefState[F]:
        """Return the belief after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        if move is None:
            return state
        return self._after(state, None, self.tracker.is_intervention(state.progress), *move)

    def _after(
        self, state: FilterBeliefState[F], step: int | None, robot: bool, progress: Progress,
        evidence: Evidence,
    ) -> FilterBeliefState[F]:  # fmt: skip
        if robot:
            return FilterBeliefState(progress, state.filter_state)
        likelihood = self.likelihood(state.progress, step, evidence)
        filter_state = self.filter.step(state.filter_state, likelihood)
        return FilterBeliefState(progress, filter_state, is_human=True)

    def observe_state(self, state: FilterBeliefState[F], world: int) -> FilterBeliefState[F]:
        """Return the belief in another state of the task, given as bits."""
        return replace(state, progress=self.tracker.in_world(state.progress, world))

    def observe_evidence(
        self, state: FilterBeliefState[F], likelihood: Floats
    ) -> FilterBeliefState[F]:
        """Return the belief after evidence that is no step, such as an answer to a question.

        Args:
            state: The belief before.
            likelihood: That of the evidence for each goal.
        """
        return replace(state, filter_state=self.filter.weigh(state.filter_state, likelihood))

    def posterior(self, state: FilterBeliefState[F]) -> Floats:
        """Return the probability of each goal, in order."""
        return weights_to_posterior(self.filter.goals(state.filter_state))

    def changes(self, states: Sequence[FilterBeliefState[F]]) -> tuple[GoalChange, ...]:
        """Return the changes that are probable given all observations.

        Args:
            states: The belief after each observation, in order.
        """
        return changes_before(states)

    def changed(self, states: Sequence[FilterBeliefState[F]]) -> float:
        """Return the probability, given all observations, that the goal has changed at all."""
        return change_points(states)[1].changed
