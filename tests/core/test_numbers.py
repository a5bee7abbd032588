"""Numbers of any size are read, written and computed, or refused by a typed error in no time."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.core.numbers import decimal_of, fraction_of, int_of, int_text, nearest_float
from hrcplan.errors import LimitError
from hrcplan.pddl.inputs import read
from hrcplan.plans import Plan, PlannedAction, parse_plan
from hrcplan.validation import validate

DOMAIN = """(define (domain big) (:requirements :numeric-fluents) (:functions (f) (total-cost))
  (:action square :parameters () :effect (assign (f) (* (f) (f))))
  (:action halve :parameters () :effect (assign (f) (/ (f) 2)))
  (:action pay :parameters () :effect (increase (total-cost) (* (f) (* (f) (f))))))"""
PROBLEM = """(define (problem p) (:domain big) (:init (= (f) {f}) (= (total-cost) 0)) (:goal (and))
  (:metric minimize (total-cost)))"""


@given(st.fractions())
def test_decimals_are_exact_or_off_by_half_of_the_last(value: Fraction) -> None:
    assert abs(Fraction(decimal_of(value)) - value) <= Fraction(1, 2 * 10**12)


@given(st.integers(), st.integers(0, 3000))
def test_whole_numbers_of_any_length_come_back(value: int, zeros: int) -> None:
    large = value * 10**zeros
    assert int_of(int_text(large)) == large
    assert int_text(large, ",").replace(",", "") == int_text(large)


@given(st.fractions())
def test_a_fraction_is_read_as_it_is_written(value: Fraction) -> None:
    assert fraction_of(str(value)) == value


@pytest.mark.parametrize(
    "text", ["1e999999999", "1" * 10_000_000, "1/0", "", "nan", "0x1", "1e1e1"]
)
def test_what_is_no_number_of_sensible_size_is_none(text: str) -> None:
    assert fraction_of(text) is None


def test_floats_beyond_the_largest_are_whole_numbers() -> None:
    assert nearest_float(Fraction(10**400 * 4 + 1, 4)) == 10**400


def problem_with(tmp_path: Path, f: str) -> tuple[str, str]:
    domain, problem = tmp_path / "big.pddl", tmp_path / "p.pddl"
    domain.write_text(DOMAIN)
    problem.write_text(PROBLEM.format(f=f))
    return str(domain), str(problem)


def test_a_number_that_doubles_its_digits_is_a_limit(tmp_path: Path) -> None:
    problem = read(*problem_with(tmp_path, "9"))
    with pytest.raises(LimitError, match="digits"):
        validate(problem, Plan(tuple(PlannedAction("square", ()) for _ in range(40))))


@pytest.mark.parametrize("f", ["9" * 149 + ".5", "9" * 149])
def test_a_cost_beyond_the_largest_float_is_shown(tmp_path: Path, f: str) -> None:
    from click.testing import CliRunner

    from hrcplan.cli import main

    paths = problem_with(tmp_path, f)
    plan = tmp_path / "plan"
    plan.write_text("(pay)\n" if "." in f else "(square)\n" * 3 + "(pay)")
    for flags in ([], ["--json"]):
        done = CliRunner().invoke(main, ["validate", *paths, str(plan), *flags])
        assert done.exit_code == 0, done.output
    assert parse_plan(plan.read_text()).actions
