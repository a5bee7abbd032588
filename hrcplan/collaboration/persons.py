"""Who acts besides the robots: the contract, and simulated humans."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Protocol, runtime_checkable

from hrcplan.bank import Bank
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import PersonEvent
from hrcplan.collaboration.history import (
    BegunAction,
    EndedAction,
    History,
    PassedTurn,
    WantedGoal,
    actions_in,
)
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.episodes.episode import PATIENCE, ROUNDS
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove, TakesTurns
from hrcplan.execution import events as ev
from hrcplan.execution.links.messages import PersonSaid

YES_WORDS = ("yes", "y", "ja", "j")
NO_WORDS = ("no", "n", "nein")

NOBODY_CAN_HELP = "no agent can help the goal any more"


IDLE_S = 30.0  # without an event, after which people at a terminal or a page stand still
MOST_IDLE = 4  # times in a row that this is an event, each after twice as long as the one before


def idle_wait_s(run: CompanionRun, setup: CollaborationSetup) -> float | None:
    """Return for how many seconds people may think until they stand still; None for ever.

    Where turns are taken, or a question is open, waiting says nothing.
    """
    is_free = setup.pace != TURNS and not setup.has_one_goal
    if not is_free or run.question is not None or run.is_paused or run.running:
        return None
    last = itertools.takewhile(lambda mark: isinstance(mark, PassedTurn), reversed(run.history))
    n = sum(1 for _ in last) // len(setup.people)
    return IDLE_S * 2**n if n < MOST_IDLE else None


class Person(Protocol):
    """Acts for all people of a collaboration."""

    is_live: bool
    """Whether a person does what a plan asks for only when they say so."""

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return what these people do now; nothing if they do not act before something happens."""


@runtime_checkable
class Interruptible(Protocol):
    """A person at a terminal, whose decision ends without an action if something happens."""

    interrupt: Callable[[float], bool] | None
    """Waits for some seconds at most, and returns whether something has happened."""


class ReportedPerson:
    """People whose actions and words the robot's program reports; they never act otherwise."""

    is_live = True

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return nothing."""
        return ()


def reported_words(run: CompanionRun, t: float, report: PersonSaid) -> PersonEvent:
    """Return what words mean: an answer if a question is open, else words to be read."""
    words = report.text.strip().lower().rstrip(".!")
    question = run.question
    if question is not None:
        answers = {option.lower(): option for option in question.options}
        if question.question == shared.DONE:
            answers = dict.fromkeys(YES_WORDS, shared.YES) | dict.fromkeys(NO_WORDS, shared.NO)
        if words in answers:
            return shared.Answered(t, answers[words])
    return shared.Said(t, report.agent, report.text)


class CooperativePerson:
    """People who do what a plan asks for, and are content when its goal holds."""

    is_live = False

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return the answer to an open question; nothing else is done unasked."""
        return (shared.Answered(run.t, shared.YES),) if run.question is not None else ()


class SimulatedPerson:
    """A simulated human of turn-taking episodes, who acts for all people.

    Args:
        setup: The collaboration.
        bank: The plans.
        human: Chooses the steps.
        course: What is wanted and when.
        tells_goal: Whether the robot hears what is wanted after every move.
    """

    is_live = False

    def __init__(
        self, setup: CollaborationSetup, bank: Bank, human: EpisodeHuman, course: Course,
        tells_goal: bool = False,
    ) -> None:  # fmt: skip
        self.setup, self.bank, self.human, self.course = setup, bank, human, course
        self.tells_goal = tells_goal
        self._moves = team_moves(bank)
        costs = [float(bank.graphs[goal].optimal_cost or 0) for goal in course.goals]
        self._most = PATIENCE * int(sum(costs) + len(costs)) + len(setup.slots)
        self._tried: tuple[tuple[str, ...], History] | None = None

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return the answer to an open question, or the next move."""
        turn = self._turn(run)
        if run.question is not None:
            return (shared.Answered(run.t, self._answer(run, run.question, turn)),)
        why = self._why_stop(run)
        if why is not None:
            return (ev.StopAsked(run.t, why),)
        if self._tried == (agents, run.history):
            return ()  # it could not be begun
        self._tried = agents, run.history
        event = self._event(run, agents, self._move(run, agents, turn))
        goal = self.bank.names[self.course.goal(turn)]
        if not self.tells_goal or goal == _last_wanted(run.history):
            return (event,)
        return event, shared.Wanted(run.t, goal)

    def _turn(self, run: CompanionRun) -> int:
        if self.setup.pace == TURNS:
            return run.round
        own = (
            m for m in run.history
            if (isinstance(m, BegunAction) and not m.is_robot)
            or (isinstance(m, PassedTurn) and m.agent not in self.setup.robots)
        )  # fmt: skip
        return sum(1 for _ in own)

    def _answer(self, run: CompanionRun, question: shared.Ask, turn: int) -> str:
        """Return the true answer: whether that was all, or which goal is wanted now."""
        goal = self.bank.names[self.course.goal(turn)]
        is_option = goal in question.options
        if question.question == shared.GOAL:
            return goal if is_option else shared.OTHER
        is_last = turn >= max(self.course.turns, default=0)
        return shared.YES if is_last and is_option else shared.NO

    def _why_stop(self, run: CompanionRun) -> str | None:
        """Return why the episode ends: all agents wait, or it takes too long."""
        marks = [m for m in run.history if isinstance(m, BegunAction | PassedTurn)]
        least = ROUNDS * len(self.setup.slots)
        if len(marks) >= least and all(isinstance(m, PassedTurn) for m in marks[-least:]):
            return NOBODY_CAN_HELP
        return "it takes too long" if len(marks) > self._most else None

    def _move(self, run: CompanionRun, agents: tuple[str, ...], turn: int) -> HumanMove:
        world, moment = task_state_after(run.history, self.bank, self._moves)
        own = [a for a in actions_in(run.history) if a.agent in self._group(agents)]
        last = self.bank.table.find(own[-1].words) if own else None
        if self._moves is None or not isinstance(self.human, TakesTurns):
            return self.human.move(turn, world, last)
        if self.setup.pace != TURNS:
            moment = Moment(self.bank.team.index(agents[0]), moment.without_robot)
        return self.human.move_in_turn(turn, world, last, moment)

    def _group(self, agents: tuple[str, ...]) -> tuple[str, ...]:
        return agents if self._moves is not None else self.setup.people

    def _event(self, run: CompanionRun, agents: tuple[str, ...], move: HumanMove) -> PersonEvent:
        if move.step is None:
            return shared.Passed(run.t, agents[0])
        world, _ = task_state_after(run.history, self.bank, self._moves)
        table = self.bank.table
        action = table.doer(world, move.step, frozenset(agents))
        if action is None:
            return shared.Passed(run.t, agents[0])  # another person has to do it
        ground = table.task.actions[action]
        return shared.Begun(run.t, ground.agent or agents[0], ground.name, ground.args)


def _last_wanted(history: History) -> str | None:
    """Return the last goal that people said they have; None if they said none."""
    return next((m.goal for m in reversed(history) if isinstance(m, WantedGoal)), None)


def task_state_after(history: History, bank: Bank, moves: TeamMoves | None) -> tuple[int, Moment]:
    """Return the state of the task after a history, and whose turn it is; what runs is done."""
    outcomes = {m.number: m.outcome for m in history if isinstance(m, EndedAction)}
    table, world, moment = bank.table, bank.initial, Moment()
    for mark in history:
        if isinstance(mark, PassedTurn):
            moment = moment if moves is None else moves.after(moment, None)
        if not isinstance(mark, BegunAction):
            continue
        step = table.find(mark.words)
        if step is None:
            continue
        if outcomes.get(mark.number, ev.DONE) == ev.DONE:
            after = table.successor(world, step)
            world = world if after is None else after
        moment = moment if moves is None else moves.after(moment, step)
    return world, moment
