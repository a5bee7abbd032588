"""Collaboration as environments of Gymnasium and PettingZoo, for robots that learn.

`make` returns a Gymnasium environment: a robot against simulated humans. `make_vec` steps thousands
of them at once in numpy. `aec_env` and `parallel_env` are PettingZoo environments, in which the
humans learn, too. Importing this package registers ``hrcplan/Collaboration-v0`` in Gymnasium.

>>> import hrcplan
>>> env = hrcplan.environments.make("kitchen", goal_changes=1)
Traceback (most recent call last):
...
hrcplan.errors.UsageError: an environment has no option 'goal_changes'
>>> env = hrcplan.environments.make("kitchen", changes=1)
>>> observation, info = env.reset(seed=1)
>>> int(observation.sum()), int(info["action_mask"].sum())
(35, 39)
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Unpack

from hrcplan.bank import Bank
from hrcplan.core.extras import require
from hrcplan.environments.policies import AssistantPolicy as AssistantPolicy
from hrcplan.environments.policies import PolicyAssistant as PolicyAssistant
from hrcplan.environments.rollout import SceneryOptions

if TYPE_CHECKING:
    from pettingzoo import AECEnv

    from hrcplan.environments.collaboration import CollaborationEnv
    from hrcplan.environments.multi_agent import CollaborationParallelEnv
    from hrcplan.environments.vector import CollaborationVectorEnv

ENV_ID = "hrcplan/Collaboration-v0"
"""The name of the environment in Gymnasium."""


def make(
    domain: str | Bank = "kitchen", goals: str | None = None, *, render_mode: str | None = None,
    **scenery: Unpack[SceneryOptions],
) -> CollaborationEnv:  # fmt: skip
    """Return a Gymnasium environment: robots help simulated humans whose goal they have to infer.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        render_mode: ``ansi``: ``render`` returns text.
        scenery: What the episodes are like: ``human``, ``changes``, ``mistake_rate``,
            ``wait_rate``, ``goals_per``, ``world``, ``belief``.

    Raises:
        UsageError: if an option is not valid, or Gymnasium is not installed.
        InputError: if a file is missing or has faults.
    """
    require("gymnasium", "an environment")
    from hrcplan.environments.collaboration import CollaborationEnv

    return CollaborationEnv(domain, goals, render_mode=render_mode, **scenery)


def make_vec(
    domain: str | Bank = "kitchen", goals: str | None = None, *, num_envs: int = 1024,
    **scenery: Unpack[SceneryOptions],
) -> CollaborationVectorEnv:  # fmt: skip
    """Return many environments that are stepped at once, where it does not matter who acts.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        num_envs: How many there are.
        scenery: ``changes``, ``mistake_rate`` and ``wait_rate``; the humans are ``frontier``.

    Raises:
        UsageError: if an option is not valid, or Gymnasium is not installed.
        InputError: if a file is missing or has faults.
        UnsupportedError: if agents take turns in a team.
    """
    require("gymnasium", "an environment")
    from hrcplan.environments.vector import CollaborationVectorEnv

    return CollaborationVectorEnv(domain, goals, num_envs=num_envs, **scenery)


def aec_env(
    domain: str | Bank = "kitchen",
    goals: str | None = None,
    *,
    render_mode: str | None = None,
    **scenery: Unpack[SceneryOptions],
) -> AECEnv:
    """Return a PettingZoo environment in which humans and robots act one after the other.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        render_mode: ``ansi``: ``render`` returns text.
        scenery: What the episodes are like: ``changes``, ``goals_per``, ``world``, ``belief``.

    Raises:
        UsageError: if an option is not valid, or PettingZoo is not installed.
        InputError: if a file is missing or has faults.
    """
    require("pettingzoo", "an environment of several agents")
    from pettingzoo.utils.wrappers import OrderEnforcingWrapper

    from hrcplan.environments.multi_agent import CollaborationAECEnv

    env = CollaborationAECEnv(domain, goals, render_mode=render_mode, **scenery)
    return OrderEnforcingWrapper(env)


def parallel_env(
    domain: str | Bank = "kitchen", goals: str | None = None, *, render_mode: str | None = None,
    **scenery: Unpack[SceneryOptions],
) -> CollaborationParallelEnv:  # fmt: skip
    """Return a PettingZoo environment in which humans and robots choose at the same time.

    Args:
        domain: A path, a shipped name, or a bank.
        goals: A folder of goals; by default the domain's problems.
        render_mode: ``ansi``: ``render`` returns text.
        scenery: What the episodes are like: ``changes``, ``goals_per``, ``world``, ``belief``.

    Raises:
        UsageError: if an option is not valid, or PettingZoo is not installed.
        InputError: if a file is missing or has faults.
    """
    require("pettingzoo", "an environment of several agents")
    from hrcplan.environments.multi_agent import CollaborationParallelEnv

    return CollaborationParallelEnv(domain, goals, render_mode=render_mode, **scenery)


def _register() -> None:
    """Make the environment known to Gymnasium."""
    import gymnasium

    if ENV_ID not in gymnasium.registry:
        gymnasium.register(
            id=ENV_ID,
            entry_point="hrcplan.environments.collaboration:CollaborationEnv",
            vector_entry_point="hrcplan.environments.vector:CollaborationVectorEnv",
        )


if find_spec("gymnasium") is not None:
    _register()
