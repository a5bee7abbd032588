"""The PettingZoo environments: humans and robots are agents that act by policies of their own."""

from __future__ import annotations

from typing import Any, SupportsIndex, Unpack

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import AECEnv, ParallelEnv

from hrcplan.bank import Bank
from hrcplan.environments.encoding import (
    ActionEncoding,
    ObservationEncoding,
    RobotObservations,
    as_bits,
)
from hrcplan.environments.rendering import MODES, render
from hrcplan.environments.rollout import Rollout, Scenery, SceneryOptions, bank_for
from hrcplan.episodes.turns import Mover
from hrcplan.errors import UsageError

AgentObservation = dict[str, NDArray[Any]]


class _Team:
    """What both environments share: the agents, their spaces, and what each observes.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        render_mode: ``ansi``: ``render`` returns text.
        scenery: The attributes of `Scenery`, but for those of simulated humans.
    """

    def __init__(
        self, domain: str | Bank, goals: str | None, render_mode: str | None,
        scenery: SceneryOptions,
    ) -> None:  # fmt: skip
        if render_mode is not None and render_mode not in MODES:
            raise UsageError(f"the render mode is {' or '.join(MODES)}, not '{render_mode}'")
        if simulated := {"human", "mistake_rate", "wait_rate"}.intersection(scenery):
            message = f"humans are agents here, so there is no {', '.join(sorted(simulated))}"
            raise UsageError(message, hint="hrcplan.environments.make simulates the humans")
        bank = bank_for(domain, goals)
        self.rollout = Rollout(bank, Scenery.of(**scenery))
        self.movers = self.rollout.movers
        self.names = list(self.movers)
        self.actions = {name: ActionEncoding(bank, m.agents) for name, m in self.movers.items()}
        wants = [f"wants {goal}" for goal in bank.names]
        self._of_human = ObservationEncoding(bank, wants)
        self._of_robot = {
            name: RobotObservations(bank, [self.movers[name]], self.rollout.n_probabilities)
            for name in self.rollout.robot_names
        }
        self.observation_spaces = {name: self._space(name) for name in self.names}
        self.action_spaces = {
            name: spaces.Discrete(actions.n_actions) for name, actions in self.actions.items()
        }
        self.random, _ = seeding.np_random()

    def encoding(self, name: str) -> ObservationEncoding:
        """Return what the numbers of an agent's observations mean."""
        return self._of_human if self.movers[name].is_human else self._of_robot[name]

    def _space(self, name: str) -> spaces.Dict:
        encoding = self.encoding(name)
        return spaces.Dict(
            {
                "observation": spaces.Box(0, 1, (encoding.size,), encoding.dtype),
                "action_mask": spaces.Box(0, 1, (self.actions[name].n_actions,), np.int8),
            }
        )

    def begin(self, seed: int | None, options: dict[str, Any] | None) -> None:
        """Start an episode."""
        if seed is not None:
            self.random, _ = seeding.np_random(seed)
        self.rollout.begin(self.random, options)

    def observation(self, name: str, *, acts: bool) -> AgentObservation:
        """Return what an agent observes; the mask allows steps only if it ``acts`` now."""
        mover, state = self.movers[name], self.rollout.turns.state
        if mover.is_human:
            wants = np.zeros(len(self.rollout.bank.names))
            wants[self.rollout.goal_of(mover)] = 1
            observation = self._of_human.of(state, wants)
        else:
            observation = self._of_robot[name].encode(state, mover, self.rollout.probabilities())
        return {"observation": observation, "action_mask": self.mask(mover, acts=acts)}

    def mask(self, mover: Mover, *, acts: bool) -> NDArray[np.int8]:
        """Return which actions an agent can do; waiting alone if it does not act now."""
        actions = self.actions[mover.name]
        if not acts:
            return as_bits(1, actions.n_actions)
        return actions.mask(self.rollout.turns.state, mover.agents)

    def do(self, action: SupportsIndex) -> None:
        """Let the agent whose turn it is do an action; it waits if it cannot do it."""
        mover = self.rollout.turns.mover
        actions = self.actions[mover.name]
        number = actions.valid(action)
        can = actions.able(self.rollout.turns.state, mover.agents) >> number & 1
        self.rollout.do(actions.step(number) if can else None)

    def info(self, name: str) -> dict[str, Any]:
        """Return what a human wants, and how the episode has ended."""
        mover, ending = self.movers[name], self.rollout.turns.ending
        info: dict[str, Any] = {} if ending is None else {"ending": ending}
        if mover.is_human:
            info["goal"] = self.rollout.bank.names[self.rollout.goal_of(mover)]
        return info

    def state(self) -> NDArray[Any]:
        """Return the facts as bits."""
        return as_bits(self.rollout.turns.state, len(self.rollout.bank.goals.task.facts))


class _Spaces:
    """What both classes of PettingZoo are made of: the agents and their spaces."""

    def __init__(
        self, domain: str | Bank = "kitchen", goals: str | None = None, *,
        render_mode: str | None = None, **scenery: Unpack[SceneryOptions],
    ) -> None:  # fmt: skip
        super().__init__()
        self.team = _Team(domain, goals, render_mode, scenery)
        self.render_mode = render_mode
        self.possible_agents = list(self.team.names)
        self.agents: list[str] = []
        self.observation_spaces = self.team.observation_spaces
        self.action_spaces = self.team.action_spaces

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's actions."""
        return self.action_spaces[agent]

    def state(self) -> NDArray[Any]:
        """Return the facts as bits."""
        return self.team.state()

    def render(self) -> str | None:
        """Return the episode so far as text, if the render mode is ``ansi``."""
        return None if self.render_mode is None else render(self.team.rollout)


class CollaborationAECEnv(_Spaces, AECEnv):  # type: ignore[misc]
    """Humans and robots act one after the other, the humans first.

    An observation holds ``observation`` and ``action_mask``. A human also observes its goal. All
    agents get the same reward: minus a timestep for each turn, and if the episode is stuck, those
    until its cap. An action that the mask does not allow is a wait.
    """

    metadata = {  # noqa: RUF012  (as in the base)
        "name": "collaboration_v0", "render_modes": list(MODES), "render_fps": 1,
        "is_parallelizable": False,
    }  # fmt: skip

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        """Start an episode; options as of ``CollaborationEnv.reset``."""
        self.team.begin(seed, options)
        self.agents = list(self.possible_agents)
        self.rewards = dict.fromkeys(self.agents, 0.0)
        self._cumulative_rewards = dict.fromkeys(self.agents, 0.0)
        self._skip_agent_selection = None
        self._take_turn()

    def step(self, action: SupportsIndex | None) -> None:
        """Let the selected agent act; None once it is terminated or truncated."""
        agent = self.agent_selection
        if action is None or self.terminations[agent] or self.truncations[agent]:
            self._was_dead_step(action)
            return
        self._cumulative_rewards[agent] = 0.0
        self.team.do(action)
        self.rewards = dict.fromkeys(self.agents, float(self.team.rollout.reward()))
        self._take_turn()
        self._accumulate_rewards()
        self._deads_step_first()

    def _take_turn(self) -> None:
        rollout = self.team.rollout
        self.agent_selection = rollout.turns.mover.name
        self.terminations = dict.fromkeys(self.agents, rollout.is_terminated)
        self.truncations = dict.fromkeys(self.agents, rollout.is_truncated)
        self.infos = {name: self.team.info(name) for name in self.agents}

    def observe(self, agent: str) -> AgentObservation:
        """Return what an agent observes now."""
        turns = self.team.rollout.turns
        acts = turns.ending is None and turns.mover.name == agent
        return self.team.observation(agent, acts=acts)


class CollaborationParallelEnv(_Spaces, ParallelEnv):  # type: ignore[misc]
    """Humans and robots choose at the same time; a step is a round in which each acts once.

    The actions of a round are carried out in the order of the turns, the humans first; one that
    cannot be done any more when its turn comes is a wait. Observations are as of
    `CollaborationAECEnv`. All agents get the same reward: minus a timestep for each turn.
    """

    metadata = {  # noqa: RUF012  (as in the base)
        "name": "collaboration_v0", "render_modes": list(MODES), "render_fps": 1,
    }  # fmt: skip

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, AgentObservation], dict[str, dict[str, Any]]]:
        """Start an episode; options as of ``CollaborationEnv.reset``."""
        self.team.begin(seed, options)
        self.agents = list(self.possible_agents)
        return self._observations(), {name: self.team.info(name) for name in self.agents}

    def step(
        self, actions: dict[str, SupportsIndex]
    ) -> tuple[
        dict[str, AgentObservation], dict[str, float], dict[str, bool], dict[str, bool],
        dict[str, dict[str, Any]],
    ]:  # fmt: skip
        """Let each agent act once, in the order of the turns.

        Raises:
            UsageError: if an agent has no action, or the episode is over.
        """
        if not self.agents:
            raise UsageError("the episode is over", code="episode-over", hint="call reset first")
        if absent := [name for name in self.agents if name not in actions]:
            raise UsageError(f"there is no action of {', '.join(absent)}", code="bad-action")
        rollout, names = self.team.rollout, self.agents
        for name in names:
            if rollout.turns.ending is None:
                self.team.do(actions[name])
        rewards = dict.fromkeys(names, float(rollout.reward()))
        terminations = dict.fromkeys(names, rollout.is_terminated)
        truncations = dict.fromkeys(names, rollout.is_truncated)
        observations = self._observations()
        infos = {name: self.team.info(name) for name in names}
        if rollout.turns.ending is not None:
            self.agents = []
        return observations, rewards, terminations, truncations, infos

    def _observations(self) -> dict[str, AgentObservation]:
        acts = self.team.rollout.turns.ending is None
        return {name: self.team.observation(name, acts=acts) for name in self.agents}
