"""The turns of an episode: the human acts first, then the robot; they do not talk.

Time is counted in turns: every action of either agent takes one timestep, and so does waiting.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, SupportsIndex, runtime_checkable

import numpy as np

from hrcplan.assistance.assistant import Assistant, inform
from hrcplan.bank import Bank, StepTable
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.core.arrays import Floats
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove, TakesTurns
from hrcplan.errors import UsageError
from hrcplan.inference.belief import S, after_wait, n_declared
from hrcplan.pddl.conventions import robots

PATIENCE = 4  # an episode ends after that many times the steps that its goals need

NEAR = 1e-6  # to what probabilities sum to

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
    moves = team_moves(bank)
    world = world or SimulatedTurns(bank)
    if moves is None:
        return Play(bank, human, robot, course, world, watch).run()
    return _TeamPlay(bank, human, robot, course, world, watch, moves).run()


class Play(Generic[S]):
    """One episode as it happens; subclasses say whose turn it is, and what a robot hears."""

    def __init__(
        self, bank: Bank, human: EpisodeHuman, robot: Assistant[S], course: Course,
        world: TurnWorld, watch: EpisodeWatch[S] | None,
    ) -> None:  # fmt: skip
        self.bank, self.human, self.robot = bank, human, robot
        self.course, self.world, self.watch = course, world, watch
        self.robots = robots(bank.goals.problem)
        self.people = frozenset(bank.goals.problem.agents) - self.robots
        self.state, self.belief = world.begin(), robot.start()
        self.turns: list[EpisodeTurn] = []
        self.decisions_ms: list[float] = []
        self.last: int | None = None
        self.n_waits = 0
        self.agent: str | None = None

    def run(self) -> EpisodeRecord:
        """Return the record."""
        lengths = [self.bank.graphs[goal].n_steps for goal in self.course.goals]
        most = PATIENCE * sum(lengths) + len(lengths)
        turn = 0
        while (ending := self._ending(turn, most)) is None:
            self._human(turn)
            if self._is_over(turn):
                ending = REACHED
                break
            self._robot(turn)
            turn += 1
        goal = self.course.goal(turn)
        is_reachable = ending == REACHED or self.bank.locate(goal, self.state)[1] is not None
        decisions = tuple(self.decisions_ms)
        return EpisodeRecord(self.course, tuple(self.turns), ending, decisions, most, is_reachable)

    def _ending(self, turn: int, most: int) -> str | None:
        """Return how an episode has ended before a turn of the human; None if it goes on."""
        if self._is_over(turn):
            return REACHED
        # Both may wait by choice, and go on afterwards.
        is_last = turn > max(self.course.turns, default=0)
        if is_last and self.n_waits > 1 and not self._can_help(turn):
            return STUCK
        return UNFINISHED if len(self.turns) >= most else None

    def _can_help(self, turn: int) -> bool:
        """Return whether the human can do a step that its goal has next."""
        graph, node = self.bank.locate(self.course.goal(turn), self.state)
        steps = graph.next(node) if node is not None else ()
        return any(True for _ in self.bank.table.able(self.state, steps, self.people))

    def _is_over(self, turn: int) -> bool:
        goal = self.course.goal(turn)
        is_last = turn >= max(self.course.turns, default=0)
        return is_last and self.bank.goals.is_reached(goal, self.state)

    def _move(self, turn: int) -> HumanMove:
        return self.human.move(turn, self.state, self.last)

    def _observe_wait(self) -> None:
        """A wait says nothing where it is not known whose turn it is."""

    def _human(self, turn: int) -> None:
        goal = self.course.goal(turn)
        move = self._move(turn)
        is_needed = self._do(move.step, goal, self.people)
        if move.step is not None:
            self.last = move.step
            self._observe_human(move.step)
        else:
            self._observe_wait()
        self._inform(goal)
        if move.step is None:
            self._note(EpisodeTurn(len(self.turns), True, None, goal, False, round=turn))
            return
        posterior = _checked(self._posterior(), len(self.bank.names))
        likelier = posterior > posterior[goal]
        rank = int(likelier.sum() + (posterior[:goal] == posterior[goal]).sum())
        self._note(
            EpisodeTurn(
                len(self.turns), True, move.step, goal, is_needed, move.is_mistake,
                int(posterior.argmax()), rank, self._n_declared(), turn,
            )
        )  # fmt: skip

    def _observe_human(self, step: int) -> None:
        self.belief = self.robot.observe(self.belief, step)

    def _inform(self, goal: int) -> None:
        self.belief = inform(self.robot, self.belief, goal)

    def _posterior(self) -> Floats:
        return self.robot.posterior(self.belief)

    def _n_declared(self) -> int:
        return n_declared(self.belief)

    def _choice(self) -> int | None:
        return self.robot.choose(self.belief)

    def _robot(self, turn: int) -> None:
        goal, began = self.course.goal(turn), time.perf_counter()
        step = self._choice()
        self.decisions_ms.append((time.perf_counter() - began) * 1e3)
        is_needed = self._do(step, goal, self.robots)
        if step is not None:
            self.belief = self.robot.observe(self.belief, step, robot=True)
        else:
            self._observe_wait()
        self._note(EpisodeTurn(len(self.turns), False, step, goal, is_needed, round=turn))

    def _do(self, step: int | None, goal: int, agents: frozenset[str]) -> bool:
        """Do a step in the world; return whether it is next in a valid plan of a goal."""
        self.n_waits = self.n_waits + 1 if step is None else 0
        if step is None:
            return False
        graph, node = self.bank.locate(goal, self.state)
        self.state = self.act(step, agents)
        return node is not None and step in graph.next(node)

    def act(self, step: int, agents: frozenset[str]) -> int:
        """Return the state after a step that one of the agents does."""
        return self.world.do(self.state, _action(self.bank.table, self.state, step, agents))

    def own_choice(self, step: int | None, robots: frozenset[str]) -> int | None:
        """Return the step of the robot whose turn it is; None if another robot has to do it."""
        if not isinstance(step, int | np.integer) or not 0 <= step < len(self.bank.table):
            return step
        is_others = self.bank.table.doer(self.state, int(step), robots - self.robots)
        can = self.bank.table.doer(self.state, int(step), self.robots)
        return None if can is None and is_others is not None else step

    def _note(self, turn: EpisodeTurn) -> None:
        turn = turn if self.agent is None else replace(turn, agent=self.agent)
        self.turns.append(turn)
        if self.watch is not None:
            self.watch(turn, self.belief)


ROUNDS = 3  # of nothing but waits, after which a team is stuck


class _TeamPlay(Play[S]):
    """The same with any number of humans and robots, in the order of the team's turns.

    All humans have the same goals and are moved by one ``human``; ``robot`` moves all robots.
    """

    def __init__(
        self, bank: Bank, human: EpisodeHuman, robot: Assistant[S], course: Course,
        world: TurnWorld, watch: EpisodeWatch[S] | None, moves: TeamMoves,
    ) -> None:  # fmt: skip
        super().__init__(bank, human, robot, course, world, watch)
        self.moves, self.moment = moves, Moment()
        self.all_robots, self.lasts = self.robots, dict[str, int | None]()

    def run(self) -> EpisodeRecord:
        """Return the record."""
        costs = [self.bank.graphs[goal].optimal_cost or 0 for goal in self.course.goals]
        n_turns = len(self.moves.is_robot)
        most = PATIENCE * int(sum(costs)) * (n_turns if self.bank.is_solo else 1) + n_turns
        turn, ending = 0, self._ending(0, most)
        while ending is None:
            ending = self._round(turn)
            turn += 1
            ending = ending or self._ending(turn, most)
        goal = self.course.goal(turn)
        is_reachable = ending == REACHED or self.moves.can_reach(goal, self.state)
        decisions = tuple(self.decisions_ms)
        return EpisodeRecord(self.course, tuple(self.turns), ending, decisions, most, is_reachable)

    def _round(self, turn: int) -> str | None:
        for agent, is_robot in zip(self.bank.team, self.moves.is_robot, strict=True):
            self.robots = self.people = frozenset({agent})
            self.last = self.lasts.get(agent)
            if is_robot:
                self._robot(turn)
            else:
                self._human(turn)
                self.lasts[agent] = self.last
            if self._is_over(turn):
                return REACHED
        return None

    def _ending(self, turn: int, most: int) -> str | None:
        if self._is_over(turn):
            return REACHED
        is_last = turn > max(self.course.turns, default=0)
        if is_last and self.n_waits >= ROUNDS * len(self.bank.team):
            return STUCK
        return UNFINISHED if len(self.turns) >= most else None

    def _move(self, turn: int) -> HumanMove:
        if isinstance(self.human, TakesTurns):
            return self.human.move_in_turn(turn, self.state, self.last, self.moment)
        return self.human.move(turn, self.state, self.last)

    def _choice(self) -> int | None:
        """Return the step of the robot whose turn it is; None if another robot has to do it."""
        return self.own_choice(super()._choice(), self.all_robots)

    def _observe_wait(self) -> None:
        self.belief = after_wait(self.robot, self.belief)

    def _do(self, step: int | None, goal: int, agents: frozenset[str]) -> bool:
        """Do a step in the world; return whether it loses the team no time."""
        self.n_waits = self.n_waits + 1 if step is None else 0
        is_needed = False
        if step is not None:
            is_needed = step in self.moves.choices(self.state, self.moment).next_steps(goal)
            self.state = self.act(step, agents)
        self.moment = self.moves.after(self.moment, step)
        return is_needed


def _action(table: StepTable, state: int, step: SupportsIndex, agents: frozenset[str]) -> int:
    if not isinstance(step, int | np.integer) or not 0 <= step < len(table):
        raise UsageError(f"{step!r} is no step", code="bad-step")
    action = table.doer(state, int(step), agents)
    if action is None:
        who = " or ".join(sorted(agents)) or "any agent"
        raise UsageError(f"{table[int(step)]} cannot be done by {who} here", code="bad-step")
    return action


def _checked(posterior: Floats, n_goals: int) -> Floats:
    """Return the posterior of a robot, which must have a probability for each goal."""
    answer = np.asarray(posterior, dtype=object)
    try:
        numbers: Floats = answer.astype(np.float64)
    except (TypeError, ValueError):
        numbers = np.zeros(0)
    is_one = numbers.shape == (n_goals,) and (numbers >= 0).all()
    if not is_one or abs(numbers.sum() - 1) > NEAR:
        raise UsageError(f"{answer} is no probability for each goal", code="bad-posterior")
    return numbers
