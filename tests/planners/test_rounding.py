"""Times that a planner has rounded: gaps that are too short by that are made whole."""

import pytest

from hrcplan.errors import PlannerError
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.kairos import Kairos
from hrcplan.planners.result import ask
from hrcplan.planners.rounding import with_wider_gaps
from hrcplan.plans import parse_plan
from tests.planners.actors import Actor
from tests.texts import problem_of

DOMAIN = """(define (domain race) (:requirements :durative-actions :fluents)
  (:predicates (at ?x) (free) (next ?x ?y)) (:functions (length ?x))
  (:durative-action run :parameters (?x ?y) :duration (= ?duration (/ (length ?x) 3))
    :condition (and (at start (at ?x)) (at start (next ?x ?y)) (over all (free)))
    :effect (and (at start (not (at ?x))) (at end (at ?y)))))"""
PROBLEM = problem_of(DOMAIN, """(define (problem p) (:domain race) (:objects a b c d)
  (:init (at a) (free) (next a b) (next b c) (next c d)
    (= (length a) 380) (= (length b) 20) (= (length c) 5)) (:goal (at d)))""")  # fmt: skip


@pytest.mark.parametrize(
    "plan",
    [
        "0: (run a b) [126.666667]\n126.667666: (run b c) [6.666667]\n"
        "133.335333: (run c d) [1.666667]",
        "0: (run a b) [126.667]\n126.667: (run b c) [6.667]\n133.335: (run c d) [1.667]",
    ],
)
def test_gaps_that_rounding_made_too_short_are_widened(plan: str) -> None:
    actor = Actor("rounds", lambda request: Answer(Status.SOLVED, parse_plan(plan)))
    result = ask(actor, Request(PROBLEM), False, "")
    assert result.report is not None
    assert result.report.valid


def test_a_plan_that_is_wrong_otherwise_stays_invalid() -> None:
    plan = parse_plan("0: (run a b) [126.667]\n120: (run b c) [6.667]\n133.335: (run c d) [1.667]")
    actor = Actor("wrong", lambda request: Answer(Status.SOLVED, plan))
    with pytest.raises(PlannerError, match="invalid plan"):
        ask(actor, Request(PROBLEM), False, "")


def test_only_schedules_in_decimals_are_changed() -> None:
    for text in ("(run a b)\n(run b c)", "0: (run a b) [5]"):
        plan = parse_plan(text)
        assert with_wider_gaps(plan) is plan


def test_plans_of_kairos_with_thirds_are_valid() -> None:
    result = ask(Kairos(), Request(PROBLEM, any_plan=True), False, "")
    assert result.plan is not None
    assert len(result.plan.actions) == 3
