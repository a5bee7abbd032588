"""Uniform-cost search: metrics that no other planner here proves, and exact numbers."""

from __future__ import annotations

import random
import time
from fractions import Fraction

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.uniform_cost import UniformCost
from hrcplan.validation import validate
from tests.worlds import problem_from

ROADS = """(define (domain roads) (:requirements :strips :action-costs)
  (:predicates (at ?p) (road ?p ?q)) (:functions (total-cost) (toll ?p ?q))
  (:action go :parameters (?p ?q) :precondition (and (at ?p) (road ?p ?q))
    :effect (and (at ?q) (not (at ?p)) (increase (total-cost) (toll ?p ?q)))))"""
SHOP = """(define (domain shop) (:requirements :strips :numeric-fluents)
  (:predicates (open) (closed)) (:functions (money) (goods))
  (:action sell :parameters () :precondition (and (open) (>= (goods) 2))
    :effect (and (decrease (goods) 2) (increase (money) 3)))
  (:action close :parameters () :precondition (open) :effect (and (closed) (not (open)))))"""


def roads(tolls: dict[str, str], metric: str = "minimize (total-cost)", goal: str = "c") -> Problem:
    places = " ".join(sorted({p for pair in tolls for p in pair} | {goal}))
    facts = " ".join(f"(road {p} {q}) (= (toll {p} {q}) {n})" for (p, q), n in tolls.items())
    return problem_from(
        ROADS,
        f"""(define (problem p) (:domain roads) (:objects {places})
      (:init (at a) {facts} (= (total-cost) 0)) (:goal (at {goal})) (:metric {metric}))""",
    )


def solve(problem: Problem, seconds: float = 20) -> Answer:
    answer = UniformCost().solve(Request(problem, time.monotonic() + seconds))
    if answer.plan is not None:
        report = validate(problem, answer.plan)
        assert report.valid
        assert report.metric == answer.objective
    return answer


def test_a_negative_cost_on_the_way_is_worth_a_detour() -> None:
    answer = solve(roads({"ac": "0.35", "ab": "-5", "bc": "0.2"}))
    assert answer.status is Status.OPTIMAL
    assert answer.objective == Fraction("-4.8")


def test_costs_that_fall_without_end_have_no_best_plan() -> None:
    with pytest.raises(UnsupportedError, match="without end"):
        solve(roads({"ac": "1", "ab": "-2", "ba": "1", "bc": "1"}))


def test_numbers_are_not_rounded() -> None:
    big = 2**53
    answer = solve(roads({"ac": f"{big + 1}", "ab": f"{big}", "bc": "0"}))
    assert (answer.status, answer.objective) == (Status.OPTIMAL, big)


def test_total_time_counts_actions() -> None:
    tolls = {"ab": "1", "bc": "1", "ac": "5"}
    assert solve(roads(tolls, "minimize (total-time)")).objective == 1
    assert solve(roads(tolls, "minimize (+ (total-cost) (* 2 (total-time)))")).objective == 6


@pytest.mark.parametrize(("metric", "value", "n_sales"), [
    ("maximize (money)", 6, 2),
    ("minimize (money)", 0, 0),
    ("maximize (- (money) (goods))", 5, 2),
    ("minimize (+ (* 2 (goods)) (total-time))", 5, 2),
])  # fmt: skip
def test_a_metric_of_the_last_state(metric: str, value: int, n_sales: int) -> None:
    problem = problem_from(
        SHOP,
        f"""(define (problem p) (:domain shop)
      (:init (open) (= (money) 0) (= (goods) 5)) (:goal (closed)) (:metric {metric}))""",
    )
    answer = solve(problem)
    assert (answer.status, answer.objective) == (Status.OPTIMAL, value)
    assert answer.plan is not None
    assert [a.name for a in answer.plan.actions].count("sell") == n_sales


def test_all_states_without_the_goal_are_a_proof() -> None:
    assert solve(roads({"ab": "1", "ba": "1"}, goal="c")).status is Status.UNSOLVABLE


def test_an_early_stop_is_a_bound() -> None:
    counter = (
        SHOP.replace("(>= (goods) 2)", "(< (goods) 900000)")
        .replace("decrease (goods) 2", "increase (goods) 1")
        .replace("(:precondition (open) :effect (and (closed)", "")
    )
    text = """(define (problem p) (:domain shop) (:init (open) (= (money) 0) (= (goods) 0))
      (:goal (>= (goods) 800000)))"""
    answer = UniformCost().solve(Request(problem_from(counter, text), time.monotonic() + 0.3))
    assert answer.status is Status.UNSOLVED
    assert answer.bound is not None
    assert 0 < answer.bound < 800000


@pytest.mark.parametrize("seed", range(30))
def test_it_agrees_with_all_simple_paths(seed: int) -> None:
    """Forward roads only, so that negative tolls make no cycle."""
    rng = random.Random(seed)
    places = "abcdef"
    pairs = [p + q for i, p in enumerate(places) for q in places[i + 1 :] if rng.random() < 0.6]
    tolls = {pair: str(rng.randint(-3, 9)) for pair in pairs}
    best: dict[str, int] = {"a": 0}
    for p in places:
        for q in places:
            if p in best and p + q in tolls:
                best[q] = min(best.get(q, 10**9), best[p] + int(tolls[p + q]))
    answer = solve(roads({**tolls, "ga": "0"}, goal="f"))
    if "f" in best:
        assert (answer.status, answer.objective) == (Status.OPTIMAL, best["f"])
    else:
        assert answer.status is Status.UNSOLVABLE


TANK = """(define (domain tank) (:requirements :adl :numeric-fluents :derived-predicates)
  (:predicates (open) (ready) (safe)) (:functions (level))
  (:derived (ready) (and (open) (>= (level) 2.5)))
  (:derived (safe) (or (ready) (not (open))))
  (:action fill :parameters () :precondition (not (ready)) :effect (increase (level) 1))
  (:action leave :parameters () :precondition (ready)
    :effect (and (when (safe) (not (open))) (assign (level) 0))))"""


def test_numbers_and_derived_predicates_together() -> None:
    problem = problem_from(
        TANK,
        """(define (problem p) (:domain tank) (:init (open) (= (level) 0))
             (:goal (and (safe) (not (open)) (= (level) 0)))
             (:metric minimize (total-time)))""",
    )
    answer = solve(problem)
    assert answer.status is Status.OPTIMAL
    assert answer.objective == 4


def test_no_plan_is_proven_although_the_metric_improves_without_end() -> None:
    tolls = {"ab": "-1", "ba": "-1"}
    assert solve(roads(tolls, goal="z")).status is Status.UNSOLVABLE
    with pytest.raises(UnsupportedError, match="without end"):
        solve(roads({**tolls, "bz": "1"}, goal="z"))
