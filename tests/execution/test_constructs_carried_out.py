"""Constructs beyond facts and actions are carried out: axioms, effects of a start, preferences."""

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.execution import events as ev
from hrcplan.execution.execute import execute
from hrcplan.execution.order import waits
from hrcplan.execution.worlds.simulated import FactChange, Nature
from hrcplan.pddl.inputs import read
from hrcplan.plans import parse_plan
from tests.execution.scripted import carried_out

BLOCKS = """
(define (domain blocks) (:requirements :adl :derived-predicates)
  (:types agent block)
  (:predicates (on ?x ?y - block) (table ?x - block) (hold ?a - agent ?x - block)
               (above ?x ?y - block) (clear ?x - block))
  (:derived (above ?x ?y - block)
    (or (on ?x ?y) (exists (?z - block) (and (on ?x ?z) (above ?z ?y)))))
  (:derived (clear ?x - block) (not (exists (?y - block) (above ?y ?x))))
  (:action lift :parameters (?a - agent ?x - block)
    :precondition (and (clear ?x) (not (exists (?o - agent) (hold ?o ?x))))
    :effect (and (hold ?a ?x) (not (table ?x)) (forall (?y - block) (not (on ?x ?y)))))
  (:action stack :parameters (?a - agent ?x ?y - block)
    :precondition (and (hold ?a ?x) (clear ?y) (not (above ?y ?x)))
    :effect (and (on ?x ?y) (not (hold ?a ?x)))))
"""
TOWER = """
(define (problem tower) (:domain blocks) (:objects ann bob - agent a b c - block)
  (:init (on a b) (table b) (table c)) (:goal (and (above a c) (above b c))))
"""


def test_recursive_derived_predicates_are_planned_and_carried_out() -> None:
    done = execute(BLOCKS, TOWER, planner="fast-downward")
    assert done.outcome.success


def test_an_action_waits_for_one_that_changes_what_its_condition_follows_from() -> None:
    plan = parse_plan("0: (lift ann a) [1]\n1: (lift bob b) [1]")
    order = waits(read(BLOCKS, TOWER), plan)
    assert [wait.index for wait in order[1]] == [0]  # (clear b) does not hold as (above a b) does


def test_a_deviation_in_what_is_derived_is_seen() -> None:
    way = "0: (lift ann b) [1]\n1: (stack ann b c) [1]\n2: (lift bob a) [1]\n3: (stack bob a b) [1]"
    problem = read(BLOCKS, TOWER.replace("(on a b)", "(table a)"))
    fallen = Nature(accidents=(FactChange(0.5, frozenset({("on", "a", "c")})),))
    done, provider = carried_out(problem, way, nature=fallen)
    assert done.outcome.ending == ev.NO_PLAN  # as there is no other plan to hand
    assert "deviation: (on a c) holds" in provider.asks[1].reasons


KETTLE = """
(define (domain kettle) (:requirements :durative-actions :conditional-effects)
  (:predicates (full) (hot) (warm) (idle))
  (:durative-action drain :duration (= ?duration 2) :condition (at start (idle))
    :effect (and (at start (not (idle))) (at end (not (full))) (at end (idle))))
  (:durative-action boil :duration (= ?duration 5)
    :effect (and (when (at start (full)) (at end (hot)))
                 (when (and (at start (full)) (at end (not (full)))) (at end (warm))))))
"""


@pytest.mark.parametrize(("drain_s", "is_warm"), [(0, True), (6, False)])
def test_an_effect_at_the_end_remembers_the_start(drain_s: int, is_warm: bool) -> None:
    goal = "(and (hot) (not (full)) (warm))" if is_warm else "(and (hot) (not (full)))"
    problem = read(
        KETTLE,
        f"(define (problem tea) (:domain kettle) (:init (full) (idle)) (:goal {goal}))",
    )
    done, _ = carried_out(problem, f"0: (boil) [5]\n{drain_s}.001: (drain) [2]")
    assert done.outcome.success
    assert (("warm",) in done.run.state.facts) == is_warm


ROOMS = """
(define (domain rooms) (:requirements :typing :preferences)
  (:types room) (:predicates (clean ?r - room))
  (:action clean :parameters (?r - room) :effect (clean ?r)))
"""


def test_preferences_are_worth_the_rest_of_the_plan() -> None:
    problem = read(
        ROOMS,
        "(define (problem p) (:domain rooms) (:objects a b - room) (:init) (:goal (and (clean a)"
        " (preference tidy (clean b)))) (:metric minimize (is-violated tidy)))",
    )
    done, _ = carried_out(problem, "0: (clean a) [1]\n1: (clean b) [1]")
    assert done.outcome.success
    assert ("clean", "b") in done.run.state.facts


def test_trajectory_constraints_are_refused_by_name() -> None:
    problem = (
        "(define (problem p) (:domain rooms) (:objects a b - room) (:init) (:goal (clean a))"
        " (:constraints (sometime (clean b))))"
    )
    with pytest.raises(UnsupportedError, match="trajectory constraints cannot be executed"):
        execute(ROOMS.replace(":preferences", ":constraints"), problem)
