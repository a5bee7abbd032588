"""``either`` compiled away means the same: equal ground actions, equal verdicts."""

from __future__ import annotations

from hrcplan.pddl.inputs import read
from hrcplan.pddl.single_types import with_single_types
from hrcplan.planners.handover import Handover
from hrcplan.planners.solve import solve
from hrcplan.task.reachable import reachable

DOMAIN = """
(define (domain port)
  (:requirements :typing :numeric-fluents :conditional-effects)
  (:types car boat plane - object  amphibian - car  amphibian - boat  place)
  (:predicates (at ?v - (either car boat plane) ?p - place) (shiny ?v - object) (is-car-or-boat))
  (:functions (fuel ?v - (either car boat)))
  (:action go :parameters (?v - (either car boat) ?a ?b - place)
    :precondition (and (at ?v ?a) (>= (fuel ?v) 2))
    :effect (and (not (at ?v ?a)) (at ?v ?b) (decrease (fuel ?v) 2)))
  (:action sail :parameters (?v - boat ?a ?b - place)
    :precondition (at ?v ?a) :effect (and (not (at ?v ?a)) (at ?v ?b)))
  (:action wash :parameters (?p - place)
    :precondition (exists (?v - (either car plane)) (at ?v ?p))
    :effect (forall (?v - (either plane boat)) (when (at ?v ?p) (shiny ?v)))))
"""
PROBLEM = """
(define (problem p) (:domain port)
  (:objects c - car b - boat a - amphibian f - plane x y - place)
  (:init (at c x) (at b x) (at f y) (at a y) (= (fuel c) 4) (= (fuel b) 6) (= (fuel a) 2))
  (:goal (and (forall (?v - (either boat plane)) (shiny ?v)) (at c y))))
"""


def names(problem) -> list[str]:  # type: ignore[no-untyped-def]
    instances, _ = reachable(problem, float("inf"))
    return sorted(f"{i.action.name} {' '.join(i.binding.values())}" for i in instances)


def test_the_same_ground_actions_and_no_either_in_the_text() -> None:
    problem = read(DOMAIN, PROBLEM)
    single = with_single_types(problem)
    texts = Handover(single).texts
    assert all("either" not in text for text in texts)
    assert names(read(*texts)) == names(single) == names(problem)


def test_a_problem_with_single_types_is_the_same_object() -> None:
    problem = read("transport", "two-boxes")
    assert with_single_types(problem) is problem


def test_enhsp_plans_with_either() -> None:
    result = solve(read(DOMAIN, PROBLEM), "enhsp", any_plan=True, timeout_s=60)
    assert result.plan is not None
    assert {"wash", "go"} <= {action.name for action in result.plan.actions}
