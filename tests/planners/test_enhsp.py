"""ENHSP proves what it understands, and is not believed where it is known to be wrong."""

import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.errors import PlannerError, UnsupportedError
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners import enhsp, handover
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.enhsp import Enhsp
from hrcplan.planners.fast_downward import FastDownward
from hrcplan.planners.solve import solve as solve_problem
from hrcplan.task import Task
from hrcplan.validation import validate
from tests.texts import problem_of

TANK = """
(define (domain tank)
  (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types place)
  (:predicates (at ?p - place) (road ?a ?b - place))
  (:functions (fuel) (use ?a ?b - place) (total-cost))
  (:action drive :parameters (?a ?b - place)
    :precondition (and (at ?a) (road ?a ?b) (>= (fuel) (use ?a ?b)))
    :effect (and (not (at ?a)) (at ?b) (decrease (fuel) (use ?a ?b))
      (increase (total-cost) (+ 1 (* 0.25 (use ?a ?b)) 0.1))))
  (:action refuel :parameters () :precondition (< (fuel) 3)
    :effect (and (increase (fuel) 7) (increase (total-cost) PRICE))))
"""
TRIP = """
(define (problem trip) (:domain tank) (:objects a b c - place)
  (:init (at a) (road a b) (road b c) (= (use a b) 4) (= (use b c) 5) (= (fuel) 5)
    (= (use a a) 0) (= (use a c) 0) (= (use b a) 0) (= (use b b) 0) (= (use c a) 0) (= (use c b) 0)
    (= (use c c) 0) (= (total-cost) 5))
  (:goal (and (at c) (>= (fuel) 2))) (:metric minimize (total-cost)))
"""


def tank(folder: Path, price: str = "3", trip: str = TRIP) -> Problem:
    (folder / "d.pddl").write_text(TANK.replace("PRICE", price))
    (folder / "p.pddl").write_text(trip)
    return read(folder / "d.pddl", folder / "p.pddl")


def solve(problem: Problem, seconds: float = 30, *, any_plan: bool = False) -> Answer:
    return Enhsp().solve(Request(problem, time.monotonic() + seconds, any_plan))


def test_numbers_that_bits_cannot_hold_are_planned_with(tmp_path: Path) -> None:
    problem = tank(tmp_path)
    with pytest.raises(UnsupportedError):
        Task(problem)
    answer = solve(problem)
    assert answer.status is Status.OPTIMAL
    assert answer.plan is not None
    report = validate(problem, answer.plan)
    assert report.valid
    assert report.metric == answer.objective == 5 + Fraction(745, 100)


def test_a_cost_that_actions_change_is_left_out_not_called_unsolvable(tmp_path: Path) -> None:
    """ENHSP 20 itself says "unsolvable" here."""
    problem = tank(tmp_path, price="(fuel)")
    answer = solve(problem)
    assert answer.status is Status.SOLVED
    assert answer.objective is None
    assert answer.plan is not None
    assert validate(problem, answer.plan).valid


def test_unsolvable_is_believed_where_it_knows(tmp_path: Path) -> None:
    assert solve(tank(tmp_path, trip=TRIP.replace("(road b c)", ""))).status is Status.UNSOLVABLE


def test_unsolvable_is_not_believed_of_a_task_it_was_not_made_for(tmp_path: Path) -> None:
    problem = tank(tmp_path, trip=TRIP.replace("(road b c)", ""))
    scaled = tuple(
        replace(a, effects=tuple(
            replace(e, kind="scale-up") if e.target.name == "fuel" else e for e in a.effects
        ))
        for a in problem.domain.actions
    )  # fmt: skip
    answer = solve(replace(problem, domain=replace(problem.domain, actions=scaled)))
    assert answer.status is not Status.UNSOLVABLE


def test_what_it_cannot_parse_is_an_error_not_unsolvable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(handover, "problem_text", lambda problem: "(define (problem trip)")
    with pytest.raises(PlannerError, match="enhsp failed"):
        solve(tank(tmp_path))


def test_interactions_are_planned_optimally(tmp_path: Path) -> None:
    domain = """
(define (domain talk) (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent job)
  (:predicates (done ?j - job)) (:functions (motivation ?a - agent) (total-cost))
  (:action work :parameters (?a - agent ?j - job)
    :effect (and (done ?j) (increase (total-cost) (+ (motivation ?a) 0.5))))
  (:action remind :parameters (?a - agent)
    :effect (and (assign (motivation ?a) 1) (increase (total-cost) 2))))
"""
    (tmp_path / "d.pddl").write_text(domain)
    (tmp_path / "p.pddl").write_text("""
(define (problem t) (:domain talk) (:objects human - agent i j k - job)
  (:init (= (motivation human) 4) (= (total-cost) 0)) (:goal (and (done i) (done j) (done k)))
  (:metric minimize (total-cost)))""")
    problem = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    answer = solve(problem)
    assert (answer.status, answer.objective) == (Status.OPTIMAL, Fraction(13, 2))


@pytest.mark.parametrize(
    "values",
    [{}, {("motivation", "human"): 10}, {("capacity", "robot", "glass"): Fraction(1, 3)}],
    ids=["low", "unmotivated", "fraction"],
)
def test_it_agrees_with_fast_downward(values: dict[tuple[str, ...], Fraction]) -> None:
    problem = read("kitchen", "parfait-nut").with_values(values)
    short = with_goal(problem, "(and (in oats glass) (has-water glass) (served))", "drink")
    ours, theirs = solve(short), FastDownward().solve(Request(short))
    assert ours.status is theirs.status is Status.OPTIMAL
    assert ours.objective is not None
    assert theirs.objective is not None
    assert abs(ours.objective - theirs.objective) < 1e-5


def test_the_sequential_reading_costs_what_fast_downward_proves() -> None:
    problem = read("transport", "two-boxes")
    answer = solve(problem)
    assert answer.status is Status.SOLVED
    assert answer.plan is not None
    assert validate(problem, answer.plan).cost == 24


def test_without_time_for_the_proof_there_is_a_plan() -> None:
    """It proves nothing on whole recipes."""
    problem = read("kitchen", "parfait-nut")
    answer = solve(problem, 8)
    assert answer.status is Status.SOLVED
    assert answer.objective is not None
    assert answer.objective >= 50


def test_any_plan_is_quick_and_not_called_optimal() -> None:
    answer = solve(read("kitchen", "stew-tomato"), any_plan=True)
    assert answer.status is Status.SOLVED
    assert answer.objective is not None
    assert answer.objective >= 62


def test_it_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(enhsp, "find_java", lambda: None)
    assert "pip install 'hrcplan[planners]'" in (Enhsp().missing() or "")


def test_derived_predicates_are_compiled_away() -> None:
    """Its parser knows none, and numbers keep this task from being lowered."""
    domain = """(define (domain d) (:requirements :derived-predicates :fluents)
      (:predicates (ready) (done)) (:functions (level))
      (:derived (ready) (>= (level) 2))
      (:action lift :parameters () :effect (increase (level) 1))
      (:action finish :parameters () :precondition (ready) :effect (done)))"""
    text = "(define (problem p) (:domain d) (:init (= (level) 0)) (:goal (done)))"
    answer = solve(problem_of(domain, text))
    assert answer.plan is not None
    assert [action.name for action in answer.plan.actions] == ["lift", "lift", "finish"]


def test_a_number_that_changes_for_all_objects_is_read() -> None:
    domain = """(define (domain d) (:requirements :adl :fluents) (:predicates (done))
      (:functions (level ?x))
      (:action fill :parameters () :effect (forall (?y) (increase (level ?y) 1)))
      (:action finish :parameters (?x) :precondition (>= (level ?x) 2) :effect (done)))"""
    text = """(define (problem p) (:domain d) (:objects a b)
      (:init (= (level a) 0) (= (level b) -1)) (:goal (and (done) (>= (level b) 1))))"""
    answer = solve(problem_of(domain, text))
    assert answer.plan is not None
    assert sorted(action.name for action in answer.plan.actions) == ["fill", "fill", "finish"]


def test_processes_and_events_are_planned_and_not_judged() -> None:
    domain = """(define (domain tank) (:requirements :fluents :time :negative-preconditions)
      (:predicates (filling)) (:functions (level))
      (:action open :parameters () :precondition (not (filling)) :effect (filling))
      (:action close :parameters () :precondition (filling) :effect (not (filling)))
      (:process flow :parameters () :precondition (filling)
        :effect (increase (level) (* #t (+ 1 0.5 0.5))))
      (:event overflow :parameters () :precondition (> (level) 20) :effect (not (filling))))"""
    text = """(define (problem p) (:domain tank) (:init (= (level) 0))
      (:goal (and (>= (level) 5) (not (filling)))))"""
    result = solve_problem(problem_of(domain, text), "enhsp", timeout_s=20)
    assert result.status is Status.SOLVED
    assert result.plan is not None
    assert [action.name for action in result.plan.actions] == ["open", "close"]
    assert result.plan.actions[1].start_s == 3
    assert "cannot judge" in str(result.mismatch)
