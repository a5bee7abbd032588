"""The bound from the relaxed task: never above a proven optimum, and exact on a chain."""

from __future__ import annotations

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.relaxed_bound import RelaxedBound
from hrcplan.planners.solve import solve
from tests.worlds import problem_from

RELAY = """(define (domain relay) (:requirements :strips :durative-actions)
  (:predicates (at ?p) (next ?p ?q))
  (:durative-action go :parameters (?p ?q) :duration (= ?duration 5)
    :condition (and (at start (at ?p)) (at start (next ?p ?q)))
    :effect (and (at start (not (at ?p))) (at end (at ?q)))))"""
RELAY_ABC = """(define (problem p) (:domain relay) (:objects a b c)
  (:init (at a) (next a b) (next b c)) (:goal (at c)))"""
MATCH = """(define (domain match) (:requirements :strips :durative-actions)
  (:predicates (light) (dark) (mended))
  (:durative-action strike :parameters () :duration (= ?duration 5)
    :condition (at start (dark)) :effect (and (at start (light)) (at end (not (light)))))
  (:durative-action mend :parameters () :duration (= ?duration 2)
    :condition (over all (light)) :effect (at end (mended))))"""
MATCH_P = "(define (problem p) (:domain match) (:init (dark)) (:goal (mended)))"


DOOR = """(define (domain door) (:requirements :strips :durative-actions)
  (:predicates (turned) (is-open))
  (:durative-action turn :parameters () :duration (= ?duration 4)
    :condition () :effect (at end (turned)))
  (:durative-action open :parameters () :duration (= ?duration 5)
    :condition (at end (turned)) :effect (at end (is-open))))"""
DOOR_P = "(define (problem p) (:domain door) (:init) (:goal (is-open)))"
PAIR = """(define (domain pair) (:requirements :strips :durative-actions :action-costs)
  (:predicates (left) (right) (lifted)) (:functions (total-cost))
  (:durative-action lift-left :parameters () :duration (= ?duration 1)
    :condition (over all (right)) :effect (and (at start (left)) (at end (not (left)))
      (at end (lifted)) (at end (increase (total-cost) 3))))
  (:durative-action lift-right :parameters () :duration (= ?duration 1)
    :condition (over all (left)) :effect (and (at start (right)) (at end (not (right)))
      (at end (increase (total-cost) 4)))))"""
PAIR_P = """(define (problem p) (:domain pair) (:init) (:goal (lifted))
  (:metric minimize (total-cost)))"""


@pytest.mark.parametrize(("domain", "problem"), [
    ("transport", "two-boxes"), ("transport", "handover"), ("kitchen", "pasta-bean"),
])  # fmt: skip
def test_it_is_never_above_the_optimum(domain: str, problem: str) -> None:
    task = read(domain, problem)
    answer = RelaxedBound().solve(Request(task))
    best = solve(task, "fast-downward" if domain == "kitchen" else "exact")
    assert best.status is Status.OPTIMAL
    assert answer.bound is not None
    assert best.objective is not None
    assert 0 < answer.bound <= best.objective


def test_a_chain_takes_as_long_as_its_actions() -> None:
    assert RelaxedBound().solve(Request(problem_from(RELAY, RELAY_ABC))).bound == 10


def test_a_goal_that_nothing_makes_true_is_unsolvable() -> None:
    text = RELAY_ABC.replace("(next b c)", "")
    assert RelaxedBound().solve(Request(problem_from(RELAY, text))).status is Status.UNSOLVABLE


def test_what_has_to_run_at_the_same_time_is_bounded() -> None:
    """Mending takes 2; the match, which has to burn for it, is lit at once."""
    problem = problem_from(MATCH, MATCH_P)
    best = solve(problem, timeout_s=20)
    assert RelaxedBound().solve(Request(problem)).bound == 2
    assert best.objective is not None
    assert best.objective >= 2


def test_a_condition_at_the_end_is_no_delay() -> None:
    """Opening takes 5 and may begin before the key has turned, after 4."""
    assert RelaxedBound().solve(Request(problem_from(DOOR, DOOR_P))).bound == 5


def test_costs_of_what_runs_at_the_same_time_add_up() -> None:
    """Each of two actions needs what the other one starts."""
    assert RelaxedBound().solve(Request(problem_from(PAIR, PAIR_P))).bound == 3 + 4


def test_in_a_portfolio_a_temporal_plan_has_a_bound() -> None:
    best = solve(problem_from(MATCH, MATCH_P), timeout_s=20)
    assert best.bound is not None
    assert best.gap is not None


def test_an_end_that_needs_what_its_start_undoes_is_left_to_others() -> None:
    """Ground tasks lack such actions, so the relaxed task would promise too much."""
    text = DOOR.replace(":effect (at end (is-open))", ":effect (and (at start (not (turned))) "
                        "(at end (is-open)))")  # fmt: skip
    with pytest.raises(UnsupportedError, match="undo what its end needs"):
        RelaxedBound().solve(Request(problem_from(text, DOOR_P)))


def test_a_temporal_metric_to_maximize_has_no_bound() -> None:
    problem = problem_from(PAIR, PAIR_P.replace("minimize", "maximize"))
    with pytest.raises(UnsupportedError, match="can gain"):
        RelaxedBound().solve(Request(problem))
