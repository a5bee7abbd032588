"""What every assistant does: it watches like a belief, and chooses what the robot does next."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

import numpy as np

from hrcplan.assistance.step_values import StepValues
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import Belief, State
from hrcplan.inference.exact import IMPOSSIBLE

WAIT = None
TIES = 9  # decimals of values: what differs by less is equally good

S = TypeVar("S", bound=State)


@runtime_checkable
class Assistant(Belief[S], Protocol[S]):
    """A belief that also chooses the robot's steps; whoever keeps this protocol can be studied.

    It is made from a bank. Nothing is remembered outside the states.
    """

    def choose(self, state: S) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        ...


@dataclass(frozen=True, slots=True)
class StepChoice:
    """Steps that the robot could do, and how good each is; ``wait`` is how good it is to wait."""

    steps: tuple[int, ...] = ()
    values: tuple[float, ...] = ()
    wait: float = 0.0

    @property
    def best(self) -> int | None:
        """The best step, the first of equals; None if waiting is as good."""
        if not self.steps:
            return WAIT
        place = int(np.round(self.values, TIES).argmax())
        return self.steps[place] if round(self.values[place] - self.wait, TIES) > 0 else WAIT


@dataclass(frozen=True, slots=True)
class AssistantState(Generic[S]):
    """The state of a `BeliefAssistant`: its belief, the goals' progress, the human's last step."""

    belief: S
    track: Progress
    last: int | None = None
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.track.world

    @property
    def n_declared(self) -> int:
        """How many changes of goal the belief has declared."""
        return int(getattr(self.belief, "n_declared", 0))


class BeliefAssistant(ABC, Generic[S]):
    """An assistant made of a belief and a way to value steps, which is all that is left to write.

    Args:
        bank: The plans.
        belief: What is believed about the human's goal.
    """

    def __init__(self, bank: Bank, belief: Belief[S]) -> None:
        self.bank, self.belief = bank, belief
        own = getattr(belief, "tracker", None)
        self.tracker: ProgressTracker = own or ProgressTracker(bank)
        self._shares_track = own is not None
        self.outlook = StepValues(self.tracker)

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    def start(self) -> AssistantState[S]:
        """Return the state before anything was done."""
        return AssistantState(self.belief.start(), self.tracker.start)

    def observe(
        self, state: AssistantState[S], step: int, *, robot: bool = False
    ) -> AssistantState[S]:
        """Return the state after one more step, done by the human or by the robot."""
        belief = self.belief.observe(state.belief, step, robot=robot)
        if belief.ignored == IMPOSSIBLE:
            return AssistantState(belief, state.track, state.last, IMPOSSIBLE)
        last = state.last if robot else step
        return AssistantState(
            belief, self._followed(state.track, belief, step), last, belief.ignored
        )

    def _followed(self, track: Progress, belief: Any, step: int) -> Progress:
        if self._shares_track:
            shared: Progress = belief.track
            return shared
        found = self.tracker.follow(track, step)
        return track if found is None else found[0]

    def posterior(self, state: AssistantState[S]) -> Floats:
        """Return the probability of each goal, in order."""
        return self.belief.posterior(state.belief)

    @abstractmethod
    def options(self, state: AssistantState[S]) -> StepChoice:
        """Return the steps that the robot could do now, and how good each is."""

    def choose(self, state: AssistantState[S]) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        return self.options(state).best


@dataclass(frozen=True, slots=True)
class StepCandidate:
    """A step that the robot could do: its value, and the goals that it would help, likeliest first.

    ``saves`` is how many steps it is expected to save.
    """

    action: str
    value: float
    saves: float
    helps: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why an assistant does what it does: the goals it believes in, and what it could do."""

    goals: tuple[tuple[str, float], ...]
    chosen: str | None
    candidates: tuple[StepCandidate, ...]
    n_declared: int


def explain(
    assistant: BeliefAssistant[Any], state: AssistantState[Any], n_goals: int = 3, n_steps: int = 5
) -> Explanation:
    """Return why an assistant chooses what it chooses.

    Args:
        assistant: The assistant.
        state: Its state.
        n_goals: The most goals to name.
        n_steps: The most candidates to name.
    """
    posterior, outlook = assistant.posterior(state), assistant.outlook
    options = assistant.options(state)
    wanted = outlook.wanted(state.track)
    saved, _ = outlook.help(state.track, wanted, options.steps, posterior)
    words = [str(assistant.bank.table[step]) for step in options.steps]
    order = sorted(range(len(words)), key=lambda i: -round(options.values[i], TIES))
    candidates = tuple(
        StepCandidate(
            words[i],
            options.values[i],
            float(saved[i]),
            _named(assistant, posterior, wanted.goals[wanted.steps == options.steps[i]], n_goals),
        )
        for i in order[:n_steps]
    )
    everything = np.arange(len(posterior))
    chosen = None if options.best is None else str(assistant.bank.table[options.best])
    return Explanation(
        _named(assistant, posterior, everything, n_goals), chosen, candidates, state.n_declared
    )


def _named(
    assistant: BeliefAssistant[Any], posterior: Floats, goals: Sequence[int] | Any, n: int
) -> tuple[tuple[str, float], ...]:
    chosen = sorted(map(int, goals), key=lambda goal: -posterior[goal])[:n]
    return tuple((assistant.names[goal], float(posterior[goal])) for goal in chosen)
