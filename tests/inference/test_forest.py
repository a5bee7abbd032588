"""The forest, and how near it comes to the best that can be done with the same features."""

import numpy as np
import pytest

from hrcplan.bank import build
from hrcplan.inference import batch
from hrcplan.inference.ceiling import Ceiling
from hrcplan.inference.forest import Flat, Forest

MEALS = 10
SAMPLES = 12_000


@pytest.fixture(scope="module")
def some(kitchen):
    return build(kitchen.goals.only(kitchen.names[::3]))


@pytest.fixture(scope="module")
def forest(some):
    return Forest(some, seed=1, n_samples=SAMPLES, n_trees=40)


@pytest.fixture(scope="module")
def prefixes(some):
    rng = np.random.default_rng(2)
    found = []
    for goal in range(MEALS):
        for plan in some.sample(goal, 150, rng):
            found.append((plan[: rng.integers(1, len(plan) + 1)], goal))
    return found


def test_one_row_through_flat_trees_is_what_scikit_learn_says(forest):
    rows, _ = forest.prefixes(200, np.random.default_rng(3))
    expected = forest.predict(rows)
    flat = Flat(forest._model)
    for row, probabilities in zip(rows, expected, strict=True):
        assert flat.predict(row).tolist() == pytest.approx(probabilities.tolist(), abs=1e-6)


def test_accuracy_is_near_the_ceiling_and_not_above_it(some, forest, prefixes):
    plans, goals = zip(*prefixes, strict=True)
    best = Ceiling(some).accuracy(plans, goals)
    right = 0
    for plan, goal in prefixes:
        right += int(batch(forest, plan)[-1].argmax()) == goal
    assert best - 0.03 <= right / len(prefixes) <= best + 0.01
    assert forest.training.accuracy == pytest.approx(best, abs=0.04)


def test_the_ceiling_is_bayes_over_listed_prefixes(workshop, brute):
    """The posterior of a set of steps is the share of beginnings of plans that have this set."""
    ceiling = Ceiling(workshop)
    plans = [brute.optimal_plans(workshop, goal, workshop.initial) for goal in range(5)]
    for plan in plans[1]:
        for length in range(1, len(plan) + 1):
            steps = frozenset(plan[:length])
            expected = [
                sum(frozenset(p[:length]) == steps for p in own) / len(own) / len(own[0])
                for own in plans
            ]
            found = ceiling.weights(plan[:length])
            assert (found / found.sum()).tolist() == pytest.approx(
                (np.array(expected) / sum(expected)).tolist()
            )


def test_same_seed_same_forest_whatever_the_jobs(some):
    one = Forest(some, seed=5, n_samples=1000, n_trees=8)
    two = Forest(some, seed=5, n_samples=1000, n_trees=8, n_jobs=2)
    rows, _ = one.prefixes(100, np.random.default_rng(4))
    assert np.abs(one.predict(rows) - two.predict(rows)).max() < 1e-12  # sums in another order
    assert one.training.accuracy == two.training.accuracy
    other = Forest(some, seed=6, n_samples=1000, n_trees=8)
    assert np.abs(one.predict(rows) - other.predict(rows)).max() > 0.01


def test_any_classifier_can_be_plugged_in(some, prefixes):
    from sklearn.naive_bayes import BernoulliNB

    belief = Forest(some, n_samples=4000, classifier=BernoulliNB())
    right = sum(int(batch(belief, plan)[-1].argmax()) == goal for plan, goal in prefixes[::5])
    assert right / len(prefixes[::5]) > 0.8
    assert belief.training.n_held_out == 800


def test_steps_of_both_agents_are_features(some, forest):
    step = some.sample(0, 1, np.random.default_rng(1))[0][0]
    human = forest.observe(forest.start(), step)
    robot = forest.observe(forest.start(), step, robot=True)
    assert human.row.tolist() == robot.row.tolist()
    assert human.row.sum() == 1
