"""Effects that depend on the start of their action, with facts that remember it."""

import pytest

from hrcplan.pddl.memory_facts import with_memory_facts
from hrcplan.pddl.model import TRUE
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.kairos import Kairos
from hrcplan.plans import parse_plan
from hrcplan.validation import validate
from tests.texts import problem_of

OVEN = """(define (domain oven) (:requirements :durative-actions :adl)
  (:types dish) (:predicates (hot) (lid ?d - dish) (raw ?d - dish) (done ?d - dish) (burnt))
  (:durative-action heat :parameters () :duration (= ?duration 2) :condition (and)
    :effect (and (at start (hot)) (at end (not (hot)))))
  (:durative-action bake :parameters (?d - dish) :duration (= ?duration 1)
    :condition (at start (raw ?d))
    :effect (and (at end (not (raw ?d)))
      (when (and (at start (hot)) (at start (lid ?d))) (at end (done ?d)))
      (forall (?e - dish) (when (and (at start (hot)) (at end (lid ?e))) (at end (done ?e))))
      (when (at start (not (hot))) (at end (burnt))))))"""
PIES = """(define (problem pies) (:domain oven) (:objects pie cake - dish)
  (:init (raw pie) (raw cake) (lid pie)) (:goal (and (done pie) (not (burnt)))))"""


@pytest.mark.parametrize(
    "text",
    [
        "0: (heat) [2]\n0.5: (bake pie) [1]",
        "0: (heat) [2]\n0.5: (bake cake) [1]",
        "0: (heat) [2]\n1.5: (bake pie) [1]",
        "0: (bake pie) [1]\n0.5: (heat) [2]",
        "0: (heat) [2]\n0.5: (bake cake) [1]\n0.7: (bake pie) [1]",
        "0: (bake pie) [1]",
    ],
)
def test_plans_are_judged_the_same(text: str) -> None:
    problem = problem_of(OVEN, PIES)
    simple = with_memory_facts(problem)
    effects = [effect for action in simple.domain.actions for effect in action.effects]
    assert all(effect.start_condition == TRUE for effect in effects)
    one, other = (validate(p, parse_plan(text)) for p in (problem, simple))
    remembered = {fact for fact in other.state if fact[0].startswith("remember")}
    assert (one.valid, one.reason) == (other.valid, other.reason)
    assert one.state == other.state - remembered
    assert not remembered


def test_a_problem_without_them_stays() -> None:
    problem = problem_of(OVEN.replace("at start (hot)) (at", "at end (hot)) (at").replace(
        "(when (at start (not (hot)))", "(when (at end (not (hot)))").replace(
        "(at start (lid", "(at end (lid"), PIES)  # fmt: skip
    assert with_memory_facts(problem) is problem


def test_kairos_plans_with_several_of_them() -> None:
    answer = Kairos().solve(Request(problem_of(OVEN, PIES), any_plan=True))
    assert answer.status is Status.SOLVED
