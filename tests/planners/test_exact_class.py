"""Which tasks and metrics `exact` takes, and the reasons why it declines the others."""

from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Answer, Status
from hrcplan.planners.exact import ExactPlanner
from hrcplan.plans import EPSILON_S, Plan, parse_plan
from hrcplan.task import Task
from hrcplan.task.ground import ground
from hrcplan.validation import validate

# One small domain, one change for each way to fall outside the class.

DOMAIN = """(define (domain tiny)
  (:requirements :strips :typing :durative-actions :numeric-fluents :negative-preconditions
                 :conditional-effects :disjunctive-preconditions :duration-inequalities)
  (:types agent)
  (:predicates (idle ?a - agent) (lit) (done ?a - agent) (wet))
  (:functions (effort ?a - agent) (total-cost))
  (:durative-action work
    :parameters (?a - agent) :duration (= ?duration 10)
    :condition (and (at start (idle ?a)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (done ?a))
                 (at start (increase (total-cost) (effort ?a)))))
  {more})"""
PROBLEM = """(define (problem tiny) (:domain tiny) (:objects ann bob - agent)
  (:init (idle ann) (idle bob) (wet) (= (effort ann) {ann}) (= (effort bob) 0.3) (= (total-cost) 0))
  (:goal (and {goal})) {metric})"""
BOTH = "(done ann) (done bob)"
SUM = "(:metric minimize (+ (total-cost) (total-time)))"


def extra(condition: str, effect: str, duration: str = "(= ?duration 5)") -> str:
    return f"""(:durative-action extra :parameters (?a - agent) :duration {duration}
      :condition (and (at start (idle ?a)) {condition})
      :effect (and (at start (not (idle ?a))) (at end (idle ?a)) {effect}))"""


def tiny(folder: Path, more: str = "", goal: str = BOTH, metric: str = SUM, ann: str = "2") -> Task:
    (folder / "domain.pddl").write_text(DOMAIN.format(more=more))
    text = PROBLEM.format(goal=goal, metric=metric, ann=ann)
    (folder / "problem.pddl").write_text(text)
    return Task(read(str(folder / "domain.pddl"), str(folder / "problem.pddl")))


OPEN = "(>= ?duration 5)"
FREE = ":parameters () :duration (= ?duration 5) :condition (and) :effect (at end (lit))"
LOOSE = """:parameters (?a - agent) :duration (= ?duration 5) :condition (at start (idle ?a))
  :effect (at end (lit))"""


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        (extra("", "(at end (lit))", OPEN), "duration that the planner may choose"),
        (extra("", "(at end (lit))", "(= ?duration 0)"), "lasts 0 s"),
        ("(:action extra :parameters (?a - agent) :effect (lit))", "instantaneous"),
        (f"(:durative-action extra {FREE})", r"\(extra\) has no agent"),
        (f"(:durative-action extra {LOOSE})", "both need ann throughout"),
        (extra("", "(at start (lit))"), r"adds \(lit\) at its start"),
        (extra("", "(at end (lit)) (at end (not (wet)))"), r"deletes \(wet\) at its end"),
        (extra("(at end (lit))", "(at end (wet)) (at end (lit))"), "condition at its end"),
        (extra("", "(at end (when (done ?a) (lit)))"), "conditional effect"),
        (extra("", "(at end (increase (total-cost) 1))"), "costs something at its end"),
        (
            extra("", "(at start (not (lit))) (at end (lit))"),
            r"\(lit\) depends on which of them ends first",
        ),
        (
            extra("(over all (not (lit)))", "(at end (lit))"),
            r"\(lit\) depends on which of them ends first",
        ),
    ],
)
def test_it_declines_with_the_reason(more: str, reason: str, tmp_path: Path) -> None:
    task = tiny(tmp_path, more)
    with pytest.raises(UnsupportedError, match=reason):
        ExactPlanner().replan(task)


@pytest.mark.parametrize(
    ("metric", "ann", "reason"),
    [
        ("(:metric maximize (total-cost))", "2", "to minimize"),
        ("(:metric minimize (* (total-cost) (total-time)))", "2", "not a sum"),
        ("(:metric minimize (- (total-time) (total-cost)))", "2", "rewards cost or time"),
        (SUM, "-1", r"\(work ann\) costs -1"),
    ],
)
def test_it_declines_metrics(metric: str, ann: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(UnsupportedError, match=reason):
        ExactPlanner().replan(tiny(tmp_path, metric=metric, ann=ann))


def test_it_declines_classical_tasks() -> None:
    with pytest.raises(UnsupportedError, match="exact declines: no action has a duration"):
        ExactPlanner().replan(ground("kitchen", "oatmeal-apple"))


@pytest.mark.parametrize(
    ("metric", "objective"),
    [
        (SUM, Fraction("12.3")),
        ("(:metric minimize (+ 3 (* (effort bob) (total-cost)) (/ (total-time) 3)))",
         3 + Fraction("0.69") + Fraction(10, 3)),
        ("(:metric minimize (total-cost))", Fraction("2.3")),
        ("(:metric minimize (total-time))", 10),
    ],
)  # fmt: skip
def test_metrics_are_exact(metric: str, objective: Number, tmp_path: Path) -> None:
    answer = ExactPlanner().replan(tiny(tmp_path, metric=metric))
    assert answer.status is Status.OPTIMAL
    assert answer.objective == objective


def test_without_a_metric_it_is_the_makespan(tmp_path: Path) -> None:
    answer = ExactPlanner().replan(tiny(tmp_path, metric=""))
    assert answer.status is Status.OPTIMAL
    assert answer.plan is not None
    assert answer.plan.makespan_s == 10
    assert answer.objective is None  # there is a cost, which is not what was minimized


def test_a_goal_that_holds_needs_nothing(tmp_path: Path) -> None:
    assert ExactPlanner().replan(tiny(tmp_path, goal="(idle ann)")) == Answer(
        Status.OPTIMAL, Plan(), 0
    )


def test_unsolvable(tmp_path: Path) -> None:
    task = tiny(tmp_path, extra("(at start (lit))", "(at end (lit))"), goal="(lit)")
    assert ExactPlanner().replan(task) == Answer(Status.UNSOLVABLE)


def test_odd_durations_are_printed_so_that_they_can_be_read(tmp_path: Path) -> None:
    thirds = extra("(at start (done ?a))", "(at end (lit))", "(= ?duration (/ 10 3))")
    task = tiny(tmp_path, thirds, goal="(lit)")
    plan = ExactPlanner().replan(task).plan
    assert plan is not None
    assert [a.start_s for a in plan.actions] == [0, 10 + EPSILON_S]
    assert validate(task.problem, parse_plan(str(plan))).valid
