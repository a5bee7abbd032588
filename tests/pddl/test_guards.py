"""Guards of functions without a value: the same plans, and nothing that is read is missing."""

from itertools import product

import pytest

from hrcplan.pddl.guards import guarded
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.plans import Plan, PlannedAction
from hrcplan.validation import validate
from tests.texts import problem_of

DOMAIN = """(define (domain sparse) (:requirements :adl :fluents :derived-predicates)
  (:constants a b) (:predicates (at ?x) (has-toll) (near ?x)) (:functions (toll ?x) (fuel) (share))
  (:derived (near ?x) (< (toll ?x) 3))
  (:action go :parameters (?x) :precondition (and (not (at ?x)) {condition})
    :effect (and (at ?x) {effect}))
  (:action set :parameters (?x)
    :effect (and (when (not (at ?x)) (assign (toll ?x) 2)) (decrease (share) 1))))
"""
PROBLEM = """(define (problem p) (:domain sparse)
  (:init (= (fuel) 4) (= (share) 1) (= (toll a) 3)) (:goal {goal}))"""


def plans(problem: Problem, length: int) -> list[Plan]:
    steps = [
        PlannedAction(action.name, args)
        for action in problem.domain.actions
        for args in product(problem.all_objects, repeat=len(action.params))
    ]
    return [Plan(chosen) for n in range(length + 1) for chosen in product(steps, repeat=n)]


@pytest.mark.parametrize(
    ("condition", "effect", "goal"),
    [
        ("(or (< (toll ?x) 3) (at a))", "", "(at b)"),
        ("(not (< (toll ?x) 3))", "", "(at a)"),
        ("(imply (not (= (toll ?x) 2)) (at a))", "", "(at b)"),
        ("(forall (?y) (or (= ?x ?y) (>= (toll ?y) 2)))", "", "(at a)"),
        ("(not (exists (?y) (< (toll ?y) 2)))", "", "(at a)"),
        ("", "(decrease (fuel) (toll ?x))", "(and (at a) (at b))"),
        ("", "(increase (toll ?x) 1)", "(at b)"),
        ("", "(when (at a) (decrease (fuel) (toll ?x)))", "(at b)"),
        ("", "(forall (?y) (when (at ?y) (decrease (fuel) (toll ?y))))", "(at b)"),
        ("(near ?x)", "", "(or (at a) (at b))"),
        ("", "", "(and (at b) (not (> (toll b) 2)))"),
        ("(> (/ 1 (share)) 0)", "", "(at b)"),
        ("", "(assign (fuel) (/ (toll ?x) (share)))", "(at b)"),
        ("", "(scale-down (fuel) (share))", "(at b)"),
    ],
)
def test_guards_change_no_plan_and_nothing_missing_is_read(
    condition: str, effect: str, goal: str
) -> None:
    problem = problem_of(
        DOMAIN.format(condition=condition, effect=effect), PROBLEM.format(goal=goal)
    )
    safe = guarded(problem)
    again = problem_of(domain_text(safe.domain), problem_text(safe))
    assert "has-toll-2" in safe.domain.predicates or "toll" not in f"{condition}{effect}"
    verdicts = set()
    for plan in plans(problem, 3):
        report, other = validate(problem, plan), validate(again, plan)
        assert report.valid == other.valid, (str(plan), report.reason, other.reason)
        assert "no value" not in str(other.reason)
        assert "zero" not in str(other.reason)
        verdicts.add(report.valid)
    assert verdicts == {True, False}


TIMED = """(define (domain timed) (:requirements :durative-actions :fluents)
  (:predicates (at ?x)) (:functions (length ?x))
  (:durative-action go :parameters (?x) :duration (= ?duration (length ?x))
    :condition (and) :effect (at end (at ?x))))"""


@pytest.mark.parametrize(("name", "valid"), [("a", True), ("b", False), ("c", False)])
def test_durations_and_timed_values_have_guards(name: str, valid: bool) -> None:
    text = f"""(define (problem p) (:domain timed) (:objects a b c)
      (:init (= (length a) 2) (at 3 (= (length b) 2))) (:goal (at {name})))"""
    safe = guarded(problem_of(TIMED, text))
    plan = Plan((PlannedAction("go", (name,), 0, 2),))
    report = validate(safe, plan)
    assert report.valid == valid
    assert valid or f"(has-length {name})" in str(report.reason)
    late = Plan((PlannedAction("go", ("b",), 4, 2),))
    assert validate(safe, late).valid == (name == "b")


def test_values_that_never_come_can_stay_missing() -> None:
    domain = """(define (domain roads) (:requirements :fluents)
      (:predicates (at ?x)) (:functions (length ?x ?y) (level ?x) (driven))
      (:action go :parameters (?x ?y) :precondition (and (at ?x) (> (level ?x) 0))
        :effect (and (at ?y) (increase (driven) (length ?x ?y))))
      (:action fill :parameters (?x) :effect (assign (level ?x) 1)))"""
    problem = problem_of(domain, """(define (problem p) (:domain roads) (:objects a b c)
      (:init (at a) (= (driven) 0) (= (length a b) 2)) (:goal (at b)))""")  # fmt: skip
    full, sparse = guarded(problem), guarded(problem, fills=False)
    assert sparse.domain == full.domain
    assert sparse.facts == full.facts
    assert set(full.values) - set(sparse.values) == {
        ("length", x, y) for x in "abc" for y in "abc" if (x, y) != ("a", "b")
    }
    assert sparse.values["level", "c"] == 0


def test_a_problem_without_gaps_stays_as_it_is() -> None:
    problem = read("transport", "two-boxes")
    assert guarded(problem) is problem
