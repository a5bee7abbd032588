"""Environments for learners: robot steps per second, the humans' turns and resets included."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from rows import Row, interleaved

from hrcplan.bank import Bank
from hrcplan.environments import make, make_vec
from hrcplan.environments.rollout import bank_for
from hrcplan.episodes.pddlgym_world import environment

SINGLE, VECTOR, OVER_GYM = 20_000, 300_000, 10
N_STEPS, N_ENVS, N_BATCHES, THEIRS_S = 2_000, 2_048, 10, 0.2
N_ROUNDS = 20  # short ones: the best of them is one that nothing else has slowed


def rows() -> Iterator[Row]:
    """Yield the rates of single environments and of many at once, and how they compare."""
    bank = bank_for("kitchen")
    runs: dict[str, Callable[[], float]] = {
        "passive": partial(_single, bank, _passive),
        "random": partial(_single, bank, _random),
        "vector": partial(_vector, bank),
    }
    if find_spec("pddlgym") is not None:
        runs["pddlgym"] = partial(_pddlgym, bank)
    rates = interleaved(runs, N_ROUNDS, max)
    for name, what in (("passive", "a robot that waits"), ("random", "a random robot")):
        rate, goal = rates[name], f">= {SINGLE:,} steps/s"
        measured = f"{rate:,.0f} robot steps/s"
        yield Row(f"kitchen, 30 goals, single, {what}", measured, "", goal, rate < SINGLE)
    rate, goal = rates["vector"], f">= {VECTOR:,} steps/s"
    measured, what = f"{rate:,.0f} robot steps/s", f"kitchen, 30 goals, {N_ENVS:,} in numpy"
    yield Row(what, measured, "the choice of random actions left out", goal, rate < VECTOR)
    if "pddlgym" in rates:
        ratio = rates["random"] / rates["pddlgym"]
        compared = (
            f"pddlgym: {rates['pddlgym']:,.0f} steps/s of one agent alone, ratio {ratio:,.0f}"
        )
        yield Row("kitchen, single", f"{rates['random']:,.0f} robot steps/s", compared,
                  f">= {OVER_GYM} x", ratio < OVER_GYM)  # fmt: skip


def _passive(mask: np.ndarray[Any, Any], chance: np.random.Generator) -> int:
    return 0


def _random(mask: np.ndarray[Any, Any], chance: np.random.Generator) -> int:
    able = mask.nonzero()[0]
    return int(able[int(chance.random() * len(able))])


def _single(bank: Bank, policy: Callable[[Any, np.random.Generator], int]) -> float:
    env, chance = make(bank), np.random.default_rng(1)
    _, info = env.reset(seed=1)
    start = time.process_time()
    for _ in range(N_STEPS):
        _, _, terminated, truncated, info = env.step(policy(info["action_mask"], chance))
        if terminated or truncated:
            _, info = env.reset()
    return N_STEPS / (time.process_time() - start)


def _vector(bank: Bank) -> float:
    envs, chance = _envs(bank), np.random.default_rng(1)
    _, infos = envs.reset(seed=1)
    total = 0.0
    for _ in range(N_BATCHES):
        mask = infos["action_mask"]
        actions = (chance.random(mask.shape, dtype=np.float32) * mask).argmax(axis=1)
        start = time.process_time()
        *_, infos = envs.step(actions)
        total += time.process_time() - start
    return N_ENVS * N_BATCHES / total


_ENVS: dict[int, Any] = {}


def _envs(bank: Bank) -> Any:
    """Return the environments; their tables are made once."""
    if id(bank) not in _ENVS:
        _ENVS[id(bank)] = make_vec(bank, num_envs=N_ENVS)
    return _ENVS[id(bank)]


def _pddlgym(bank: Bank) -> float:
    """Return the rate of pddlgym with one agent that acts at random: no human, no goal to infer."""
    world, chance, n_steps = environment(bank.goals.problem), np.random.default_rng(1), 0
    state = world.reset()[0]
    start = time.process_time()
    while time.process_time() < start + THEIRS_S:
        choices = sorted(world.action_space.all_ground_literals(state))
        state = world.step(choices[int(chance.random() * len(choices))])[0]
        n_steps += 1
    return n_steps / (time.process_time() - start)
