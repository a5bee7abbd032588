"""What old and careless files have: read where other readers do, with a warning; else a cure."""

import itertools
from pathlib import Path

import pytest

from hrcplan.pddl import typed_lists
from hrcplan.pddl.check import check, domain_in, load_domain, load_problem
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.plans import parse_plan
from hrcplan.task import Task
from hrcplan.validation import validate
from tests.texts import problem_of

DOMAIN = """(define (domain yard)
  (:requirements :typing :negative-preconditions)
  (:types crane spot - object)
  (:predicates (free ?c - crane) (over ?c - crane ?s - spot))
  (:action swing :parameters (?c - crane ?s - spot)
    :precondition (free ?c)
    :effect (and (over ?c ?s) (not (free ?c)))))
"""
PROBLEM = """(define (problem one) (:domain yard)
  (:objects c1 - crane s1 - spot)
  (:init (free c1))
  (:goal (over c1 s1)))
"""


def codes(tmp_path: Path, domain: str, problem: str) -> list[tuple[str, str]]:
    """Severity and code of every fault of a pair of texts."""
    (tmp_path / "d.pddl").write_text(domain)
    (tmp_path / "p.pddl").write_text(problem)
    report = check([tmp_path / "d.pddl", tmp_path / "p.pddl"])
    return [(d.severity, d.code) for d in report.diagnostics]


SLOPPY = {
    "missing-space": [
        ("(free ?c)\n", "(free?c)\n"),
        ("swing :parameters", "swing:parameters"),
        ("(:requirements :typing :neg", "(:requirements:typing:neg"),
        ("(:predicates (free", "(:predicates (near ?a-crane) (free"),
        ("?c - crane ?s - spot)\n", "?c -crane ?s - spot)\n"),
        ("  (:action", "  (:functions (weight ?c - crane) -number (reach))\n  (:action"),
    ],
    "not-printable": [("(free ?c)\n", "(free\u00a0?c)\n")],
    "keyword-name": [("(free ?c - crane)", "(free ?c - crane) (= ?a ?b)"),
                     ("crane spot - object", "crane spot number")],
    "undeclared-supertype": [("crane spot - object", "crane spot - thing")],
    "duplicate-type": [("crane spot - object", "crane spot - object thing - object spot - thing")],
    "empty-typed-list": [("c1 - crane s1", "c1 - crane - spot s1")],
    "repeated-parameter": [("(over ?c - crane ?s - spot))\n", "(over ?c - crane ?c - spot))\n")],
    "duplicate-predicate": [("(free ?c - crane)", "(free ?c - crane) (free ?x - crane)")],
    "duplicate-object": [("c1 - crane s1", "c1 c1 - crane s1")],
    "duplicate-fact": [("(:init", "(:init (free c1)")],
    "domain-mismatch": [("(:domain yard)", "(:domain garden)")],
    "outside-define": [("(define (domain", '(in-package "PDDL")\n(define (domain')],
    "duplicate-action": [
        ("(not (free ?c)))))", "(not (free ?c))))\n(:action swing"
         " :parameters (?c - crane ?s - spot) :precondition (free ?c)"
         " :effect (and (over ?c ?s) (not (free ?c)))))")
    ],
    "shadowed-variable": [(":precondition (free ?c)", ":precondition (and (free ?c)"
                           " (exists (?s - spot) (not (over ?c ?s))))")],
}  # fmt: skip


@pytest.mark.parametrize(
    ("code", "change"), [(code, change) for code, changes in SLOPPY.items() for change in changes]
)
def test_what_is_sloppy_is_read_with_a_warning(
    code: str, change: tuple[str, str], tmp_path: Path
) -> None:
    domain, problem = DOMAIN.replace(*change), PROBLEM.replace(*change)
    assert (domain, problem) != (DOMAIN, PROBLEM)
    found = codes(tmp_path, domain, problem)
    assert ("warning", code) in found
    assert all(severity == "warning" for severity, _ in found)
    plan = parse_plan("(swing c1 s1)")
    loaded = load_problem(load_domain(tmp_path / "d.pddl"), tmp_path / "p.pddl")
    assert validate(loaded, plan).valid


def test_names_that_are_words_of_pddl_elsewhere_are_names(tmp_path: Path) -> None:
    swaps = {"over": "at", "free": "define", "c1": "start", "s1": "end"}
    domain, problem = DOMAIN, PROBLEM
    for old, new in swaps.items():
        domain, problem = domain.replace(f"({old} ", f"({new} "), problem.replace(old, new)
    assert codes(tmp_path, domain, problem) == []
    loaded = load_problem(load_domain(tmp_path / "d.pddl"), tmp_path / "p.pddl")
    assert validate(loaded, parse_plan("(swing start end)")).valid


def test_a_type_that_is_listed_twice_is_below_both(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(
        "(define (domain d) (:types crane floor spot zone - object box - object zone - floor)"
        " (:predicates (p ?z - zone)))"
    )
    domain = load_domain(tmp_path / "d.pddl")
    assert domain.is_a("zone", ("floor",))
    assert domain.is_a("zone", ("object",))


REFUSALS = [
    ("(over ?c ?s) (not (free ?c))", "(over ?c, ?s) (not (free ?c))", "comma", "spaces"),
    (":precondition (free ?c)", ":precondition (!= ?c ?s)", "foreign-operator", "(not (= …))"),
    (":precondition (free ?c)", ":precondition (== ?c ?s)", "foreign-operator", "write ="),
    (":precondition (free ?c)", ":precondition (implies (free ?c) (free ?c))", "foreign-operator",
     "imply"),
    ("(not (free ?c))", "(if (free ?c) (not (free ?c)))", "foreign-operator", "when"),
    ("(not (free ?c))", "(not (and (free ?c)))", "not-an-effect", "(and (not (p)) (not (q)))"),
    ("(and (over ?c ?s) (not (free ?c)))", "(over ?c ?s) (not (free ?c))", "stray-word", "(and …)"),
    ("(:types crane spot - object)", "(:types)", "unknown-type", "add (:types crane spot)"),
    ("(:types crane spot - object)", "(:types crane) (:types spot)", "repeated-section",
     "into one"),
    ("(free ?c - crane)", "(free ?c - crane) (<= ?a ?b)", "not-a-name", "begins with a letter"),
    ("(:types crane spot - object)\n", "", "unknown-type", "add (:types crane spot)"),
    ("?c - crane ?s - spot)\n", "?c- crane ?s - spot)\n", "missing-space", "write '?c - crane'"),
    ("?c - crane ?s - spot)\n", "?c-crane ?s - spot)\n", "unbound", "'?c-crane'"),
    ("crane spot - object", "crane spot-object", "unknown-type", "no spaces around"),
    (":precondition (free ?c)", ":condition (free ?c)", "unknown-section", "write :precondition"),
    (DOMAIN, f"Here is the domain:\n{DOMAIN}", "outside-define", "remove the rest"),
    ("(free ?c - crane)", "(free ?c - crane) (:private (mine ?c - crane))", "unsupported",
     "private"),
    (":parameters (?c - crane ?s - spot)", ":parameters (?c - crane) :vars (?s - spot)",
     "unsupported", ":parameters"),
    ("(not (free ?c)))))", "(not (free ?c))))\n(:action swing :parameters () :effect ()))",
     "duplicate-action", "another name"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "code", "cure"), REFUSALS)
def test_a_refusal_names_the_cure(old: str, new: str, code: str, cure: str, tmp_path: Path) -> None:
    assert old in DOMAIN
    (tmp_path / "d.pddl").write_text(DOMAIN.replace(old, new))
    errors = [d for d in check([tmp_path / "d.pddl"]).diagnostics if d.severity == "error"]
    assert code == errors[0].code
    assert cure in (errors[0].hint or "")
    if code != "unsupported" and code != "unbound":
        assert len(errors) == 1


@pytest.mark.parametrize(
    ("duration", "cure"),
    [
        ("()", "(>= ?duration 0)"),
        ("(> ?duration 0)", "(>= ?duration 0)"),
        ("(= 3 ?duration)", "?duration stands first"),
        ("3", "(= ?duration 3)"),
    ],
)
def test_other_forms_of_durations_are_refused_with_the_right_one(
    duration: str, cure: str, tmp_path: Path
) -> None:
    (tmp_path / "d.pddl").write_text(
        f"(define (domain d) (:predicates (p)) (:durative-action a :parameters ()"
        f" :duration {duration} :effect (at end (p))))"
    )
    (fault,) = check([tmp_path / "d.pddl"]).diagnostics
    assert fault.code == "bad-duration"
    assert cure in (fault.hint or "")


@pytest.mark.parametrize(
    ("before", "after", "word"),
    [("```pddl\n", "\n```\n", "Markdown"), ("<!DOCTYPE html><pre>", "</pre>", "web page")],
)
def test_what_stands_around_a_file_is_named(
    before: str, after: str, word: str, tmp_path: Path
) -> None:
    (tmp_path / "d.pddl").write_text(before + DOMAIN + after)
    (fault,) = check([tmp_path / "d.pddl"]).diagnostics
    assert fault.code == "outside-define"
    assert word in fault.message
    assert fault.hint


def test_a_function_with_an_object_as_value_is_refused_with_a_cure(tmp_path: Path) -> None:
    domain = DOMAIN.replace("(:action", "(:functions (place ?c - crane) - number)\n(:action")
    problem = PROBLEM.replace("(free c1))", "(free c1) (= (place c1) s1))")
    (tmp_path / "d.pddl").write_text(domain)
    (tmp_path / "p.pddl").write_text(problem)
    (fault,) = check([tmp_path / "d.pddl", tmp_path / "p.pddl"]).diagnostics
    assert fault.code == "not-a-number"
    assert "predicate" in (fault.hint or "")


CAPTURE = """(define (domain capture)
  (:predicates (p ?x) (q ?x))
  (:action mark :parameters (?x)
    :effect (when (p ?x) (forall (?x) (q ?x)))))
"""


def test_a_condition_outside_of_a_quantifier_means_the_outer_variable() -> None:
    problem = problem_of(
        CAPTURE,
        "(define (problem c) (:domain capture) (:objects a b) (:init (p a))"
        " (:goal (forall (?x) (q ?x))))",
    )
    assert validate(problem, parse_plan("(mark a)")).valid
    assert not validate(problem, parse_plan("(mark b)")).valid
    again = problem_of(domain_text(problem.domain), problem_text(problem))
    assert validate(again, parse_plan("(mark a)")).valid


SPARSE = """(define (domain sparse)
  (:predicates (at ?x) (done))
  (:functions (distance ?x ?y) (total-cost))
  (:action drive :parameters (?x ?y)
    :precondition (at ?x)
    :effect (and (at ?y) (not (at ?x)) (increase (total-cost) (distance ?x ?y))))
  (:action finish :parameters (?x ?y)
    :precondition {condition}
    :effect (done)))
"""
SPARSE_PROBLEM = """(define (problem p) (:domain sparse) (:objects a b)
  (:init (at a) (= (distance a b) 2)) (:goal {goal}) (:metric minimize (total-cost)))"""


@pytest.mark.parametrize(
    ("condition", "n_ways"),
    [
        ("(< (distance ?x ?y) 5)", 1),
        ("(not (> (distance ?x ?y) 5))", 1),
        ("(or (< (distance ?x ?y) 5) (at ?x))", 2),  # in whichever order
        ("(or (at ?x) (< (distance ?x ?y) 5))", 2),
        ("(not (and (> (distance ?x ?y) 5) (at ?x)))", 3),
        ("(imply (< (distance ?x ?y) 5) (at ?x))", 2),
        ("(exists (?z) (= (distance ?x ?z) 2))", 2),
        ("(forall (?z) (< (distance ?x ?z) 5))", 0),
        ("(not (exists (?z) (> (distance ?x ?z) 5)))", 0),
    ],
)
def test_a_comparison_of_what_has_no_value_is_false_and_so_is_its_negation(
    condition: str, n_ways: int
) -> None:
    problem = problem_of(SPARSE.format(condition=condition), SPARSE_PROBLEM.format(goal="(done)"))
    pairs = [f"(finish {x} {y})" for x in "ab" for y in "ab"]
    valid = [pair for pair in pairs if validate(problem, parse_plan(pair)).valid]
    assert len(valid) == n_ways
    ground = {str(action) for action in Task(problem).actions if action.name == "finish"}
    assert set(valid) <= ground


def test_an_action_that_reads_an_undefined_value_cannot_run() -> None:
    problem = problem_of(SPARSE.format(condition="(at ?x)"), SPARSE_PROBLEM.format(goal="(done)"))
    assert validate(problem, parse_plan("(drive a b)\n(finish b b)")).cost == 2
    report = validate(problem, parse_plan("(drive a a)\n(finish a a)"))
    assert (report.failed_step, report.reason) == (0, "(distance a a) has no value")
    assert [str(a) for a in Task(problem).actions if a.name == "drive"] == ["(drive a b)"]


def test_a_goal_that_compares_an_undefined_value_does_not_hold() -> None:
    for goal in ("(< (distance b b) 5)", "(not (< (distance b b) 5))"):
        problem = problem_of(SPARSE.format(condition="(at ?x)"), SPARSE_PROBLEM.format(goal=goal))
        report = validate(problem, parse_plan(""))
        assert not report.valid
        assert "(distance b b) has no value" in str(report.reason)


def test_numbers_of_repeated_parameters_grow_with_their_count_alone(monkeypatch):
    numbers = []

    def count(start):
        for number in itertools.count(start):
            numbers.append(number)
            yield number

    monkeypatch.setattr(typed_lists, "count", count)
    text = f"(define (domain d) (:predicates (p {'?c ?d ' * 500}- object)))"
    domain = domain_in(SourceText("d.pddl", text))
    names = [param.name for param in domain.predicates["p"].params]
    assert len(set(names)) == 1000
    assert len(numbers) == 998, "one number for each repetition"
