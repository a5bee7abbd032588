"""Changes of goal, looking back: against all histories, and on runs that were put together."""

import math
from itertools import combinations, pairwise, product

import numpy as np
import pytest

from hrcplan.bank import build
from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference.change_points import MORE, MOST, ChangePoints
from hrcplan.inference.changes import change_points
from hrcplan.inference.switching import SwitchingBelief


def histories(likelihoods, prior):
    """Yield places, goals and weight of every history, the slow way."""
    n_steps, n_rates, n_goals = likelihoods.shape
    most = min(MOST, n_steps - 1)
    shares = np.array([MORE**k for k in range(most)])
    priors = [1 - prior, *(prior * shares / shares.sum())]
    for k in range(most + 1):
        for places in combinations(range(1, n_steps), k):
            for goals in product(range(n_goals), repeat=k + 1):
                if any(a == b for a, b in pairwise(goals)):
                    continue
                pursued = [goals[sum(t >= at for at in places)] for t in range(n_steps)]
                chance = priors[k] / math.comb(n_steps - 1, k) / n_goals / (n_goals - 1) ** k
                for rate in range(n_rates):
                    steps = likelihoods[np.arange(n_steps), rate, pursued]
                    yield places, goals, chance * float(np.prod(steps)) / n_rates


@pytest.mark.parametrize("seed", range(12))
def test_the_posterior_is_that_of_all_histories(seed):
    rng = np.random.default_rng(seed)
    likelihoods = rng.random((6, 2, 3)) ** 4
    if seed % 2:  # a change that shows
        likelihoods[:3, :, 0] += 1
        likelihoods[3:, :, 2] += 1
    points = ChangePoints(likelihoods, 0.4)
    every = list(histories(likelihoods, 0.4))
    counts = np.zeros(MOST + 1)
    for places, _, weight in every:
        counts[len(places)] += weight
    counts /= counts.sum()
    assert points.counts.tolist() == pytest.approx(counts.tolist())
    assert points.changed == pytest.approx(1 - counts[0])
    found = points.changes()
    n = sum(counts[i:].sum() > 0.5 for i in range(1, MOST + 1))
    assert len(found) == n
    for i, change in enumerate(found):
        at = np.zeros(6)
        for places, _, weight in every:
            if len(places) == n:
                at[places[i]] += weight
        at /= at.sum()
        assert change.probability == pytest.approx(counts[i + 1 :].sum())
        assert at[change.at] == pytest.approx(at.max())
        assert change.first <= change.at <= change.last
        assert at[change.first : change.last + 1].sum() >= 0.9 - 1e-9
    if seed % 2:
        assert [(c.at, c.before, c.after) for c in found] == [(3, 0, 2)]


def test_steps_that_say_nothing_leave_the_place_open():
    likelihoods = np.ones((9, 1, 2))
    likelihoods[:2] = likelihoods[7:, :, ::-1] = [[1.0, 1e-4]]
    (change,) = ChangePoints(likelihoods).changes()
    assert (change.first, change.at, change.last) == (2, 4, 7)
    assert (change.before, change.after) == (0, 1)


def test_nothing_to_look_back_at():
    for shape in ((1, 2, 5), (4, 1, 1)):
        points = ChangePoints(np.full(shape, 0.1))
        assert (points.changed, points.changes()) == (0.0, ())
    assert change_points([])[1].changed == 0.0
    assert ChangePoints(np.zeros((3, 1, 2))).changes() == ()


def test_two_changes_have_one_goal_between_them():
    likelihoods = np.full((12, 1, 4), 0.01)
    for t, goal in enumerate([0] * 4 + [3] * 4 + [1] * 4):
        likelihoods[t, 0, goal] = 1.0
    found = ChangePoints(likelihoods).changes()
    assert [(c.at, c.before, c.after) for c in found] == [(4, 0, 3), (8, 3, 1)]


def spliced(bank, rng, goals, at):
    """Return steps of a human who takes any next step of its goal, and changes it once."""
    state, found = bank.initial, []
    while len(found) < 60:
        graph = bank.graph_from(goals[len(found) >= at], state)
        following = list(graph.next(0)) if graph.n_nodes else []
        if not following:
            break
        found.append(int(rng.choice(following)))
        state = bank.table.successor(state, found[-1])
    return found


@pytest.mark.parametrize("name", ["kitchen", "easy-ipc-grid_p5-5-5_hyp-0_full"])
def test_changes_in_spliced_runs_are_reported(name, kitchen, instances):
    bank = kitchen if name == "kitchen" else build(read_instance(instances / name).goals)
    belief, rng = SwitchingBelief(bank), np.random.default_rng(17)
    n_runs = n_found = n_near = n_goals = n_false = 0
    for _ in range(12):
        goals = rng.choice(len(bank.names), 2, replace=False)
        at = max(2, bank.graphs[goals[0]].n_steps // 2)
        for second in (goals[1], goals[0]):
            steps = spliced(bank, rng, (goals[0], second), at)
            states = [belief.start()]
            for step in steps:
                states.append(belief.observe(states[-1], step))
            found = belief.changes(states[1:])
            assert bool(found) == (belief.changed(states[1:]) > 0.5)
            if second == goals[0]:
                n_false += bool(found)
            elif len(steps) > at:
                n_runs, n_found = n_runs + 1, n_found + bool(found)
                n_near += any(abs(change.at - at) <= 1 for change in found)
                n_goals += any((c.before, c.after) == tuple(goals) for c in found)
    assert n_false <= 1
    assert n_found >= 0.85 * n_runs
    assert n_near >= 0.8 * n_found
    assert n_goals >= 0.7 * n_found
