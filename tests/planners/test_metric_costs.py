"""Metrics over functions that only they look at: planned as total-cost, proven, bounded."""

from __future__ import annotations

import random
from contextlib import suppress

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.gains import idle_gain, most_gain
from hrcplan.planners.lowering import lower, prices
from hrcplan.planners.metric_costs import with_total_cost
from hrcplan.planners.relaxed_bound import RelaxedBound
from hrcplan.planners.solve import solve
from hrcplan.planners.uniform_cost import UniformCost
from hrcplan.task import Task
from hrcplan.validation import validate
from tests.texts import problem_of

MARKET = """(define (domain market) (:requirements :adl :numeric-fluents :action-costs)
  (:types place crate van - object)
  (:predicates (at ?v - van ?p - place) (stored ?c - crate ?p - place) (aboard ?c - crate)
    (sold ?c - crate) (road ?a ?b - place))
  (:functions (profit) (used ?v - van) (gain ?c - crate) (way ?a ?b - place) (total-cost) (odd))
  (:action drive :parameters (?v - van ?a ?b - place)
    :precondition (and (at ?v ?a) (road ?a ?b))
    :effect (and (at ?v ?b) (not (at ?v ?a)) (increase (used ?v) (way ?a ?b)) (increase (odd) 1)))
  (:action load :parameters (?c - crate ?p - place ?v - van)
    :precondition (and (at ?v ?p) (stored ?c ?p))
    :effect (and (aboard ?c) (not (stored ?c ?p)) (increase (total-cost) 1)))
  (:action sell :parameters (?c - crate ?v - van)
    :precondition (and (at ?v town) (aboard ?c))
    :effect (and (not (aboard ?c)) (sold ?c) (increase (profit) (gain ?c)))))"""
PROBLEM = """(define (problem m) (:domain market)
  (:objects farm mill - place apples pears - crate red blue - van)
  (:init (at red town) (at blue town) (stored apples farm) (stored pears mill)
    (road town farm) (road farm town) (road farm mill) (road mill farm)
    {ways} (= (gain apples) 8) (= (gain pears) 5) (= (profit) 0) (= (total-cost) 1) (= (odd) 0)
    (= (used red) 0) (= (used blue) 2))
  (:goal {goal}) (:metric {metric}))"""
WAYS = [*(("town", "farm", 3), ("farm", "town", 3), ("farm", "mill", 4), ("mill", "farm", 4))]


def market(
    metric: str, goal: str = "(and)", complete: bool = True, domain: str = MARKET
) -> Problem:
    names = ("town", "farm", "mill")
    ways = {(a, b): 9 for a in names for b in names} if complete else {}
    ways |= {(a, b): n for a, b, n in WAYS}
    text = " ".join(f"(= (way {a} {b}) {n})" for (a, b), n in ways.items())
    domain = domain.replace("(:predicates", "(:constants town - place) (:predicates")
    return problem_of(domain, PROBLEM.format(ways=text, metric=metric, goal=goal))


METRICS = [
    ("minimize (used red)", "(sold apples)", 0),  # blue drives
    ("minimize (+ (used red) (used blue) 1)", "(and (sold apples) (sold pears))", 10),
    ("minimize (+ (* 3 (used blue)) (* 0.5 (total-time)))", "(sold apples)", 7.5),
    ("maximize (- (profit) (+ (used red) (used blue)))", "(and)", 4),
    ("maximize (- (* 3 (profit)) (+ (used red) (used blue)))", "(and)", 30),
    ("maximize (- 100 (used red))", "(and (sold apples) (at red farm))", 97),
    ("minimize (+ (total-cost) (used red))", "(and (sold apples))", 2),
]


@pytest.mark.parametrize(("metric", "goal", "best"), METRICS)
def test_the_metric_is_the_same_and_proven(metric: str, goal: str, best: float) -> None:
    problem = market(metric, goal)
    costs = with_total_cost(problem)
    assert costs.domain.changed_functions == {"total-cost"}
    result = solve(problem, timeout_s=30)
    assert (result.status, float(result.objective or 0)) == (Status.OPTIMAL, best)
    assert result.plan is not None
    assert result.problem is problem
    report, other = (validate(p, result.plan) for p in (problem, costs))
    assert report.metric == other.metric == result.objective
    assert result.report == report


@pytest.mark.parametrize(("metric", "goal", "best"), METRICS)
def test_the_bound_of_the_relaxation_holds(metric: str, goal: str, best: float) -> None:
    problem = with_total_cost(market(metric, goal))
    answer = RelaxedBound().solve(Request(problem))
    assert answer.bound is not None
    assert answer.bound >= best if problem.maximize else answer.bound <= best


def test_planners_for_costs_take_the_task() -> None:
    problem = market("minimize (+ (used red) (used blue))", "(sold pears)")
    result = solve(problem, "fast-downward", timeout_s=30)
    assert (result.status, result.objective) == (Status.OPTIMAL, 2 + 7)


@pytest.mark.parametrize(
    "problem",
    [
        market("minimize (used red)", "(and (sold apples) (<= (used blue) 7))"),
        market("minimize (* (used red) (used blue))", "(sold apples)"),
        market("minimize (used red)", complete=False),  # a value that is missing stops the van
    ],
)
def test_what_is_read_or_no_sum_stays(problem: Problem) -> None:
    costs = with_total_cost(problem)
    assert costs.metric == problem.metric
    assert "used" in costs.domain.changed_functions


def test_a_counter_of_missing_values_stays_in_the_amount() -> None:
    problem = market("minimize (profit)", "(sold apples)", complete=False)
    assert solve(problem, timeout_s=30).objective == 8


IDLE = """(define (domain idle) (:requirements :strips :action-costs) (:predicates (p) (q))
  (:functions (total-cost))
  (:action go :precondition (p) :effect (and (q) (increase (total-cost) 3)))
  (:action rest :precondition (p) :effect (and (p) (increase (total-cost) {cost}))))"""
START = "(define (problem x) (:domain idle) (:init (p)) (:goal (q)) (:metric {sense} (total-cost)))"


@pytest.mark.parametrize(("sense", "cost"), [("minimize", -1), ("maximize", 1)])
def test_a_gain_that_changes_nothing_else_prevents_proofs(sense: str, cost: int) -> None:
    problem = problem_of(IDLE.format(cost=cost), START.format(sense=sense))
    assert idle_gain(problem) is not None
    with pytest.raises(UnsupportedError):
        lower(Task(problem))
    for planner in (UniformCost(), RelaxedBound()):
        with pytest.raises(UnsupportedError, match=r"without end|again and again|change nothing"):
            planner.solve(Request(problem))
    result = solve(problem, timeout_s=2)
    assert result.status is Status.SOLVED
    assert result.gap is None


def test_a_gain_that_costs_nothing_else_is_no_gain() -> None:
    problem = problem_of(IDLE.format(cost=0), START.format(sense="minimize"))
    assert idle_gain(problem) is None
    assert lower(Task(problem)).costs == (3,)


def test_gains_are_limited_by_what_they_use_up() -> None:
    problem = with_total_cost(market("maximize (profit)"))
    task = Task(problem)
    assert most_gain(task, prices(task).prices) == 8 + 5
    more = {("stored", "apples", "mill")}
    twice = task.with_facts(problem.facts | more)
    assert most_gain(twice, prices(twice).prices) == 2 * 8 + 5


def test_nothing_limits_a_gain() -> None:
    endless = MARKET.replace("(not (stored ?c ?p))", "(stored ?c ?p)")
    task = Task(with_total_cost(market("maximize (profit)", domain=endless)))
    with pytest.raises(UnsupportedError, match=r"\(sell .*again and again"):
        most_gain(task, prices(task).prices)


def random_problem(seed: int) -> Problem:
    """Return a task whose actions run once each and change costs and counters by chance."""
    rng = random.Random(seed)
    actions = ""
    for i in range(3):
        effects = [f"(not (once{i}))", f"(f{rng.randrange(4)} ?o)"]
        for _ in range(2):
            target, amount = rng.choice(TARGETS), rng.choice(AMOUNTS)
            effect = f"({rng.choice(('increase', 'decrease'))} {target} {amount})"
            effects.append(rng.choice((effect, f"(when (f{rng.randrange(4)} ?o) {effect})")))
        needs = rng.choice(("", "(f0 ?o)"))
        actions += f"""(:action a{i} :parameters (?o) :precondition (and (once{i}) {needs})
          :effect (and {" ".join(effects)}))"""
    facts = " ".join([*(f"(f{i} ?o)" for i in range(4)), "(once0) (once1) (once2)"])
    metric = f"(+ {' '.join(rng.sample(TERMS, 3))})"
    domain = f"""(define (domain d) (:requirements :adl :numeric-fluents) (:predicates {facts})
      (:functions (c) (d ?o) (w ?o) (total-cost)) {actions})"""
    return problem_of(domain, f"""(define (problem p) (:domain d) (:objects o1 o2)
      (:init (once0) (once1) (once2) (f0 o1) (= (c) 1) (= (d o1) 0) (= (d o2) 2) (= (w o1) 1)
        (= (w o2) 3) (= (total-cost) 4))
      (:goal (f{rng.randrange(1, 4)} o{rng.choice((1, 2))}))
      (:metric {rng.choice(("minimize", "maximize"))} {metric}))""")  # fmt: skip


TARGETS = ("(c)", "(d ?o)", "(total-cost)")
AMOUNTS = ("2", "(w ?o)", "(* 0.5 (w ?o))", "(+ 1 (w ?o))")
TERMS = ["(c)", "(* 2 (d o1))", "(d o2)", "(* -1 (c))", "(total-cost)", "(* 0.5 (total-time))", "3"]


@pytest.mark.parametrize("seed", range(40))
def test_the_best_plan_stays_the_best(seed: int) -> None:
    problem = random_problem(seed)
    costs = with_total_cost(problem)
    one, other = (UniformCost().solve(Request(p)) for p in (problem, costs))
    assert (one.status, one.objective) == (other.status, other.objective)
    with suppress(UnsupportedError):
        bound = RelaxedBound().solve(Request(costs)).bound
        if bound is not None and one.objective is not None:
            assert bound >= one.objective if problem.maximize else bound <= one.objective
