"""The contract of beliefs: what every belief does, and what some can do in addition.

A belief says how probable each of several goals of a human is, after every observed step. `Belief`
is all that has to be written. The other protocols are capabilities: hrcplan uses one where a class
has its methods, and does without where it has not. `hrcplan.testing.check_belief` tests them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, is_dataclass, replace
from typing import Any, Protocol, TypeVar, cast, runtime_checkable

from hrcplan.bank import StepTable
from hrcplan.bank.progress import Progress, ProgressTracker
from hrcplan.core.arrays import Floats, Rows
from hrcplan.task.conditions import Test

IMPOSSIBLE = "no agent can do this step here"
UNEXPLAINED = "no goal explains this step"
UNCHANGED = "this was so before"


class BeliefState(Protocol):
    """What a belief is after some observations; it never changes.

    ``world`` is the state of the task, as bits. ``ignored`` says why the last observation had no
    effect on the posterior, such as `IMPOSSIBLE`; None if it had one.
    """

    @property
    def world(self) -> int:
        """The state of the task, as bits."""

    @property
    def ignored(self) -> str | None:
        """Why the last observation had no effect on the posterior; None if it had one."""


S = TypeVar("S", bound=BeliefState)
S_contra = TypeVar("S_contra", bound=BeliefState, contravariant=True)


@runtime_checkable
class Belief(Protocol[S]):
    """A belief about which of several goals a human has.

    A belief is made from a `Bank`, and a step is an index of ``bank.table``; only a class that is
    `MadeFromGoals` has a step table of its own. All memory is in the states: a state can be
    continued in several directions, and the same steps always lead to the same posterior.
    """

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        ...

    def start(self) -> S:
        """Return the belief before any observation."""
        ...

    def observe(self, state: S, step: int, *, robot: bool = False) -> S:
        """Return the belief after one more step, done by the human or by the robot."""
        ...

    def posterior(self, state: S) -> Floats:
        """Return the probability of each goal, in order; they sum to one."""
        ...


@runtime_checkable
class ObservesWaits(Protocol[S]):
    """A belief to which a wait says something, where agents take turns."""

    def observe_wait(self, state: S) -> S:
        """Return the belief after a wait of the agent whose turn it is."""
        ...


def after_wait(belief: Belief[S], state: S) -> S:
    """Return a belief after a wait; as it was if waits say nothing to it."""
    return belief.observe_wait(state) if isinstance(belief, ObservesWaits) else state


@runtime_checkable
class ObservesAttempts(Protocol[S]):
    """A belief that observes failed steps in its own way; see `after_attempt`."""

    def observe_attempt(self, state: S, step: int) -> S:
        """Return the belief after a step that the human tried to do."""
        ...


@runtime_checkable
class ObservesEvidence(Protocol[S]):
    """A belief to which more than steps can say something about the goal."""

    def observe_evidence(self, state: S, likelihood: Floats) -> S:
        """Return the belief after evidence with this likelihood for each goal."""
        ...


@runtime_checkable
class ObservesFacts(Protocol[S]):
    """A belief that also takes observations of facts, where it is not seen what was done."""

    def observe_fact(self, state: S, test: Test) -> S:
        """Return the belief after a fact was seen to be true, or false."""
        ...


@runtime_checkable
class ActsInAnyTurn(Protocol[S]):
    """A belief that passes turns on in its own way; see `at_turn`."""

    def at_turn(self, state: S, agent: str) -> S:
        """Return the belief as it is if it is an agent's turn."""
        ...


@runtime_checkable
class ObservesStates(Protocol[S]):
    """A belief that is put right where the state of the task is seen to be another one."""

    def observe_state(self, state: S, world: int) -> S:
        """Return the belief in another state of the task, given as bits; it is no evidence."""
        ...


def in_world(belief: Belief[S], state: S, world: int) -> S:
    """Return a belief in another state of the task; as it was if it cannot be put right."""
    if isinstance(belief, ObservesStates):
        moved: S = belief.observe_state(state, world)
        return moved
    return state


@dataclass(frozen=True, slots=True)
class GoalChange:
    """A change of goal just before observation ``at`` (0-based), and how probable it is.

    Attributes:
        at: The most probable place.
        probability: How probable it is that the change happened.
        first: The first place of an interval that holds the change with 90 %, given that it
            happened; None where the belief does not say.
        last: The last place of that interval.
        before: The index of the goal that was given up; None where the belief does not say.
        after: The index of the goal that was changed to.
    """

    at: int
    probability: float
    first: int | None = None
    last: int | None = None
    before: int | None = None
    after: int | None = None

    def moved(self, places: Sequence[int]) -> GoalChange:
        """Return the same change where each place p is called ``places[p]``.

        >>> GoalChange(1, 0.9, 0, 1).moved([3, 7])
        GoalChange(at=7, probability=0.9, first=3, last=7, before=None, after=None)
        """
        first, last = (None if p is None else places[p] for p in (self.first, self.last))
        return replace(self, at=places[self.at], first=first, last=last)


@runtime_checkable
class DetectsChanges(Protocol[S_contra]):
    """A belief that tells, looking back, when the goal has changed."""

    def changes(self, states: Sequence[S_contra]) -> tuple[GoalChange, ...]:
        """Return the probable changes, given the belief after each observation, in order."""
        ...


@runtime_checkable
class WeighsChanges(Protocol[S_contra]):
    """A belief that tells, looking back, how probable it is that the goal has changed at all."""

    def changed(self, states: Sequence[S_contra]) -> float:
        """Return that probability, given the belief after each observation, in order."""
        ...


@runtime_checkable
class DeclaresChanges(Protocol):
    """The state of a belief that decides, at every step, whether the goal has changed."""

    @property
    def n_declared(self) -> int:
        """How many changes of goal were declared so far."""
        ...


@runtime_checkable
class PredictsSteps(Protocol):
    """The state of a belief that says how probable the last human step was before it was seen."""

    @property
    def marginal(self) -> float:
        """That probability; 1 before any step."""
        ...


@runtime_checkable
class Remarks(Protocol):
    """A belief, or its state, with a remark for the user: what had to be done more cheaply."""

    @property
    def note(self) -> str | None:
        """The remark; None if there is none."""
        ...


@runtime_checkable
class TracksProgress(Protocol):
    """A belief that follows the plan graphs; its states have ``progress``, to be shared."""

    @property
    def tracker(self) -> ProgressTracker:
        """What follows the plan graphs."""
        ...


class PlanFollower:
    """What follows the plan graphs of a bank: its goals and steps are those of the bank."""

    tracker: ProgressTracker

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.tracker.bank.names

    @property
    def steps(self) -> StepTable:
        """The steps that can be observed."""
        return self.tracker.bank.table


@runtime_checkable
class HasProgress(Protocol):
    """A state that knows where each goal is in its plan graph."""

    @property
    def progress(self) -> Progress:
        """The progress of all goals."""
        ...


def after_attempt(belief: Belief[S], state: S, step: int) -> S:
    """Return a belief after a step that the human tried to do: evidence, but no progress.

    A belief that does not tell the two apart stays as it was.
    """
    if isinstance(belief, ObservesAttempts):
        observed: S = belief.observe_attempt(state, step)
        return observed
    progress = _progress_in(belief, state)
    if progress is None:
        return state
    after: S = belief.observe(state, step)
    if after.ignored is not None:
        return after
    return with_progress(after, progress[0].attempt(progress[1], step))


def after_evidence(belief: Belief[S], state: S, likelihood: Floats) -> S:
    """Return a belief after evidence that is no step; as it was if it only knows of steps."""
    if isinstance(belief, ObservesEvidence):
        weighed: S = belief.observe_evidence(state, likelihood)
        return weighed
    return state


def after_others_attempt(belief: Belief[S], state: S, step: int) -> S:
    """Return a belief after a step that another agent tried to do: no evidence, no progress."""
    progress = _progress_in(belief, state)
    if progress is None:
        return state
    return with_progress(state, progress[0].attempt(progress[1], step))


def at_turn(belief: Belief[S], state: S, agent: str) -> S:
    """Return a belief as it is in an agent's turn; as it was if it does not tell turns apart."""
    if isinstance(belief, ActsInAnyTurn):
        moved: S = belief.at_turn(state, agent)
        return moved
    progress = _progress_in(belief, state)
    if progress is None:
        return state
    return with_progress(state, progress[0].at_turn(progress[1], agent))


def _progress_in(
    belief: Belief[Any], state: BeliefState
) -> tuple[ProgressTracker, Progress] | None:
    """Return what follows the plan graphs, and where they stand; None if a belief does not."""
    if isinstance(belief, TracksProgress) and isinstance(state, HasProgress):
        return belief.tracker, state.progress
    return None


def with_progress(state: S, progress: Progress) -> S:
    """Return a belief's state with another progress; as it was if it is no data class."""
    if not is_dataclass(type(state)):
        return state
    moved: S = replace(cast(Any, state), progress=progress)
    return moved


@runtime_checkable
class SetBelief(Protocol):
    """A belief about unordered sets of steps, such as a classifier.

    A set is a row with one column per label (a step's name without its agent): 1 if it is done.
    """

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        ...

    def posteriors(self, rows: Rows) -> Floats:
        """Return (rows, goals) probabilities, for each row of done labels."""
        ...


@runtime_checkable
class BatchBelief(Protocol[S_contra]):
    """A belief that judges many continuations at once, which is faster than one by one."""

    def posteriors_after(self, state: S_contra, sequences: Sequence[Sequence[int]]) -> Floats:
        """Return (sequences, goals) probabilities: after each sequence of further steps."""
        ...


@runtime_checkable
class MadeFromGoals(Protocol):
    """A class of beliefs that are made from `Goals`, not from a `Bank`; each has ``steps``."""

    takes_goals: bool


@runtime_checkable
class HasSteps(Protocol):
    """A belief with a step table of its own: observed steps are indices of it."""

    @property
    def steps(self) -> StepTable:
        """The step table."""
        ...


def n_declared(state: BeliefState) -> int:
    """Return how many changes of goal were declared; 0 if states of this kind declare none."""
    return state.n_declared if isinstance(state, DeclaresChanges) else 0


def batch(belief: Belief[S], steps: Sequence[int], robot: Sequence[bool] = ()) -> list[Floats]:
    """Return the posterior before and after each of several steps.

    Args:
        belief: Any belief.
        steps: Step ids.
        robot: Which of them the robot did; none by default.
    """
    by = robot or [False] * len(steps)
    states = [belief.start()]
    for step, robots in zip(steps, by, strict=True):
        states.append(belief.observe(states[-1], step, robot=robots))
    return [belief.posterior(state) for state in states]
