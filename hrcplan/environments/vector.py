"""Many collaborations at once in numpy, for tasks in which it does not matter who acts."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Unpack

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from hrcplan.bank import Bank
from hrcplan.environments.batch_turns import (
    N_DRAWS,
    REACHED,
    RUNNING,
    STUCK,
    UNFINISHED,
    BatchRules,
    BatchTurns,
)
from hrcplan.environments.rollout import Scenery, SceneryOptions, bank_for, known_options
from hrcplan.errors import UnsupportedError, UsageError

BatchObservations = NDArray[np.int8]


class CollaborationVectorEnv(VectorEnv[BatchObservations, NDArray[np.int64], NDArray[Any]]):
    """Many `CollaborationEnv` side by side; the humans are ``frontier`` and share a goal.

    Spaces, rewards and endings are those of `CollaborationEnv`; random numbers are others, drawn
    for all environments at once. An environment whose episode is over starts the next one in the
    next step, whose action does not matter.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        num_envs: How many environments.
        scenery: ``changes``, ``mistake_rate`` and ``wait_rate``.

    Raises:
        UsageError: if an option is not valid.
        UnsupportedError: if agents take turns in a team: steps say who acts.
    """

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012

    def __init__(
        self, domain: str | Bank = "kitchen", goals: str | None = None, *, num_envs: int = 1024,
        **scenery: Unpack[SceneryOptions],
    ) -> None:  # fmt: skip
        if num_envs < 1:
            raise UsageError(f"there is at least one environment, not {num_envs}")
        bank, self.num_envs = bank_for(domain, goals), num_envs
        self._check(bank, Scenery.of(**scenery))
        self.rules = BatchRules(bank, Scenery.of(**scenery).habits)
        self.actions = self.rules.actions
        self.single_action_space = spaces.Discrete(self.actions.n_actions)
        n_facts = self.rules.simulator.n_facts
        self.single_observation_space = spaces.Box(0, 1, (n_facts,), np.int8)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.turns: BatchTurns | None = None

    def _check(self, bank: Bank, scenery: Scenery) -> None:
        """Refuse what is not stepped in numpy.

        Raises:
            UsageError: if an option is for single environments, or a goal takes one step.
            UnsupportedError: if steps say who acts.
        """
        hint = "hrcplan.environments.make has no such limits"
        for name in ("human", "goals_per", "world", "belief"):
            default = next(field.default for field in fields(Scenery) if field.name == name)
            if getattr(scenery, name) != default:
                message = f"environments in numpy have no option '{name}'"
                raise UsageError(message, hint=hint)
        if bank.agents != "dropped":
            message = f"{bank.goals.title}: steps say who acts, which is not stepped in numpy"
            raise UnsupportedError(message, hint=hint)
        if scenery.changes and len(bank.names) < 2:
            raise UsageError("a goal can only change where there are two", code="too-few-goals")
        if not scenery.changes and any(graph.n_steps < 2 for graph in bank.graphs):
            message = "a goal takes one step, so its episode is over before the robot's first turn"
            raise UsageError(message, code="no-robot-turn")

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[BatchObservations, dict[str, Any]]:
        """Start an episode in every environment.

        Args:
            seed: All that is random from now on follows from it.
            options: None; there are none.
        """
        known_options(options, ())
        super().reset(seed=seed)
        self.turns = self.rules.begin(self.num_envs, self.np_random)
        self._paid = np.zeros(self.num_envs, dtype=np.int64)
        self.rules.let_humans_act(self.turns, self._chances())
        return self._observations(self.turns), self._infos(self.turns)

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[BatchObservations, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Let the robots act, then the humans; ended episodes are followed by new ones.

        Raises:
            UsageError: if there is not one valid action for each environment, or no episode.
        """
        turns = self.turns
        if turns is None:
            raise UsageError("no episode has begun", code="episode-over", hint="call reset first")
        actions = self._checked(actions)
        over = turns.endings != RUNNING
        actions = np.where(self._mask[np.arange(self.num_envs), actions], actions, 0)
        self.rules.let_robots_act(turns, actions, ~over)
        self._begin_anew(turns, over)
        self.rules.let_humans_act(turns, self._chances())
        due = np.where(turns.endings == STUCK, np.maximum(turns.n_turns, turns.caps), turns.n_turns)
        rewards = np.where(over, 0, self._paid - due).astype(np.float64)
        self._paid = np.where(over, 0, due)
        is_terminated = (turns.endings == REACHED) | (turns.endings == STUCK)
        observations, infos = self._observations(turns), self._infos(turns)
        return observations, rewards, is_terminated, turns.endings == UNFINISHED, infos

    def _checked(self, actions: NDArray[np.int64]) -> NDArray[np.int64]:
        numbers = np.asarray(actions)
        n = self.actions.n_actions
        if numbers.shape != (self.num_envs,) or not np.issubdtype(numbers.dtype, np.integer):
            raise UsageError(f"{self.num_envs} environments take as many actions, as integers")
        if numbers.min() < 0 or numbers.max() >= n:
            raise UsageError(f"actions are numbers from 0 to {n - 1}", code="bad-action")
        return numbers.astype(np.int64)

    def _begin_anew(self, turns: BatchTurns, over: NDArray[np.bool_]) -> None:
        if not over.any():
            return
        fresh = self.rules.begin(int(over.sum()), self.np_random)
        for field in fields(BatchTurns):
            getattr(turns, field.name)[over] = getattr(fresh, field.name)

    def _chances(self) -> NDArray[np.float64]:
        return self.np_random.random((self.num_envs, N_DRAWS))

    def _observations(self, turns: BatchTurns) -> BatchObservations:
        return self.rules.simulator.facts(turns.states).view(np.int8)

    def _infos(self, turns: BatchTurns) -> dict[str, Any]:
        self._mask = self.rules.robot_mask(turns.states)
        self._mask[turns.endings != RUNNING, 1:] = False
        every = np.ones(self.num_envs, dtype=np.bool_)
        return {"action_mask": self._mask.astype(np.int8), "_action_mask": every}

    @property
    def goals(self) -> tuple[str, ...]:
        """The names of the goals that the humans want now: for evaluation, not for robots."""
        names = self.rules.bank.names
        return () if self.turns is None else tuple(names[goal] for goal in self.turns.goal)
