"""Whose turn it is in an episode, what a step does, and when the episode is over.

These are the rules alone: who chooses the steps is no matter of theirs. `hrcplan.episodes.episode`
lets a simulated human and an assistant play by them, `hrcplan.environments` anything that learns.
"""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, SupportsIndex, runtime_checkable

import numpy as np

from hrcplan.bank import Bank, StepTable
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove, TakesTurns
from hrcplan.errors import UsageError
from hrcplan.pddl.conventions import robots

PATIENCE = 4  # an episode ends after that many times the steps that its goals need
ROUNDS = 3  # of nothing but waits, after which a team is stuck

REACHED, STUCK, UNFINISHED = "reached", "stuck", "unfinished"


@runtime_checkable
class TurnWorld(Protocol):
    """Where steps are carried out; a state is the bits of the task."""

    def begin(self) -> int:
        """Return the initial state; called at the start of every episode."""
        ...

    def do(self, state: int, action: int) -> int:
        """Return the state after a ground action of the task, given by its index."""
        ...


class SimulatedTurns:
    """The world as the PDDL says."""

    def __init__(self, bank: Bank) -> None:
        self._task = bank.goals.task

    def begin(self) -> int:
        """Return the initial state."""
        return self._task.initial

    def do(self, state: int, action: int) -> int:
        """Return the state after a ground action."""
        return self._task.successor(state, action)


@dataclass(frozen=True)
class Mover:
    """Who acts in a turn: an agent, or any of several agents where steps do not say who."""

    agents: frozenset[str]
    is_human: bool

    @cached_property
    def name(self) -> str:
        """The agents' names, with + between."""
        return "+".join(sorted(self.agents))


class EpisodeTurns:
    """The turns of an episode: the humans act, then the robots; each turn takes a timestep.

    This class is for tasks in which it does not matter who acts. All humans share one goal.

    Args:
        bank: The plans; they decide what is needed.
        world: Where steps are carried out; by default as the PDDL says.

    Attributes:
        order: Who acts, in the order of the turns of a round.
        state: The state of the task, as bits.
        round: How many rounds are over.
        place: Whose turn it is, as an index of ``order``.
        n_turns: How many turns are over.
        n_waits: How many turns in a row were waits.
        cap: The number of turns after which an episode ends at the latest, but for its last round.
        ending: How the episode has ended: `REACHED`, `STUCK` or `UNFINISHED`; None before.
    """

    order: tuple[Mover, ...]
    course: Course
    state: int
    cap: int

    def __init__(self, bank: Bank, world: TurnWorld | None = None) -> None:
        self.bank, self.world = bank, world or SimulatedTurns(bank)
        self.order = self._order()
        self.ending: str | None = REACHED

    def begin(self, course: Course) -> None:
        """Start an episode in which the humans follow a course."""
        self.course = course
        self._last_change = self._change()
        self.state = self.world.begin()
        self.round = self.place = self.n_turns = self.n_waits = 0
        self.lasts: dict[int, int] = {}
        self.cap = self._cap()
        self.ending = self._ending()

    @property
    def mover(self) -> Mover:
        """Who acts now."""
        return self.order[self.place]

    @property
    def goal(self) -> int:
        """The goal that the humans want now."""
        return self.course.goal(self.round)

    @property
    def last(self) -> int | None:
        """The last step of who acts now; None before the first."""
        return self.lasts.get(self.place)

    def human_move(self, human: EpisodeHuman) -> HumanMove:
        """Return what a human does in this turn."""
        return human.move(self.round, self.state, self.last)

    def next_steps(self) -> Container[int]:
        """Return the steps that valid plans of the humans' goal have next."""
        graph, node = self.bank.locate(self.goal, self.state)
        return () if node is None else graph.next(node)

    def do(self, step: int | None) -> None:
        """Do a step, or wait, and go on to the next turn.

        Raises:
            UsageError: if there is no such step, or the agents who act now cannot do it.
        """
        if step is None:
            self.n_waits += 1
        else:
            agents = self.order[self.place].agents
            action = _action(self.bank.table, self.state, step, agents)
            self.state = self.world.do(self.state, action)
            self.lasts[self.place] = int(step)
            self.n_waits = 0
        self._pass_on(step)
        self.n_turns += 1
        if self._is_over():
            self.ending = REACHED
            return
        self.place += 1
        if self.place == len(self.order):
            self.place, self.round = 0, self.round + 1
            self.ending = self._ending()

    def can_reach(self) -> bool:
        """Return whether the last goal can still be reached."""
        return self.bank.locate(self.goal, self.state)[1] is not None

    def _order(self) -> tuple[Mover, ...]:
        problem = self.bank.goals.problem
        helpers = robots(problem)
        return Mover(frozenset(problem.agents) - helpers, True), Mover(helpers, False)

    def _cap(self) -> int:
        lengths = [self.bank.graphs[goal].n_steps for goal in self.course.goals]
        return PATIENCE * sum(lengths) + len(lengths)

    def _pass_on(self, step: int | None) -> None:
        """Take in that a turn is over."""

    def _is_over(self) -> bool:
        is_last = self.round >= self._last_change
        return is_last and self.bank.goals.is_reached(self.goal, self.state)

    def _change(self) -> int:
        """Return the round of the last change of a goal; 0 without one."""
        return max(self.course.turns, default=0)

    def _ending(self) -> str | None:
        """Return how the episode has ended before a round; None if it goes on."""
        if self.round <= self._last_change and self._is_over():  # else it was seen after the turn
            return REACHED
        if self.round > self._last_change and self._is_stuck():
            return STUCK
        return UNFINISHED if self.n_turns >= self.cap else None

    def _is_stuck(self) -> bool:
        if self.n_waits <= 1:
            return False
        # Both may wait by choice, and go on afterwards.
        graph, node = self.bank.locate(self.goal, self.state)
        steps = graph.next(node) if node is not None else ()
        people = self.order[0].agents
        return not any(True for _ in self.bank.table.able(self.state, steps, people))


class TeamTurns(EpisodeTurns):
    """The turns of a team: agents act one after the other, the humans first.

    Args:
        bank: The plans of the team.
        moves: What its agents do.
        world: Where steps are carried out; by default as the PDDL says.
    """

    def __init__(self, bank: Bank, moves: TeamMoves, world: TurnWorld | None = None) -> None:
        self.moves = moves
        super().__init__(bank, world)

    def begin(self, course: Course) -> None:
        """Start an episode in which the humans follow a course."""
        self.moment = Moment()
        super().begin(course)

    def human_move(self, human: EpisodeHuman) -> HumanMove:
        """Return what a human does in this turn."""
        if isinstance(human, TakesTurns):
            return human.move_in_turn(self.round, self.state, self.last, self.moment)
        return human.move(self.round, self.state, self.last)

    def next_steps(self) -> Container[int]:
        """Return the steps with which who acts now loses the team no time."""
        return self.moves.choices(self.state, self.moment).next_steps(self.goal)

    def can_reach(self) -> bool:
        """Return whether the last goal can still be reached."""
        return self.moves.can_reach(self.goal, self.state)

    def _order(self) -> tuple[Mover, ...]:
        pairs = zip(self.bank.team, self.moves.is_robot, strict=True)
        return tuple(Mover(frozenset({agent}), not is_robot) for agent, is_robot in pairs)

    def _cap(self) -> int:
        costs = sum(int(self.bank.graphs[g].optimal_cost or 0) for g in self.course.goals)
        n_turns = len(self.order)
        return PATIENCE * costs * (n_turns if self.bank.is_solo else 1) + n_turns

    def _pass_on(self, step: int | None) -> None:
        self.moment = self.moves.after(self.moment, step)

    def _is_stuck(self) -> bool:
        return self.n_waits >= ROUNDS * len(self.order)


def turns_of(bank: Bank, world: TurnWorld | None = None) -> EpisodeTurns:
    """Return the turns of episodes with the plans of a bank, whose humans share one goal."""
    moves = team_moves(bank)
    return EpisodeTurns(bank, world) if moves is None else TeamTurns(bank, moves, world)


def _action(table: StepTable, state: int, step: SupportsIndex, agents: frozenset[str]) -> int:
    if not isinstance(step, int | np.integer) or not 0 <= step < len(table):
        raise UsageError(f"{step!r} is no step", code="bad-step")
    action = table.doer(state, int(step), agents)
    if action is None:
        who = " or ".join(sorted(agents)) or "any agent"
        raise UsageError(f"{table[int(step)]} cannot be done by {who} here", code="bad-step")
    return action
