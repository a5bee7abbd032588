"""Functions without a value and negative durations, reported where an action can need them."""

import time
from pathlib import Path

import pytest

from hrcplan.pddl.check import check_files
from hrcplan.planners.solve import solve
from tests.texts import problem_of

DOMAIN = """
(define (domain d)
  (:types place agent)
  (:constants x y z - place)
  (:predicates (road ?a ?b - place) (closed ?p - place) (at ?r - agent ?p - place) (open))
  (:functions (length ?a ?b - place) (fee ?p - place) (total-cost) (limit))
  (:{kind}action go
    :parameters (?r - agent ?a ?b - place)
    {body}))
"""
PROBLEM = """
(define (problem p)
  (:domain d)
  (:objects robot - agent)
  (:init (road x y) (road y z) (closed z) (at robot x) {init})
  (:goal {goal}) {metric})
"""
COST = ":effect (and (at ?r ?b) (increase (total-cost) {}))"


def faults(
    tmp_path: Path,
    body: str,
    init: str,
    *,
    kind: str = "",
    goal: str = "(at robot z)",
    metric: str = "",
) -> list[str]:
    """Return the messages about one action and one initial state."""
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(DOMAIN.format(body=body, kind=kind))
    problem.write_text(PROBLEM.format(init=init, goal=goal, metric=metric))
    found = check_files([domain, problem])
    assert all(d.code in ("unset-function", "negative-duration") for d in found), found
    return [d.message for d in found]


def unset(key: str) -> list[str]:
    return [f"'({key})' is not set: action 'go' cannot run where it needs one"]


LENGTH = COST.format("(length ?a ?b)")
FEE = COST.format("(fee ?b)")


@pytest.mark.parametrize(
    ("body", "init", "expected"),
    [
        # facts that no action changes
        (f":precondition (road ?a ?b) {LENGTH}", "(= (length x y) 1) (= (length y z) 1)", []),
        (f":precondition (road ?a ?b) {LENGTH}", "(= (length x y) 1)", unset("length y z")),
        (f":precondition (and (and (road ?b y))) {FEE}", "(= (fee x) 1)", []),
        # facts that are never true, and objects that are not there
        (f":precondition (and (open) (road ?a ?b)) {LENGTH}", "", []),
        # negated facts and (in)equality
        (f":precondition (not (closed ?b)) {FEE}", "(= (fee x) 1) (= (fee y) 1)", []),
        (f":precondition (closed ?b) {FEE}", "(= (fee x) 1) (= (fee y) 1)", unset("fee z")),
        (f":precondition (and (= ?a z) (= ?a ?b)) {FEE}", "(= (fee z) 1)", []),
        (f":precondition (and (closed ?a) (not (= ?a ?b))) {FEE}",
         "(= (fee x) 1) (= (fee y) 1)", []),
        (f":precondition (or (road ?b y) (= ?b z)) {FEE}", "(= (fee x) 1)", unset("fee z")),
        (f":precondition (forall (?p - place) (= ?p ?b)) {FEE}", "", []),
        # what an action changes may come true
        (f":precondition (and (closed ?b) (at ?r ?b)) {FEE}", "", unset("fee z")),
        # numeric conditions
        (f":precondition (> (fee ?b) 3) {COST.format(1)}", "(= (fee x) 1) (= (fee y) 1)",
         unset("fee z")),
        (f":precondition (> (limit) 3) {FEE}", "(= (limit) 1)", []),
        # total-cost is 0 unless set; what is assigned need not be set, what is decreased must
        (COST.format(1), "", []),
        (":effect (and (at ?r ?a) (assign (limit) 5))", "", []),
        (":effect (and (at ?r ?a) (decrease (limit) 5))", "", unset("limit")),
        # conditional effects
        (":effect (and (at ?r ?b) (forall (?p - place) (when (closed ?p) (increase (total-cost)"
         " (fee ?p)))))", "(= (fee z) 1)", []),
        (":effect (and (at ?r ?b) (forall (?p - place) (when (road ?p z) (increase (total-cost)"
         " (fee ?p)))))", "(= (fee z) 1)", unset("fee y")),
    ],
)  # fmt: skip
def test_a_function_must_be_set_where_an_action_can_need_it(
    body: str, init: str, expected: list[str], tmp_path: Path
) -> None:
    assert faults(tmp_path, body, init) == expected


def test_goal_and_metric_need_their_functions_too(tmp_path: Path) -> None:
    goal, metric = "(> (limit) 2)", "(:metric minimize (+ (total-cost) (fee x)))"
    assert faults(tmp_path, COST.format(1), "", goal=goal, metric=metric) == [
        "'(fee x)' is not set, but the metric needs it",
        "'(limit)' is not set, so the goal cannot hold",
    ]


def test_many_gaps_are_told_in_a_few_lines(tmp_path: Path) -> None:
    objects = " ".join(f"place-{i}" for i in range(300))
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(DOMAIN.format(body=LENGTH, kind=""))
    text = PROBLEM.format(init="", goal="(open)", metric="").replace(
        "robot - agent", f"robot - agent {objects} - place"
    )
    problem.write_text(text)
    started = time.process_time()
    found = check_files([domain, problem])
    assert time.process_time() - started < 20
    (diagnostic,) = found
    assert "more values of 'length' are not set" in diagnostic.message


@pytest.mark.parametrize(
    "body",
    [
        f":precondition (and (not (= ?r ?r)) (not (road ?a ?b))) {LENGTH}",
        ":effect (forall (?p ?q ?s - place) (when (and (road ?p ?q) (road ?p ?p))"
        " (increase (total-cost) (length ?q ?s))))",
    ],
)
def test_conditions_that_never_hold_are_given_up_in_time(body: str, tmp_path: Path) -> None:
    places = " ".join(f"place-{i}" for i in range(300))
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(DOMAIN.format(body=body, kind=""))
    text = PROBLEM.format(init="", goal="(open)", metric="")
    problem.write_text(text.replace("(:objects", f"(:objects {places} - place"))
    started = time.process_time()
    assert check_files([domain, problem]) == ()
    assert time.process_time() - started < 20


DURATION = (
    ":duration (= ?duration {}) :condition (over all (road ?a ?b)) :effect (at end (at ?r ?b))"
)


@pytest.mark.parametrize(
    ("duration", "init", "expected"),
    [
        ("(length ?a ?b)", "(= (length x y) 1) (= (length y z) 0) (= (length z z) -1)", []),
        ("(length ?a ?b)", "(= (length x y) 1) (= (length y z) -1)",
         ["'(go robot y z)' lasts less than nothing"]),
        ("(- (fee ?b) 2)", "(= (fee y) 2) (= (fee z) 2)", []),
        ("(- (fee ?b) 2)", "(= (fee y) 2) (= (fee z) 1)",
         ["'(go robot y z)' lasts less than nothing"]),
        ("(* -1 (fee ?b))", "(= (fee y) 0) (= (fee z) 0)", []),
        ("(length ?a ?b)", "(= (length x y) 1)", unset("length y z")),
    ],
)  # fmt: skip
def test_no_duration_that_can_occur_is_below_zero(
    duration: str, init: str, expected: list[str], tmp_path: Path
) -> None:
    body = DURATION.format(duration)
    assert faults(tmp_path, body, init, kind="durative-") == expected


def test_a_function_may_be_called_like_a_predicate() -> None:
    domain = """(define (domain mill) (:requirements :fluents) (:predicates (sugar ?m) (done))
      (:functions (sugar ?m))
      (:action press :parameters (?m) :precondition (and (sugar ?m) (> (sugar ?m) 0))
        :effect (and (decrease (sugar ?m) 1) (done))))"""
    problem = problem_of(domain, """(define (problem p) (:domain mill) (:objects a b)
      (:init (sugar a) (= (sugar a) 3)) (:goal (done)))""")  # fmt: skip
    assert (problem.facts, problem.values) == ({("sugar", "a")}, {("sugar", "a"): 3})
    plan = solve(problem, timeout_s=20, any_plan=True).plan
    assert plan is not None
    assert str(plan).strip() == "(press a)"
