"""A trace played again: the recorded robot with the instance's human, in our own world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.episodes.episode import EpisodeRecord, EpisodeTurn
from hrcplan.episodes.humans import Course
from hrcplan.episodes.traces import Beliefs, trace_of_episode
from hrcplan.errors import InputError, UsageError
from hrcplan.inference.traces import ActionTrace, TraceAction
from hrcplan.studies.changed_mind.episodes import play_shared
from hrcplan.studies.study import StudyOptions


@dataclass(frozen=True, slots=True)
class RecordedState:
    """The state of a `RecordedRobot`: what it declared; the rest follows from the timestep."""

    n_declared: int = 0
    world: int = 0
    ignored: str | None = None


class RecordedRobot:
    """Does and believes in each timestep what a trace says.

    Args:
        bank: The plans.
        trace: The trace.
        path: Its file, for messages.
    """

    def __init__(self, bank: Bank, trace: ActionTrace, path: str) -> None:
        self.bank, self.names, self.path = bank, bank.names, path
        assert trace.episode is not None
        self._timesteps = trace.episode.timesteps or 0
        self._by_timestep: dict[int, tuple[int, TraceAction]] = {}
        for line, action in enumerate(trace.actions, start=2):
            last = max(self._by_timestep, default=-1)
            if not (action.t.is_integer() and last < action.t < self._timesteps):
                self.fail("bad-time", f"timestep {action.t:g} is out of order", line)
            self._by_timestep[int(action.t)] = line, action
        self._now = 0

    def start(self) -> RecordedState:
        """Return the state before anything was done."""
        return RecordedState()

    def observe(self, state: RecordedState, step: int, *, robot: bool = False) -> RecordedState:
        """Return the state after one more step, done by the human or by the robot."""
        _, action = self._by_timestep.get(self._now, (0, None))
        declared = None if robot or action is None else action.declared
        return state if declared is None else RecordedState(declared)

    def posterior(self, state: RecordedState) -> Floats:
        """Return what the trace says that was believed after this action of a human."""
        line, action = self._by_timestep.get(self._now, (None, None))
        if action is None:  # `watch` will find a wait here
            return np.full(len(self.names), 1 / len(self.names))
        if action.posterior is None or action.declared is None:
            message = f"no posterior, or no declared, after the human's action in {self._place}"
            self.fail("no-posterior", message, line)
        return np.array(action.posterior)

    def choose(self, state: RecordedState) -> int | None:
        """Return what the trace says that the robot did in this timestep; None if it waited."""
        line, action = self._by_timestep.get(self._now, (None, None))
        if action is None:
            return None
        step = self.bank.table.find(action.words)
        if step is None:
            self.fail("unknown-step", f"there is no action ({' '.join(action.words)})", line)
        return step

    def watch(self, turn: EpisodeTurn) -> None:
        """Compare a turn with the trace, and go on to the next timestep."""
        line, action = self._by_timestep.get(turn.t, (None, None))
        step = None if action is None else self.bank.table.find(action.words)
        if turn.t >= self._timesteps:
            self.fail("cut-trace", f"the episode goes on after {self._timesteps} timesteps", None)
        if step != turn.step:
            is_by = "the instance's human" if turn.is_human else "the robot"
            does = "waits" if turn.step is None else f"does {self.bank.table[turn.step]}"
            noted = "a wait" if action is None else f"({' '.join(action.words)})"
            message = f"{is_by} {does} in {self._place}, but the trace has {noted}"
            self.fail("other-step", message, line)
        self._now = turn.t + 1

    @property
    def line(self) -> int | None:
        """The line of the trace that belongs to the present timestep; None for a wait."""
        return self._by_timestep.get(self._now, (None,))[0]

    @property
    def _place(self) -> str:
        return f"timestep {self._now}"

    def fail(self, code: str, message: str, line: int | None) -> NoReturn:
        """Refuse the trace.

        Raises:
            InputError: in any case.
        """
        raise InputError(message, code=code, path=self.path, line=line)


def replay(
    bank: Bank, trace: ActionTrace, options: StudyOptions, human: str, course: Course, path: str
) -> tuple[EpisodeRecord, Beliefs]:
    """Return the episode of a trace, played again, and what was believed in it.

    Args:
        bank: The plans.
        trace: The trace.
        options: Options of the changed-mind study: the task.
        human: The human.
        course: What the human wants and when.
        path: The file of the trace, for messages.

    Raises:
        InputError: if an action cannot be done, the human is another one, or the trace ends sooner
            or later than the episode.
    """
    robot, beliefs = RecordedRobot(bank, trace, path), Beliefs()
    try:
        record = play_shared(options, human, robot, course, beliefs, robot.watch)
    except UsageError as error:
        raise InputError(error.message, code=error.code, path=path, line=robot.line) from None
    assert trace.episode is not None
    if record.n_turns != trace.episode.timesteps:
        message = f"the episode ends after {record.n_turns} timesteps, which the trace does not"
        robot.fail("cut-trace", message, 1)
    replayed = trace_of_episode(bank, record, beliefs)
    for line, (one, other) in enumerate(zip(trace.actions, replayed.actions, strict=True), 2):
        if one != other:
            robot.fail("other-step", f"this action is {other.as_json()} when replayed", line)
    return record, beliefs
