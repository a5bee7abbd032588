"""Costs with conditions and quantifiers: ground actions for each cost, and the same optimum."""

import pytest

from hrcplan.planners.contract import Status
from hrcplan.planners.solve import solve
from hrcplan.task import Task
from tests.texts import problem_of

DOMAIN = """(define (domain shop) (:requirements :adl :action-costs)
  (:predicates (bought ?x) (heavy ?x) (free)) (:functions (total-cost) (price ?x))
  (:action buy :parameters (?x) :effect (and (bought ?x) {effect}))
  (:action wait :parameters () :effect (and (free) (increase (total-cost) 1))))"""
PROBLEM = """(define (problem p) (:domain shop) (:objects a b)
  (:init (= (total-cost) 0) (= (price a) 2) (= (price b) 3) (heavy a))
  (:goal (and (bought a) (bought b))) (:metric minimize (total-cost)))"""


@pytest.mark.parametrize("planner", ["fast-downward", "uniform-cost", "enhsp"])
@pytest.mark.parametrize(
    ("effect", "cost", "n_actions"),
    [
        ("(when (heavy ?x) (increase (total-cost) (price ?x)))", 2, 3),
        ("(when (not (free)) (increase (total-cost) (price ?x)))", 1, 5),
        ("(forall (?y) (increase (total-cost) (price ?y)))", 10, 3),
        ("(forall (?y) (when (bought ?y) (increase (total-cost) (price ?y))))", 2, 9),
        ("(when (bought ?x) (increase (total-cost) (price ?x))) (increase (total-cost) 1)", 2, 5),
    ],
)
def test_a_cost_may_depend_on_the_state(
    effect: str, cost: int, n_actions: int, planner: str
) -> None:
    problem = problem_of(DOMAIN.format(effect=effect), PROBLEM)
    assert len(Task(problem).actions) == n_actions
    result = solve(problem, planner, timeout_s=20)
    assert result.objective == cost
    assert result.status is Status.OPTIMAL or planner == "enhsp"
