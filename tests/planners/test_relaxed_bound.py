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


def test_what_needs_concurrency_is_left_to_others() -> None:
    with pytest.raises(UnsupportedError, match="at its start"):
        RelaxedBound().solve(Request(problem_from(MATCH, MATCH_P)))
