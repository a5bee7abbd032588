"""Cluster-robust errors: beside plain loops, by simulation, and where there is little to go by."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.studies.estimate import (
    MANY,
    MeanEstimate,
    estimate,
    estimate_by,
    estimate_clustered,
    t_quantile,
)
from hrcplan.studies.measure import Measure, mean_html, mean_text

KEYS = st.sampled_from("abcde")
TABLES = st.lists(
    st.tuples(st.tuples(KEYS, KEYS), st.integers(-9, 9)), min_size=2, max_size=30
)  # fmt: skip
N_GOALS, N_TABLES = 30, 600


@pytest.mark.parametrize(
    ("first", "second"), [(0, 0), (0.1, 0.1), (0.2, 0.2), (0.4, 0.4), (1, 1), (0.4, 0), (0, 1)]
)
def test_intervals_hold_the_true_mean_as_often_as_they_say(first, second):
    """Tables of 30 x 29 pairs whose true mean is known, with effects of either goal or none."""
    rng, n_held = np.random.default_rng(2024), 0
    pairs = [(i, j) for i in range(N_GOALS) for j in range(N_GOALS) if i != j]
    for _ in range(N_TABLES):
        of_first, of_second = first * rng.normal(size=N_GOALS), second * rng.normal(size=N_GOALS)
        noise = rng.normal(size=(N_GOALS, N_GOALS))
        found = estimate_clustered(
            ((i, j), 7.0 + of_first[i] + of_second[j] + noise[i, j]) for i, j in pairs
        ).interval
        n_held += found.low <= 7.0 <= found.high
    assert 0.93 <= n_held / N_TABLES <= 0.97


def test_the_variance_is_that_of_the_formula():
    rng = np.random.default_rng(3)
    noise = rng.normal(size=40)
    values = [
        ("rst"[i % 3], "wxyz"[i % 4], float(x + i % 3 * 2 + i % 4)) for i, x in enumerate(noise)
    ]
    mean = sum(x for *_, x in values) / 40

    def part(*ways):
        groups = {tuple(value[way] for way in ways) for value in values}
        sums = [
            sum(v[2] - mean for v in values if tuple(v[way] for way in ways) == group)
            for group in groups
        ]
        return len(groups) / (len(groups) - 1) * sum(x * x for x in sums) / 40**2

    found = estimate_clustered(((a, b), x) for a, b, x in values)
    expected = max(part(0) + part(1) - part(0, 1), min(part(0), part(1)))
    assert found.se == pytest.approx(math.sqrt(expected))
    assert (found.n, found.degrees) == (40, 2)
    assert found.half == pytest.approx(t_quantile(2) * found.se)


def test_copies_of_values_do_not_narrow_the_interval():
    values = [((r, c), float(x)) for x, (r, c) in enumerate(["ax", "ay", "bx", "bz", "cy", "cz"])]
    once, often = (
        estimate_clustered(values),
        estimate_clustered([v for v in values for _ in "1234"]),
    )
    assert often.interval.low == pytest.approx(once.interval.low)
    assert estimate_by([v for v in values for _ in "1234"]).interval == once.interval


def test_a_way_without_clusters_is_none():
    one_way = estimate_clustered(((i % 4,), float(i)) for i in range(12))
    assert estimate_clustered(((i % 4, None), float(i)) for i in range(12)) == one_way
    single = estimate_clustered(((i,), float(i)) for i in range(12))
    assert single.se == pytest.approx(np.std(range(12), ddof=1) / math.sqrt(12))
    assert single == estimate(range(12))


@pytest.mark.parametrize(
    "values",
    [[], [(("a", "x"), 3.0)], [(("a", "x"), 2.0), (("a", "x"), 4.0)],
     [(("a", "x"), 2.0), (("a", "y"), 4.0)]],
)  # fmt: skip
def test_one_cluster_says_nothing_of_others(values):
    found = estimate_clustered(values)
    assert not found.is_known
    assert not found.is_above_zero
    assert not found.is_below_zero
    assert not found.interval.is_known
    assert "±" not in mean_text(found) + mean_html(found)


def test_shares_stay_between_0_and_100():
    share, steps = Measure("share", "share", "%"), Measure("steps", "steps", "timesteps")
    high = MeanEstimate(99.5, 3.0, 9)
    assert share.interval(high).high == 100
    assert share.interval(MeanEstimate(1.0, 3.0, 9)).low == 0
    assert steps.interval(high).high > 100
    assert share.span(MeanEstimate(40.0, 0.0, 1)) == (40.0, 40.0)


def test_quantiles_are_those_of_the_tables():
    known = {1: 12.7062, 2: 4.30265, 3: 3.18245, 4: 2.77645, 5: 2.57058, 9: 2.26216, 10: 2.22814,
             29: 2.04523, 30: 2.04227, 100: 1.98397}  # fmt: skip
    for df, quantile in known.items():
        assert t_quantile(df) == pytest.approx(quantile, abs=2e-5)
    assert t_quantile(MANY) == pytest.approx(t_quantile(MANY + 1), abs=1e-4)
    assert t_quantile(10**7) == pytest.approx(1.959964, abs=1e-5)


@given(TABLES, st.integers(-5, 5), st.sampled_from([1, 2, 4]))
def test_intervals_move_and_grow_with_the_values(values, by, times):
    plain = estimate_clustered(values)
    other = estimate_clustered((clusters, times * value + by) for clusters, value in values)
    assert other.mean == pytest.approx(times * plain.mean + by, abs=1e-9)
    assert other.se == pytest.approx(times * plain.se, abs=1e-6)
    assert other.degrees == plain.degrees
