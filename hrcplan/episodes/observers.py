"""What a robot observes of the turns of an episode: all humans as one, or each by itself."""

from __future__ import annotations

from typing import Generic

from hrcplan.assistance.assistant import inform
from hrcplan.assistance.per_human import PerHuman, PerHumanState
from hrcplan.core.arrays import Floats
from hrcplan.episodes.turns import EpisodeTurns, Mover, TeamTurns
from hrcplan.inference.belief import Belief, S, after_wait, n_declared


class TurnObserver(Generic[S]):
    """A belief or an assistant that observes turns; it does not matter which human acts.

    Args:
        robot: The belief or assistant.
        turns: The turns. A wait says something only where agents act one after the other.
    """

    def __init__(self, robot: Belief[S], turns: EpisodeTurns) -> None:
        self.robot, self._observes_waits = robot, isinstance(turns, TeamTurns)

    def after(self, state: S, mover: Mover, step: int | None) -> S:
        """Return the robot's state after a turn."""
        if step is not None:
            return self.robot.observe(state, step, robot=not mover.is_human)
        return after_wait(self.robot, state) if self._observes_waits else state

    def inform(self, state: S, mover: Mover, goal: int) -> S:
        """Return the robot's state after a turn of a human who wants ``goal``."""
        return inform(self.robot, state, goal)

    def posterior(self, state: S, mover: Mover) -> Floats:
        """Return how probable each goal is as that of a human."""
        return self.robot.posterior(state)

    def n_declared(self, state: S, mover: Mover) -> int:
        """Return how many changes of a human's goal were declared."""
        return n_declared(state)


class PerHumanObserver(TurnObserver[PerHumanState[S]], Generic[S]):
    """A robot that observes several humans who each have a goal of their own."""

    robot: PerHuman[S]

    def __init__(self, robot: PerHuman[S]) -> None:
        self.robot = robot

    def after(self, state: PerHumanState[S], mover: Mover, step: int | None) -> PerHumanState[S]:
        """Return the robot's state after a turn."""
        if step is None:
            return self.robot.observe_wait(state)
        if mover.is_human:
            return self.robot.observe_by(state, step, mover.name)
        return self.robot.observe(state, step, robot=True)

    def inform(self, state: PerHumanState[S], mover: Mover, goal: int) -> PerHumanState[S]:
        """Return the robot's state after a turn of a human who wants ``goal``."""
        return self.robot.inform_by(state, goal, mover.name)

    def posterior(self, state: PerHumanState[S], mover: Mover) -> Floats:
        """Return how probable each goal is as that of a human."""
        return self.robot.posterior_of(state, mover.name)

    def n_declared(self, state: PerHumanState[S], mover: Mover) -> int:
        """Return how many changes of a human's goal were declared."""
        return self.robot.n_declared_of(state, mover.name)
