"""Constructs beyond facts and numbers: who is asked to plan with them, and that it is judged."""

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Status
from hrcplan.planners.solve import solve
from tests.texts import problem_of

WIRES = problem_of(
    """(define (domain wires) (:requirements :adl :derived-predicates)
      (:predicates (source ?x) (wire ?x ?y) (closed ?x) (fed ?x))
      (:functions (total-cost) (price ?x))
      (:derived (fed ?x) (and (closed ?x)
        (or (source ?x) (exists (?y) (and (wire ?y ?x) (fed ?y))))))
      (:action close :parameters (?x) :precondition (not (closed ?x))
        :effect (and (closed ?x) (increase (total-cost) (price ?x)))))""",
    """(define (problem p) (:domain wires) (:objects a b c d)
      (:init (source a) (wire a b) (wire b d) (wire a c) (wire c d)
        (= (price a) 1) (= (price b) 5) (= (price c) 2) (= (price d) 1))
      (:goal (fed d)) (:metric minimize (total-cost)))""",
)
DOOR = problem_of(
    """(define (domain door) (:requirements :durative-actions :timed-initial-literals)
      (:predicates (open) (inside) (outside))
      (:durative-action enter :parameters () :duration (= ?duration 2)
        :condition (and (over all (open)) (at start (outside)))
        :effect (and (at start (not (outside))) (at end (inside)))))""",
    """(define (problem p) (:domain door) (:init (outside) (at 5 (open)) (at 9 (not (open))))
      (:goal (inside)))""",
)
TEA = problem_of(
    """(define (domain tea) (:requirements :strips :preferences)
      (:predicates (tea ?x) (tidy ?x)) (:action pour :parameters (?x) :effect (tea ?x))
      (:action wipe :parameters (?x) :precondition (tea ?x) :effect (tidy ?x)))""",
    """(define (problem p) (:domain tea) (:objects a b)
      (:init) (:goal (and (tea a) (preference clean (tidy a))))
      (:metric minimize (is-violated clean)))""",
)
MEMORY = problem_of(
    """(define (domain memory) (:requirements :durative-actions :conditional-effects)
      (:predicates (light) (seen) (free))
      (:durative-action look :parameters () :duration (= ?duration 3)
        :condition (at start (free))
        :effect (and (at start (not (free))) (at end (free))
          (when (at start (light)) (at end (seen)))))
      (:durative-action lamp :parameters () :duration (= ?duration 1)
        :condition (at start (free))
        :effect (and (at start (not (free))) (at end (free)) (at end (light)))))""",
    "(define (problem p) (:domain memory) (:init (free)) (:goal (seen)))",
)
TANK = problem_of(
    """(define (domain tank) (:requirements :fluents :time)
      (:predicates (filling)) (:functions (level))
      (:action turn :parameters () :effect (filling))
      (:process flow :parameters () :precondition (filling)
        :effect (increase (level) (* #t 2))))""",
    "(define (problem p) (:domain tank) (:init (= (level) 0)) (:goal (> (level) 5)))",
)


@pytest.mark.parametrize("problem", [WIRES, DOOR, TEA, MEMORY], ids=lambda p: p.domain.name)
def test_a_plan_is_found_and_judged(problem: Problem) -> None:
    result = solve(problem, timeout_s=15)
    assert result.plan is not None
    assert result.report is not None
    assert result.report.valid


@pytest.mark.parametrize("planner", ["fast-downward", "kairos"])
def test_planners_that_know_axioms_find_the_cheapest_plan(planner: str) -> None:
    result = solve(WIRES, planner, timeout_s=15)
    assert result.objective == 4
    if planner == "fast-downward":
        assert result.status is Status.OPTIMAL


@pytest.mark.parametrize(
    ("problem", "planner", "name"),
    [
        (WIRES, "exact", "derived predicates"),
        (WIRES, "uniform-cost", "derived predicates"),
        (WIRES, "enhsp", "derived predicates"),
        (DOOR, "exact", "timed initial literals"),
        (MEMORY, "exact", "condition at the start"),
        (TANK, "fast-downward", "processes"),
    ],
)
def test_a_planner_that_does_not_know_a_construct_says_so(
    problem: Problem, planner: str, name: str
) -> None:
    with pytest.raises(UnsupportedError, match=name):
        solve(problem, planner, timeout_s=15)


def test_a_plan_that_hrcplan_cannot_judge_is_shown_as_such() -> None:
    result = solve(TANK, timeout_s=15)
    assert result.plan is not None
    assert result.report is None
    assert result.status is Status.SOLVED
    assert "cannot judge" in str(result.mismatch)


SPARSE = """(define (domain sparse) (:requirements :fluents :negative-preconditions)
  (:predicates (at ?x)) (:functions (distance ?x ?y) (fuel))
  (:action drive :parameters (?x ?y)
    :precondition (and (at ?x) {condition})
    :effect (and (at ?y) (not (at ?x)) {effect})))
"""
SPARSE_PROBLEM = """(define (problem p) (:domain sparse) (:objects a b c)
  (:init (at a) (= (fuel) 10) (= (distance a b) 2) (= (distance b c) 3)) (:goal (at c)))"""


@pytest.mark.parametrize("planner", ["kairos", "enhsp", "uniform-cost"])
@pytest.mark.parametrize(
    ("condition", "effect"),
    [
        ("(>= (fuel) (distance ?x ?y))", "(decrease (fuel) 1)"),
        ("(not (< (distance ?x ?y) 1))", "(decrease (fuel) 1)"),
        ("(> (fuel) 0)", "(decrease (fuel) (distance ?x ?y))"),
        ("(imply (< (distance ?x ?y) 1) (at ?y))", "(decrease (fuel) (distance ?x ?y))"),
        ("(> (fuel) 0)", "(when (at ?x) (decrease (fuel) (distance ?x ?y)))"),
    ],
)
def test_planners_leave_out_what_reads_an_undefined_value(
    condition: str, effect: str, planner: str
) -> None:
    problem = problem_of(SPARSE.format(condition=condition, effect=effect), SPARSE_PROBLEM)
    result = solve(problem, planner, timeout_s=15)
    assert result.plan is not None
    assert [a.args for a in result.plan.actions] == [("a", "b"), ("b", "c")]
