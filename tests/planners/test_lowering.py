"""The lowered task means what the task means: to our own reader and to three planners."""

import heapq
import random
import re
import sys
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from math import inf
from pathlib import Path

import pytest

from hrcplan.errors import PlanFormatError, UnsupportedError
from hrcplan.pddl import library
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TOTAL_COST, Arithmetic, Compare, Constant, Function, Problem
from hrcplan.planners.lowering import Lowering, lower
from hrcplan.planners.process import ProcessEnd, ProcessLimits, run
from hrcplan.task import Task
from hrcplan.task.ground import ground
from hrcplan.validation import validate

COST = Function(TOTAL_COST)
TALK = """
(define (domain talk)
  (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent job - object)
  (:predicates (done ?j - job) (open ?j - job))
  (:functions (motivation ?a - agent) (effort ?j - job) (total-cost))
  (:action work :parameters (?a - agent ?j - job)
    :precondition (open ?j)
    :effect (and (done ?j) (not (open ?j))
      (increase (total-cost) (+ (motivation ?a) (effort ?j)))))
  (:action remind :parameters (?a - agent)
    :precondition (>= (motivation ?a) 3)
    :effect (and (decrease (motivation ?a) 3) (increase (total-cost) 2)))
  (:action praise :parameters (?a - agent)
    :precondition (>= (motivation ?a) 4)
    :effect (and (assign (motivation ?a) 1) (increase (total-cost) 2.5))))
"""
TALK_PROBLEM = """
(define (problem talk-{n}) (:domain talk) (:objects human - agent {jobs} - job)
  (:init {init} (= (motivation human) {motivation}) (= (total-cost) 0))
  (:goal (and {goal})) (:metric minimize (total-cost)))
"""
CHOICE = """
(define (domain choice)
  (:requirements :adl :durative-actions :action-costs)
  (:types lamp)
  (:predicates (lit ?l - lamp) (lit--x) (busy) (odd) (even) (wet))
  (:functions (total-cost))
  (:action lit :parameters (?l - lamp)
    :precondition (or (not (odd)) (and (even) (not (wet))))
    :effect (and (forall (?m - lamp) (when (lit ?m) (not (lit ?m)))) (lit ?l)
      (when (and (odd) (even)) (wet)) (when (or (wet) (not (even))) (even))))
  (:durative-action turn :parameters (?l - lamp)
    :duration (= ?duration 2)
    :condition (and (at start (not (busy))) (over all (busy)))
    :effect (and (at start (busy)) (at start (when (lit ?l) (odd))) (at end (not (busy)))
      (at end (when (or (not (busy)) (even)) (lit--x))) (at end (lit ?l))))
  (:action pour :parameters () :precondition (odd) :effect (and (not (odd)) (not (even)))))
"""
CHOICE_PROBLEM = """
(define (problem choice-one) (:domain choice) (:objects x y - lamp) (:init (even))
  (:goal (or (and (lit--x) (lit y)) (and (wet) (not (even))))))
"""


def talk(folder: Path, n: int = 3, motivation: str = "7", efforts: str = "1 0.5 0") -> Problem:
    jobs = [f"j{i}" for i in range(n)]
    init = " ".join(
        f"(open {job}) (= (effort {job}) {effort})"
        for job, effort in zip(jobs, efforts.split() * n, strict=False)
    )
    goal = " ".join(f"(done {job})" for job in jobs)
    text = TALK_PROBLEM.format(
        n=n, jobs=" ".join(jobs), init=init, goal=goal, motivation=motivation
    )
    return read(TALK, text)


def optimum(task: Task) -> Fraction | float:
    """Dijkstra over the bits of the task; the cost there is at the start is not counted."""
    best = {task.initial: Fraction(0)}
    waiting = [(Fraction(0), task.initial)]
    while waiting:
        cost, state = heapq.heappop(waiting)
        if cost > best[state]:
            continue
        if task.is_goal(state):
            return cost
        for index in task.applicable(state):
            after = task.successor(state, index)
            price = cost + task.costs[index]
            if price < best.get(after, inf):
                best[after] = price
                heapq.heappush(waiting, (price, after))
    return inf


def check_same_walks(task: Task, folder: Path, seed: int = 0) -> Lowering:
    """Walk at random through task and lowered task side by side."""
    lowered = lower(task)
    other = Task(read(lowered.domain_text, lowered.problem_text))
    names = re.findall(r"^    \((\S+)\)$", lowered.domain_text, re.MULTILINE)
    facts = dict(zip(task.facts, names, strict=False))
    dice = random.Random(seed)
    for _ in range(5):
        state, its = task.initial, other.initial
        for _ in range(30):
            shown = {facts[fact] for fact in task.facts_of(state)}
            changing = {name for (name,) in other.facts}
            assert {name for (name,) in other.facts_of(its)} == shown & changing
            assert task.is_goal(state) == other.is_goal(its)
            offered = {
                lowered.actions[other.actions[i].name].index: i for i in other.applicable(its)
            }
            assert sorted(offered) == task.applicable(state)
            if not offered:
                break
            index = dice.choice(sorted(offered))
            state, its = task.successor(state, index), other.successor(its, offered[index])
    return lowered


@pytest.mark.parametrize(
    ("domain", "problem"),
    [("transport", "handover"), ("kitchen", library.problem_names("kitchen")[0])],
)
def test_lowered_walks_are_the_same(domain: str, problem: str, tmp_path: Path) -> None:
    task = ground(domain, problem)
    lowered = check_same_walks(task, tmp_path)
    assert lowered.exact_for_metric == (domain == "kitchen")
    assert lowered.costs == task.costs
    assert lowered.scale == 1


def test_values_that_change_become_facts(tmp_path: Path) -> None:
    lowered = check_same_walks(Task(talk(tmp_path, motivation="7.5")), tmp_path)
    assert "(motivation--human--is--7_5)" in lowered.problem_text
    assert "(motivation--human--is--1)" in lowered.domain_text
    assert lowered.scale == 2


def test_conditions_on_the_state_stay(tmp_path: Path) -> None:
    lowered = check_same_walks(Task(read(CHOICE, CHOICE_PROBLEM)), tmp_path)
    assert lowered.conditional
    assert "(or " in lowered.problem_text
    assert "(when " in lowered.domain_text


def test_names_are_given_once(tmp_path: Path) -> None:
    """An action, and two predicates, that all become lit--x."""
    lowered = lower(Task(read(CHOICE, CHOICE_PROBLEM)))
    facts = re.findall(r"^    \((\S+)\)$", lowered.domain_text, re.MULTILINE)
    names = [*facts, *lowered.actions]
    assert len(names) == len(set(names))
    assert {"lit--x", "lit--x--v2", "lit--x--v3"} <= set(names)
    assert lowered.actions["lit--x--v3"].args == ("x",)


def test_an_end_that_undoes_an_unsure_start_is_refused(tmp_path: Path) -> None:
    text = CHOICE.replace("(at end (lit ?l))", "(at end (not (odd)))")
    with pytest.raises(UnsupportedError, match="undoes what its start"):
        lower(Task(read(text, CHOICE_PROBLEM)))
    text = CHOICE.replace("(or (not (busy)) (even))", "(odd)")
    with pytest.raises(UnsupportedError, match="depends on what its start"):
        lower(Task(read(text, CHOICE_PROBLEM)))


def test_fractions_are_scaled_exactly(tmp_path: Path) -> None:
    problem = talk(tmp_path, efforts="0.125 0.2 0")
    lowered = lower(Task(problem.with_values({("effort", "j2"): Fraction(1, 3)})))
    assert lowered.scale == 120
    by_name = dict(zip(lowered.actions, lowered.costs, strict=True))
    assert by_name["work--human--j0"] % 120 == 15
    assert {lowered.objective(c) for n, c in by_name.items() if n.startswith("praise")} == {
        Fraction(5, 2)
    }


def test_zero_costs_stay_zero(tmp_path: Path) -> None:
    problem = talk(tmp_path).with_values({("motivation", "human"): 0, ("effort", "j2"): 0})
    lowered = lower(Task(problem))
    assert 0 in lowered.costs


def test_a_weighted_metric_weighs_the_costs(tmp_path: Path) -> None:
    text = TALK_PROBLEM.replace(
        "(total-cost)))", "(+ (/ (total-cost) 3) (effort j0) 7 total-time)))"
    )
    text = text.replace("(= (total-cost) 0)", "(= (total-cost) 6)")
    text = text.format(n=1, jobs="j0", init="(open j0) (= (effort j0) 4)", goal="(done j0)",
                       motivation="1")  # fmt: skip
    problem = read(TALK, text)
    lowered = lower(Task(problem))
    plan = lowered.plan("(work--human--j0)")
    assert validate(problem, plan).metric == Fraction(5, 3) + 2 + 4 + 7 + 1  # one action
    cost = dict(zip(lowered.actions, lowered.costs, strict=True))["work--human--j0"]
    assert lowered.objective(cost) == validate(problem, plan).metric


def test_time_is_left_out_and_said_to_be() -> None:
    problem = read("transport", "two-boxes")
    lowered = lower(Task(problem))
    assert not lowered.exact_for_metric
    assert lowered.objective(24) is None
    # Where nothing but time counts, one action after the other takes the sum of the durations.
    timed = replace(problem, metric=problem.metric.parts[1])  # type: ignore[union-attr]
    assert set(lower(Task(timed)).costs) == {50}


def test_what_no_cost_can_say_is_refused(tmp_path: Path) -> None:
    problem = talk(tmp_path)
    with pytest.raises(UnsupportedError, match="maximized"):
        lower(Task(replace(problem, maximize=True)))
    with pytest.raises(UnsupportedError, match="negative"):
        lower(Task(problem.with_values({("effort", "j0"): -9})))
    moving = Task(replace(problem, metric=Function("motivation", ("human",))))
    with pytest.raises(UnsupportedError, match="which actions change"):
        lower(moving)
    curved = Task(replace(problem, metric=Arithmetic("*", (COST, COST))))
    with pytest.raises(UnsupportedError, match="not a weighted sum"):
        lower(curved)


def test_a_goal_that_never_holds_is_unreachable(tmp_path: Path) -> None:
    problem = read("transport", "two-boxes")
    lowered = lower(Task(replace(problem, goal=Compare("<", Constant(1), Constant(0)))))
    other = Task(read(lowered.domain_text, lowered.problem_text))
    assert not other.is_goal((1 << len(other.facts)) - 1)


def test_plans_lead_back(tmp_path: Path) -> None:
    lowered = lower(Task(talk(tmp_path)))
    plan = lowered.plan("; cost = 3\n(REMIND--HUMAN )\n(work--human--j1)\n")
    assert str(plan) == "(remind human)\n(work human j1)\n"
    with pytest.raises(PlanFormatError, match="no action of the lowered task"):
        lowered.plan("(remind human)")


# Three planners read the same file; GPL, so as child processes.

SYMK = ["symk/fast-downward.py", "domain.pddl", "problem.pddl", "--search", "sym_bd()"]
FD = ["downward/fast-downward.py", "domain.pddl", "problem.pddl", "--search", "astar(lmcut())"]


def cheapest(planner: str, lowered: Lowering, folder: Path) -> int:
    """Return the lowered cost of the plan that a planner calls optimal."""
    (folder / "domain.pddl").write_text(lowered.domain_text)
    (folder / "problem.pddl").write_text(lowered.problem_text)
    argv = {
        "symk": script("up_symk", *SYMK),
        "fast-downward": script("up_fast_downward", *FD),
        "kstar": [sys.executable, "-c", KSTAR_CODE],
    }[planner]
    finished = run(argv, cwd=folder, limits=ProcessLimits(60))
    assert finished.end is ProcessEnd.EXITED, finished.stderr
    found = re.findall(r"Plan cost: (\d+)|'cost': (\d+)", finished.stdout)
    assert found, finished.stdout[-2000:] + finished.stderr[-2000:]
    return int(next(filter(None, found[0])))


KSTAR_CODE = """
from pathlib import Path
from kstar_planner import planners
found = planners.plan_topk(
    domain_file=Path("domain.pddl"), problem_file=Path("problem.pddl"),
    number_of_plans_bound=1, timeout=50,
)
print(found["plans"])
"""


def script(package: str, path: str, *args: str) -> list[str]:
    spec = find_spec(package)
    assert spec is not None
    assert spec.submodule_search_locations
    return [sys.executable, str(Path(spec.submodule_search_locations[0]) / path), *args]


@pytest.mark.parametrize("planner", ["fast-downward", "symk", "kstar"])
def test_planners_find_the_optimum_under_interactions(planner: str, tmp_path: Path) -> None:
    for motivation, efforts in [("7", "1 0.5 0"), ("2", "0.1 3 0"), ("4", "0 0 0")]:
        task = Task(talk(tmp_path, 3, motivation, efforts))
        lowered = lower(task)
        assert lowered.objective(cheapest(planner, lowered, tmp_path)) == optimum(task)


AGENT_STATES: dict[str, dict[tuple[str, ...], int | Fraction]] = {
    "low": {},
    "unmotivated": {("motivation", "human"): 10},
    "fraction": {("motivation", "human"): Fraction(1, 3), ("knowledge", "robot"): Fraction(5, 2)},
}


@pytest.mark.parametrize("values", AGENT_STATES.values(), ids=AGENT_STATES)
@pytest.mark.parametrize(
    ("domain", "name"), [("kitchen", "parfait-nut"), ("transport", "two-boxes")]
)
def test_fast_downward_and_symk_prove_the_same(
    domain: str, name: str, values: dict[tuple[str, ...], int | Fraction], tmp_path: Path
) -> None:
    lowered = lower(Task(read(domain, name).with_values(values)))
    theirs = {
        planner: cheapest(planner, lowered, tmp_path) for planner in ("fast-downward", "symk")
    }
    assert theirs["fast-downward"] == theirs["symk"]
