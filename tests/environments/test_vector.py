"""Episodes in numpy are those of single environments: the same turns from the same chances."""

import numpy as np
import pytest
from gymnasium.vector import AutoresetMode
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.bank import build
from hrcplan.core import bit_rows
from hrcplan.environments import make_vec
from hrcplan.environments.batch_turns import REACHED, RUNNING, STUCK, UNFINISHED, BatchRules
from hrcplan.environments.encoding import ActionEncoding, as_bits
from hrcplan.episodes import humans
from hrcplan.episodes.courses import Habits
from hrcplan.episodes.episode import PATIENCE
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.episodes.turns import turns_of
from hrcplan.errors import UsageError
from tests.episodes.test_episode import door

ENDINGS = {None: RUNNING, "reached": REACHED, "stuck": STUCK, "unfinished": UNFINISHED}


class Twin:
    """A single episode that hears the chances of a row."""

    def __init__(self, bank, batch, row, habits):
        course = Course(
            tuple(batch.goals[row].tolist()), tuple(batch.changes[row].tolist()),
            habits.mistake_rate, habits.wait_rate,
        )  # fmt: skip
        self.turns, self.human = turns_of(bank), Frontier(bank, course)
        self.turns.begin(course)
        self.robots = next(mover.agents for mover in self.turns.order if not mover.is_human)

    def human_acts(self, chances, patch):
        if self.turns.ending is None:
            patch.setattr(humans, "_draws", lambda seed, turn: iter(chances).__next__)
            self.turns.do(self.turns.human_move(self.human).step)

    def robot_acts(self, step):
        if self.turns.ending is None:
            self.turns.do(step)


def check_alike(bank, habits, n, n_rounds, seed):
    rules, rng = BatchRules(bank, habits), np.random.default_rng(seed)
    batch = rules.begin(n, rng)
    twins = [Twin(bank, batch, row, habits) for row in range(n)]
    assert batch.caps.tolist() == [twin.turns.cap for twin in twins]
    with pytest.MonkeyPatch.context() as patch:
        for _ in range(n_rounds):
            chances = rng.random((n, 3))
            rules.let_humans_act(batch, chances)
            mask = rules.robot_mask(batch.states)
            for row, twin in enumerate(twins):
                twin.human_acts(chances[row], patch)
                own = rules.actions.mask(twin.turns.state, twin.robots)
                assert mask[row].tolist() == own.tolist()
            compare(batch, twins)
            actions = (rng.random(mask.shape) * mask).argmax(axis=1) * (rng.random(n) < 0.8)
            rules.let_robots_act(batch, actions, batch.endings == RUNNING)
            for action, twin in zip(actions.tolist(), twins, strict=True):
                twin.robot_acts(rules.actions.step(action))
    return batch


def compare(batch, twins):
    turns = [twin.turns for twin in twins]
    assert bit_rows.unpack(batch.states) == [t.state for t in turns]
    assert batch.endings.tolist() == [ENDINGS[t.ending] for t in turns]
    assert batch.n_turns.tolist() == [t.n_turns for t in turns]
    assert batch.n_waits.tolist() == [t.n_waits for t in turns]


def test_kitchen_turn_by_turn(kitchen):
    batch = check_alike(kitchen, Habits(1, 0.1, 0.1), 40, 20, seed=1)
    assert (batch.endings == REACHED).any()


ABILITIES = (
    {},
    {"able": "ann"},
    {"able": "robo", "agents": "ann bob robo"},
    {"agents": "ann robo rob2", "controllable": "robo"},
)


@pytest.mark.parametrize("options", ABILITIES)
def test_agents_with_other_abilities_and_all_endings(options):
    endings = {
        ending
        for seed in range(4)
        for habits in (Habits(1, 0.3, 0.2), Habits(2), Habits(0, 1.0))
        for ending in check_alike(door(**options), habits, 12, 14, seed).endings.tolist()
    }
    assert endings >= {REACHED, STUCK, UNFINISHED}


@settings(max_examples=25)
@given(data=st.data())
def test_small_worlds_turn_by_turn(data, small_bank):
    bank = data.draw(small_bank(kinds=("free", "able")))
    if bank.agents == "dropped" and all(graph.n_steps for graph in bank.graphs):
        habits = Habits(data.draw(st.integers(0, 2)), data.draw(st.sampled_from([0.0, 0.4])))
        check_alike(bank, habits, 6, 8, data.draw(st.integers(0, 99)))


@settings(max_examples=25)
@given(data=st.data())
def test_masks_are_what_agents_can_do(data, small_bank):
    bank = data.draw(small_bank())
    agents = frozenset(data.draw(st.sampled_from([{"ann"}, {"robo"}, {"ann", "bob"}])))
    actions = ActionEncoding(bank, agents)
    for _ in range(6):
        state = data.draw(st.integers(0, (1 << len(bank.goals.task.facts)) - 1))
        able = set(bank.table.able(state, range(len(bank.table)), agents))
        mask = actions.mask(state, agents)
        assert mask[0] == 1
        assert {actions.step(int(a)) for a in np.flatnonzero(mask)} == able | {None}
        assert all(actions.action(actions.step(a)) == a for a in range(actions.n_actions))


def test_bits_of_nothing():
    assert as_bits(0, 0).tolist() == []
    assert as_bits(5, 3).tolist() == [1, 0, 1]


def test_vector_environment(kitchen):
    envs = make_vec(kitchen, num_envs=64, changes=1, mistake_rate=0.1)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    rng, totals, costs, ended = np.random.default_rng(0), np.zeros(64), [], np.zeros(64, bool)
    observations, infos = envs.reset(seed=3)
    for _ in range(60):
        assert observations in envs.observation_space
        mask = infos["action_mask"]
        actions = (rng.random(mask.shape) * mask).argmax(axis=1)
        observations, rewards, is_terminated, is_truncated, infos = envs.step(actions)
        assert (rewards[ended] == 0).all()
        totals += rewards
        ended = is_terminated | is_truncated
        costs += (-totals[ended]).tolist()
        assert (infos["action_mask"][ended].sum(axis=1) == 1).all()
        assert -totals[ended].sum() == envs.turns.n_turns[ended].sum()
        totals[ended] = 0
    assert len(costs) > 64
    assert max(costs) <= PATIENCE * 2 * max(graph.n_steps for graph in kitchen.graphs) + 3
    assert set(envs.goals) <= set(kitchen.names)


def test_equal_seeds_give_equal_episodes(kitchen):
    envs = make_vec(kitchen, num_envs=16)

    def log(seed):
        observations, infos = envs.reset(seed=seed)
        parts = [observations]
        for _ in range(12):
            actions = infos["action_mask"].cumsum(axis=1).argmax(axis=1)
            observations, *_, infos = envs.step(actions)
            parts.append(observations)
        return np.stack(parts).tolist()

    assert log(1) == log(1) != log(2)


def test_actions_are_checked(kitchen):
    envs = make_vec(kitchen, num_envs=2)
    with pytest.raises(UsageError, match="no episode has begun"):
        envs.step(np.zeros(2, int))
    envs.reset(seed=0)
    for actions in (np.zeros(3, int), np.zeros(2), np.array([0, -1]), np.array([0, 10**6])):
        with pytest.raises(UsageError, match="actions"):
            envs.step(actions)
    with pytest.raises(UsageError, match="at least one environment"):
        make_vec(kitchen, num_envs=0)
    with pytest.raises(UsageError, match="a goal takes one step"):
        make_vec(build(door(able="ann").goals.only(["built", "painted"])))
