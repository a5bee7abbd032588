"""A belief that watches an episode of another robot: the robot acts, the belief is asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic

from hrcplan.assistance.assistant import Assistant
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import Belief, BeliefState, S, after_wait, n_declared


@dataclass(frozen=True, slots=True)
class WatcherState(Generic[S]):
    """The state of a `Watcher`: that of the robot that acts, and that of the belief."""

    robot: BeliefState
    belief: S

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.robot.world

    @property
    def ignored(self) -> str | None:
        """Why the last observation had no effect on the posterior; None if it had one."""
        return self.belief.ignored

    @property
    def n_declared(self) -> int:
        """How many changes of goal the belief has declared."""
        return n_declared(self.belief)


class Watcher(Generic[S]):
    """Chooses what a robot chooses, and believes what a belief believes.

    Args:
        robot: The robot.
        belief: The belief; it has no part in what is done.
    """

    def __init__(self, robot: Assistant[Any], belief: Belief[S]) -> None:
        self.robot, self.belief, self.names = robot, belief, belief.names

    def start(self) -> WatcherState[S]:
        """Return the state before anything was done."""
        return WatcherState(self.robot.start(), self.belief.start())

    def observe(self, state: WatcherState[S], step: int, *, robot: bool = False) -> WatcherState[S]:
        """Return the state after one more step, done by the human or by the robot."""
        return WatcherState(
            self.robot.observe(state.robot, step, robot=robot),
            self.belief.observe(state.belief, step, robot=robot),
        )

    def observe_wait(self, state: WatcherState[S]) -> WatcherState[S]:
        """Return the state after a wait of the agent whose turn it is."""
        belief: S = after_wait(self.belief, state.belief)
        return WatcherState(after_wait(self.robot, state.robot), belief)

    def posterior(self, state: WatcherState[S]) -> Floats:
        """Return what the belief believes."""
        return self.belief.posterior(state.belief)

    def choose(self, state: WatcherState[S]) -> int | None:
        """Return what the robot chooses."""
        return self.robot.choose(state.robot)
