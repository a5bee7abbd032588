"""The turns of an episode: the human acts first, then the robot; they do not talk.

Time is counted in turns: every action of either agent takes one timestep, and so does waiting.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Generic, Protocol

import numpy as np

from hrcplan.assistance.assistant import Assistant
from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.episodes.humans import Course, EpisodeHuman
from hrcplan.episodes.observers import TurnObserver
from hrcplan.episodes.turns import PATIENCE as PATIENCE
from hrcplan.episodes.turns import REACHED as REACHED
from hrcplan.episodes.turns import ROUNDS as ROUNDS
from hrcplan.episodes.turns import STUCK as STUCK
from hrcplan.episodes.turns import UNFINISHED as UNFINISHED
from hrcplan.episodes.turns import EpisodeTurns, turns_of
from hrcplan.episodes.turns import SimulatedTurns as SimulatedTurns
from hrcplan.episodes.turns import TurnWorld as TurnWorld
from hrcplan.errors import UsageError
from hrcplan.inference.belief import S

NEAR = 1e-6  # to what probabilities sum to


@dataclass(frozen=True, slots=True)
class EpisodeTurn:
    """One timestep: who acts, the step, the human's goal, and whether the goal needs the step.

    ``step`` is None for a wait. After an action of the human, ``guess`` is the goal with the
    highest posterior, ``rank`` how many goals have a higher one than the right goal, and
    ``n_declared`` how many changes the robot has declared so far. ``is_needed`` says whether the
    step is next in a valid plan of the goal. ``round`` counts the turns of each agent from 0;
    ``agent`` is who acts, where humans have goals of their own.
    """

    t: int
    is_human: bool
    step: int | None
    goal: int
    is_needed: bool
    is_mistake: bool = False
    guess: int | None = None
    rank: int | None = None
    n_declared: int = 0
    round: int = 0
    agent: str | None = None


@dataclass(frozen=True)
class EpisodeRecord:
    """One episode: its turns, how it ended, and the time of each decision of the robot in ms.

    ``cap`` is the number of timesteps after which an episode ends in any case, and the cost of one
    that did not reach its goal. ``is_reachable`` says whether the last goal was reached, or could
    still be at the end. ``courses`` are those of humans with goals of their own; ``course`` is
    then that of the first.
    """

    course: Course
    turns: tuple[EpisodeTurn, ...]
    ending: str
    decisions_ms: tuple[float, ...] = ()
    cap: int = 0
    is_reachable: bool = True
    courses: Mapping[str, Course] = field(default_factory=dict)

    def n_changes(self, turn: EpisodeTurn) -> int:
        """Return how often the goal of who acts has changed up to a turn."""
        course = self.courses.get(turn.agent or "", self.course)
        return sum(turn.round >= change for change in course.turns)

    @property
    def n_turns(self) -> int:
        """Timesteps until the last goal was reached, or until the end."""
        return len(self.turns)

    @property
    def cost(self) -> int:
        """Timesteps until the last goal was reached; the cap if it was not."""
        return self.n_turns if self.ending == REACHED else max(self.cap, self.n_turns)

    def __repr__(self) -> str:
        goals = " → ".join(map(str, self.course.goals))
        return f"EpisodeRecord(goals {goals}, {self.ending} after {self.n_turns} turns)"


EpisodeWatch = Callable[[EpisodeTurn, S], None]
"""Is called with every turn and the robot's state after it."""


def play(
    bank: Bank, human: EpisodeHuman, robot: Assistant[S], course: Course,
    world: TurnWorld | None = None, watch: EpisodeWatch[S] | None = None,
) -> EpisodeRecord:  # fmt: skip
    """Return the record of one episode: turns until the human's last goal is reached.

    Args:
        bank: The plans; they decide what is needed.
        human: Who acts first.
        robot: The assistant; one that `KnowsGoal` receives the human's goal after each of the
            human's turns.
        course: What the human wants and when; the human was made from the same one.
        world: Where it happens; by default as the PDDL says.
        watch: Is called with every turn.

    Raises:
        UsageError: if the human or the robot chooses an index that is no step, or a step that it
            cannot do, or the robot's posterior has no probability for each goal.
    """
    turns = turns_of(bank, world)
    turns.begin(course)
    humans = {mover.name: human for mover in turns.order if mover.is_human}
    return Play(turns, humans, robot, TurnObserver(robot, turns), watch).run()


class Robot(Protocol[S]):
    """The part of an assistant that starts and chooses."""

    def start(self) -> S:
        """Return the state before anything was done."""
        ...

    def choose(self, state: S) -> int | None:
        """Return the step that the robot should do now, or None to wait."""
        ...


class Play(Generic[S]):
    """One episode as it happens.

    Args:
        turns: The turns of an episode that has begun.
        humans: The human who chooses for each human mover, by the mover's name.
        robot: Chooses for all robots.
        observer: What the robot observes.
        watch: Is called with every turn.
        names_agents: Whether the turns in the record say who acts.
    """

    def __init__(
        self, turns: EpisodeTurns, humans: Mapping[str, EpisodeHuman], robot: Robot[S],
        observer: TurnObserver[S], watch: EpisodeWatch[S] | None, *, names_agents: bool = False,
    ) -> None:  # fmt: skip
        self.bank, self.now, self.humans = turns.bank, turns, humans
        self.robot, self.observer, self.watch = robot, observer, watch
        self.names_agents = names_agents
        self.belief = robot.start()
        self.turns: list[EpisodeTurn] = []
        self.decisions_ms: list[float] = []
        self._robots = frozenset[str]().union(
            *(mover.agents for mover in turns.order if not mover.is_human)
        )

    def run(self) -> EpisodeRecord:
        """Return the record."""
        now = self.now
        while now.ending is None:
            if now.mover.is_human:
                self._human()
            else:
                self._robot()
        is_reachable = now.ending == REACHED or now.can_reach()
        decisions = tuple(self.decisions_ms)
        return EpisodeRecord(
            now.course, tuple(self.turns), now.ending, decisions, now.cap, is_reachable
        )

    def _human(self) -> None:
        now, mover = self.now, self.now.mover
        t, goal, turn = now.n_turns, now.goal, now.round
        move = now.human_move(self.humans[mover.name])
        is_needed = self._do(move.step)
        self.belief = self.observer.after(self.belief, mover, move.step)
        self.belief = self.observer.inform(self.belief, mover, goal)
        agent = mover.name if self.names_agents else None
        if move.step is None:
            self._note(EpisodeTurn(t, True, None, goal, False, round=turn, agent=agent))
            return
        posterior = _checked(self.observer.posterior(self.belief, mover), len(self.bank.names))
        likelier = posterior > posterior[goal]
        rank = int(likelier.sum() + (posterior[:goal] == posterior[goal]).sum())
        n_declared = self.observer.n_declared(self.belief, mover)
        self._note(
            EpisodeTurn(
                t, True, move.step, goal, is_needed, move.is_mistake, int(posterior.argmax()),
                rank, n_declared, turn, agent,
            )
        )  # fmt: skip

    def _robot(self) -> None:
        now, mover = self.now, self.now.mover
        t, goal, turn = now.n_turns, now.goal, now.round
        began = time.perf_counter()
        step = self._own(self.robot.choose(self.belief))
        self.decisions_ms.append((time.perf_counter() - began) * 1e3)
        is_needed = self._do(step)
        self.belief = self.observer.after(self.belief, mover, step)
        agent = mover.name if self.names_agents else None
        self._note(EpisodeTurn(t, False, step, goal, is_needed, round=turn, agent=agent))

    def _do(self, step: int | None) -> bool:
        """Do a step; return whether it is next in a valid plan of the goal."""
        next_steps = () if step is None else self.now.next_steps()
        self.now.do(step)
        return step in next_steps

    def _own(self, step: int | None) -> int | None:
        """Return the step of the robot whose turn it is; None if another robot has to do it."""
        if not isinstance(step, int | np.integer) or not 0 <= step < len(self.bank.table):
            return step
        state, own = self.now.state, self.now.mover.agents
        is_others = self.bank.table.doer(state, int(step), self._robots - own)
        can = self.bank.table.doer(state, int(step), own)
        return None if can is None and is_others is not None else step

    def _note(self, turn: EpisodeTurn) -> None:
        self.turns.append(turn)
        if self.watch is not None:
            self.watch(turn, self.belief)


def _checked(posterior: Floats, n_goals: int) -> Floats:
    """Return the posterior of a robot, which must have a probability for each goal."""
    answer = np.asarray(posterior, dtype=object)
    try:
        numbers: Floats = answer.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        numbers = np.zeros(0)
    is_one = numbers.shape == (n_goals,) and (numbers >= 0).all()
    if not is_one or abs(numbers.sum() - 1) > NEAR:
        raise UsageError(f"{answer} is no probability for each goal", code="bad-posterior")
    return numbers
