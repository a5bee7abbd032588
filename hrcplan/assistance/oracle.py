"""A robot that is told the human's goal: the bound that no other assistant can expect to beat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from zlib import crc32

import numpy as np

from hrcplan.assistance.step_values import StepValues
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.exact import IMPOSSIBLE


@dataclass(frozen=True, slots=True)
class OracleState:
    """The state of `Oracle`: where every goal stands, and the goal it was told."""

    track: Progress
    goal: int | None = None
    n_declared: int = 0
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.track.world


class Oracle:
    """Does a step that the human's goal has next; which one depends on the state alone."""

    def __init__(self, bank: Bank) -> None:
        self.bank, self.tracker = bank, ProgressTracker(bank)
        self.outlook = StepValues(self.tracker)

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.bank.names

    def start(self) -> OracleState:
        """Return the state before anything was done or told."""
        return OracleState(self.tracker.start)

    def told(self, state: OracleState, goal: int) -> OracleState:
        """Return the state once the human's goal is known."""
        return replace(
            state, goal=goal, n_declared=state.n_declared + (state.goal not in (None, goal))
        )

    def observe(self, state: OracleState, step: int, *, robot: bool = False) -> OracleState:
        """Return the state after one more step."""
        found = self.tracker.follow(state.track, step)
        if found is None:
            return replace(state, ignored=IMPOSSIBLE)
        return replace(state, track=found[0], ignored=None)

    def posterior(self, state: OracleState) -> Floats:
        """Return certainty of the goal."""
        found = np.zeros(len(self.names))
        found[state.goal or 0] = 1.0
        return found

    def choose(self, state: OracleState) -> int | None:
        """Return a step that the goal has next and the robot can do; None if there is none."""
        wanted = self.outlook.wanted(state.track)
        mine = set(wanted.steps[wanted.goals == state.goal].tolist())
        steps = [s for s in self.outlook.candidates(state.track, wanted) if s in mine]
        return steps[_spread(state.world) % len(steps)] if steps else None


def _spread(world: int) -> int:
    """Return a number that differs as if by chance between states, and is always the same."""
    return crc32(world.to_bytes(world.bit_length() // 8 + 1, "little"))
