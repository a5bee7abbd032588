"""The contract of assistants: they observe like a belief, and choose what the robot does next.

`Assistant` is all that has to be written. `KnowsGoal` and `Explains` are capabilities: hrcplan uses
them where a class has their methods. `BeliefAssistant` is a base for your own.
`hrcplan.testing.check_assistant` tests the laws.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable
from dataclasses import dataclass, replace
from typing import Generic, Protocol, TypeVar, runtime_checkable

from hrcplan.assistance.explanation import (
    Explanation,
    StepChoice,
    explanation_of,
)
from hrcplan.assistance.step_values import StepValues
from hrcplan.assistance.team_help import for_likeliest_goal
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.core.deprecation import Renamed, warn_old_name
from hrcplan.inference.belief import (
    IMPOSSIBLE,
    Belief,
    BeliefState,
    HasProgress,
    PlanFollower,
    S_contra,
    TracksProgress,
    after_attempt,
    after_wait,
    at_turn,
    in_world,
    n_declared,
)

S = TypeVar("S", bound=BeliefState)


class ProgressState(BeliefState, HasProgress, Protocol):
    """The state of an assistant that follows the plan graphs."""


P = TypeVar("P", bound=ProgressState)


@runtime_checkable
class Assistant(Belief[S], Protocol[S]):
    """A belief that also chooses the robot's steps; it is made from a bank.

    All memory is in the states.
    """

    def choose(self, state: S) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        ...


@runtime_checkable
class KnowsGoal(Protocol[S]):
    """An assistant that receives the human's goal after each of the human's turns."""

    def inform(self, state: S, goal: int) -> S:
        """Return the state once the human's present goal is known."""
        ...


@runtime_checkable
class Explains(Protocol[S_contra]):
    """An assistant that can say what it has weighed."""

    def explain(self, state: S_contra) -> Explanation:
        """Return why it chooses, in this state, what it chooses."""
        ...


@runtime_checkable
class NeedsTraining(Protocol):
    """A class of assistants that train a classifier unless they are given another belief."""

    needs_training: bool


@dataclass(frozen=True, slots=True)
class AssistantState(Generic[S]):
    """The state of a `BeliefAssistant`: its belief, the goals' progress, the human's last step."""

    belief: S
    progress: Progress
    last: int | None = None
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world

    @property
    def n_declared(self) -> int:
        """How many changes of goal the belief has declared."""
        return n_declared(self.belief)

    track = Renamed("progress")


class BankAssistant(PlanFollower, ABC, Generic[S]):
    """What the built-in assistants share: the bank, the goals' progress, and the steps' values."""

    def __init__(self, bank: Bank, tracker: ProgressTracker | None = None) -> None:
        self.bank = bank
        self.tracker = tracker or ProgressTracker(bank)
        self.step_values = StepValues(self.tracker)

    outlook = Renamed("step_values")

    @abstractmethod
    def start(self) -> S:
        """Return the state before anything was done."""

    @abstractmethod
    def observe(self, state: S, step: int, *, robot: bool = False) -> S:
        """Return the state after one more step, done by the human or by the robot."""

    @abstractmethod
    def posterior(self, state: S) -> Floats:
        """Return the probability of each goal, in order."""

    @abstractmethod
    def choose(self, state: S) -> int | None:
        """Return the step that the robot should do now, or None to wait."""


class ValueAssistant(BankAssistant[P], Generic[P]):
    """An assistant that values steps, does the best one, and can explain it."""

    @abstractmethod
    def options(self, state: P) -> StepChoice:
        """Return the steps that the robot could do now, and how good each is."""

    def choose(self, state: P) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        return self.options(state).best

    def in_turn(self, choice: StepChoice, state: P) -> StepChoice:
        """Return a choice as it is; in a team that takes turns, what helps the likeliest goal."""
        moves, progress = self.tracker.moves, state.progress
        if moves is None or not any(moves.is_robot):
            return choice
        moment = self.step_values.next_robot(progress)
        return for_likeliest_goal(choice, moves, progress.world, moment, self.posterior(state))

    def explain(self, state: P, n_goals: int = 3, n_steps: int = 5) -> Explanation:
        """Return why it chooses what it chooses, with that many goals and steps at most."""
        return explanation_of(
            self.step_values, state.progress, self.posterior(state), self.options(state),
            n_declared(state), n_goals, n_steps,
        )  # fmt: skip


class BeliefAssistant(ValueAssistant[AssistantState[S]], Generic[S]):
    """An assistant made of a belief and a way to value steps; only ``options`` is left to write.

    Args:
        bank: The plans.
        belief: What is believed about the human's goal.
    """

    def __init__(self, bank: Bank, belief: Belief[S]) -> None:
        super().__init__(bank, belief.tracker if isinstance(belief, TracksProgress) else None)
        self.belief = belief
        self._shares_progress = isinstance(belief, TracksProgress)

    def start(self) -> AssistantState[S]:
        """Return the state before anything was done."""
        return AssistantState(self.belief.start(), self.tracker.start)

    def observe(
        self, state: AssistantState[S], step: int, *, robot: bool = False
    ) -> AssistantState[S]:
        """Return the state after one more step, done by the human or by the robot."""
        belief = self.belief.observe(state.belief, step, robot=robot)
        if belief.ignored == IMPOSSIBLE:
            return AssistantState(belief, state.progress, state.last, IMPOSSIBLE)
        progress = self._progress_after(state.progress, belief, step)
        return AssistantState(belief, progress, state.last if robot else step, belief.ignored)

    def observe_wait(self, state: AssistantState[S]) -> AssistantState[S]:
        """Return the state after a wait of the agent whose turn it is, where agents take turns."""
        belief: S = after_wait(self.belief, state.belief)
        progress = self._progress_after(state.progress, belief, None)
        return replace(state, belief=belief, progress=progress)

    def observe_attempt(self, state: AssistantState[S], step: int) -> AssistantState[S]:
        """Return the state after a step that the human tried to do: evidence, but no progress."""
        belief: S = after_attempt(self.belief, state.belief, step)
        progress = self.tracker.attempt(state.progress, step)
        return replace(state, belief=belief, progress=progress, ignored=belief.ignored)

    def observe_state(self, state: AssistantState[S], world: int) -> AssistantState[S]:
        """Return the state in another state of the task, given as bits."""
        belief: S = in_world(self.belief, state.belief, world)
        return replace(state, belief=belief, progress=self.tracker.in_world(state.progress, world))

    def at_turn(self, state: AssistantState[S], agent: str) -> AssistantState[S]:
        """Return the state as it is if it is an agent's turn, where agents take turns."""
        belief: S = at_turn(self.belief, state.belief, agent)
        return replace(state, belief=belief, progress=self.tracker.at_turn(state.progress, agent))

    def _progress_after(
        self, progress: Progress, belief: BeliefState, step: int | None
    ) -> Progress:
        if self._shares_progress and isinstance(belief, HasProgress):
            return belief.progress
        tracker = self.tracker
        move = tracker.wait(progress) if step is None else tracker.follow(progress, step)
        return progress if move is None else move[0]

    def posterior(self, state: AssistantState[S]) -> Floats:
        """Return the probability of each goal, in order."""
        return self.belief.posterior(state.belief)


@runtime_checkable
class _HasToldMethod(Protocol[S]):
    """`KnowsGoal` as it was called in earlier versions."""

    def told(self, state: S, goal: int) -> S: ...


def inform(assistant: Belief[S], state: S, goal: int) -> S:
    """Return an assistant's state after a turn of the human whose goal is ``goal``.

    The goal changes nothing for an assistant that does not know it (`KnowsGoal`).
    """
    if isinstance(assistant, KnowsGoal):
        new_state: S = assistant.inform(state, goal)
        return new_state
    if isinstance(assistant, _HasToldMethod):
        warn_old_name(f"method of {type(assistant).__name__}", "told", "inform")
        new_state = assistant.told(state, goal)
        return new_state  # noqa: RET504  (typed above)
    return state


def needs_training(kind: Hashable) -> bool:
    """Return whether a class of assistants trains a classifier, which takes minutes."""
    return isinstance(kind, NeedsTraining) and kind.needs_training


def explain(
    assistant: ValueAssistant[P], state: P, n_goals: int = 3, n_steps: int = 5
) -> Explanation:
    """Return why an assistant chooses what it chooses.

    Args:
        assistant: The assistant.
        state: Its state.
        n_goals: The most goals to name.
        n_steps: The most candidates to name.
    """
    return assistant.explain(state, n_goals, n_steps)
