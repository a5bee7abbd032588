"""Which goals steps are consistent with, beside lists of all plans and all parts of histories."""

from collections import Counter
from fractions import Fraction
from itertools import combinations
from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.assistance.rhp.consistency import Subset
from hrcplan.assistance.rhp.sampled import Sampled
from hrcplan.assistance.rhp.set_posterior import SetPosterior
from hrcplan.assistance.rhp.subsequence import Subsequence
from hrcplan.bank import Bank, BuildOptions, build, multisets
from hrcplan.core.bits import positions

BANKS = ("workshop", "hall", "detours")
N_FEW = 6


@pytest.fixture(scope="session")
def detours(hall: Bank) -> Bank:
    """Plans with twice the steps they need, in which people walk to and fro."""
    small = hall.goals.only(["cup", "key"])
    return build(small, BuildOptions(quality=Fraction(3, 2)))


@pytest.fixture(scope="session", params=BANKS)
def bank(request) -> Bank:
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="session")
def plans(bank):
    """All plans of each goal, as labels."""
    label = bank.table.labels
    found = ([tuple(label[s] for s in p) for p in bank.plans(g)] for g in range(len(bank.names)))
    return [sorted(set(listed)) for listed in found]


@pytest.fixture(scope="session")
def few(bank):
    """The plans that a sample of a few holds, as labels."""
    label, rng = bank.table.labels, np.random.default_rng(5)
    return [
        [tuple(label[s] for s in row if s >= 0) for row in bank.sampler(g).draw(N_FEW, rng)]
        for g in range(len(bank.names))
    ]


@pytest.fixture(scope="session")
def tests(bank):
    """Each way to test beside what it should know and how it should compare."""
    return {
        "subset": (Subset(bank), "plans", _holds),
        "subsequence": (Subsequence(bank), "plans", _in_order),
        "sampled": (Sampled(bank, N_FEW, seed=5), "few", _in_order),
    }


@pytest.fixture(scope="session", params=["subset", "subsequence", "sampled"])
def case(request, tests):
    test, known, compare = tests[request.param]
    return test, request.getfixturevalue(known), compare


def _holds(plan, seen):
    return not Counter(seen) - Counter(plan)


def _in_order(plan, seen):
    left = iter(plan)
    return all(label in left for label in seen)


def _expected(case, seen):
    _, known, compare = case
    return sum(1 << g for g, listed in enumerate(known) if any(compare(p, seen) for p in listed))


@st.composite
def _histories(draw, bank, most=7):
    """Steps out of plans of two goals, in some order, now and then another one, or one twice."""
    pool = []
    for _ in range(2):
        goal = draw(st.integers(0, len(bank.names) - 1))
        seed = draw(st.integers(0, 3))
        pool += bank.sample(goal, 1, np.random.default_rng(seed))[0]
    others = st.lists(st.integers(0, len(bank.table) - 1), max_size=2)
    chosen = draw(st.permutations(pool)) if draw(st.booleans()) else pool
    keep = draw(st.lists(st.booleans(), min_size=len(pool), max_size=len(pool)))
    kept = [step for step, wanted in zip(chosen, keep, strict=True) if wanted]
    return tuple((draw(others) + kept)[:most])


@given(data=st.data())
@settings(max_examples=60, deadline=None)
def test_goals_are_those_with_such_a_plan(data, bank, case):
    steps = data.draw(_histories(bank))
    seen = [bank.table.labels[step] for step in steps]
    assert case[0].goals(steps) == _expected(case, seen)


@given(data=st.data())
@settings(max_examples=60, deadline=None)
def test_largest_parts_are_the_first_of_all(data, bank, case):
    """All parts are listed by size, worth and lateness; the first consistent ones are wanted."""
    history = data.draw(_histories(bank))
    latest = data.draw(st.sampled_from(history or (0,)))
    n = data.draw(st.integers(1, 5))
    worth = data.draw(st.lists(st.integers(0, 4), min_size=len(history), max_size=len(history)))
    places = range(len(history))
    parts = [part for size in range(len(history) + 1) for part in combinations(places, size)]
    parts.sort(key=lambda p: (-len(p), -sum(worth[i] for i in p), -sum(1 << i for i in p)))
    label, expected = bank.table.labels, []
    for part in parts:
        sequence = (*(history[i] for i in part), latest)
        if sequence not in expected and _expected(case, [label[s] for s in sequence]):
            expected.append(sequence)
    assert case[0].largest(history, latest, worth, n) == expected[:n]


def test_everything_is_consistent_with_nothing(case, bank):
    assert case[0].everything == case[0].goals(()) == (1 << len(bank.names)) - 1


def test_largest_of_a_step_without_use_is_none(case, bank, plans):
    label = bank.table.labels
    used = {step for listed in plans for plan in listed for step in plan}
    idle = [step for step in range(len(bank.table)) if label[step] not in used]
    for step in idle[:3]:
        assert case[0].largest((0,), step, [1], 2) == []


@given(data=st.data())
@settings(max_examples=30, deadline=None)
def test_goals_of_too_many_kinds_are_searched(data, bank, plans):
    """Without a list of kinds the answers are the same."""
    steps = data.draw(_histories(bank))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(multisets, "step_multisets", lambda graph: None)
        searched = Subset(bank)
        seen = [searched.label[step] for step in steps]
        expected = _expected((searched, plans, _holds), seen)
        assert searched.goals(steps) == searched.goals(steps) == expected
        if steps:
            worth = [1] * (len(steps) - 1)
            found = searched.largest(steps[:-1], steps[-1], worth, 2)
    if steps:
        assert found == Subset(bank).largest(steps[:-1], steps[-1], worth, 2)


def test_unknown_counts_as_consistent(workshop):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(multisets, "is_subset", lambda graph, seen: None)
        patch.setattr(multisets, "step_multisets", lambda graph: None)
        subset = Subset(workshop)
        assert subset.goals(tuple(range(len(workshop.table)))) == subset.everything


def test_kitchen_orders_rule_out_what_sets_do_not(kitchen):
    """A step before one that opens it fits a goal as a set, but in no order of a plan."""
    steps = tuple(kitchen.table.find(w) for w in (("pour", "beans", "pan"), ("get", "beans")))
    subset, ordered = Subset(kitchen), Subsequence(kitchen)
    assert subset.goals(steps) == subset.goals(steps[::-1]) == ordered.goals(steps[::-1]) != 0
    assert ordered.goals(steps) == 0


def test_presence_weighs_beginnings_and_forgives(kitchen):
    """Steps of a goal tell it, one that it has no use for only doubts it, and nothing nothing."""
    presence = SetPosterior(kitchen)
    rows = np.zeros((3, len(kitchen.table)), dtype=np.uint8)
    plan = kitchen.sample(3, 1, np.random.default_rng(0))[0]
    rows[:2, list(plan[:12])] = 1
    others = sorted(set(range(len(kitchen.table))) - kitchen.graphs[3].used_steps)
    rows[1, others[0]] = 1
    found = presence.posteriors(rows)
    assert found.sum(axis=1) == pytest.approx(1)
    assert found[:2].argmax(axis=1).tolist() == [3, 3]
    assert found[2] == pytest.approx(1 / 30)


def test_presence_is_the_ceiling_on_beginnings(workshop):
    presence = SetPosterior(workshop, error=0.0)
    for goal in (0, 1, 3):
        plan = workshop.sample(goal, 1, np.random.default_rng(1))[0]
        row = np.zeros((1, len(workshop.table)), dtype=np.uint8)
        row[0, list(plan)] = 1
        weights = presence._ceiling.weights(plan)
        known = weights > 0
        found = presence.posteriors(row)[0]
        assert found[known] / found[goal] == pytest.approx(weights[known] / weights[goal])


def test_presence_weighs_every_goal_by_its_definition(bank):
    """By counts where the steps begin a plan, else all sets alike; and errors for the rest."""
    presence, label = SetPosterior(bank, error=0.25), bank.table.labels
    rng = np.random.default_rng(3)
    rows = (rng.random((60, max(label) + 1)) < rng.random((60, 1))).astype(np.uint8)
    n_counted = 0
    for row in rows:
        done = set(np.flatnonzero(row).tolist())
        state = presence._world(sorted(done))
        for graph, weight in zip(bank.graphs, presence._weights(row), strict=True):
            used = {label[step] for step in graph.used_steps}
            n, size = len(done & used), max(graph.n_steps, len(used))
            node = graph.node_of(state)
            expected = 1 / comb(size, n) / size
            if node is not None and graph.layers[graph.layer_of[node]][0] == n:
                passing = graph.ways_to(node) * graph.plans_from(node)
                expected = passing / graph.plans / graph.n_steps
                n_counted += 1
            assert weight == pytest.approx(expected * 0.25 ** (len(done) - n), rel=1e-12)
    assert 0 < n_counted < 60 * len(bank.graphs)


def test_bits_are_places():
    assert list(positions(0)) == []
    assert sum(1 << i for i in positions(987654321 << 70)) == 987654321 << 70
