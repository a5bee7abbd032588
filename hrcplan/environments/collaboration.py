"""The Gymnasium environment: a robot learns to help simulated humans whose goal it has to infer."""

from __future__ import annotations

from typing import Any, Unpack

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.environments.encoding import ActionEncoding, Bits, RobotObservations, as_bits
from hrcplan.environments.rendering import MODES, render
from hrcplan.environments.rollout import Rollout, Scenery, SceneryOptions, bank_for
from hrcplan.errors import UsageError

Observation = NDArray[Any]


class CollaborationEnv(gymnasium.Env[Observation, np.int64]):
    """Turns of simulated humans and robots; the action is the step of the robot whose turn it is.

    An observation is an array of zeros and ones: a fact of the task each, then, of several robots,
    which one acts. With a belief, the probability of each goal follows, and it is an array of
    floats. An action is a step of a robot; 0 waits, and so does what ``info["action_mask"]`` does
    not allow. The reward is minus the timesteps since the last action, those of the humans
    included; the first one also counts what humans did before it. An episode is terminated when the
    last goal of the humans holds. It is also terminated if no agent does anything any more: then
    the reward counts all timesteps until the cap. At the cap it is truncated.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        render_mode: ``ansi``: ``render`` returns text.
        scenery: The attributes of `Scenery`: what the humans are like, and what the robot observes.

    Attributes:
        rollout: The episode, with all its moves.
        actions: What the actions do.
        observations: What the bits of an observation mean.

    Raises:
        UsageError: if an option is not valid.
    """

    metadata = {"render_modes": list(MODES), "render_fps": 1}  # noqa: RUF012  (as in the base)

    def __init__(
        self, domain: str | Bank = "kitchen", goals: str | None = None, *,
        render_mode: str | None = None, **scenery: Unpack[SceneryOptions],
    ) -> None:  # fmt: skip
        if render_mode is not None and render_mode not in MODES:
            raise UsageError(f"the render mode is {' or '.join(MODES)}, not '{render_mode}'")
        self.render_mode = render_mode
        bank = bank_for(domain, goals)
        self.rollout = Rollout(bank, Scenery.of(**scenery))
        robots = [self.rollout.movers[name] for name in self.rollout.robot_names]
        self.actions = ActionEncoding(bank, frozenset().union(*(r.agents for r in robots)))
        self.observations = RobotObservations(bank, robots, self.rollout.n_probabilities)
        self.action_space: spaces.Discrete = spaces.Discrete(self.actions.n_actions)
        self.observation_space = spaces.Box(
            0, 1, (self.observations.size,), self.observations.dtype
        )
        self._able = 1

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start an episode; return the first observation of a robot, and an info.

        Args:
            seed: All that is random from now on follows from it.
            options: ``goal``, the name of the goal that the humans keep; or ``course``, a
                ``hrcplan.Course``, or one for each human by name if they have goals of their own.

        Raises:
            UsageError: if an option is not valid.
        """
        super().reset(seed=seed)
        self.rollout.begin_undecided(self.np_random, options)
        return self._observation(), self._info()

    def step(self, action: np.int64 | int) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Let the robot whose turn it is act, then the humans, until a robot has to act again.

        Raises:
            UsageError: if there is no such action, or the episode is over.
        """
        rollout = self.rollout
        if rollout.turns.ending is not None:
            raise UsageError("the episode is over", code="episode-over", hint="call reset first")
        number = self.actions.valid(action)
        is_able = bool(self._able >> number & 1)
        rollout.do(self.actions.step(number) if is_able else None)
        rollout.let_humans_move()
        observation, info = self._observation(), self._info()
        if not is_able:
            info["invalid_action"] = True
        return (
            observation, float(rollout.reward()), rollout.is_terminated, rollout.is_truncated, info
        )  # fmt: skip

    def render(self) -> str | None:
        """Return the episode so far as text, if the render mode is ``ansi``."""
        return None if self.render_mode is None else render(self.rollout)

    def action_masks(self) -> Bits:
        """Return which actions can be done now: the name by which some learners ask for it."""
        return as_bits(self._able, self.actions.n_actions)

    def _observation(self) -> Observation:
        rollout = self.rollout
        return self.observations.encode(
            rollout.turns.state, rollout.turns.mover, rollout.probabilities()
        )

    def _info(self) -> dict[str, Any]:
        turns = self.rollout.turns
        is_over = turns.ending is not None
        self._able = 1 if is_over else self.actions.able(turns.state, turns.mover.agents)
        info: dict[str, Any] = {
            "action_mask": self.action_masks(),
            "goal": self.rollout.goal_names,
            "timestep": turns.n_turns,
        }
        if is_over:
            info["ending"] = turns.ending
        return info
