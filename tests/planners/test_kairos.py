"""kairos: the best of its presets, within its time, in a process that stays ours."""

import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TOTAL_COST, Function, Problem
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.fast_downward import FastDownward
from hrcplan.planners.handover import Handover
from hrcplan.planners.kairos import TIMED_PRESETS, Kairos
from hrcplan.validation import validate
from tests.texts import problem_of

HUMAN = ("motivation", "human")


def solve(problem: Problem, seconds: float = 10, *, any_plan: bool = False) -> Answer:
    return Kairos().solve(Request(problem, time.monotonic() + seconds, any_plan))


def metric(problem: Problem, answer: Answer) -> Fraction:
    assert answer.plan is not None
    report = validate(problem, answer.plan)
    assert report.valid, report.reason
    assert report.metric is not None
    return Fraction(report.metric)


@pytest.mark.parametrize("motivation", [1, 5, 10])
@pytest.mark.parametrize("name", ["two-boxes", "handover"])
def test_the_portfolio_is_as_good_as_its_best_preset(name: str, motivation: int) -> None:
    problem = read("transport", name).with_values({HUMAN: motivation})
    answer = solve(problem)
    assert answer.status is Status.SOLVED  # an exhausted search is no proof
    single = [
        metric(problem, Kairos((preset,)).solve(Request(problem))) for preset in TIMED_PRESETS
    ]
    assert metric(problem, answer) == min(single)


def test_a_duration_that_decides_what_is_reached_is_chosen() -> None:
    domain = """(define (domain press)
      (:requirements :fluents :durative-actions :duration-inequalities)
      (:predicates (shut)) (:functions (force) (most))
      (:durative-action push :parameters ()
        :duration (<= ?duration (- (most) (force)))
        :condition (and) :effect (at end (increase (force) ?duration)))
      (:action close :parameters () :precondition (> (force) 0) :effect (shut)))"""
    problem = read(
        domain,
        """(define (problem p) (:domain press) (:init (= (force) 0) (= (most) 9))
      (:goal (shut)) (:metric minimize (total-time)))""",
    )
    answer = solve(problem, any_plan=True)
    assert answer.plan is not None
    assert validate(problem, answer.plan).valid


def test_its_own_figure_is_reported() -> None:
    problem = read("transport", "two-boxes").with_values({HUMAN: Fraction(17, 8)})
    answer = solve(problem)
    assert answer.objective is not None
    assert abs(answer.objective - metric(problem, answer)) < 1e-6


def test_a_classical_task_is_proven() -> None:
    problem = read("kitchen", "parfait-nut").with_values({HUMAN: Fraction(1, 3)})
    short = with_goal(problem, "(and (in oats glass) (served))", "short")
    ours, theirs = solve(short), FastDownward().solve(Request(short))
    assert theirs.status is Status.OPTIMAL
    assert ours.status in (Status.OPTIMAL, Status.SOLVED)  # it gives up when it is held up
    assert ours.objective is not None
    assert theirs.objective is not None
    assert abs(ours.objective - theirs.objective) < 1e-5


def test_a_whole_recipe_is_never_below_the_optimum() -> None:
    problem = read("kitchen", "parfait-nut")
    assert metric(problem, solve(problem, 2)) >= 50


def test_the_cost_of_the_sequential_reading_is_never_below_the_optimum() -> None:
    problem = read("transport", "two-boxes")
    costly = replace(problem, metric=Function(TOTAL_COST))
    assert metric(costly, solve(costly)) >= 24


def test_unsolvable_is_said() -> None:
    problem = read("transport", "two-boxes")
    facts = frozenset(f for f in problem.facts if f[0] != "reach")
    assert solve(replace(problem, facts=facts)).status is Status.UNSOLVABLE


def test_costs_that_actions_change_are_minimized(tmp_path: Path) -> None:
    """Its search ignores such a metric, so it gets the lowered task."""
    (tmp_path / "d.pddl").write_text("""
(define (domain talk) (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent job) (:predicates (done ?j - job))
  (:functions (motivation ?a - agent) (total-cost))
  (:action work :parameters (?a - agent ?j - job)
    :effect (and (done ?j) (increase (total-cost) (+ (motivation ?a) 0.5))))
  (:action remind :parameters (?a - agent)
    :effect (and (assign (motivation ?a) 1) (increase (total-cost) 2))))
""")
    (tmp_path / "p.pddl").write_text("""
(define (problem t) (:domain talk) (:objects human - agent i j k - job)
  (:init (= (motivation human) 4) (= (total-cost) 3)) (:goal (and (done i) (done j) (done k)))
  (:metric minimize (total-cost)))""")
    problem = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    answer = solve(problem)
    assert (answer.status, answer.objective) == (Status.OPTIMAL, 3 + Fraction(13, 2))


def test_for_any_plan_nothing_is_grounded_first(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(task: object) -> None:
        raise AssertionError

    monkeypatch.setattr("hrcplan.planners.kairos.lower", refuse)
    domain = """(define (domain fill) (:requirements :fluents) (:predicates) (:functions (level))
      (:action pour :parameters () :effect (increase (level) 1)))"""
    text = "(define (problem p) (:domain fill) (:init (= (level) 0)) (:goal (>= (level) 2)))"
    answer = solve(problem_of(domain, text), any_plan=True)
    assert answer.plan is not None
    assert len(answer.plan.actions) == 2


@pytest.mark.parametrize(("goal", "guards"), [("b", [False]), ("c", [False, True])])
def test_missing_values_are_guarded_where_it_finds_no_plan_without(
    goal: str, guards: list[bool], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[bool] = []

    def of(problem: Problem, **forms: bool) -> Handover:
        asked.append(forms["guards"])
        return Handover.of(problem, **forms)

    monkeypatch.setattr("hrcplan.planners.kairos.Handover", SimpleNamespace(of=of))
    domain = """(define (domain roads) (:requirements :fluents) (:predicates (at ?x))
      (:functions (length ?x ?y) (fuel)) (:action go :parameters (?x ?y)
        :precondition (and (at ?x) (not (> (length ?x ?y) (fuel)))) :effect (at ?y)))"""
    text = f"""(define (problem p) (:domain roads) (:objects a b c)
      (:init (at a) (= (fuel) 9) (= (length a b) 2)) (:goal (at {goal})))"""
    answer = solve(problem_of(domain, text), any_plan=True)
    assert (answer.plan is not None) == (goal == "b")
    assert asked == guards


def test_it_keeps_its_time_and_lets_other_threads_run() -> None:
    problem = read("transport", "boxes-6")
    ticks = []
    done = threading.Event()

    def tick() -> None:
        while not done.wait(0.02):
            ticks.append(1)

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    answer = solve(problem, 2)
    took = time.monotonic() - begun
    done.set()
    thread.join()
    assert took < 20
    assert len(ticks) > 20
    assert metric(problem, answer) > 0


def test_no_time_is_no_plan() -> None:
    assert solve(read("transport", "two-boxes"), -1).status is Status.UNSOLVED


def test_any_plan_is_the_first() -> None:
    problem = read("transport", "boxes-6")
    begun = time.monotonic()
    answer = solve(problem, 30, any_plan=True)
    assert time.monotonic() - begun < 25
    assert answer.status is Status.SOLVED
    assert metric(problem, answer) > 0


def test_what_it_does_not_read_is_unsupported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "hrcplan.planners.handover.problem_text", lambda problem: "(define (problem"
    )
    with pytest.raises(UnsupportedError, match="does not read"):
        solve(read("transport", "two-boxes"))


def test_ctrl_c_stops_it() -> None:
    code = (
        "import time; from hrcplan.pddl.inputs import read\n"
        "from hrcplan.planners.contract import Request\n"
        "from hrcplan.planners.kairos import Kairos\n"
        "request = Request(read('transport', 'boxes-6'), time.monotonic() + 60)\n"
        "print('ready', flush=True)\n"
        "Kairos(('ff',)).solve(request)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, text=True)  # fmt: skip
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    time.sleep(1)
    begun = time.monotonic()
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=20)
    assert time.monotonic() - begun < 15
    assert "KeyboardInterrupt" in errors


def test_a_metric_to_be_maximized_is_raised_step_by_step() -> None:
    """kairos itself stops at the first plan, which sells nothing."""
    domain = """(define (domain shop) (:requirements :fluents :durative-actions)
      (:predicates (done) (left ?x)) (:functions (gain) (worth ?x))
      (:durative-action sell :parameters (?x) :duration (= ?duration 2)
        :condition (at start (left ?x))
        :effect (and (at start (not (left ?x))) (at end (increase (gain) (worth ?x)))))
      (:durative-action close :parameters () :duration (= ?duration 2) :condition (and)
        :effect (at end (done))))"""
    text = """(define (problem p) (:domain shop) (:objects a b c)
      (:init (left a) (left b) (left c) (= (gain) 0) (= (worth a) 1) (= (worth b) 5)
        (= (worth c) -2)) (:goal (done)) (:metric maximize (gain)))"""
    problem = problem_of(domain, text)
    assert metric(problem, solve(problem)) == 6
    timed = text.replace("(gain)))", "(- (gain) (* 0.5 (total-time)))))")
    assert metric(problem_of(domain, timed), solve(problem_of(domain, timed))) == 5
