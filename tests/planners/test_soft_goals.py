"""Preferences of goals compiled away: the same plans, the same costs, proven optima."""

import pytest

from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Status
from hrcplan.planners.soft_goals import without_preferences
from hrcplan.planners.solve import solve
from tests.texts import problem_of

DOMAIN = """(define (domain tea) (:requirements :adl :preferences :action-costs)
  (:predicates (tea ?x) (tidy ?x) (broken ?x)) (:functions (total-cost) (price ?x) (weight))
  (:action pour :parameters (?x) :precondition (not (broken ?x))
    :effect (and (tea ?x) (increase (total-cost) (price ?x))))
  (:action wipe :parameters (?x) :precondition (tea ?x)
    :effect (and (tidy ?x) (not (tea ?x)) (increase (total-cost) 1))){more})"""
PROBLEM = """(define (problem p) (:domain tea) (:objects a b)
  (:init (= (total-cost) 5) (= (price a) 2) (= (price b) 3) (= (weight) 2) {init})
  (:goal (and (or (tea a) (tidy a)) {goal})) {metric})"""
CLEAN = "(preference clean (tidy a)) (forall (?x) (preference served (or (tea ?x) (tidy ?x))))"


def tea(metric: str, goal: str = CLEAN, init: str = "", more: str = "") -> Problem:
    metric = f"(:metric {metric})" if metric else ""
    text = PROBLEM.format(metric=metric, goal=goal, init=init)
    return problem_of(DOMAIN.format(more=more), text)


@pytest.mark.parametrize("planner", ["fast-downward", "uniform-cost", "enhsp", "auto"])
@pytest.mark.parametrize(
    ("metric", "init", "best"),
    [
        ("minimize (is-violated clean)", "", 0),
        ("minimize (+ (total-cost) (* 10 (is-violated clean)) (is-violated served))", "", 9),
        ("minimize (+ (total-cost) (* 10 (is-violated clean)) (* 5 (is-violated served)))", "", 11),
        ("minimize (+ (total-cost) (* 0.5 (is-violated clean)))", "", 7.5),
        ("minimize (+ (* 2 (is-violated served)) (total-time) (weight))", "(broken b)", 5),
        ("minimize (+ (* 2 (total-cost)) (* 3 (is-violated clean)))", "", 16),
        ("", "", 7),
    ],
)
def test_the_best_plan_is_proven(metric: str, init: str, best: float, planner: str) -> None:
    result = solve(tea(metric, init=init), planner, timeout_s=20)
    assert result.plan is not None
    assert result.report is not None
    assert result.objective == best
    assert result.mismatch is None
    assert result.status is Status.OPTIMAL or planner == "enhsp"
    assert {action.name for action in result.plan.actions} <= {"pour", "wipe"}


def test_a_task_without_a_plan_stays_unsolvable() -> None:
    problem = tea("minimize (is-violated clean)", init="(broken a)")
    assert solve(problem, "uniform-cost", timeout_s=20).status is Status.UNSOLVABLE


@pytest.mark.parametrize(
    "problem",
    [
        tea("maximize (is-violated clean)"),
        tea("minimize (* (total-cost) (is-violated clean))"),
        tea("minimize (- (total-cost) (is-violated clean))"),
        tea("minimize (total-cost)", "(tea b)"),
        tea(
            "minimize (total-cost)",
            more="(:action d :parameters (?x) :precondition (preference q (tea ?x))"
            " :effect (tea ?x))",
        ),
    ],
)
def test_what_cannot_be_compiled_is_left_to_others(problem: Problem) -> None:
    assert without_preferences(problem) is None
