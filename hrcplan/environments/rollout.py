"""An episode that is carried out move by move: what all environments share.

The turns are those of `hrcplan.episodes`, so an episode is that of a study with the same humans.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, TypedDict, Unpack

import numpy as np

from hrcplan.assistance.per_human import PerHuman
from hrcplan.bank import Bank, read_goals
from hrcplan.bank.cache import cached_bank
from hrcplan.core.text import nearest
from hrcplan.episodes.courses import Habits, draw_course, draw_own_courses
from hrcplan.episodes.humans import HUMANS, Course, EpisodeHuman
from hrcplan.episodes.observers import PerHumanObserver, TurnObserver
from hrcplan.episodes.own_goals import OwnGoalTurns
from hrcplan.episodes.turns import REACHED, STUCK, UNFINISHED, EpisodeTurns, Mover, turns_of
from hrcplan.episodes.worlds import WORLDS
from hrcplan.errors import UsageError
from hrcplan.inference.registry import METHODS
from hrcplan.inference.run import GOALS_PER, HUMAN, TEAM

TRIES = 100  # draws of an episode that is not over before it begins
OPTIONS = ("course", "goal")


class SceneryOptions(TypedDict, total=False):
    """The attributes of `Scenery` as options of an environment."""

    human: str
    changes: int
    mistake_rate: float
    wait_rate: float
    goals_per: str
    world: str
    belief: str | None


@dataclass(frozen=True, slots=True)
class Scenery:
    """What the episodes of an environment are like.

    Attributes:
        human: A simulated human by name or as ``module:Class``: see ``hrcplan.humans``.
        changes: How often a human changes its goal in an episode.
        mistake_rate: The probability of a mistake in a turn of a human.
        wait_rate: The probability that a human waits in a turn.
        goals_per: ``team`` if all humans share one goal, ``human`` if each has its own.
        world: Where steps are carried out: see ``hrcplan.worlds``.
        belief: A belief whose probabilities the robot observes, such as ``switching``: see
            ``hrcplan.beliefs``. None: it observes the state alone.
    """

    human: str = "frontier"
    changes: int = 0
    mistake_rate: float = 0.0
    wait_rate: float = 0.0
    goals_per: str = TEAM
    world: str = "simulated"
    belief: str | None = None

    def __post_init__(self) -> None:
        """Refuse what is no probability or no number of changes.

        Raises:
            UsageError: if a value is out of range.
        """
        if self.changes < 0 or not float(self.changes).is_integer():
            raise UsageError(f"changes are 0 or more, not {self.changes}")
        for name, rate in (("mistake", self.mistake_rate), ("wait", self.wait_rate)):
            if not 0 <= rate <= 1:
                raise UsageError(f"a {name} rate is a probability, not {rate}")
        if self.goals_per not in GOALS_PER:
            raise UsageError(f"goals are per {' or '.join(GOALS_PER)}, not '{self.goals_per}'")

    @classmethod
    def of(cls, **options: Unpack[SceneryOptions]) -> Scenery:
        """Return what episodes with these options are like.

        Raises:
            UsageError: if there is no such option, or its value is out of range.
        """
        names = [field.name for field in fields(cls)]
        if unknown := [name for name in options if name not in names]:
            hint = nearest(unknown[0], names) or f"options: {', '.join(names)}"
            raise UsageError(f"an environment has no option '{unknown[0]}'", hint=hint)
        return cls(**options)

    @property
    def habits(self) -> Habits:
        """How often goals change, and the rates of mistakes and waits."""
        return Habits(int(self.changes), self.mistake_rate, self.wait_rate)


def bank_for(domain: str | Bank, goals: str | None = None) -> Bank:
    """Return the bank of a domain's goals, from the cache if it is there; or the bank given.

    Raises:
        UsageError: if a goal has no plan or holds from the start, or human or robot is missing.
    """
    bank = domain if isinstance(domain, Bank) else cached_bank(read_goals(domain, goals))
    for mover in turns_of(bank).order:
        if not mover.agents:
            who = "human" if mover.is_human else "robot"
            raise UsageError(f"there is no {who} among the agents", code=f"no-{who}")
    for graph in bank.graphs:
        if not graph.n_steps:
            message = f"goal '{graph.goal}' has no plan, or holds from the start"
            raise UsageError(message, code="no-plan")
    return bank


class Move(NamedTuple):
    """Who acted, the step (None for a wait), and the goal that the humans wanted then."""

    mover: Mover
    step: int | None
    goal: int


class Rollout:
    """Episodes one after the other; each is carried out move by move.

    Args:
        bank: The plans.
        scenery: What the episodes are like.

    Attributes:
        turns: Whose turn it is, in what state, and how the episode has ended.
        moves: All moves of the episode.
    """

    def __init__(self, bank: Bank, scenery: Scenery) -> None:
        self.bank, self.scenery = bank, scenery
        world = WORLDS.make(scenery.world, bank)
        has_own_goals = scenery.goals_per == HUMAN and len(bank.humans) > 1
        self.own_turns = OwnGoalTurns(bank, world) if has_own_goals else None
        self.turns: EpisodeTurns = self.own_turns or turns_of(bank, world)
        self.movers = {mover.name: mover for mover in self.turns.order}
        self._human = HUMANS.find(scenery.human)
        self._observer = self._belief_of(scenery.belief) if scenery.belief else None
        if scenery.changes and len(bank.names) < 2:
            raise UsageError("a goal can only change where there are two", code="too-few-goals")
        self.moves: list[Move] = []

    @property
    def robot_names(self) -> list[str]:
        """The movers that are robots, in the order of their turns."""
        return [mover.name for mover in self.turns.order if not mover.is_human]

    @property
    def human_names(self) -> list[str]:
        """The movers that are humans, in the order of their turns."""
        return [mover.name for mover in self.turns.order if mover.is_human]

    def begin(self, random: np.random.Generator, options: Mapping[str, Any] | None) -> None:
        """Start an episode whose course is drawn, or given by the options of a reset.

        Raises:
            UsageError: if an option is not valid.
        """
        known = known_options(options, OPTIONS)
        self._start(self._courses(str(int(random.integers(1 << 62))), known))

    def begin_undecided(
        self, random: np.random.Generator, options: Mapping[str, Any] | None
    ) -> None:
        """Start an episode and let the humans move until a robot has to.

        Raises:
            UsageError: if the options are not valid, or humans reach the goal without a robot.
        """
        for _ in range(TRIES):
            self.begin(random, options)
            self.let_humans_move()
            if self.turns.ending is None:
                return
            if known_options(options, OPTIONS):
                break
        message = "the episode is over before the robot's first turn"
        raise UsageError(message, code="no-robot-turn", hint="take goals that need more steps")

    def _courses(self, seed: str, options: Mapping[str, Any]) -> dict[str, Course]:
        habits, course = self.scenery.habits, options.get("course")
        if self.own_turns is not None:
            if course is None and "goal" not in options:
                return draw_own_courses(self.bank, seed, habits)
            if not isinstance(course, Mapping) or set(course) != set(self.bank.humans):
                raise UsageError("humans with goals of their own need a course each")
            return dict(course)
        if course is None:
            course = draw_course(self.bank, seed, habits)
            if "goal" in options:
                goal = self.bank.goal_index(options["goal"])
                course = Course((goal,), (), *course_rates(course), seed)
        if not isinstance(course, Course):
            raise UsageError(f"a course is a hrcplan.Course, not {type(course).__name__}")
        return {"": course}

    def _start(self, courses: Mapping[str, Course]) -> None:
        self.moves, self.paid, bank = [], 0, self.bank
        if self.own_turns is not None:
            self.own_turns.begin_each(courses)
            self.humans: dict[str, EpisodeHuman] = {
                name: self._human(bank.for_human(name), course) for name, course in courses.items()
            }
        else:
            (course,) = courses.values()
            self.turns.begin(course)
            self.humans = dict.fromkeys(self.human_names, self._human(bank, course))
        if self._observer is not None:
            self._belief = self._observer.robot.start()

    def let_humans_move(self) -> None:
        """Let the simulated humans act until a robot has to, or the episode is over."""
        turns = self.turns
        while turns.ending is None and (mover := turns.mover).is_human:
            self.do(turns.human_move(self.humans[mover.name]).step)

    def do(self, step: int | None) -> None:
        """Let who acts now do a step, or wait.

        Raises:
            UsageError: if it cannot do the step.
        """
        turns = self.turns
        move = Move(turns.mover, step, turns.goal)
        turns.do(step)
        self.moves.append(move)
        if self._observer is not None:
            self._belief = self._observer.after(self._belief, move.mover, step)

    def reward(self) -> int:
        """Return minus the timesteps since the last call.

        Where the episode is stuck, those until its cap count too, so that the rewards of an episode
        sum to minus its cost in a study.
        """
        n_turns = self.turns.n_turns
        if self.turns.ending == STUCK:
            n_turns = max(n_turns, self.turns.cap)
        reward, self.paid = self.paid - n_turns, n_turns
        return reward

    @property
    def is_terminated(self) -> bool:
        """Whether the goal was reached, or no agent does anything any more."""
        return self.turns.ending in (REACHED, STUCK)

    @property
    def is_truncated(self) -> bool:
        """Whether the cap was reached."""
        return self.turns.ending == UNFINISHED

    def goal_of(self, mover: Mover) -> int:
        """Return what a human wants now."""
        if self.own_turns is not None:
            return self.own_turns.courses[mover.name].goal(self.turns.round)
        return self.turns.goal

    @property
    def goal_names(self) -> str:
        """What the humans want now; with goals of their own, in the order of their turns."""
        if self.own_turns is None:
            return self.bank.names[self.turns.goal]
        wanted = (self.goal_of(self.movers[name]) for name in self.human_names)
        return ", ".join(self.bank.names[goal] for goal in wanted)

    # The belief that a robot observes.

    def _belief_of(self, name: str) -> TurnObserver[Any]:
        if self.own_turns is None:
            return TurnObserver(METHODS.make(name, self.bank), self.turns)
        return PerHumanObserver(PerHuman(self.bank, lambda view: METHODS.make(name, view)))

    @property
    def n_probabilities(self) -> int:
        """The number of probabilities that a robot observes."""
        if self._observer is None:
            return 0
        n_humans = len(self.human_names) if self.own_turns is not None else 1
        return n_humans * len(self.bank.names)

    def probabilities(self) -> list[float]:
        """Return the probability of each goal; with goals of their own, human by human."""
        if self._observer is None:
            return []
        names = self.human_names if self.own_turns is not None else self.human_names[:1]
        posteriors = (self._observer.posterior(self._belief, self.movers[name]) for name in names)
        return [float(p) for posterior in posteriors for p in posterior]


def known_options(options: Mapping[str, Any] | None, names: Sequence[str]) -> Mapping[str, Any]:
    """Return the options of a reset that have a meaning; each other one gives a warning.

    They are no error, because wrappers and checkers pass options of their own.
    """
    for name in (name for name in options or {} if name not in names):
        hint = nearest(name, names) or (f"options: {', '.join(names)}" if names else "none exist")
        warnings.warn(f"reset ignores the option '{name}'; {hint}", UserWarning, stacklevel=5)
    return {name: value for name, value in (options or {}).items() if name in names}


def course_rates(course: Course) -> tuple[float, float]:
    """Return the rates of mistakes and waits of a course."""
    return course.mistake_rate, course.wait_rate
