"""A collaboration as the record of an episode in turns, so that its guesses are measured alike."""

from __future__ import annotations

from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration.collaborate import CollaborationParts
from hrcplan.collaboration.history import BegunAction, History, PassedTurn, WantedGoal
from hrcplan.collaboration.persons import NOBODY_CAN_HELP, task_state_after
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS
from hrcplan.episodes.episode import REACHED, STUCK, UNFINISHED, EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course
from hrcplan.execution import events as ev
from hrcplan.inference.belief import n_declared


def ending_of(run: CompanionRun) -> str:
    """Return how a collaboration with a simulated human ended: as episodes in turns do."""
    if run.run.ending == ev.GOAL:
        return REACHED
    return STUCK if run.run.why == NOBODY_CAN_HELP else UNFINISHED


def record_of(run: CompanionRun, parts: CollaborationParts, course: Course) -> EpisodeRecord:
    """Return the record: one turn for each action that began, and for each wait of people.

    A guess is what the robot believes once an action of people has begun. Attempts count, also if
    they fail.
    """
    teller = _Teller(parts, course)
    history = run.history
    for place, mark in enumerate(history):
        if isinstance(mark, BegunAction):
            teller.add_action(mark, history[:place], _with_wanted(history, place))
        elif isinstance(mark, PassedTurn):
            teller.add_wait(mark)
    return EpisodeRecord(course, tuple(teller.turns), ending_of(run))


def _with_wanted(history: History, place: int) -> History:
    """Return a history up to a mark, with what people then said that they want."""
    end = place + 1
    while end < len(history) and isinstance(history[end], WantedGoal):
        end += 1
    return history[:end]


class _Teller:
    """Makes the turns of one collaboration."""

    def __init__(self, parts: CollaborationParts, course: Course) -> None:
        self.adviser, self.bank, self.setup = parts.adviser, parts.bank, parts.setup
        self.course = course
        self.moves: TeamMoves | None = team_moves(parts.bank)
        self.turns: list[EpisodeTurn] = []
        self.n_human = 0

    @property
    def goal(self) -> int:
        """What people want now."""
        n_people = len(self.setup.people) if self.setup.pace == TURNS and self.moves else 1
        return self.course.goal(self.n_human // n_people)

    def add_wait(self, mark: PassedTurn) -> None:
        """Add that an agent does nothing; that of a robot is no evidence, but a turn."""
        is_human = mark.agent not in self.setup.robots
        self.turns.append(EpisodeTurn(len(self.turns), is_human, None, self.goal, False))
        self.n_human += is_human

    def add_action(self, mark: BegunAction, before: History, after: History) -> None:
        """Add an action, with the robot's guess if it is one of people."""
        step = self.bank.table.find(mark.words)
        goal, t = self.goal, len(self.turns)
        is_needed = step is not None and self._is_needed(step, goal, mark.agent, before)
        if mark.is_robot:
            self.turns.append(EpisodeTurn(t, False, step, goal, is_needed))
            return
        self.n_human += 1
        state = self.adviser.fold.state(after)
        posterior = self.adviser.assistant.posterior(state)
        rank = int((posterior > posterior[goal]).sum())
        rank += int((posterior[:goal] == posterior[goal]).sum())
        self.turns.append(
            EpisodeTurn(
                t, True, step, goal, is_needed, False, int(posterior.argmax()), rank,
                n_declared(state),
            )
        )  # fmt: skip

    def _is_needed(self, step: int, goal: int, agent: str, before: History) -> bool:
        """Return whether a valid plan of a goal has a step next."""
        world, moment = task_state_after(before, self.bank, self.moves)
        if self.moves is None:
            graph, node = self.bank.locate(goal, world)
            return node is not None and step in graph.next(node)
        if self.setup.pace != TURNS:
            moment = Moment(self.bank.team.index(agent), moment.without_robot)
        return step in self.moves.choices(world, moment).next_steps(goal)
