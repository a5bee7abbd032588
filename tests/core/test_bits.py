"""Bits and exact numbers, against what Python's own text of a number says."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.core.bits import common, holders, positions, single_bits, union
from hrcplan.core.numbers import exact, number_text, to_number

BITS = st.integers(0, 1 << 200)


@given(BITS)
def test_positions_are_those_of_the_binary_digits(bits: int) -> None:
    digits = bin(bits)[:1:-1]
    assert list(positions(bits)) == [i for i, digit in enumerate(digits) if digit == "1"]
    assert sum(single_bits(bits)) == bits


@given(st.lists(st.integers(0, 255), min_size=1))
def test_holders_transpose_sets(sets: list[int]) -> None:
    by_bit = holders(sets, 8)
    assert holders(by_bit, len(sets)) == sets
    assert union(sets) == sum(1 << bit for bit in range(8) if by_bit[bit])
    everyone = (1 << len(sets)) - 1
    assert common(sets) == sum(1 << bit for bit in range(8) if by_bit[bit] == everyone)


@given(st.fractions(max_denominator=10**6))
def test_whole_fractions_are_ints_and_nothing_else_changes(value: Fraction) -> None:
    number = exact(value)
    assert number == value
    assert isinstance(number, int) == (value.denominator == 1)
    assert exact(str(value)) == value


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_floats_keep_their_binary_value(value: float) -> None:
    assert float(exact(value)) == value


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_floats_that_are_no_numbers_are_refused(value: float) -> None:
    with pytest.raises((ValueError, OverflowError)):
        exact(value)


@given(st.decimals(min_value=-100, max_value=100, places=6).map(Fraction))
def test_decimals_are_read_as_they_are_written(value: Fraction) -> None:
    assert to_number(number_text(exact(value))) == value
