"""Validation against VAL, on good plans and on plans with something changed, and rule by rule."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import root
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction, format_plan, parse_plan
from hrcplan.validation import Report, validate
from tests.val import val
from tests.worlds import problem_from

HERE = Path(__file__).parent
GOOD = {
    "two-boxes": ("transport", 24, "58.00051"),
    "handover": ("transport", 36, "95.50102"),
    "oatmeal-apple": ("kitchen", 65, "65"),
}


def good_plan(name: str) -> Plan:
    return parse_plan((HERE / "data" / "plans" / f"{name}.plan").read_text())


def shipped(name: str) -> tuple[Path, Path, Problem]:
    domain = GOOD[name][0]
    return (
        root() / "domains" / f"{domain}.pddl",
        root() / "problems" / domain / f"{name}.pddl",
        read(domain, name),
    )


@pytest.mark.parametrize("name", GOOD)
def test_good_plans_cost_what_val_says(name: str) -> None:
    domain, file, problem = shipped(name)
    plan = good_plan(name)
    report = validate(problem, plan)
    assert report.valid
    assert report.cost == GOOD[name][1] == sum(report.step_costs)
    assert report.metric == Fraction(GOOD[name][2])
    accepts, value = val(domain, file, plan)
    assert accepts
    assert value is not None
    assert float(value) == pytest.approx(float(report.metric), abs=1e-4)


@st.composite
def changed_plans(draw: st.DrawFn, name: str) -> Plan:
    """A good plan in which one to three things were changed."""
    actions = list(good_plan(name).actions)
    objects = list(read(GOOD[name][0], name).objects)
    for _ in range(draw(st.integers(1, 3))):
        if not actions:
            break
        i = draw(st.integers(0, len(actions) - 1))
        old = actions[i]
        match draw(st.sampled_from(["drop", "double", "swap", "object", "time", "duration"])):
            case "drop":
                del actions[i]
            case "double":
                actions.insert(i, old)
            case "swap":
                j = draw(st.integers(0, len(actions) - 1))
                other = actions[j]
                actions[i] = replace(old, name=other.name, args=other.args)
                actions[j] = replace(other, name=old.name, args=old.args)
            case "object":
                args = list(old.args)
                args[draw(st.integers(0, len(args) - 1))] = draw(st.sampled_from(objects))
                actions[i] = replace(old, args=tuple(args))
            case "time" if old.start_s is not None:
                by = draw(st.sampled_from(["-0.001", "-0.0005", "0.0005", "0.001", "-30", "30"]))
                actions[i] = replace(old, start_s=max(old.start_s + Fraction(by), 0))
            case "duration" if old.duration_s is not None:
                by = draw(st.sampled_from(["-0.01", "0.01", "1", "-50"]))
                actions[i] = replace(old, duration_s=old.duration_s + Fraction(by))
    return Plan(tuple(sorted(actions, key=lambda a: a.start_s or 0)))


@settings(max_examples=60)
@given(data=st.data(), name=st.sampled_from(sorted(GOOD)))
def test_changed_plans_are_judged_as_by_val(data: st.DataObject, name: str) -> None:
    domain, file, problem = shipped(name)
    plan = data.draw(changed_plans(name))
    report = validate(problem, plan)
    accepts, value = val(domain, file, plan)
    if accepts and not report.valid and "0.001 s between them" in str(report.reason):
        return  # a gap of 0.0005 s: VAL only merges what is much closer than its tolerance
    assert report.valid == accepts, (report.reason, format_plan(plan))
    if report.valid:
        assert report.metric is not None
        assert float(str(value)) == pytest.approx(float(report.metric), abs=1e-3)


INVALID = sorted((HERE / "invalid_plans").glob("*.plan"))


@pytest.mark.parametrize("path", INVALID, ids=[path.stem for path in INVALID])
def test_kept_invalid_plans(path: Path) -> None:
    """Each names its problem, the step that fails and the reason in its first three lines."""
    text = path.read_text()
    problem, step, reason = (line.split(": ", 1)[1] for line in text.splitlines()[:3])
    report = validate(read(*problem.split("/")), parse_plan(text))
    assert not report.valid
    assert report.reason == reason
    assert report.failed_step == (None if step == "none" else int(step))
    assert (report.cost, report.makespan_s, report.metric) == (None, None, None)


def test_the_state_where_it_broke() -> None:
    problem = read("transport", "two-boxes")
    report = validate(problem, parse_plan("(move robot wp0 wp4)\n(grasp robot green wp4)\n"))
    assert ("at", "robot", "wp4") in report.state
    assert ("at", "robot", "wp0") not in report.state


CLOCKS = """
(define (domain clocks)
  (:requirements :adl :typing :numeric-fluents :durative-actions :duration-inequalities)
  (:types tank)
  (:constants left right - tank)
  (:predicates (open ?t - tank) (ready) (warm))
  (:functions (level ?t - tank) (rate ?t - tank) (total-cost))
  (:durative-action fill
    :parameters (?t - tank)
    :duration (= ?duration (rate ?t))
    :condition (and (at start (open ?t)) (over all (open ?t)) (at end (<= (level ?t) 5)))
    :effect (and (at end (increase (level ?t) ?duration))
      (at start (increase (total-cost) (* 0.5 ?duration)))))
  (:durative-action heat
    :parameters ()
    :duration (and (>= ?duration 2) (<= ?duration 4))
    :condition (at start (not (warm)))
    :effect (and (at start (warm)) (at end (ready)) (at end (not (warm)))))
  (:durative-action blink
    :parameters ()
    :duration (= ?duration 0)
    :condition (over all (open left))
    :effect (at end (ready)))
  (:durative-action watch
    :parameters ()
    :duration (= ?duration 1)
    :condition (over all (warm))
    :effect (at end (ready)))
  (:action speed
    :parameters (?t - tank)
    :precondition (> (rate ?t) 1)
    :effect (and (scale-down (rate ?t) 2) (increase (total-cost) 1)))
  (:action shut :parameters (?t - tank) :precondition (open ?t) :effect (not (open ?t)))
  (:action unlock :parameters (?t - tank) :precondition (not (open ?t)) :effect (open ?t)))
"""
TANKS = """
(define (problem tanks) (:domain clocks)
  (:init (open left) (= (level left) 0) (= (level right) 0) (= (rate left) 4) (= (rate right) 3)
    (= (total-cost) 0))
  (:goal GOAL)
  (:metric minimize (+ (total-cost) (total-time))))
"""


@pytest.fixture(scope="module")
def clocks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clocks")
    (folder / "domain.pddl").write_text(CLOCKS)
    return folder


def judge(folder: Path, goal: str, plan: str) -> tuple[Report, bool | None]:
    """Return our verdict, and VAL's if the plan is one that it can read."""
    domain, file = folder / "domain.pddl", folder / "problem.pddl"
    file.write_text(TANKS.replace("GOAL", goal))
    problem = read(domain, file)
    parsed = parse_plan(plan)
    return validate(problem, parsed), val(domain, file, parsed)[0] if parsed.is_schedule else None


@pytest.mark.parametrize(
    ("goal", "plan", "fault"),
    [
        # Numbers that the bit task cannot hold.
        ("(>= (level left) 4)", "0: (fill left) [4]", None),
        ("(>= (level left) 6)", "0: (speed left)\n1: (fill left) [2]\n4: (fill left) [2]", "goal"),
        ("(= (level left) 4)", "0: (speed left)\n1: (fill left) [2]\n4: (fill left) [2]", None),
        ("(>= (level left) 4)", "0: (fill left) [3]", "lasts 4 s"),
        # A duration within its bounds, at them, and outside.
        ("(ready)", "0: (heat) [3]", None),
        ("(ready)", "0: (heat) [4]", None),
        ("(ready)", "0: (heat) [5]", "lasts <= 4 s"),
        ("(ready)", "0: (heat) [1]", "lasts >= 2 s"),
        # Over all: from just after the start to just before the end.
        ("(ready)", "0: (heat) [3]\n1: (watch) [1]", None),
        ("(ready)", "0: (heat) [3]\n2: (watch) [1]", None),
        ("(ready)", "0: (heat) [3]\n2.5: (watch) [1]", "needs (warm)"),
        ("(ready)", "0: (heat) [3]\n0: (watch) [1]", None),
        ("(ready)", "0: (watch) [1]\n0.5: (heat) [3]", "needs (warm)"),
        ("(>= (level left) 4)", "0: (fill left) [4]\n3: (shut left)", "needs (open left)"),
        ("(>= (level left) 4)", "0: (fill left) [4]\n4: (shut left)", None),
        (
            "(>= (level left) 4)",
            "0: (fill left) [4]\n2: (shut left)\n3: (unlock left)",
            "needs (open left)",
        ),
        # What does not interfere may coincide; what does may not.
        (
            "(and (not (open left)) (open right))",
            "1: (shut left)\n1: (unlock right)",
            None,
        ),
        ("(not (open left))", "1: (shut left)\n1: (shut left)", "interfere"),
        ("(open left)", "1: (shut left)\n1.001: (unlock left)", None),
        ("(open left)", "1: (shut left)\n1: (unlock left)", "interfere"),
        ("(= (total-cost) 2)", "1: (speed left)\n1: (speed right)", None),
        ("(= (rate left) 1)", "1: (speed left)\n1: (speed left)", "interfere"),
        # Nothing to do; an action without length.
        ("(open left)", "", None),
        ("(ready)", "0: (blink) [0]", None),
        ("(ready)", "0: (shut left)\n1: (blink) [0]", None),  # nothing lies between its ends
    ],
)
def test_rules(clocks: Path, goal: str, plan: str, fault: str | None) -> None:
    report, accepted = judge(clocks, goal, plan)
    assert report.valid == (fault is None), report.reason
    assert fault is None or fault in str(report.reason)
    if accepted is not None:
        assert report.valid == accepted


def test_sequential_plans_read_durations_where_they_are(clocks: Path) -> None:
    report, _ = judge(clocks, "(= (level left) 2)", "(speed left)\n(fill left)\n")
    assert report.valid
    assert report.cost == 2
    assert report.step_costs == (1, 1)
    assert report.makespan_s == Fraction(2001, 1000)
    assert report.metric == Fraction(4001, 1000)


def test_an_empty_plan_costs_nothing(clocks: Path) -> None:
    report, _ = judge(clocks, "(open left)", "")
    assert (report.valid, report.cost, report.makespan_s, report.metric) == (True, 0, 0, 0)


def test_a_plan_without_times_in_a_classical_domain_has_no_makespan() -> None:
    report = validate(read("kitchen", "oatmeal-apple"), good_plan("oatmeal-apple"))
    assert report.makespan_s is None


def test_a_number_without_a_value_is_a_reason_not_a_crash(clocks: Path) -> None:
    report, _ = judge(clocks, "(>= (level left) 4)", "(fill left)\n")
    assert report.valid
    missing = read(clocks / "domain.pddl", clocks / "problem.pddl")
    bare = replace(missing, values={})
    assert validate(bare, parse_plan("")).reason is not None
    assert validate(bare, parse_plan("0: (fill left) [4]")).failed_step == 0
    assert validate(bare, parse_plan("(speed left)")).failed_step == 0


def test_actions_given_as_values_need_no_text() -> None:
    problem = read("transport", "two-boxes")
    assert validate(problem, Plan((PlannedAction("move", ("robot", "wp0", "wp1")),))).reason == (
        "the goal (box-at green wp2) does not hold at the end"
    )


def test_a_smaller_gap_is_valid_where_it_is_asked_for() -> None:
    text = (Path(__file__).parent / "invalid_plans" / "half-a-gap.plan").read_text()
    problem = read(*text.splitlines()[0].split(": ", 1)[1].split("/"))
    plan = parse_plan(text)
    assert validate(problem, plan).gap_s == Fraction(5, 10000)
    assert validate(problem, plan, epsilon_s=Fraction(5, 10000)).valid


STEPS = """(define (domain steps) (:requirements :strips) (:predicates (at ?p) (next ?p ?q))
  (:action go :parameters (?p ?q) :precondition (and (at ?p) (next ?p ?q))
    :effect (and (at ?q) (not (at ?p)))))"""
STEPS_ABC = """(define (problem p) (:domain steps) (:objects a b c)
  (:init (at a) (next a b) (next b c)) (:goal (at c)) (:metric minimize (total-time)))"""


@pytest.mark.parametrize("text", ["(go a b) (go b c)", "0: (go a b)\n1: (go b c)"])
def test_the_total_time_of_a_classical_plan_is_its_number_of_actions(text: str) -> None:
    assert validate(problem_from(STEPS, STEPS_ABC), parse_plan(text)).metric == 2


@pytest.mark.parametrize(("text", "costs"), [("", ()), ("0: (turn) [2]", (1,))])
def test_a_cost_that_comes_by_itself_is_no_action_s(
    tmp_path: Path, text: str, costs: tuple[int, ...]
) -> None:
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    domain.write_text("""(define (domain toll)
        (:requirements :durative-actions :numeric-fluents :timed-initial-literals)
        (:predicates (open)) (:functions (total-cost))
        (:durative-action turn :parameters () :duration (= ?duration 2) :condition ()
            :effect (at end (increase (total-cost) 1))))""")
    problem.write_text("""(define (problem p) (:domain toll)
        (:init (= (total-cost) 0) (at 1 (open)) (at 5 (= (total-cost) 3)))
        (:goal (open)) (:metric minimize (total-cost)))""")
    report = validate(domain, problem, text)
    assert (report.valid, report.cost, report.step_costs) == (True, 3, costs)
