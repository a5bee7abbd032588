"""Simulated humans: they have goals, change them, make mistakes, and wait.

All random decisions of a human are derived from a `Course`, which is drawn before the first step.
So every robot meets the same human, and differences between robots are paired.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, runtime_checkable

from hrcplan.bank import Bank, PlanGraph
from hrcplan.bank.htn import Htn, decompose
from hrcplan.bank.team_moves import Moment
from hrcplan.bank.turn_moves import team_moves
from hrcplan.bank.walk import shortest
from hrcplan.core.registry import Registry
from hrcplan.pddl.conventions import people

MAX_NETWORKS = 256  # that are remembered


@dataclass(frozen=True, slots=True)
class Course:
    """The goals of a human over time, and the seed of its random decisions.

    Attributes:
        goals: The goals, in the order in which they are wanted.
        turns: The human's turn (from 0) at which each goal but the first begins to be wanted.
        mistake_rate: The probability that an action is one that the goal does not need.
        wait_rate: The probability of doing nothing in a turn.
        seed: From which the chances of every turn are derived.
    """

    goals: tuple[int, ...]
    turns: tuple[int, ...] = ()
    mistake_rate: float = 0.0
    wait_rate: float = 0.0
    seed: str = ""

    def goal(self, turn: int) -> int:
        """Return the goal that is wanted in a turn."""
        if not self.turns:
            return self.goals[0]
        return self.goals[sum(turn >= change for change in self.turns)]


@dataclass(frozen=True, slots=True)
class HumanMove:
    """What a human does in a turn: a step, or None to wait; and whether it is a mistake."""

    step: int | None
    is_mistake: bool = False


@runtime_checkable
class EpisodeHuman(Protocol):
    """A human who takes turns with a robot; made from a bank and a course."""

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return what the human does in a turn, in a state, after its own last step."""
        ...


@runtime_checkable
class TakesTurns(Protocol):
    """A human, or several with the same goals, who take turns in a team."""

    def move_in_turn(self, turn: int, world: int, last: int | None, moment: Moment) -> HumanMove:
        """Return what the human does whose turn it is; see ``EpisodeHuman.move``."""
        ...


Draw = Callable[[], float]
"""The next random number of a turn, in [0, 1)."""


class Frontier:
    """A human who takes any step that a valid plan of its goal has next, all alike.

    In a team it takes any step that loses the team no time. If only waiting loses none, it waits;
    but if no robot has acted since its last turn, it does the best step without the robots.

    Args:
        bank: The plans.
        course: What is wanted and when.

    Attributes:
        needs_graph: Whether ``choose`` looks at the plans of the goal.
    """

    needs_graph = False

    def __init__(self, bank: Bank, course: Course) -> None:
        self.bank, self.course = bank, course
        self._doers = people(bank.goals.problem) if bank.human is None else {bank.human}
        self._moves = team_moves(bank)

    def move_in_turn(self, turn: int, world: int, last: int | None, moment: Moment) -> HumanMove:
        """Return what the human does whose turn it is."""
        if self._moves is None:
            return self.move(turn, world, last)
        course, place = self.course, f"/{moment.turn}" if moment.turn else ""
        draw = _draws(course.seed + place, turn)
        if draw() < course.wait_rate:
            return HumanMove(None)
        goal, errs = course.goal(turn), draw() < course.mistake_rate
        choices = self._moves.choices(world, moment)
        steps = choices.next_steps(goal)
        useful = self.bank.graphs[goal].used_steps.union(steps)
        wrong = [step for step in choices.steps.tolist() if step not in useful] if errs else []
        if wrong:
            return HumanMove(wrong[int(draw() * len(wrong))], is_mistake=True)
        if not steps:
            return HumanMove(None)
        return HumanMove(self._choice(goal, world, moment, steps, last, draw))

    def _choice(
        self, goal: int, world: int, moment: Moment, steps: Sequence[int], last: int | None,
        draw: Draw,
    ) -> int:  # fmt: skip
        """Return one of the next steps; all alike if they are not in the plans of the goal."""
        if self.needs_graph and self._moves is not None:
            graph, node = self._moves.locate(goal, world, moment.turn)
            if node is not None and graph.next(node).keys() >= set(steps):
                return self.choose(graph, node, steps, last, draw)
        return self.prefer(steps, last, draw)

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return what the human does in a turn, in a state, after its own last step."""
        if self._moves is not None:
            return self.move_in_turn(turn, world, last, Moment())
        course, draw = self.course, _draws(self.course.seed, turn)
        if draw() < course.wait_rate:
            return HumanMove(None)
        goal, errs = course.goal(turn), draw() < course.mistake_rate
        graph, node = self.bank.locate(goal, world)
        if errs and (wrong := self._useless(graph, world)):
            return HumanMove(wrong[int(draw() * len(wrong))], is_mistake=True)
        steps = [] if node is None else list(self._able(world, graph.next(node)))
        if node is None or not steps:
            return HumanMove(None)
        return HumanMove(self.choose(graph, node, steps, last, draw))

    def choose(
        self, graph: PlanGraph, node: int, steps: Sequence[int], last: int | None, draw: Draw
    ) -> int:
        """Return one of ``steps``, which follow ``node`` in the plans of a goal.

        Args:
            graph: The plans of the goal.
            node: Where they stand.
            steps: Those of the next steps that the human can do, in order.
            last: The human's last step.
            draw: Gives random numbers.
        """
        return self.prefer(steps, last, draw)

    def prefer(self, steps: Sequence[int], last: int | None, draw: Draw) -> int:
        """Return one of ``steps`` without regard to the plans that they belong to."""
        return steps[int(draw() * len(steps))]

    def _able(self, world: int, steps: Sequence[int] | dict[int, int]) -> list[int]:
        return list(self.bank.table.able(world, steps, self._doers))

    def _useless(self, graph: PlanGraph, world: int) -> list[int]:
        useful = graph.used_steps
        can = self.bank.table.applicable(world)
        return self._able(world, [step for step in can if step not in useful])


class ByPlans(Frontier):
    """A human who follows any valid plan, all plans alike: steps with more plans are likelier."""

    needs_graph = True

    def choose(
        self, graph: PlanGraph, node: int, steps: Sequence[int], last: int | None, draw: Draw
    ) -> int:
        """Return a step in proportion to the plans that go on with it."""
        counts = [graph.plans_from(graph.next(node)[step]) for step in steps]
        rest = draw() * sum(counts)
        for step, count in zip(steps, counts, strict=True):
            rest -= count
            if rest < 0:
                return step
        return steps[-1]


class CliqueChain(Frontier):
    """A human who works through a network of chains and cliques, and finishes what it has begun.

    The model of the changed-mind paper (IV-B). The network is derived from the plans of the goal,
    and orders some steps that plans leave open; steps of the robot may deviate from this order.
    """

    needs_graph = True

    def choose(
        self, graph: PlanGraph, node: int, steps: Sequence[int], last: int | None, draw: Draw
    ) -> int:
        """Return the step that the network allows next; any other if the human cannot do that."""
        rest = [step for step, _ in shortest(graph, node)]
        choice = _network(graph).choose(rest, last, lambda n: int(draw() * n))
        if choice is None or choice not in steps:
            return super().choose(graph, node, steps, last, draw)
        return choice


class Scripted(Frontier):
    """A human who does given steps first, in order, and then goes on with any valid plan.

    A step that is done already is left out; one that cannot be done yet lets the next ones pass.

    Args:
        bank: The plans.
        course: What is wanted and when.
        steps: The steps, as ids of the bank's table.
    """

    def __init__(self, bank: Bank, course: Course, steps: Sequence[int]) -> None:
        super().__init__(bank, course)
        self.steps = tuple(steps)

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return the next step of the script that can be done, else what follows in a plan."""
        able = self._able(world, self.steps)
        return HumanMove(able[0]) if able else super().move(turn, world, last)

    def move_in_turn(self, turn: int, world: int, last: int | None, moment: Moment) -> HumanMove:
        """Return the next step of the script that can be done, else what follows in a plan."""
        doer = frozenset(self.bank.team[moment.turn : moment.turn + 1])
        able = list(self.bank.table.able(world, self.steps, doer))
        return HumanMove(able[0]) if able else super().move_in_turn(turn, world, last, moment)


@lru_cache(maxsize=MAX_NETWORKS)
def _network(graph: PlanGraph) -> Htn:
    return decompose(graph)


def _draws(seed: str, turn: int) -> Draw:
    """Return the random numbers of a turn: whether to wait or err, and what to choose."""
    return random.Random(f"{seed}/{turn}").random


HUMANS: Registry[[Bank, Course], EpisodeHuman] = Registry(
    "human",
    {
        "frontier": "hrcplan.episodes.humans:Frontier",
        "cc-htn": "hrcplan.episodes.humans:CliqueChain",
        "plans": "hrcplan.episodes.humans:ByPlans",
        "habit": "hrcplan.episodes.choosers:Habit",
        "inertia": "hrcplan.episodes.choosers:Inertia",
        "general-first": "hrcplan.episodes.choosers:GeneralFirst",
        "special-first": "hrcplan.episodes.choosers:SpecialFirst",
        "noisy-rational": "hrcplan.episodes.choosers:NoisyRational",
    },
    "hrcplan.humans",
    EpisodeHuman,
)
