"""Plans in the output of planners: which lines are read, and which text is a broken plan."""

from __future__ import annotations

from fractions import Fraction

import pytest

from hrcplan.errors import PlanFormatError
from hrcplan.inference.observations import observed_words
from hrcplan.pddl.model import Problem
from hrcplan.plans import PlannedAction, find_plans, read_plan
from tests.texts import problem_of
from tests.worlds import problem_from

WALK = """(define (domain walk) (:requirements :strips)
  (:predicates (at ?p) (link ?p ?q))
  (:action go :parameters (?p ?q) :precondition (and (at ?p) (link ?p ?q))
    :effect (and (at ?q) (not (at ?p)))))"""
TIMED = """(define (domain walk) (:requirements :strips :durative-actions)
  (:predicates (at ?p) (link ?p ?q))
  (:durative-action go :parameters (?p ?q) :duration (= ?duration 5)
    :condition (and (at start (at ?p)) (at start (link ?p ?q)))
    :effect (and (at end (at ?q)) (at start (not (at ?p))))))"""
PROBLEM = """(define (problem p) (:domain walk) (:objects a b c)
  (:init (at a) (link a b) (link b c)) (:goal (at c)))"""
GO = (PlannedAction("go", ("a", "b")), PlannedAction("go", ("b", "c")))

FF = """
ff: found legal plan as follows

step    0: GO A B
        1: GO B C
        2: REACH-GOAL

time spent:    0.00 seconds instantiating 2 easy, 0 hard action templates
"""
FAST_DOWNWARD = """[t=0.01s, 9 KB] Solution found!
go a b (1)
go b c (1)
[t=0.01s, 9 KB] Plan length: 2 step(s).
[t=0.01s, 9 KB] Plan cost: 2
"""
MADAGASCAR = "PLAN FOUND: 2 steps\nSTEP 0: go(a,b)\nSTEP 1: go(b,c)\n2 actions in the plan.\n"
ENHSP = """Problem Solved

Found Plan:
0.0: (go a b)
0.0: -----waiting---- [1.0]
1.0: (go b c)

Plan-Length:2
"""
POPF = """Initial heuristic = 2.000
b (1.000 | 5.000);;;; Solution Found
; States evaluated: 3
; Cost: 10.001
0.000: (go a b)  [5.000]
5.001: (go b c)  [5.000]
"""
LPG = """   Time: (ACTION) [action Duration; action Cost]
 0.0003:   (GO A B) [D:5.0000; C:0.1000]
 5.0013:   (GO B C) [D:5.0000; C:0.1000]

Solution number: 1
"""


@pytest.fixture(scope="module")
def walk() -> Problem:
    return problem_from(WALK, PROBLEM)


@pytest.fixture(scope="module")
def timed() -> Problem:
    return problem_from(TIMED, PROBLEM)


@pytest.mark.parametrize("log", [FF, FAST_DOWNWARD, MADAGASCAR, ENHSP])
def test_logs_of_classical_planners(log: str, walk: Problem) -> None:
    assert [plan.actions for plan in find_plans(log, walk)] == [GO]
    assert read_plan(log, walk)[0].actions == GO


@pytest.mark.parametrize(("log", "start"), [(POPF, "5.001"), (LPG, "5.0013")])
def test_logs_of_temporal_planners(log: str, start: str, timed: Problem) -> None:
    (plan,) = find_plans(log, timed)
    assert plan.actions[1].start_s == Fraction(start)
    assert [action.duration_s for action in plan.actions] == [5, 5]
    assert read_plan(log, timed)[0] == plan


def test_of_several_plans_the_last_is_read(timed: Problem) -> None:
    better = POPF.replace("5.001", "5.002")
    plan, n_plans = read_plan(POPF + better, timed)
    assert n_plans == 2
    assert plan.actions[1].start_s == Fraction("5.002")


@pytest.mark.parametrize("fault", ["go b c", "(go b", "2: [go b c]"])
def test_a_plan_with_a_broken_line_is_no_log(fault: str, walk: Problem) -> None:
    with pytest.raises(PlanFormatError) as caught:
        read_plan(f"; comment\n(go a b)\n{fault}\n", walk)
    assert caught.value.line == 3


def test_a_log_without_a_plan_is_no_plan(walk: Problem) -> None:
    with pytest.raises(PlanFormatError):
        read_plan("best first search space empty! problem proven unsolvable.", walk)


@pytest.mark.parametrize("text", ["1. (go a b)\n2. (go b c)", "go(a, b)\ngo(b, c)", LPG])
def test_observed_actions_are_read_like_plans(text: str) -> None:
    lines = [line for line in text.splitlines() if "go" in line.lower()]
    assert observed_words("\n".join(lines)) == (("go", "a", "b"), ("go", "b", "c"))


@pytest.mark.parametrize(
    "text",
    [
        "1. go a b\n2. go b c\n",
        "- go a b\n- go b c\n",
        "STEP 1: go(a,b)\nSTEP 2: go(b,c)\n",
        "begin_plan\n(go a b)\n(go b c)\nend_plan\n",
        "```pddl\n(go a b)\n(go b c)\n```\n",
    ],
)
def test_lists_without_a_log_around_them(text: str) -> None:
    assert read_plan(text, problem_from(WALK, PROBLEM))[0].actions == GO


TWO_STEPS = """(define (domain d) (:requirements :typing) (:types o) (:constants a b - o)
  (:predicates (p ?x ?y - o))
  (:action go :parameters (?x ?y - o) :effect (p ?x ?y)))"""
TWO_TIMED_STEPS = """(define (domain d) (:requirements :typing :durative-actions) (:types o)
  (:constants a b - o) (:predicates (p ?x ?y - o))
  (:durative-action go :parameters (?x ?y - o) :duration (= ?duration 5) :condition (and)
    :effect (at end (p ?x ?y))))"""
NO_GOAL = "(define (problem x) (:domain d) (:init) (:goal (and)))"


@pytest.mark.parametrize(
    "text",
    [
        '["(go a b)", "(go b a)"]',
        '{"plan": [{"action": "go", "args": ["a", "b"]}, {"action": "go", "args": ["b", "a"]}]}',
        '{"result": {"plan": [{"name": "(go a b)", "action": "(:action go …)"}, "go b a"]}}',
        '[["go", "a", "b"], ["GO", "b", "A"]]',
        '{"plan": "(go a b)\\n(go b a)\\n"}',
        '[{"name": "go", "parameters": {"?x": "a", "?y": "b"}},'
        ' {"name": "go", "parameters": [{"name": "b"}, {"name": "a"}]}]',
        "['(go a b)', '(go b a)']",
        "[('go', 'a', 'b'), ('go', 'b', 'a')]",
        "[go(a, b), go(b, a)]",
        "SequentialPlan:\n    go(a, b)\n    go(b, a)",
        "((go a b) (go b a))",
        "(\n (go a b)\n (go b a)\n)\n",
        "go a b\ngo b a\n",
        "0: go a b\n1: go b a",
        '"go a b"\n"go b a"',
        "go,a,b\ngo,b,a",
        "\ufeff(go a b)\n(go b a)",
    ],
)
def test_plans_as_programs_print_them(text: str) -> None:
    plan, _ = read_plan(text, problem_of(TWO_STEPS, NO_GOAL))
    assert str(plan) == "(go a b)\n(go b a)\n"


@pytest.mark.parametrize(
    "text",
    [
        "0.000: go a b [5]\n5.001: go b a [5.000]",
        "0,000: (go a b) [5,000]\n5,001: (go b a) [5,0]",
        "0.000s: (go a b) [5.000s]\n5.001s: (go b a) [5s]",
        "TimeTriggeredPlan:\n    0.0: go(a, b) [5.0]\n    5.001: go(b, a) [5.0]",
        '[{"time": 0, "action": "go", "args": ["a", "b"], "duration": 5},'
        ' {"start": 5.001, "action": "go", "parameters": ["b", "a"], "duration": 5.0}]',
        '{"items": [{"time": 0.0, "action": "(go a b)", "duration": 5.0},'
        ' {"time": 5.001, "action": "(go b a)", "duration": 5.0}]}',
    ],
)
def test_plans_with_times_as_programs_print_them(text: str) -> None:
    plan, _ = read_plan(text, problem_of(TWO_TIMED_STEPS, NO_GOAL))
    assert str(plan) == "0.000: (go a b) [5.000]\n5.001: (go b a) [5.000]\n"


@pytest.mark.parametrize(
    "text",
    ["go a c", "go a", "{}", '{"plan": 5}', "[1, 2]", "[" * 5000, "go a b c d"],
)
def test_what_is_no_plan_in_any_form(text: str) -> None:
    with pytest.raises(PlanFormatError):
        read_plan(text, problem_of(TWO_STEPS, NO_GOAL))
