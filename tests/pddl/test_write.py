"""What is written means the same: exact numbers, every construct, and dialects of it."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.core.numbers import to_number
from hrcplan.episodes.pddlgym_world import environment, fact_of
from hrcplan.errors import UnsupportedError
from hrcplan.pddl import library
from hrcplan.pddl.dialect import with_binary_sums
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.write import decimal_text, domain_text, problem_text
from hrcplan.task import Task

# Every construct that the model has, also ones that the shipped domains do without.
ODD_DOMAIN = """
;; hrcplan: success ask 0.1234567890123456789
(define (domain odd)
  (:requirements :adl :fluents :durative-actions)
  (:types agent place - object box crate - place tub - (either box crate))
  (:constants home - place spare - box)
  (:predicates (at ?a - agent ?p - place) (seen ?x ?y) (on ?b - (either box crate)) (done))
  (:functions (price ?p - place) (mood ?a - agent) (total-cost) - number)
  (:action ask
    :parameters (?a - agent ?p ?q - place)
    :precondition (and (at ?a ?p) (not (= ?p ?q)) (or (done) (imply (seen ?a ?p) (seen ?p ?a)))
      (forall (?b - box) (exists (?c - (either box crate)) (seen ?b ?c)))
      (>= (- (price ?p)) (/ 1 3)))
    :effect (and (not (at ?a ?p)) (forall (?b ?c - box) (when (on ?b) (seen ?b ?c)))
      (when (and (done) (at ?a home)) (not (done))) (assign (mood ?a) 2.50)
      (scale-up (mood ?a) 1e-3) (increase (total-cost) (+ (price ?p) (price spare) 0.1 -2))))
  (:action nothing :parameters () :effect (done))
  (:durative-action wait
    :parameters (?a - agent)
    :duration (and (>= ?duration 1.5) (<= ?duration (* 2 (mood ?a))))
    :condition (and (at start (and (done) (at ?a home))) (over all (done))
      (forall (?b - box) (at end (on ?b))))
    :effect (and (at start (not (done))) (at end (increase (mood ?a) ?duration))
      (forall (?b - box) (at end (when (on ?b) (not (on ?b))))))))
"""
ODD_PROBLEM = """
(define (problem odd-one) (:domain odd) (:objects b2 b1 - box ann - agent c1 - crate t - tub)
  (:init (at ann b2) (seen c1 b1) (done) (= (price home) -0.125) (= (price b2) 1e3) (= (price c1) 0)
    (= (price t) 1) (= (price spare) 2)
    (= (price b1) 0.333333333333333333333333333333) (= (mood ann) 7))
  (:goal (or (done) (not (at ann home)) (exists (?b - box) (on ?b)) (> (mood ann) 0.3)))
  (:metric maximize (- (* 0.17 total-time) (total-cost) (/ (mood ann) 7))))
"""


@pytest.fixture
def odd(tmp_path: Path) -> Problem:
    return read(ODD_DOMAIN, ODD_PROBLEM)


def again(problem: Problem, folder: Path) -> Problem:
    found = read(domain_text(problem.domain), problem_text(problem))
    same = replace(found.domain, path=problem.domain.path)
    return replace(found, domain=same, path=problem.path)


def test_every_construct_is_read_back(odd: Problem, tmp_path: Path) -> None:
    back = again(odd, tmp_path)
    assert back == odd
    # Equal mappings may differ in order; ties are broken by it, so it counts.
    for one, other in [
        (back.objects, odd.objects),
        (back.domain.types, odd.domain.types),
        (back.domain.constants, odd.domain.constants),
        (back.domain.predicates, odd.domain.predicates),
        (back.domain.functions, odd.domain.functions),
    ]:
        assert list(one) == list(other)


def test_what_is_written_is_written_again_alike(odd: Problem, tmp_path: Path) -> None:
    back = again(odd, tmp_path)
    assert domain_text(back.domain) == domain_text(odd.domain)
    assert problem_text(back) == problem_text(odd)


def test_lines_stay_readable() -> None:
    problem = read("kitchen", library.problem_names("kitchen")[0])
    init = problem_text(problem).split("(:init")[1].split("(:goal")[0]
    assert max(map(len, init.splitlines())) <= 100
    assert len(init.splitlines()) < len(problem.facts) + len(problem.values)


@given(st.integers(-(10**30), 10**30), st.integers(-60, 99))
def test_each_number_of_a_file_is_written_so_that_it_is_read_back(digits: int, shift: int) -> None:
    word = f"{digits}e{-shift}"
    value = to_number(word)
    assert value is not None
    assert to_number(decimal_text(value)) == value


def test_a_small_number_without_an_end_is_not_zero() -> None:
    assert 0 < Fraction(decimal_text(Fraction(1, 3 * 10**40))) < Fraction(1, 10**40)


@given(st.fractions().filter(lambda f: 10**30 % f.denominator == 0) | st.integers())
def test_numbers_whose_decimals_end_are_exact(value: Fraction) -> None:
    text = decimal_text(value)
    assert "e" not in text
    assert len(text) > 31 or to_number(text) == value
    assert Fraction(text) == value


@given(st.fractions(min_value=-1000, max_value=1000))
def test_other_numbers_are_near(value: Fraction) -> None:
    read_back = to_number(decimal_text(value))
    assert read_back is not None
    assert abs(read_back - value) <= Fraction(1, 10**12)


def test_changed_values_are_written(odd: Problem, tmp_path: Path) -> None:
    changed = odd.with_values({("mood", "ann"): Fraction(355, 64)})
    assert again(changed, tmp_path).values["mood", "ann"] == Fraction(355, 64)


def test_constants_that_occur_only_in_costs_stay(odd: Problem) -> None:
    """unified-planning's writer drops them; ENHSP then calls a solvable task unsolvable."""
    assert "spare - box" in domain_text(odd.domain)


def test_without_costs_nothing_numeric_is_left() -> None:
    problem = read("kitchen", library.problem_names("kitchen")[0])
    domain, text = (
        domain_text(problem.domain, strip_costs=True),
        problem_text(problem, strip_costs=True),
    )
    for word in ("total-cost", "increase", ":functions", ":metric", ":action-costs", "(= ("):
        assert word not in domain
        assert word not in text


def test_without_costs_the_same_actions_apply() -> None:
    problem = read("kitchen", library.problem_names("kitchen")[0])
    plain = read(
        domain_text(problem.domain, strip_costs=True),
        problem_text(problem, strip_costs=True),
    )
    ours, theirs = Task(problem), Task(plain)
    assert ours.facts == theirs.facts
    assert [str(a) for a in ours.actions] == [str(a) for a in theirs.actions]


def test_numbers_that_decide_cannot_be_left_out(odd: Problem) -> None:
    with pytest.raises(UnsupportedError, match="'ask' compares"):
        domain_text(odd.domain, strip_costs=True)
    plain = read("transport", "two-boxes")
    with pytest.raises(UnsupportedError, match="the goal compares"):
        problem_text(replace(plain, goal=odd.goal), strip_costs=True)


def test_binary_sums_mean_the_same(odd: Problem) -> None:
    """ENHSP reads no sum of more than two."""
    text = domain_text(with_binary_sums(odd).domain)
    assert "(+ (+ (+ (price ?p) (price spare)) 0.1) -2)" in text
    assert "(>= (- 0 (price ?p)) (/ 1 3))" in text
    metric = problem_text(with_binary_sums(odd)).split("maximize ")[1]
    assert metric.startswith("(- (- (* 0.17 (total-time)) (total-cost)) (/ (mood ann) 7))")


def test_pddlgym_reads_the_kitchen_without_costs() -> None:
    """The second simulator: it knows type hierarchies, but no numbers."""
    pytest.importorskip("pddlgym.core", reason="pddlgym needs Python < 3.12")
    problem = read("kitchen", library.problem_names("kitchen")[0])
    env = environment(problem)
    seen, _ = env.reset()
    assert len(seen.literals) == len(problem.facts)
    offered = set(map(fact_of, env.action_space.all_ground_literals(seen)))
    task = Task(problem)
    ours = {(task.actions[i].name, *task.actions[i].args) for i in task.applicable(task.initial)}
    assert ours <= offered  # pddlgym also offers what changes nothing
