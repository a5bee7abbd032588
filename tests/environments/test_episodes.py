"""An episode of an environment is that of a study, step by step, whoever the robot is."""

from itertools import product

import numpy as np
import pytest

from hrcplan.assistance import ASSISTANTS
from hrcplan.assistance.per_human import PerHuman
from hrcplan.environments import AssistantPolicy, PolicyAssistant, make
from hrcplan.episodes.courses import Habits, draw_course, draw_own_courses
from hrcplan.episodes.episode import REACHED, STUCK, play
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.episodes.own_goals import play_own_goals

ERRATIC = Habits(1, 0.2, 0.1)


def run(env, act, course):
    """Return the sum of rewards and the info at the end of an episode."""
    observation, info = env.reset(options={"course": course})
    total = 0.0
    while True:
        action = act(observation, info["action_mask"])
        observation, reward, is_terminated, is_truncated, info = env.step(action)
        total += reward
        if is_terminated or is_truncated:
            assert is_terminated == (info["ending"] in (REACHED, STUCK))
            assert info["action_mask"].tolist() == [1] + [0] * (env.action_space.n - 1)
            return total, info


def moves_of(env):
    return [(move.mover.is_human, move.step, move.goal) for move in env.rollout.moves]


def turns_of(record):
    return [(turn.is_human, turn.step, turn.goal) for turn in record.turns]


def check_alike(bank, method, human, n, belief=None):
    env = make(bank, human=human, belief=belief)
    policy, robot = AssistantPolicy(env, method), ASSISTANTS.make(method, bank)
    for seed in range(n):
        course = draw_course(bank, f"{method}/{seed}", ERRATIC)
        record = play(bank, HUMANS.make(human, bank, course), robot, course)
        total, info = run(env, lambda *_: policy.act(), course)
        assert moves_of(env) == turns_of(record)
        assert (info["ending"], info["timestep"]) == (record.ending, record.n_turns)
        assert total == -record.cost


@pytest.mark.parametrize("human", ["frontier", "cc-htn", "habit", "noisy-rational"])
def test_kitchen(kitchen, human):
    check_alike(kitchen, "hrcplan", human, 4)


def test_agents_that_move(transport, household):
    check_alike(transport, "oracle", "frontier", 4)
    check_alike(household, "oracle", "inertia", 2)


def test_several_robots_and_humans(team):
    check_alike(team, "oracle", "frontier", 3, belief="exact")
    check_alike(team, "hrcplan", "frontier", 1)


def test_humans_with_goals_of_their_own(own_goals):
    bank = own_goals
    env = make(bank, goals_per="human", belief="exact")
    assert env.rollout.n_probabilities == 2 * len(bank.names)
    for seed, method in product(range(6), ["oracle", "hrcplan"]):
        courses = draw_own_courses(bank, str(seed), ERRATIC)
        humans = {w: HUMANS.make("frontier", bank.for_human(w), c) for w, c in courses.items()}
        helper = PerHuman(bank, lambda view, name=method: ASSISTANTS.make(name, view))
        record = play_own_goals(bank, humans, helper, courses)
        policy = AssistantPolicy(env, method)
        total, info = run(env, lambda *_, p=policy: p.act(), courses)
        assert moves_of(env) == turns_of(record)
        assert (total, info["ending"]) == (-record.cost, record.ending)


class Hashed(PolicyAssistant):
    """Acts by a fixed table of numbers: what it does depends on all that it observes."""

    def act(self, observation, action_mask):
        weights = np.random.default_rng(7).random((len(action_mask), len(observation)))
        return int(((weights @ observation) * action_mask).argmax())


class Believing(Hashed):
    observes_belief = True
    belief_name = "exact"


@pytest.mark.parametrize("kind", [Hashed, Believing])
def test_a_policy_is_the_same_robot_in_a_study(kitchen, team, kind):
    for bank in (kitchen, team):
        robot = kind(bank)
        env = make(bank, belief=robot.belief_name if robot.observes_belief else None)
        assert robot.observations.names == env.observations.names
        for seed in range(2):
            course = draw_course(bank, str(seed), ERRATIC)
            record = play(bank, HUMANS.make("frontier", bank, course), robot, course)
            total, _ = run(env, robot.act, course)
            assert moves_of(env) == turns_of(record)
            assert total == -record.cost


def test_a_policy_keeps_the_laws_of_assistants(kitchen):
    from hrcplan.testing import check_assistant

    check_assistant(Believing(kitchen), kitchen, [next(kitchen.plans(goal)) for goal in range(3)])


def test_getting_stuck_early_costs_what_a_study_says(team):
    """A team in which only the robot can finish, and a robot that never acts."""
    stuck = 0
    for goal in range(len(team.names)):
        env = make(team)
        total, info = run(env, lambda *_: 0, Course((goal,)))
        stuck += info["ending"] == STUCK
        assert total == -(env.rollout.turns.cap if info["ending"] == STUCK else info["timestep"])
    assert stuck
