"""A collaboration as the record of an episode in turns, so that its guesses are measured alike."""

from __future__ import annotations

from typing import Any

from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import CollaborationParts
from hrcplan.collaboration.events import Begun, SharedCommand, SharedEvent, Wanted
from hrcplan.collaboration.history import BegunAction, EndedAction, History, PassedTurn
from hrcplan.collaboration.persons import NOBODY_CAN_HELP, task_state_after
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS
from hrcplan.core.arrays import Floats
from hrcplan.episodes.episode import REACHED, STUCK, UNFINISHED, EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course
from hrcplan.execution import events as ev
from hrcplan.execution.codec import to_json
from hrcplan.execution.traces import trace_of
from hrcplan.inference.belief import n_declared
from hrcplan.inference.traces import ActionTrace
from hrcplan.pddl.model import Problem


def ending_of(run: CompanionRun) -> str:
    """Return how a collaboration with a simulated human ended: as episodes in turns do."""
    if run.run.ending == ev.GOAL:
        return REACHED
    return STUCK if run.run.why == NOBODY_CAN_HELP else UNFINISHED


class GuessLog:
    """Watches a collaboration: what the robot believes once each action of people has begun."""

    def __init__(self, adviser: Adviser) -> None:
        self.adviser = adviser
        self.by_number: dict[int, tuple[Floats, int]] = {}
        self._steps: list[tuple[SharedEvent, tuple[SharedCommand, ...]]] = []

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Note the belief after an action of people, and after they have said what they want."""
        self._steps.append((event, commands))
        if isinstance(event, Begun | Wanted) and (last := run.last_reported) is not None:
            state = self.adviser.fold.state(run.history)
            posterior = self.adviser.assistant.posterior(state)
            self.by_number[last.number] = posterior, n_declared(state)

    def trace(self, problem: Problem) -> ActionTrace:
        """Return what was done, with what was noted of each action."""
        beliefs = {
            number: (tuple(posterior.tolist()), n_known)
            for number, (posterior, n_known) in self.by_number.items()
        }
        lines: list[dict[str, Any]] = [{}]
        for event, commands in self._steps:
            decided = [to_json(one) for one in commands if isinstance(one, ev.Dispatch)]
            lines += [{"event": to_json(event)}, {"decided": decided}]
        return trace_of(lines, problem, beliefs)


def record_of(
    run: CompanionRun, parts: CollaborationParts, course: Course, log: GuessLog
) -> EpisodeRecord:
    """Return the record: one turn for each action that began, and for each wait of people.

    Attempts count, also if they fail.
    """
    teller = _Teller(parts, course, log)
    for place, mark in enumerate(run.history):
        if isinstance(mark, BegunAction):
            teller.add_action(mark)
        elif isinstance(mark, PassedTurn):
            teller.add_wait(mark)
        if not isinstance(mark, EndedAction) or mark.outcome != ev.DONE:
            teller.see(run.history[: place + 1])
    return EpisodeRecord(course, tuple(teller.turns), ending_of(run))


class _Teller:
    """Makes the turns of one collaboration."""

    def __init__(self, parts: CollaborationParts, course: Course, log: GuessLog) -> None:
        self.bank, self.setup, self.log = parts.bank, parts.setup, log
        self.course = course
        self.moves: TeamMoves | None = team_moves(parts.bank)
        self.turns: list[EpisodeTurn] = []
        self.n_human = 0
        self.see(())

    def see(self, history: History) -> None:
        """Take in where the task is after a history."""
        self.world, self.moment = task_state_after(history, self.bank, self.moves)

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

    def add_action(self, mark: BegunAction) -> None:
        """Add an action, with the robot's guess if it is one of people."""
        step = self.bank.table.find(mark.words)
        goal, t = self.goal, len(self.turns)
        is_needed = step is not None and self._is_needed(step, goal, mark.agent)
        self.n_human += not mark.is_robot
        if mark.number not in self.log.by_number:
            self.turns.append(EpisodeTurn(t, not mark.is_robot, step, goal, is_needed))
            return
        posterior, n_known = self.log.by_number[mark.number]
        rank = int((posterior > posterior[goal]).sum())
        rank += int((posterior[:goal] == posterior[goal]).sum())
        self.turns.append(
            EpisodeTurn(
                t, True, step, goal, is_needed, False, int(posterior.argmax()), rank,
                n_known,
            )
        )  # fmt: skip

    def _is_needed(self, step: int, goal: int, agent: str) -> bool:
        """Return whether a valid plan of a goal has a step next."""
        world, moment = self.world, self.moment
        if self.moves is None:
            graph, node = self.bank.locate(goal, world)
            return node is not None and step in graph.next(node)
        if self.setup.pace != TURNS:
            moment = Moment(self.bank.team.index(agent), moment.without_robot)
        return step in self.moves.choices(world, moment).next_steps(goal)
