"""`exact` where all sequential states would be too many: landmarks, symmetries, a first plan."""

import random
import time
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import pytest

from hrcplan.core import clock
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import And, Atom
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.exact import ExactPlanner, proof, search
from hrcplan.planners.exact.arcs import Arcs
from hrcplan.planners.exact.estimates import Landmarks
from hrcplan.planners.exact.graph import FAR
from hrcplan.planners.exact.memory import TaskMemory
from hrcplan.planners.exact.symmetry import Swap, representative, symmetries
from hrcplan.planners.exact.weights import Weights, metric, weights
from hrcplan.plans import Plan
from hrcplan.task import Task
from hrcplan.task.ground import ground
from hrcplan.validation import validate
from tests.worlds import problem_from

LATER = time.monotonic() + 3600

# Agents carry boxes from one room to another; `{costs}` may tell agents apart.

DOMAIN = """(define (domain carriers)
  (:requirements :strips :typing :durative-actions :numeric-fluents)
  (:types agent box room)
  (:predicates (idle ?a - agent) (in ?a - agent ?r - room) (free ?a - agent)
    (has ?a - agent ?b - box) (lies ?b - box ?r - room))
  (:functions (effort ?a - agent) (total-cost))
  (:durative-action go :parameters (?a - agent ?from ?to - room) :duration (= ?duration 2)
    :condition (and (at start (idle ?a)) (at start (in ?a ?from)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at start (not (in ?a ?from)))
      (at end (in ?a ?to)) (at start (increase (total-cost) (effort ?a)))))
  (:durative-action take :parameters (?a - agent ?b - box ?r - room) :duration (= ?duration 1)
    :condition (and (at start (idle ?a)) (at start (free ?a)) (at start (lies ?b ?r))
      (over all (in ?a ?r)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at start (not (free ?a)))
      (at start (not (lies ?b ?r))) (at end (has ?a ?b))))
  (:durative-action put :parameters (?a - agent ?b - box ?r - room) :duration (= ?duration 1)
    :condition (and (at start (idle ?a)) (at start (has ?a ?b)) (over all (in ?a ?r)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at start (not (has ?a ?b)))
      (at end (lies ?b ?r)) (at end (free ?a)))))"""


def carriers(
    folder: Path, n_agents: int = 3, n_boxes: int = 4, efforts: tuple[int, ...] = (1, 1, 1),
    goal: str = "",
) -> Task:  # fmt: skip
    agents, boxes = [f"a{i}" for i in range(n_agents)], [f"b{i}" for i in range(n_boxes)]
    idle = " ".join(
        f"(idle {a}) (in {a} hall) (free {a}) (= (effort {a}) {effort})"
        for a, effort in zip(agents, efforts, strict=False)
    )
    lies = " ".join(f"(lies {box} hall)" for box in boxes)
    goal = goal or " ".join(f"(lies {box} shed)" for box in boxes)
    (folder / "domain.pddl").write_text(DOMAIN)
    (folder / "problem.pddl").write_text(
        f"(define (problem p) (:domain carriers) (:objects {' '.join(agents)} - agent"
        f" {' '.join(boxes)} - box hall shed - room)"
        f"(:init {idle} {lies} (= (total-cost) 0)) (:goal (and {goal}))"
        "(:metric minimize (+ (total-cost) (total-time))))"
    )
    return Task(read(str(folder / "domain.pddl"), str(folder / "problem.pddl")))


def parts(task: Task) -> tuple[TaskMemory, Weights]:
    memory = TaskMemory(task, LATER)
    memory.admit(task, LATER)
    return memory, weights(task, metric(task.problem), memory.frame, memory.lanes)


def swaps_of(task: Task) -> tuple[Swap, ...]:
    memory, costs = parts(task)
    return symmetries(task, memory.frame, costs, LATER)


def walk(task: Task, seed: int, n_steps: int = 30) -> list[int]:
    """Return the states of a random walk."""
    rng, states = random.Random(seed), [task.initial]
    for _ in range(n_steps):
        states.append(task.successor(states[-1], rng.choice(task.applicable(states[-1]))))
    return states


def test_few_of_all_states_are_looked_at() -> None:
    planner = ExactPlanner()
    answer = planner.replan(ground("transport", "boxes-4"))
    assert answer.status is Status.OPTIMAL
    assert answer.bound == 101.5
    (memory,) = planner._memories.memories
    assert len(memory.graph.states) < 2500  # of 124,416


@pytest.mark.parametrize("name", ["two-boxes", "handover"])
def test_landmarks_are_never_above_the_distance(name: str) -> None:
    task = ground("transport", name).with_values({("motivation", "human"): 4})
    memory, costs = parts(task)
    memory.graph.complete(task, FAR, LATER)
    n_states = len(memory.graph.states)
    goals = [i for i, state in enumerate(memory.graph.states) if task.is_goal(state)]
    arcs = Arcs(task, memory.graph)
    by_work, by_cost, by_ticks = (
        arcs.distances(each, goals, LATER) for each in (costs.work, costs.cost, costs.busy)
    )
    landmarks = Landmarks(task, memory.graph, costs, LATER)
    for state in walk(task, seed=1):
        index = memory.graph.state(state)
        landmarks.refine(index)
        edges = iter(memory.graph.edges(task, index))
        for action, target in zip(edges, edges, strict=True):
            landmarks.inherit(index, action, target)
            for i in (index, target):
                assert landmarks[i].work <= by_work[i]
                assert landmarks[i].cost <= by_cost[i]
                assert landmarks[i].busy <= by_ticks[i]
                assert landmarks[i].chain <= by_ticks[i]
    assert len(memory.graph.states) == n_states


def test_a_symmetry_maps_what_can_follow(tmp_path: Path) -> None:
    task = carriers(tmp_path)
    swaps = swaps_of(task)
    assert len(swaps) == 3 + 6  # pairs of agents, pairs of boxes; the rooms differ by the goal
    for state in walk(task, seed=2):
        for swap in swaps:
            image = swap.of_facts(state)
            assert swap.of_facts(image) == state
            assert task.is_goal(image) == task.is_goal(state)
            images = [swap.actions[action] for action in task.applicable(state)]
            assert sorted(images) == task.applicable(image)
            for action in task.applicable(state):
                after = task.successor(image, swap.actions[action])
                assert after == swap.of_facts(task.successor(state, action))


def test_all_images_of_a_node_have_one_representative(tmp_path: Path) -> None:
    task = carriers(tmp_path, n_boxes=2)
    swaps = swaps_of(task)
    for state in walk(task, seed=3):
        for action in task.applicable(state):
            facts, running = task.start(state, action), ((1, action),)
            node = representative(facts, running, swaps)
            for swap in swaps:
                image = swap.of_facts(facts), swap.of_running(running)
                assert representative(*image, swaps) == node


def test_boxes_and_their_places_are_swapped_together() -> None:
    """Each of four boxes has a place of its own to go to."""
    task = ground("transport", "boxes-4")
    moved = [
        {name for a, image in enumerate(swap.actions) if a != image
         for name in set(task.actions[a].args) - set(task.actions[image].args)}
        for swap in swaps_of(task)
    ]  # fmt: skip
    assert {"human", "robot"} in moved
    assert {"wp0", "wp3"} in moved  # no box has to go there
    assert {"green", "blue", "wp2", "wp5"} in moved


def test_what_costs_or_is_to_be_done_tells_objects_apart(tmp_path: Path) -> None:
    assert len(swaps_of(carriers(tmp_path, efforts=(1, 2, 1)))) == 1 + 6
    assert len(swaps_of(carriers(tmp_path, goal="(lies b0 shed) (lies b1 shed)"))) == 3 + 2


OWNED = (
    DOMAIN.replace("box room)", "box room cart)")
    .replace("(idle ?a - agent)", "(idle ?a - agent) (owns ?a - agent ?c - cart) (full ?c - cart)")
    .replace("take :parameters (?a - agent", "take :parameters (?a - agent ?c - cart")
    .replace(
        "(and (at start (idle ?a)) (at start (free", "(and (at start (owns ?a ?c)) (at start (free"
    )
    .replace("(at end (has ?a ?b))", "(at end (has ?a ?b)) (at end (full ?c))")
)


def owners(n_agents: int, n_boxes: int) -> Task:
    """Return a task of agents who put boxes into the carts that they own."""
    agents, boxes, carts = ([f"{x}{i}" for i in range(n)] for x, n in
                            (("a", n_agents), ("b", n_boxes), ("c", n_agents)))  # fmt: skip
    parts = [f"(idle {a}) (in {a} hall) (free {a}) (= (effort {a}) 1)" for a in agents]
    parts += [f"(owns {a} {cart})" for a, cart in zip(agents, carts, strict=True)]
    parts += [f"(lies {box} hall)" for box in boxes]
    names = f"{' '.join(agents)} - agent {' '.join(boxes)} - box {' '.join(carts)} - cart"
    goal = " ".join(f"(lies {box} shed)" for box in boxes)
    text = (
        f"(define (problem p) (:domain carriers) (:objects {names} hall shed - room)"
        f" (:init {' '.join(parts)} (= (total-cost) 0)) (:goal (and {goal}))"
        " (:metric minimize (+ (total-cost) (total-time))))"
    )
    return Task(problem_from(OWNED, text))


def test_agents_are_swapped_with_what_is_theirs() -> None:
    task = owners(3, 3)
    swaps = swaps_of(task)
    assert len(swaps) == 3 + 3
    names = [
        set(task.actions[a].args) ^ set(task.actions[image].args)
        for swap in swaps
        for a, image in enumerate(swap.actions)
    ]
    assert {"a0", "a1", "c0", "c1"} in names


def answers(task: Task, monkeypatch: pytest.MonkeyPatch, quick: int) -> Answer:
    monkeypatch.setattr(proof, "QUICK", quick)
    return ExactPlanner().replan(task)


@pytest.mark.parametrize("efforts", [(1, 1, 1), (1, 1, 3), (0, 0, 0)])
def test_the_plan_does_not_depend_on_symmetries(
    efforts: tuple[int, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = carriers(tmp_path, n_boxes=3, efforts=efforts)
    early, never = answers(task, monkeypatch, 1), answers(task, monkeypatch, FAR)
    assert early == never
    assert early.bound == never.bound


def test_equal_agents_are_not_searched_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    expanded: list[int] = []

    class Counted(search.Search):
        def run(self, most_expanded: int | None = None) -> str | None:
            path = super().run(most_expanded)
            expanded.append(self.n_expanded)
            return path

    monkeypatch.setattr(proof, "Search", Counted)
    for quick in (1, FAR):
        answers(carriers(tmp_path, n_boxes=3), monkeypatch, quick)
    assert 3 * expanded[-2] < expanded[-1]
    for quick in (1, FAR):
        answers(owners(2, 2), monkeypatch, quick)
    assert 3 * expanded[-2] < 2 * expanded[-1]


def test_at_a_limit_the_best_plan_so_far_has_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    task = ground("transport", "boxes-3")
    monkeypatch.setattr(search, "MAX_NODES", 1200)
    plans: list[Plan] = []
    request = Request(task.problem, LATER, improves=True, on_plan=plans.append)
    answer = ExactPlanner().solve(request)
    assert answer.status is Status.SOLVED
    assert [answer.plan] == plans
    report = validate(task.problem, plans[0])
    assert report.valid
    assert report.metric == answer.objective
    assert answer.bound is not None
    assert 72.5 <= answer.bound <= 92.5  # the optimum
    assert report.metric is not None
    assert answer.bound < report.metric
    quiet = ExactPlanner().solve(replace(request, improves=False))
    assert (quiet.status, quiet.bound) == (Status.UNSOLVED, answer.bound)


def test_nodes_take_no_more_than_half_of_the_memory() -> None:
    problem = read("transport", "boxes-4")
    few = ExactPlanner().solve(Request(problem, LATER, memory_bytes=200 * 2 * search.NODE_BYTES))
    assert few.note == "no proof within 200 nodes"
    assert few.bound is not None


@pytest.mark.parametrize("looks", [1600, 1900, 4000])
def test_out_of_time_there_is_a_bound(looks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The clock of this test goes on by one second with each look at it."""
    seconds = count()
    monkeypatch.setattr(clock, "time", SimpleNamespace(monotonic=lambda: next(seconds)))
    task = ground("transport", "boxes-4")
    answer = ExactPlanner().replan(task, looks)
    assert answer.status is Status.UNSOLVED
    assert "out of time" in answer.note
    assert answer.bound is not None
    assert 87 <= answer.bound <= 101.5  # the optimum


@pytest.mark.parametrize("quick", [1, 300])
def test_any_plan_may_be_the_one_to_begin_with(quick: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "QUICK", quick)
    task = ground("transport", "boxes-4")
    answer = ExactPlanner().replan(task, any_plan=True)
    assert answer.status is Status.SOLVED
    assert answer.plan is not None
    assert validate(task.problem, answer.plan).valid


def test_a_goal_that_only_looks_reachable_is_unsolvable(monkeypatch: pytest.MonkeyPatch) -> None:
    """The robot cannot hold both boxes; without deletes it could."""
    monkeypatch.setattr(proof, "QUICK", 20)
    both = [Atom("holding", ("robot", box)) for box in ("green", "blue")]
    task = ground("transport", "two-boxes").with_goal(And(tuple(both)))
    planner = ExactPlanner()
    assert planner.replan(task) == Answer(Status.UNSOLVABLE)
    assert planner.replan(task) == Answer(Status.UNSOLVABLE)  # by distances
