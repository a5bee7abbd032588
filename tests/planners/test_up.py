"""unified-planning's engines behind one door, contained, and told apart when they are missing."""

import time
from pathlib import Path

import pytest

from hrcplan.errors import MissingPlannerError, PlannerError, UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.fast_downward import FastDownward
from hrcplan.planners.up import UnifiedPlanning, engines, to_up
from hrcplan.validation import validate

SMALL_DOMAIN = """
(define (domain small)
  (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent thing)
  (:constants depot - thing)
  (:predicates (has ?a - agent ?t - thing) (free ?t - thing))
  (:functions (effort ?a - agent) (weight ?t - thing) (total-cost))
  (:action take :parameters (?a - agent ?t - thing) :precondition (free ?t)
    :effect (and (has ?a ?t) (not (free ?t))
      (increase (total-cost) (+ (effort ?a) (+ (weight ?t) (weight depot))))))
  (:action hand :parameters (?a ?b - agent ?t - thing) :precondition (has ?a ?t)
    :effect (and (has ?b ?t) (not (has ?a ?t)) (increase (total-cost) (effort ?a)))))
"""
SMALL = """
(define (problem one) (:domain small) (:objects human robot - agent x y - thing)
  (:init (free x) (free y) (= (effort human) 2) (= (effort robot) 0.5) (= (weight x) 1)
    (= (weight y) 3) (= (weight depot) 0.25) (= (total-cost) 1))
  (:goal (and (has human x) (has robot y))) (:metric minimize (total-cost)))
"""


@pytest.fixture
def request_(tmp_path: Path) -> Request:
    (tmp_path / "d.pddl").write_text(SMALL_DOMAIN)
    (tmp_path / "p.pddl").write_text(SMALL)
    problem = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    return Request(problem, time.monotonic() + 60)


def check(request: Request, answer: Answer) -> None:
    assert answer.plan is not None
    assert validate(request.problem, answer.plan).valid


def test_symk_proves_what_fast_downward_proves(request_: Request) -> None:
    theirs = FastDownward().solve(request_)
    answer = UnifiedPlanning("symk-opt").solve(request_)
    assert answer.status is theirs.status is Status.OPTIMAL
    assert answer.plan is not None
    assert validate(request_.problem, answer.plan).metric == theirs.objective


def test_conditions_on_the_state_arrive(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text("""
(define (domain lamps) (:requirements :adl) (:predicates (p) (q) (r))
  (:action a :effect (and (p) (when (q) (r))))
  (:action b :precondition (or (p) (and (q) (not (r)))) :effect (and (q) (not (p)))))
""")
    (tmp_path / "p.pddl").write_text(
        "(define (problem x) (:domain lamps) (:init) (:goal (or (and (p) (q)) (and (r) (p)))))"
    )
    problem = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    request = Request(problem, time.monotonic() + 60)
    answer = UnifiedPlanning("symk-opt").solve(request)
    assert answer.status is Status.OPTIMAL
    check(request, answer)
    assert answer.plan is not None
    assert len(answer.plan.actions) == 3


def test_pyperplan_knows_no_costs_and_proves_nothing(request_: Request) -> None:
    answer = UnifiedPlanning("pyperplan-opt").solve(request_)
    assert answer.status is Status.SOLVED
    check(request_, answer)


def test_a_temporal_problem_in_its_sequential_reading() -> None:
    request = Request(read("transport", "two-boxes"), time.monotonic() + 60)
    answer = UnifiedPlanning("symk-opt").solve(request)
    assert answer.status is Status.SOLVED
    check(request, answer)
    assert answer.plan is not None
    assert validate(request.problem, answer.plan).cost == 24


def test_a_missing_engine_says_what_unified_planning_hides(request_: Request) -> None:
    with pytest.raises(MissingPlannerError, match="pip install up-tamer"):
        UnifiedPlanning("tamer").solve(request_)
    with pytest.raises(MissingPlannerError, match="knows no engine 'no-such'"):
        UnifiedPlanning("no-such").solve(request_)


def test_what_is_no_planner_is_unsupported(request_: Request) -> None:
    with pytest.raises(UnsupportedError, match="by itself"):
        UnifiedPlanning("up_grounder").solve(request_)


def test_time_runs_out_as_an_answer(request_: Request) -> None:
    late = Request(request_.problem, time.monotonic() + 0.3)
    answer = UnifiedPlanning("symk-opt").solve(late)
    assert answer.status is Status.UNSOLVED


def test_a_child_that_dies_is_an_error(request_: Request, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some engines take their whole process with them, silently and with exit code 0."""
    monkeypatch.setattr("hrcplan.planners.up._CODE", "raise SystemExit(0)")
    with pytest.raises(PlannerError, match="exit code 0"):
        UnifiedPlanning("symk-opt").solve(request_)


def test_engines_are_listed_with_reasons() -> None:
    found = engines()
    assert found["symk-opt"] is None
    assert "No module named 'up_tamer'" in (found["tamer"] or "")


def test_a_problem_is_handed_over(request_: Request) -> None:
    problem = to_up(request_.problem)
    assert {action.name for action in problem.actions} == {"take", "hand"}
    assert "depot" in {item.name for item in problem.all_objects}
    assert len(problem.quality_metrics) == 1


def test_what_unified_planning_cannot_hold_is_said() -> None:
    with pytest.raises(UnsupportedError, match="total-time"):
        to_up(read("transport", "two-boxes"))
