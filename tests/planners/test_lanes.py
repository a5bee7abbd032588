"""Sequential plans in lanes: valid, in order, no agent in two places, short."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.lanes import schedule
from hrcplan.plans import Plan, PlannedAction, occupied, parse_plan
from hrcplan.task import Task
from hrcplan.validation import validate

# Two chains of three steps and a last one that needs both, for two agents.
DOMAIN = """
(define (domain chains)
  (:requirements :strips :typing)
  (:types agent item)
  (:predicates (raw ?i - item) (cut ?i - item) (done ?i - item) (served))
  (:action cut :parameters (?a - agent ?i - item) :precondition (raw ?i)
    :effect (and (cut ?i) (not (raw ?i))))
  (:action finish :parameters (?a - agent ?i - item) :precondition (cut ?i) :effect (done ?i))
  (:action serve :parameters (?a - agent) :precondition (forall (?i - item) (done ?i))
    :effect (served)))
"""
PROBLEM = """
(define (problem p) (:domain chains)
  (:objects human robot - agent x y z - item)
  (:init (raw x) (raw y) (raw z))
  (:goal (served)))
"""


@pytest.fixture
def chains(tmp_path: Path) -> Problem:
    (tmp_path / "d.pddl").write_text(DOMAIN)
    (tmp_path / "p.pddl").write_text(PROBLEM)
    return read(tmp_path / "d.pddl", tmp_path / "p.pddl")


def no_overlap(problem: Problem, plan: Plan) -> None:
    for agent in problem.agents:
        mine = [a for a in plan.actions if agent in occupied(a, problem)]
        for earlier, later in pairwise(mine):
            assert earlier.end_s is not None
            assert later.start_s is not None
            assert earlier.end_s <= later.start_s, (earlier, later)


def test_steps_of_an_agent_free_task_are_shared(chains: Problem) -> None:
    steps = [f"({step} human {i})" for i in "xyz" for step in ("cut", "finish")]
    plan, shortest = schedule(chains, parse_plan("\n".join([*steps, "(serve human)"])))
    assert validate(chains, plan).valid
    no_overlap(chains, plan)
    assert {a.args[0] for a in plan.actions} == {"human", "robot"}
    assert plan.makespan_s == 4  # six steps on two agents, then serve
    assert shortest


def test_a_chain_cannot_be_shortened(chains: Problem) -> None:
    plan = parse_plan("(cut human x)\n(finish human x)")
    laid, shortest = schedule(chains, plan)
    assert laid.makespan_s == 2
    assert shortest


def test_a_dearer_agent_is_not_given_the_step() -> None:
    problem = read("kitchen", "salad-garden").with_values({("motivation", "human"): 7})
    task = Task(problem)
    plan = _greedy(task)
    laid, _ = schedule(problem, plan)
    assert {a.args[0] for a in laid.actions} == {"robot"}


def _greedy(task: Task) -> Plan:
    """Return some valid robot-only plan: breadth is cut to steps that add goal-relevant facts."""
    wanted = task.goal[0][1]
    state, actions = task.initial, []
    while state & wanted != wanted:
        last = state
        for i in task.applicable(state):
            action = task.actions[i]
            if action.agent == "robot" and action.adds & ~state and action.name != "serve":
                state = task.successor(state, i)
                actions.append(PlannedAction(action.name, action.args))
        if state == last:
            serve = next(i for i in task.applicable(state) if "serve" in str(task.actions[i]))
            state = task.successor(state, serve)
            actions.append(PlannedAction("serve", ("robot",)))
    return Plan(tuple(actions))


def test_temporal_lanes_keep_gaps(tmp_path: Path) -> None:
    problem = read("transport", "two-boxes")
    text = """(move human wp1 wp4)\n(grasp human blue wp4)\n(move robot wp0 wp3)
    (grasp robot green wp3)\n(move robot wp3 wp2)\n(place robot green wp2)
    (move human wp4 wp5)\n(place human blue wp5)"""
    plan, shortest = schedule(problem, parse_plan(text))
    report = validate(problem, plan)
    assert report.valid, report.reason
    assert report.makespan_s == pytest.approx(200.003)
    assert shortest
    no_overlap(problem, plan)


def test_both_agents_of_a_handover_are_busy() -> None:
    problem = read("transport", "two-boxes")
    action = PlannedAction("take", ("robot", "blue", "human", "wp4"))
    assert occupied(action, problem) == {"human", "robot"}
