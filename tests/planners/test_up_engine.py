"""Problems of unified-planning in and out, and hrcplan as its engine, on its own examples."""

from collections.abc import Iterator
from typing import Any

import pytest
from unified_planning.environment import get_environment
from unified_planning.model import Fluent, Problem
from unified_planning.shortcuts import BoolType, OneshotPlanner, PlanValidator
from unified_planning.test.examples import get_example_problems

import hrcplan
from hrcplan.errors import UnsupportedError
from hrcplan.planners.from_up import convert
from hrcplan.planners.up_engine import register

EXAMPLES = get_example_problems()
# What PDDL cannot hold: hierarchies, schedules, preferences of actions, goals at times, and
# parameters that are no objects.
BEYOND_PDDL = frozenset(
    [
        "basic_oversubscription", "locations_connected_visited_oversubscription",
        "basic_bool_fluent_param", "basic_int_fluent_param", "basic_bounded_int_action_param",
        "basic_unbounded_int_action_param", "robot_fluent_of_user_type_with_int_id",
        "timed_connected_locations", "robot_with_static_fluents_duration_timed_goals", "htn-go",
        "htn-go-temporal", "basic_numeric_with_timed_effect", "sched:basic", "sched:resource_set",
        "sched:symbolic", "sched:jobshop-ft06-operators",
    ]
)  # fmt: skip
# Bounds of numbers that change continuously: unified-planning cannot compile them away.
BOUNDED = frozenset(
    ["robot_continuous", "robot_conditional_effects", "robot_non_linear_continuous_1"]
)


@pytest.fixture(autouse=True)
def quiet() -> Iterator[None]:
    environment = get_environment()
    stream, environment.credits_stream = environment.credits_stream, None
    yield
    environment.credits_stream = stream


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_comes_in_or_is_refused_by_name(name: str) -> None:
    problem = EXAMPLES[name].problem
    if name in BEYOND_PDDL | BOUNDED:
        with pytest.raises(UnsupportedError, match=r"PDDL cannot hold this problem .*: \S"):
            hrcplan.from_up(problem)
    else:
        assert hrcplan.from_up(problem).domain.actions or not problem.actions


def solved(problem: Problem) -> Any:
    register()
    with OneshotPlanner(name="hrcplan") as planner:
        return planner.solve(problem, timeout=30)


SMALL = (
    "basic", "basic_conditional", "basic_exists", "basic_with_costs", "hierarchical_blocks_world",
    "robot_fluent_of_user_type", "robot_loader", "travel", "locations_connected_cost_minimize",
)  # fmt: skip


@pytest.mark.parametrize("name", SMALL)
def test_engine_solves_examples_in_their_own_names(name: str) -> None:
    problem = EXAMPLES[name].problem
    result = solved(problem)
    assert result.status.name in ("SOLVED_OPTIMALLY", "SOLVED_SATISFICING")
    with PlanValidator(problem_kind=problem.kind, plan_kind=result.plan.kind) as validator:
        assert validator.validate(problem, result.plan).status.name == "VALID"


def test_engine_proves_a_metric_of_cost_and_time() -> None:
    result = solved(hrcplan.to_up(hrcplan.read("transport", "two-boxes"), with_time=True))
    assert result.status.name == "SOLVED_OPTIMALLY"
    assert float(result.metrics["metric"]) == pytest.approx(58.00051)
    assert len(result.plan.timed_actions) == 8


def test_costs_with_constants_survive_both_ways() -> None:
    domain = """(define (domain d) (:requirements :typing :action-costs) (:types t)
      (:constants k - t) (:predicates (p ?x - t)) (:functions (total-cost) (c ?x - t))
      (:action a :parameters (?x - t) :precondition (not (p ?x))
        :effect (and (p ?x) (increase (total-cost) (+ 3 (c k))))))"""
    text = """(define (problem e) (:domain d) (:objects o - t)
      (:init (= (total-cost) 0) (= (c k) 1.5) (= (c o) 9)) (:goal (p o))
      (:metric minimize (total-cost)))"""
    problem = hrcplan.read(domain, text)
    again = hrcplan.from_up(hrcplan.to_up(problem))
    assert (
        hrcplan.validate(again, "(a o)").metric == hrcplan.validate(problem, "(a o)").metric == 4.5
    )


def test_engine_says_what_it_cannot_hold_and_what_has_no_plan() -> None:
    beyond = solved(EXAMPLES["basic_oversubscription"].problem)
    assert beyond.status.name == "UNSUPPORTED_PROBLEM"
    hopeless = Problem("hopeless")
    hopeless.add_fluent(Fluent("x", BoolType()), default_initial_value=False)
    hopeless.add_goal(hopeless.fluent("x"))
    assert solved(hopeless).status.name == "UNSOLVABLE_PROVEN"


def test_plans_come_back_through_what_was_compiled_away() -> None:
    problem = EXAMPLES["robot_fluent_of_user_type"].problem
    conversion = convert(problem)
    plan = hrcplan.plan(conversion.problem).plan
    assert plan is not None
    actions = conversion.plan_back(plan).actions
    assert {action.action for action in actions} <= set(problem.actions)
