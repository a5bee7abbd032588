"""Goals with nested quantifiers are grounded without a look at every instance beforehand."""

import pytest

from hrcplan.pddl.walks import compares
from hrcplan.task import Task, grounding
from tests.texts import problem_of

DOMAIN = """(define (domain d) (:requirements :adl) (:predicates (p ?x) (q ?x ?y))
  (:action a :parameters (?x) :precondition () :effect (p ?x)))"""
PROBLEM = """(define (problem p) (:domain d) (:objects a b c) (:init (q a b))
  (:goal (forall (?x) (exists (?y) (or (p ?x) (q ?x ?y))))))"""


def test_a_goal_without_numbers_is_not_searched_for_functions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = problem_of(DOMAIN, PROBLEM)
    assert not compares(problem.goal)
    monkeypatch.setattr(grounding, "mentions", lambda *_: pytest.fail("every instance is visited"))
    assert Task(problem).goal
