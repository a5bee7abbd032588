"""The two-way cluster bootstrap beside plain loops, and where it has little to draw from."""

import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.studies.estimate import N_RESAMPLED, Interval, two_way_bootstrap

Values = list[tuple[str, str | None, float]]
KEYS = st.sampled_from("abcde")
TABLES = st.lists(st.tuples(KEYS, KEYS, st.integers(-9, 9)), min_size=2, max_size=30)


def in_loops(values: Values) -> tuple[float, float]:
    """Return the ends by drawing the same rows and columns and adding up value by value."""
    rows, columns = (list(dict.fromkeys(value[at] for value in values)) for at in (0, 1))
    rng = np.random.default_rng(0)
    drawn = [rng.multinomial(len(k), [1 / len(k)] * len(k), N_RESAMPLED) for k in (rows, columns)]
    means = []
    for of_rows, of_columns in zip(*drawn, strict=True):
        total, n = 0.0, 0
        for row, column, value in values:
            times = int(of_rows[rows.index(row)]) * int(of_columns[columns.index(column)])
            total, n = total + times * value, n + times
        if n:
            means.append(total / n)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)


def table(n_rows: int, n_columns: int, seed: int = 1) -> Values:
    chance = random.Random(seed)
    in_row, in_column = ([chance.gauss(0, 1) for _ in range(n)] for n in (n_rows, n_columns))
    return [
        (f"r{i}", f"c{j}", 0.5 + in_row[i] + in_column[j] + chance.gauss(0, 0.3))
        for i in range(n_rows)
        for j in range(n_columns)
        if i != j
        for _ in range(1 + (i + j) % 2)
    ]


def test_it_is_what_loops_give() -> None:
    values = table(6, 5)
    found = two_way_bootstrap(values)
    assert (found.low, found.high) == pytest.approx(in_loops(values))
    assert found.mean == pytest.approx(sum(v for _, _, v in values) / len(values))
    assert found.n == len(values)


def test_other_draws_give_about_the_same() -> None:
    values, chance = table(8, 8), random.Random(2)
    rows, columns = (sorted({str(value[at]) for value in values}) for at in (0, 1))
    means = []
    for _ in range(1000):
        r, c = (chance.choices(keys, k=len(keys)) for keys in (rows, columns))
        some = [v for row, column, v in values for _ in range(r.count(row) * c.count(str(column)))]
        means.append(sum(some) / len(some))
    low, high = np.quantile(means, [0.025, 0.975])
    found = two_way_bootstrap(values)
    width = found.high - found.low
    assert abs(found.low - low) < 0.1 * width
    assert abs(found.high - high) < 0.1 * width


def test_values_of_one_row_do_not_count_twice() -> None:
    """Copies of each value narrow a naive interval, and leave this one as it is."""
    values = table(6, 5)
    once, often = two_way_bootstrap(values), two_way_bootstrap([v for v in values for _ in "1234"])
    assert (often.low, often.high) == pytest.approx((once.low, once.high))


def test_with_one_column_rows_alone_are_drawn() -> None:
    values: Values = [(f"r{i}", None, float(i)) for i in range(12)]
    found = two_way_bootstrap(values)
    assert (found.low, found.high) == pytest.approx(in_loops(values))
    deviation = math.sqrt(sum((i - 5.5) ** 2 for i in range(12)) / 12 / 12)
    assert found.high - found.mean == pytest.approx(1.96 * deviation, rel=0.1)
    across = two_way_bootstrap([(None, row, value) for row, _, value in values])
    assert (across.mean, across.n) == (found.mean, 12)
    assert across.high - across.low == pytest.approx(found.high - found.low, rel=0.1)


@pytest.mark.parametrize("values", [[("a", "x", 3.0)], [("a", "x", 2.0), ("a", "x", 4.0)]])
def test_one_row_and_one_column_show_nothing(values: Values) -> None:
    found = two_way_bootstrap(values)
    assert found == Interval(3.0, -math.inf, math.inf, len(values))
    assert not found.is_above_zero
    assert not found.is_below_zero


def test_no_values_show_nothing() -> None:
    found = two_way_bootstrap([])
    assert found == Interval(0.0, 0.0, 0.0, 0)
    assert not found.is_above_zero
    assert not found.is_below_zero


def test_equal_values_have_an_interval_without_width() -> None:
    found = two_way_bootstrap([(r, c, -2.0) for r in "abc" for c in "xyz" if (r, c) != ("a", "x")])
    assert found == Interval(-2.0, -2.0, -2.0, 8)
    assert found.is_below_zero
    assert not found.is_above_zero


def test_draws_that_hit_no_value_are_left_out() -> None:
    values: Values = [("a", "x", 1.0), ("b", "y", 3.0)]
    found = two_way_bootstrap(values)
    assert (found.low, found.high) == (1.0, 3.0)
    assert found.is_above_zero


@given(TABLES, st.integers(-5, 5), st.sampled_from([1, 2, 4]))
def test_it_moves_and_grows_with_the_values(values: Values, by: int, times: int) -> None:
    plain = two_way_bootstrap(values)
    other = two_way_bootstrap([(row, column, times * value + by) for row, column, value in values])
    for end in ("low", "mean", "high"):
        assert getattr(other, end) == pytest.approx(times * getattr(plain, end) + by, abs=1e-9)


@given(TABLES)
def test_ends_are_within_the_values(values: Values) -> None:
    found = two_way_bootstrap(values)
    if math.isfinite(found.low):
        least, most = min(v for *_, v in values), max(v for *_, v in values)
        assert least - 1e-9 <= found.low <= found.high <= most + 1e-9
