"""Episodes of several humans who each have goals of their own.

The humans act first, then the robots, each in the order of the problem's objects. A human has what
it wants once its last goal has held, at whatever moment; then it waits. The episode is over when
all humans have what they want, so goals that exclude each other can all be reached in turn.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from hrcplan.assistance.per_human import PerHuman, PerHumanState
from hrcplan.bank import Bank
from hrcplan.bank.team import turn_order
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment
from hrcplan.bank.turn_moves import team_moves
from hrcplan.core.arrays import Floats
from hrcplan.episodes.episode import (
    PATIENCE,
    REACHED,
    ROUNDS,
    STUCK,
    UNFINISHED,
    EpisodeRecord,
    EpisodeWatch,
    Play,
    SimulatedTurns,
    TurnWorld,
)
from hrcplan.episodes.humans import Course, EpisodeHuman, HumanMove, TakesTurns
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
    return _OwnGoals(bank, humans, robot, courses, world, watch).run()


class _OwnGoals(Play[PerHumanState[S]]):
    def __init__(
        self, bank: Bank, humans: Mapping[str, EpisodeHuman], robot: PerHuman[S],
        courses: Mapping[str, Course], world: TurnWorld | None,
        watch: EpisodeWatch[PerHumanState[S]] | None,
    ) -> None:  # fmt: skip
        first = bank.humans[0]
        super().__init__(
            bank, humans[first], robot, courses[first], world or SimulatedTurns(bank), watch
        )
        self.humans, self.courses, self.per_human = humans, courses, robot
        self.all_robots, self.order = self.robots, turn_order(bank.goals.problem)
        self.views = {human: bank.for_human(human) for human in bank.humans}
        self.moves = {human: team_moves(view) for human, view in self.views.items()}
        self.moment, self.lasts = Moment(), dict[str, int | None]()
        self.pending = dict.fromkeys(bank.humans)
        self.round = 0

    def run(self) -> EpisodeRecord:
        """Return the record."""
        most = self._most()
        turn, ending = 0, self._ending(0, most)
        while ending is None:
            ending = self._play_round(turn)
            turn += 1
            ending = ending or self._ending(turn, most)
        can = [self._can_reach(human, turn) for human in self.pending]
        decisions, record_turns = tuple(self.decisions_ms), tuple(self.turns)
        return EpisodeRecord(
            self.courses[self.bank.humans[0]], record_turns, ending, decisions, most,
            ending == REACHED or all(can), self.courses,
        )  # fmt: skip

    def _most(self) -> int:
        lengths = {human: own_lengths(view) for human, view in self.views.items()}
        costs = (lengths[human][goal] for human, c in self.courses.items() for goal in c.goals)
        return PATIENCE * int(sum(cost for cost in costs if cost < np.inf)) + len(self.order)

    def _can_reach(self, human: str, turn: int) -> bool:
        goal, moves = self.courses[human].goal(turn), self.moves[human]
        if moves is not None:
            return moves.can_reach(goal, self.state)
        return self.bank.locate(goal, self.state)[1] is not None

    def _play_round(self, turn: int) -> str | None:
        self.round = turn
        for agent in self.order:
            self.agent = agent
            self.robots = self.people = frozenset({agent})
            if agent in self.humans:
                self.human, self.course = self.humans[agent], self.courses[agent]
                self.last = self.lasts.get(agent)
                self._human(turn)
                self.lasts[agent] = self.last
            else:
                self._robot(turn)
            self._note_reached(turn)
            if not self.pending:
                return REACHED
        return None

    def _note_reached(self, turn: int) -> None:
        """Take note of the humans whose last goal holds."""
        for human in list(self.pending):
            course = self.courses[human]
            is_last = turn >= max(course.turns, default=0)
            if is_last and self.bank.goals.is_reached(course.goal(turn), self.state):
                del self.pending[human]

    def _ending(self, turn: int, most: int) -> str | None:
        self._note_reached(turn)
        if not self.pending:
            return REACHED
        last_change = max(max(course.turns, default=0) for course in self.courses.values())
        if turn > last_change and self.n_waits >= ROUNDS * len(self.order):
            return STUCK
        return UNFINISHED if len(self.turns) >= most else None

    def _move(self, turn: int) -> HumanMove:
        if self.agent not in self.pending:
            return HumanMove(None)
        if isinstance(self.human, TakesTurns):
            return self.human.move_in_turn(turn, self.state, self.last, self.moment)
        return self.human.move(turn, self.state, self.last)

    def _observe_human(self, step: int) -> None:
        self.belief = self.per_human.observe_by(self.belief, step, self.agent or "")

    def _observe_wait(self) -> None:
        self.belief = self.per_human.observe_wait(self.belief)

    def _inform(self, goal: int) -> None:
        self.belief = self.per_human.inform_by(self.belief, goal, self.agent or "")

    def _posterior(self) -> Floats:
        return self.per_human.posterior_of(self.belief, self.agent or "")

    def _n_declared(self) -> int:
        return self.per_human.n_declared_of(self.belief, self.agent or "")

    def _choice(self) -> int | None:
        return self.own_choice(super()._choice(), self.all_robots)

    def _do(self, step: int | None, goal: int, agents: frozenset[str]) -> bool:
        """Do a step; return whether it is next for the human who acts, or for any if a robot."""
        self.n_waits = self.n_waits + 1 if step is None else 0
        asking = [self.agent] if self.agent in self.humans else list(self.pending)
        is_needed = step is not None and any(
            self._is_next(step, human) for human in asking if human is not None
        )
        if step is not None:
            self.state = self.act(step, agents)
        moves = next(iter(self.moves.values()))
        self.moment = Moment() if moves is None else moves.after(self.moment, step)
        return is_needed

    def _is_next(self, step: int, human: str) -> bool:
        """Return whether a step is next for the present goal of a human."""
        goal, moves = self.courses[human].goal(self.round), self.moves[human]
        if moves is not None:
            return step in moves.choices(self.state, self.moment).next_steps(goal)
        graph, node = self.bank.locate(goal, self.state)
        return node is not None and step in graph.next(node)
