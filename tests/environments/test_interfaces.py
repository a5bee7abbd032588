"""The checkers of Gymnasium and PettingZoo, seeds, and what users can do wrong."""

import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import api_test, parallel_api_test, parallel_seed_test, seed_test

import hrcplan
from hrcplan.bank import build
from hrcplan.core.extras import EXTRA_OF
from hrcplan.environments import aec_env, make, make_vec, parallel_env
from hrcplan.errors import UnsupportedError, UsageError
from tests.test_extras import without

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("belief", [None, "exact"])
def test_gymnasium(bank, belief):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*not having a spec.*")
        check_env(make(bank, changes=1, belief=belief, render_mode="ansi"))


def test_gymnasium_by_name(tmp_path):
    for name in ("parfait-nut", "smoothie-berry"):
        shutil.copy(ROOT / "problems" / "kitchen" / f"{name}.pddl", tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("hrcplan/Collaboration-v0", domain="kitchen", goals=str(tmp_path))
        check_env(env.unwrapped)
        many = gymnasium.make_vec(
            "hrcplan/Collaboration-v0", 3, domain="kitchen", goals=str(tmp_path), changes=1
        )
        assert many.reset(seed=0)[0].shape == (3, *env.observation_space.shape)


def test_pettingzoo(bank):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # names without numbers, observations with masks
        api_test(aec_env(bank, changes=1), num_cycles=60)
        parallel_api_test(parallel_env(bank), num_cycles=40)


def test_pettingzoo_seeds(kitchen, transport):
    for bank in (kitchen, transport):
        seed_test(lambda bank=bank: aec_env(bank, changes=1), num_cycles=30)
        parallel_seed_test(lambda bank=bank: parallel_env(bank, changes=1), num_cycles=30)


def walk(env, seed, n=40):
    """Return all that an environment says on a random walk of several episodes."""
    chance = np.random.default_rng(3)
    observation, info = env.reset(seed=seed)
    log = [(observation.tolist(), info["goal"])]
    for _ in range(n):
        able = np.flatnonzero(info["action_mask"])
        step = env.step(able[int(chance.random() * len(able))])
        observation, reward, is_terminated, is_truncated, info = step
        log.append((observation.tolist(), reward, is_terminated, is_truncated, info["goal"]))
        if is_terminated or is_truncated:
            observation, info = env.reset()
    return log


def test_equal_seeds_give_equal_episodes(bank):
    env, twin = make(bank, mistake_rate=0.1), make(bank, mistake_rate=0.1)
    first = walk(env, 5)
    assert walk(env, 5) == first == walk(twin, 5)
    assert walk(env, 6) != first


def test_humans_that_a_policy_moves_observe_their_goal(kitchen):
    env = aec_env(kitchen)
    env.reset(seed=2, options={"goal": "parfait-nut"})
    assert (env.possible_agents, env.agent_selection) == (["human", "robot"], "human")
    human, robot = env.observe("human"), env.observe("robot")
    n_facts = len(kitchen.goals.task.facts)
    wants = [name == "parfait-nut" for name in kitchen.names]
    assert human["observation"][n_facts:].tolist() == wants
    assert human["observation"][:n_facts].tolist() == robot["observation"].tolist()
    assert robot["action_mask"].sum() == 1 < human["action_mask"].sum()  # it is not its turn


def test_what_cannot_be_done_is_a_wait(kitchen):
    env = make(kitchen)
    _, info = env.reset(seed=0)
    unable = int(np.flatnonzero(info["action_mask"] == 0)[0])
    *_, info = env.step(unable)
    assert info["invalid_action"]
    assert [move.step for move in env.rollout.moves if not move.mover.is_human] == [None]


def test_a_team_in_parallel_carries_out_its_actions_in_turn(kitchen):
    env = parallel_env(kitchen)
    env.reset(options={"goal": "parfait-nut"})
    get = env.team.actions["human"].names.index("get yogurt")
    _, rewards, *_ = env.step({"human": get, "robot": get})
    steps = [move.step for move in env.team.rollout.moves]
    assert [step is None for step in steps] == [False, True]  # the human was first
    assert rewards == {"human": -2.0, "robot": -2.0}
    with pytest.raises(UsageError, match="no action of robot"):
        env.step({"human": 0})


def test_render(kitchen, team):
    for bank in (kitchen, team):
        env = make(bank, render_mode="ansi")
        assert "no episode has begun" in env.render()
        env.reset(seed=0)
        text = env.render()
        assert "acts now" in text
        assert max(map(len, text.splitlines())) <= 80
        assert make(bank).render() is None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"humn": "frontier"}, "no option 'humn'"),
        ({"human": "frontir"}, "no human 'frontir'"),
        ({"belief": "exat"}, "no method 'exat'"),
        ({"mistake_rate": 2.0}, "mistake rate is a probability"),
        ({"changes": -1}, "changes are 0 or more"),
        ({"goals_per": "robot"}, "goals are per human or team"),
        ({"render_mode": "human"}, "the render mode is ansi"),
    ],
)
def test_wrong_options_are_named(kitchen, options, message):
    with pytest.raises(UsageError, match=message):
        make(kitchen, **options)


def test_wrong_calls_are_named(kitchen, transport):
    env = make(kitchen)
    with pytest.raises(UsageError, match="the episode is over"):
        env.step(0)
    with pytest.warns(UserWarning, match="ignores the option 'gaol'; did you mean 'goal'"):
        env.reset(options={"gaol": 1})
    for options, message in (({"goal": "tea"}, "no goal 'tea'"),
                             ({"course": 3}, "a course is a hrcplan.Course")):  # fmt: skip
        with pytest.raises(UsageError, match=message):
            env.reset(options=options)
    env.reset(seed=0)
    for action in (-1, 10**6, "get", 0.5):
        with pytest.raises(UsageError, match="is no action from 0"):
            env.step(action)
    with pytest.raises(UsageError, match="humans are agents here"):
        aec_env(kitchen, human="frontier")
    with pytest.raises(UsageError, match="have no option 'belief'"):
        make_vec(kitchen, belief="exact")
    with pytest.raises(UnsupportedError, match="steps say who acts"):
        make_vec(transport)


def test_an_episode_that_needs_no_robot_is_refused():
    from tests.episodes.test_episode import door

    bank = door(able="ann")
    bank = build(bank.goals.only(["built", "painted"]))
    env = make(bank)
    with pytest.raises(UsageError, match="over before the robot's first turn"):
        env.reset(seed=0, options={"goal": "built"})
    for seed in range(5):  # of drawn goals, one that needs the robot's turn
        assert env.reset(seed=seed)[1]["goal"] == "painted"


def test_hrcplan_does_not_import_gymnasium():
    script = "import sys, hrcplan; hrcplan.read('kitchen/parfait-nut'); "
    script += "print('gymnasium' in sys.modules)"
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


def test_a_missing_package_is_one_line_with_the_command():
    script = """
import hrcplan
for name in ("make", "make_vec", "aec_env", "parallel_env"):
    try:
        getattr(hrcplan.environments, name)("kitchen")
    except hrcplan.UsageError as error:
        print(error.hint)
"""
    assert without(["gymnasium", "pettingzoo"], script) == "pip install 'hrcplan[gym]'\n" * 4


def test_the_extra_alone_is_enough_and_policies_need_none():
    others = sorted(set(EXTRA_OF) - {"gymnasium", "pettingzoo"})
    script = """
import hrcplan
bank = hrcplan.build_bank("kitchen", only=["parfait-nut", "smoothie-berry"])
make = hrcplan.environments
env, many = make.make(bank, human="cc-htn", belief="switching"), make.make_vec(bank, num_envs=2)
pair, both = make.aec_env(bank), make.parallel_env(bank)
for each in (env, many, pair, both):
    each.reset(seed=0)
waits = dict.fromkeys(both.agents, 0)
print(env.step(0)[1], many.step([0, 0])[1].tolist(), pair.step(0), both.step(waits)[1])
"""
    assert without(others, script).startswith("-3.0 [-3.0, -3.0] None {'human': -2.0")
    script = "from hrcplan.environments import PolicyAssistant; print(PolicyAssistant.__name__)"
    assert without(sorted(EXTRA_OF), script) == "PolicyAssistant\n"


def test_environments_are_a_public_name():
    assert hrcplan.environments.make is make
