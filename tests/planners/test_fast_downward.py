"""Fast Downward proves optima, says what it cannot, and is mapped honestly when it fails."""

import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.errors import PlannerError, UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Compare, Constant, Problem
from hrcplan.planners import fast_downward
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.fast_downward import FastDownward
from hrcplan.validation import validate
from tests.worlds import problem_from

HUMAN = ("motivation", "human")
ROBOT = ("knowledge", "robot")


@pytest.fixture
def parfait() -> Problem:
    return read("kitchen", "parfait-nut")


def test_it_proves_the_kitchen(parfait: Problem) -> None:
    answer = FastDownward().solve(Request(parfait))
    assert answer.status is Status.OPTIMAL
    assert answer.plan is not None
    report = validate(parfait, answer.plan)
    assert report.valid
    assert report.metric == answer.objective == 50


def test_costs_that_are_fractions_come_back_exactly(parfait: Problem) -> None:
    problem = parfait.with_values({HUMAN: Fraction(1, 3), ROBOT: Fraction(17, 100)})
    answer = FastDownward().solve(Request(problem))
    assert answer.plan is not None
    assert answer.status is Status.OPTIMAL
    assert validate(problem, answer.plan).metric == answer.objective
    assert isinstance(answer.objective, Fraction)


def test_a_changed_agent_state_changes_who_works(parfait: Problem) -> None:
    problem = parfait.with_values({HUMAN: 10})
    answer = FastDownward().solve(Request(problem))
    assert answer.plan is not None
    assert {action.args[0] for action in answer.plan.actions} == {"robot"}
    assert answer.objective == 50


def test_any_plan_is_not_called_optimal(parfait: Problem) -> None:
    answer = FastDownward().solve(Request(parfait, any_plan=True))
    assert answer.status is Status.SOLVED
    assert answer.plan is not None
    assert answer.objective is None  # costs are left out
    assert validate(parfait, answer.plan).valid


def test_plans_improve_until_the_search_ends() -> None:
    """The search for better plans is one that the installed program accepts."""
    deadline = time.monotonic() + 30
    request = Request(read("transport", "two-boxes"), deadline, any_plan=True, improves=True)
    assert FastDownward().solve(request).status is Status.SOLVED


def test_the_sequential_reading_of_a_temporal_problem_is_no_proof() -> None:
    problem = read("transport", "two-boxes")
    answer = FastDownward().solve(Request(problem))
    assert answer.status is Status.SOLVED
    assert answer.objective is None
    assert "time" in answer.note
    assert answer.plan is not None
    assert not answer.plan.is_schedule
    assert validate(problem, answer.plan).cost == 24


def test_unsolvable_is_said(parfait: Problem) -> None:
    never = replace(parfait, goal=Compare("<", Constant(1), Constant(0)))
    assert FastDownward().solve(Request(never)).status is Status.UNSOLVABLE
    bare = replace(parfait, facts=frozenset(f for f in parfait.facts if f[0] != "stored"))
    assert FastDownward().solve(Request(bare)).status is Status.UNSOLVABLE


def test_time_runs_out_as_an_answer(parfait: Problem) -> None:
    answer = FastDownward().solve(Request(parfait, deadline=time.monotonic() + 0.05, any_plan=True))
    assert answer.status is Status.UNSOLVED
    assert "timeout" in answer.note


def test_memory_runs_out_as_an_answer() -> None:
    problem = read("transport", "boxes-6")
    answer = FastDownward().solve(Request(problem, memory_bytes=5 << 20))
    assert answer.status is Status.UNSOLVED
    assert "memory" in answer.note


def test_costs_beyond_32_bits_are_refused(parfait: Problem) -> None:
    problem = parfait.with_values({HUMAN: Fraction(1, 1_000_003), ROBOT: Fraction(1, 999_983)})
    with pytest.raises(UnsupportedError, match="32-bit"):
        FastDownward().solve(Request(problem))


def test_a_crash_is_an_error_with_its_last_words(
    parfait: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fast_downward, "_FIRST", "no_such_search()")
    with pytest.raises(PlannerError, match=r"exit code 33.*no_such_search"):
        FastDownward().solve(Request(parfait, any_plan=True))


DOMAIN = """
(define (domain lamps)
  (:requirements :adl)
  (:predicates (p) (q) (r))
  (:action a :effect (and (p) (when (q) (r))))
  (:action b :precondition (p) :effect (and (q) (not (p)))))
"""


@pytest.mark.parametrize(("goal", "steps"), [("(r)", 3), ("(or (and (p) (q)) (and (r) (q)))", 3)])
def test_conditional_effects_and_alternative_goals_are_proven_too(
    goal: str, steps: int, tmp_path: Path
) -> None:
    """LM-cut knows neither conditional effects nor axioms, so another search is chosen."""
    (tmp_path / "d.pddl").write_text(DOMAIN)
    text = f"(define (problem x) (:domain lamps) (:init) (:goal {goal}))"
    (tmp_path / "p.pddl").write_text(text)
    problem = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    answer = FastDownward().solve(Request(problem))
    assert answer.status is Status.OPTIMAL
    assert answer.objective == steps


def test_requirements_that_nothing_needs_do_not_disturb_it() -> None:
    domain = """(define (domain d)
      (:requirements :adl :fluents :numeric-fluents :action-costs :preferences :derived-predicates)
      (:predicates (on ?x ?y) (above ?x ?y) (done)) (:functions (total-cost))
      (:derived (above ?x ?y) (or (on ?x ?y) (exists (?z) (and (on ?x ?z) (above ?z ?y)))))
      (:action put :parameters (?x ?y) :precondition (not (above ?y ?x))
        :effect (and (on ?x ?y) (increase (total-cost) 1))))"""
    problem = problem_from(
        domain,
        """(define (problem p) (:domain d) (:objects a b c)
      (:init (on a b)) (:goal (above a c)) (:metric minimize (total-cost)))""",
    )
    answer = FastDownward().solve(Request(problem))
    assert (answer.status, answer.objective) == (Status.OPTIMAL, 1)
