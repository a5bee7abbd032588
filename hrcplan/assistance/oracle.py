"""A robot that knows the human's goal: the bound that no other assistant can expect to beat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from zlib import crc32

import numpy as np

from hrcplan.assistance.assistant import BankAssistant
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats
from hrcplan.core.deprecation import Renamed
from hrcplan.inference.belief import IMPOSSIBLE


@dataclass(frozen=True, slots=True)
class OracleState:
    """The state of `Oracle`: the goals' progress, and the human's goal."""

    progress: Progress
    goal: int | None = None
    n_declared: int = 0
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world


class Oracle(BankAssistant[OracleState]):
    """Does a step that the human's goal has next; which one depends on the state alone."""

    def __init__(self, bank: Bank) -> None:
        super().__init__(bank)

    def start(self) -> OracleState:
        """Return the state before anything was done."""
        return OracleState(self.tracker.start)

    def inform(self, state: OracleState, goal: int) -> OracleState:
        """Return the state once the human's goal is known."""
        return replace(
            state, goal=goal, n_declared=state.n_declared + (state.goal not in (None, goal))
        )

    told = Renamed("inform")

    def observe(self, state: OracleState, step: int, *, robot: bool = False) -> OracleState:
        """Return the state after one more step."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, ignored=IMPOSSIBLE)
        return replace(state, progress=move[0], ignored=None)

    def observe_wait(self, state: OracleState) -> OracleState:
        """Return the state after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        return state if move is None else replace(state, progress=move[0])

    def posterior(self, state: OracleState) -> Floats:
        """Return certainty of the goal."""
        posterior = np.zeros(len(self.names))
        posterior[state.goal or 0] = 1.0
        return posterior

    def choose(self, state: OracleState) -> int | None:
        """Return a step that the goal has next and the robot can do; None if there is none."""
        choices = self.step_values.in_turn(state.progress)
        if choices is not None:
            steps = choices.next_steps(state.goal or 0)
            return steps[_spread(state.world) % len(steps)] if steps else None
        following = self.step_values.next_steps(state.progress)
        useful = set(following.steps[following.goals == state.goal].tolist())
        steps = [s for s in self.step_values.candidates(state.progress, following) if s in useful]
        return steps[_spread(state.world) % len(steps)] if steps else None


def _spread(world: int) -> int:
    """Return a pseudo-random number of a state: always the same for the same state."""
    return crc32(world.to_bytes(world.bit_length() // 8 + 1, "little"))
