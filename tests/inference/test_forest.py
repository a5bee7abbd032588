"""The forest, and how near it comes to the best that can be done with the same features."""

from dataclasses import replace

import numpy as np
import pytest

from hrcplan.assistance.rhp.set_posterior import PrefixPosterior
from hrcplan.bank import build
from hrcplan.errors import UsageError
from hrcplan.inference import batch
from hrcplan.inference.classifier.flat_forest import FlatForest
from hrcplan.inference.classifier.forest import MAX_KNOWN, ForestBelief
from hrcplan.inference.classifier.training import prefixes
from tests.inference import enumerated_beliefs

MEALS = 10
SAMPLES = 12_000


@pytest.fixture(scope="module")
def some(kitchen):
    return build(kitchen.goals.only(kitchen.names[::3]))


@pytest.fixture(scope="module")
def forest(some):
    return ForestBelief(some, seed=1, n_samples=SAMPLES, n_trees=40)


@pytest.fixture(scope="module")
def begun(some):
    rng = np.random.default_rng(2)
    found = []
    for goal in range(MEALS):
        for plan in some.sample(goal, 150, rng):
            found.append((plan[: rng.integers(1, len(plan) + 1)], goal))
    return found


@pytest.fixture(scope="module", params=["workshop", "hall"])
def small(request):
    """A bank, a classifier of scikit-learn trained on it, and the same as arrays."""
    from sklearn.ensemble import RandomForestClassifier

    bank = request.getfixturevalue(request.param)
    rows, goals = prefixes(bank, 1500, np.random.default_rng(8))
    classifier = RandomForestClassifier(30, min_samples_leaf=2, random_state=3).fit(rows, goals)
    return bank, classifier, FlatForest.from_sklearn(classifier)


def test_rows_through_arrays_are_what_scikit_learn_says(small):
    _, classifier, flat = small
    n_features = classifier.n_features_in_
    density = np.random.default_rng(3).random((400, 1))
    rows = (np.random.default_rng(4).random((400, n_features)) < density).astype(np.uint8)
    expected = classifier.predict_proba(rows)
    assert np.abs(flat.predict_proba(rows) - expected).max() < 1e-6
    assert expected.std() > 0.1


def test_a_row_has_the_same_probabilities_in_any_company(small):
    """To the last bit: nothing that is computed in a batch may differ from one by one."""
    _, classifier, flat = small
    rows = np.random.default_rng(5).integers(0, 2, (2500, classifier.n_features_in_), np.uint8)
    together = flat.predict_proba(rows)
    for i in range(0, len(rows), 101):
        assert flat.predict_proba(rows[i : i + 1])[0].tolist() == together[i].tolist()
    assert flat.predict_proba(rows[::-1])[::-1].tolist() == together.tolist()
    assert flat.predict_proba(rows[:0]).shape == (0, len(classifier.classes_))


def test_a_forest_of_bare_roots():
    from sklearn.ensemble import RandomForestClassifier

    rows = np.zeros((4, 2), dtype=np.uint8)
    classifier = RandomForestClassifier(3, random_state=0).fit(rows, [0, 1, 1, 1])
    flat = FlatForest.from_sklearn(classifier)
    assert flat.predict_proba(rows) == pytest.approx(classifier.predict_proba(rows))


def test_extensions_are_observations_one_after_the_other(some, forest, walk):
    rng = np.random.default_rng(6)
    state = forest.start()
    for step in walk(some, 3, 5):
        state = forest.observe(state, step)
    after = {}
    for _ in range(60):
        steps, later = [], state
        for _ in range(rng.integers(0, 4)):
            steps.append(int(rng.choice(some.table.applicable(later.world))))
            later = forest.observe(later, steps[-1])
        after[tuple(steps)] = forest.posterior(later).tolist()
    fresh = ForestBelief(some, seed=1, n_samples=SAMPLES, n_trees=40)
    assert fresh.posteriors_after(state, list(after)).tolist() == list(after.values())
    assert fresh.posteriors_after(state, []).shape == (0, MEALS)
    assert not state.row[
        [some.table.labels[step] for step in list(after)[-1]]
    ].all()  # the row itself stays


def test_many_rows_are_posteriors_and_only_some_are_remembered(forest):
    rows = np.random.default_rng(7).integers(0, 2, (MAX_KNOWN + 300, forest.n_labels), np.uint8)
    rows[1], rows[2] = rows[0], 0
    found = forest.posteriors(rows)
    assert found[0].tolist() == found[1].tolist()
    assert found[2].tolist() == [1 / MEALS] * MEALS
    assert len(forest._memo) == MAX_KNOWN
    assert found.sum(axis=1) == pytest.approx(np.ones(len(rows)))
    assert forest.posteriors(rows).tolist() == found.tolist()
    with pytest.raises(UsageError, match="labels"):
        forest.posteriors(rows[:, 1:])


def test_no_plans_no_forest(some):
    none = some.graph_from(0, 0)  # from nowhere
    with pytest.raises(UsageError, match="no goal has a plan"):
        ForestBelief(replace(some, graphs=(none,) * MEALS))


def test_accuracy_is_near_the_ceiling_and_not_above_it(some, forest, begun):
    plans, goals = zip(*begun, strict=True)
    best = PrefixPosterior(some).accuracy(plans, goals)
    right = 0
    for plan, goal in begun:
        right += int(batch(forest, plan)[-1].argmax()) == goal
    assert best - 0.03 <= right / len(begun) <= best + 0.01
    assert forest.training.accuracy == pytest.approx(best, abs=0.04)


def test_the_ceiling_is_bayes_over_listed_prefixes(workshop):
    """The posterior of a set of steps is the share of beginnings of plans that have this set."""
    ceiling = PrefixPosterior(workshop)
    plans = [
        enumerated_beliefs.optimal_plans(workshop, goal, workshop.initial) for goal in range(5)
    ]
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
    one, two, other = (
        ForestBelief(some, seed=seed, n_samples=1000, n_trees=8, n_jobs=n_jobs, cache=False)
        for seed, n_jobs in ((5, 1), (5, 2), (6, 1))
    )
    rows, _ = prefixes(some, 100, np.random.default_rng(4))
    assert one.posteriors(rows).tolist() == two.posteriors(rows).tolist()
    assert one.training.accuracy == two.training.accuracy
    assert np.abs(one.posteriors(rows) - other.posteriors(rows)).max() > 0.01


def test_any_classifier_can_be_plugged_in(some, begun):
    from sklearn.naive_bayes import BernoulliNB

    belief = ForestBelief(some, n_samples=4000, classifier=BernoulliNB())
    right = sum(int(batch(belief, plan)[-1].argmax()) == goal for plan, goal in begun[::5])
    assert right / len(begun[::5]) > 0.8
    assert belief.training.n_held_out == 800


def test_steps_of_both_agents_are_features(some, forest):
    step = some.sample(0, 1, np.random.default_rng(1))[0][0]
    human = forest.observe(forest.start(), step)
    robot = forest.observe(forest.start(), step, robot=True)
    assert human.row.tolist() == robot.row.tolist()
    assert human.row.sum() == 1
