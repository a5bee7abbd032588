"""Names that are keywords: read where nothing else can be meant, and handed over as other names."""

import shlex
import sys
from pathlib import Path

import pytest

from hrcplan.pddl.check import check_files
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.contract import Status
from hrcplan.planners.handover import Handover
from hrcplan.planners.solve import solve
from tests.texts import problem_of

DOMAIN = """(define (domain domain) (:requirements :adl :fluents :action-costs)
  (:types number) (:constants all - number)
  (:predicates (when ?x - number) (increase ?x - number) (not ?x - number) (end) (forall)
    (preference ?x - number))
  (:functions (start ?x - number) (total-cost))
  (:action over :parameters (?x - number)
    :precondition (and (when ?x) (not (increase ?x)) (not (not ?x)) (imply (end) (forall)))
    :effect (and (increase ?x) (not ?x) (end) (forall) (increase (total-cost) 1)))
  (:action define :parameters (?x - number)
    :precondition (and (increase ?x) (not ?x) (forall) (> (start ?x) 1))
    :effect (and (when (end) (not (when ?x))) (preference ?x) (increase (total-cost) 1))))"""
PROBLEM = """(define (problem problem) (:domain domain) (:objects exists - number)
  (:init (when all) (when exists) (= (start all) 2) (= (start exists) 2) (= (total-cost) 0))
  (:goal (and (preference exists) (not (when exists)) (not exists) (forall)))
  (:metric minimize (total-cost)))"""


@pytest.mark.parametrize("planner", ["fast-downward", "enhsp", "kairos", "uniform-cost", "auto"])
def test_planners_get_other_names_and_plans_have_the_old_ones(planner: str) -> None:
    result = solve(problem_of(DOMAIN, PROBLEM), planner, timeout_s=20)
    assert result.plan is not None
    assert str(result.plan) == "(over exists)\n(define exists)\n"
    assert result.status is Status.OPTIMAL or planner == "enhsp"


def test_a_program_gets_other_names_too(tmp_path: Path) -> None:
    problem = problem_of(DOMAIN, PROBLEM)
    handover = Handover.of(problem)
    assert {"when", "not", "over", "all"} <= set(handover.names.values())
    planner = tmp_path / "planner.py"
    planner.write_text("print('(over-1 exists-1)'); print('(define-1 exists-1)')")
    command = f"{sys.executable} {shlex.quote(str(planner))} {{domain}} {{problem}}"
    result = solve(problem, f"cmd:{command}", timeout_s=20)
    assert str(result.plan) == "(over exists)\n(define exists)\n"


def test_what_is_written_reads_the_same() -> None:
    problem = problem_of(DOMAIN, PROBLEM)
    again = problem_of(domain_text(problem.domain), problem_text(problem))
    assert (again.goal, again.facts) == (problem.goal, problem.facts)
    assert again.domain.actions == problem.domain.actions


def test_such_names_are_a_warning(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(DOMAIN)
    found = check_files([tmp_path / "d.pddl"])
    names = [d.message for d in found if d.code == "keyword-name"]
    assert len(names) == 6
    assert "many readers refuse a predicate called 'when'" in names


ODD_DOMAIN = """(define (domain a/b) (:requirements :strips :durative-actions :typing)
  (:types box.x) (:predicates (at@home ?b - box.x) (done! ?b - box.x))
  (:durative-action lift+@ :parameters (?b - box.x) :duration (= ?duration 2)
    :condition (at start (at@home ?b)) :effect (at end (done! ?b))))"""
ODD_PROBLEM = """(define (problem p%) (:domain a/b) (:objects b+ b- b_ é - box.x)
  (:init (at@home b+) (at@home b-) (at@home b_) (at@home é))
  (:goal (and (done! b+) (done! b-) (done! b_) (done! é))))"""


@pytest.mark.parametrize("planner", ["kairos", "fast-downward"])
def test_names_of_any_characters_are_planned_with(planner: str) -> None:
    result = solve(problem_of(ODD_DOMAIN, ODD_PROBLEM), planner, timeout_s=20, any_plan=True)
    assert result.plan is not None
    assert {(a.name, *a.args) for a in result.plan.actions} == {
        ("lift+@", box) for box in ("b+", "b-", "b_", "é")
    }
