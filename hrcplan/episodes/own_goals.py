"""Episodes of several humans who each have goals of their own.

The humans act first, then the robots, each in the order of the problem's objects. A human has what
it wants once its last goal has held, at whatever moment; then it waits. The episode is over when
all humans have what they want, so goals that exclude each other can all be reached in turn.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from hrcplan.assistance.per_human import PerHuman, PerHumanState
from hrcplan.bank import Bank
from hrcplan.bank.team import turn_order
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment
from hrcplan.bank.turn_moves import team_moves
from hrcplan.episodes.episode import EpisodeRecord, EpisodeWatch, Play
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove, TakesTurns
from hrcplan.episodes.observers import PerHumanObserver
from hrcplan.episodes.turns import PATIENCE, ROUNDS, EpisodeTurns, Mover, TurnWorld
from hrcplan.inference.belief import S


def own_lengths(bank: Bank) -> list[float]:
    """Return the timesteps to each goal of a bank of one human, from the initial state.

    The robots help, other humans do not; infinite if it is out of reach.

    Args:
        bank: The result of ``Bank.for_human``.
    """
    moves = team_moves(bank)
    if moves is None:
        return [float(graph.n_steps) if graph.n_nodes else np.inf for graph in bank.graphs]
    moment = Moment()
    while moves.is_other[moment.turn]:
        moment = moves.after(moment, None)
    least = moves.choices(bank.initial, moment).costs.min(axis=1)
    return [moment.turn + float(cost) if cost < OUT_OF_REACH else np.inf for cost in least]


def play_own_goals(
    bank: Bank, humans: Mapping[str, EpisodeHuman], robot: PerHuman[S],
    courses: Mapping[str, Course], world: TurnWorld | None = None,
    watch: EpisodeWatch[PerHumanState[S]] | None = None,
) -> EpisodeRecord:  # fmt: skip
    """Return the record of one episode: turns until every human has what it wants.

    Args:
        bank: The plans.
        humans: The humans; each was made from ``bank.for_human`` and its own course.
        robot: Helps them all.
        courses: What each human wants and when.
        world: Where it happens; by default as the PDDL says.
        watch: Is called with every turn.

    Raises:
        UsageError: as of `play`.
    """
    turns = OwnGoalTurns(bank, world)
    turns.begin_each(courses)
    observer = PerHumanObserver(robot)
    record = Play(turns, humans, robot, observer, watch, names_agents=True).run()
    return replace(record, course=courses[bank.humans[0]], courses=courses)


class OwnGoalTurns(EpisodeTurns):
    """The turns of agents one after the other, where each human has goals of its own.

    Attributes:
        courses: What each human wants and when; ``course`` is that of the human who acted last.
        pending: The humans who do not have yet what they want.
    """

    def __init__(self, bank: Bank, world: TurnWorld | None = None) -> None:
        super().__init__(bank, world)
        self.views = {human: bank.for_human(human) for human in bank.humans}
        self.moves = {human: team_moves(view) for human, view in self.views.items()}
        self._lengths = {human: own_lengths(view) for human, view in self.views.items()}

    def begin_each(self, courses: Mapping[str, Course]) -> None:
        """Start an episode in which each human follows a course of its own."""
        self.courses, self.moment = courses, Moment()
        self.pending = dict.fromkeys(self.bank.humans)
        super().begin(courses[self.bank.humans[0]])

    @property
    def goal(self) -> int:
        """The goal of the human who acts now; if it is a robot, of the one who acted last."""
        acts = self.mover.is_human
        return (self.courses[self.mover.name] if acts else self.course).goal(self.round)

    def human_move(self, human: EpisodeHuman) -> HumanMove:
        """Return what a human does in this turn."""
        if self.mover.name not in self.pending:
            return HumanMove(None)
        if isinstance(human, TakesTurns):
            return human.move_in_turn(self.round, self.state, self.last, self.moment)
        return human.move(self.round, self.state, self.last)

    def next_steps(self) -> set[int]:
        """Return the steps that are next for the human who acts, or for any human if a robot."""
        humans = [self.mover.name] if self.mover.is_human else list(self.pending)
        return {step for human in humans for step in self._next_steps(human)}

    def _next_steps(self, human: str) -> Iterable[int]:
        goal, moves = self.courses[human].goal(self.round), self.moves[human]
        if moves is not None:
            return moves.choices(self.state, self.moment).next_steps(goal)
        graph, node = self.bank.locate(goal, self.state)
        return () if node is None else graph.next(node)

    def can_reach(self) -> bool:
        """Return whether the humans who do not have what they want can still get it."""
        return all(map(self._can_reach, self.pending))

    def _can_reach(self, human: str) -> bool:
        goal, moves = self.courses[human].goal(self.round), self.moves[human]
        if moves is not None:
            return moves.can_reach(goal, self.state)
        return self.bank.locate(goal, self.state)[1] is not None

    def _order(self) -> tuple[Mover, ...]:
        agents, humans = turn_order(self.bank.goals.problem), self.bank.humans
        return tuple(Mover(frozenset({agent}), agent in humans) for agent in agents)

    def _cap(self) -> int:
        costs = (self._lengths[who][goal] for who, c in self.courses.items() for goal in c.goals)
        return PATIENCE * int(sum(cost for cost in costs if cost < np.inf)) + len(self.order)

    def _pass_on(self, step: int | None) -> None:
        if self.mover.is_human:
            self.course = self.courses[self.mover.name]
        moves = next(iter(self.moves.values()))
        self.moment = Moment() if moves is None else moves.after(self.moment, step)

    def _is_over(self) -> bool:
        for human in list(self.pending):
            course = self.courses[human]
            is_last = self.round >= max(course.turns, default=0)
            if is_last and self.bank.goals.is_reached(course.goal(self.round), self.state):
                del self.pending[human]
        return not self.pending

    def _change(self) -> int:
        return max(max(course.turns, default=0) for course in self.courses.values())

    def _is_stuck(self) -> bool:
        return self.n_waits >= ROUNDS * len(self.order)
