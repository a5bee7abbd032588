"""Mistakes of newcomers: one fault is one message, at its place, with its cure in the hint."""

from pathlib import Path

import pytest

from hrcplan.pddl.check import check_files

DOMAIN = """(define (domain d)
  (:requirements :typing :fluents :adl)
  (:types place robot - object)
  (:predicates (at ?r - robot ?p - place) (free ?r - robot))
  (:functions (n) (total-cost))
  (:action move
    :parameters (?r - robot ?a ?b - place)
    :precondition (and (at ?r ?a) (free ?r))
    :effect (and (not (at ?r ?a)) (at ?r ?b) (increase (total-cost) 1))))
"""
PROBLEM = """(define (problem p) (:domain d)
  (:objects bob - robot x y - place)
  (:init (at bob x) (free bob) (= (n) 1) (= (total-cost) 0))
  (:goal (at bob y))
  (:metric minimize (total-cost)))
"""


@pytest.mark.parametrize(
    ("right", "wrong", "place", "cure"),
    [
        ("(= (n) 1)", "(= 1 (n))", (3, 35), "write (= (f a) NUMBER)"),
        ("(= (n) 1)", "(n 1)", (3, 32), "(= (f a) NUMBER)"),
        ("(= (n) 1)", "(n=1)", (3, 32), "(= (f a) NUMBER)"),
        ("(= (n) 1)", "(increase (n) 1)", (3, 32), "(= (f a) NUMBER)"),
        ("(= (n) 1)", "(= (n) 1/2)", (3, 39), "write 0.5"),
        ("(= (n) 1)", "(= (n) 5s)", (3, 39), "write 5"),
        ("(= (n) 1)", "(= (free bob) true)", (3, 36), "write (free bob) or"),
        ("(at bob x)", "at bob x", (3, 10), "write (at bob x)"),
        ("(at bob x) (free bob)", "(and (at bob x) (free bob))", (3, 10), "leave the (and …) out"),
        ("(at bob y)", "at bob y", (4, 10), "write (:goal (at …))"),
        ("(at bob y))", "(at bob y)) // the goal", (4, 22), "write ; here"),
        ("(at bob y))", "(at bob y)) # the goal", (4, 22), "write ; here"),
        ("(at bob y)", "(= (free bob) true)", (4, 14), "(not (free bob))"),
        ("minimize", "min", (5, 3), "write minimize"),
        ("bob - robot", "bob : robot", (2, 17), "a '-' stands before a type"),
        ("bob - robot x y - place", "(bob - robot) (x y - place)", (2, 13), "leave its parenth"),
        ("bob - robot", '"bob" - robot', (2, 13), "remove them"),
        ("(:types place robot - object)", "(:types (place robot))", (3, 11), "leave its parenth"),
        ("(free ?r - robot)", "(free r - robot)", (4, 49), "write ?r"),
        ("(:predicates", "(:objects k - place) (:predicates", (4, 3), "(:constants …)"),
        ("(:predicates", "(:goal (free bob)) (:predicates", (4, 3), "belongs into a problem"),
        ("(?r - robot ?a ?b - place)", "(r - robot a b - place)", (7, 18), "write ?r"),
        ("(?r - robot ?a ?b - place)", "?r - robot ?a ?b - place", (7, 17), "(?x - type …)"),
        (
            "(?r - robot ?a ?b - place)",
            "(robot ?r place ?a ?b)",
            (7, 18),
            "the type stands behind: ?x - robot",
        ),
        (":precondition", ":pre", (8, 5), "did you mean ':precondition'?"),
        ("(free ?r))\n", "(free ?r) (> (% 5 2) 1))\n", (8, 49), "+ - * / only"),
        ("(free ?r))\n", "(free ?r) (> (max (n) 2) 1))\n", (8, 49), "+ - * / only"),
        ("(free ?r))\n", "(free ?r) (= (free ?r) 1))\n", (8, 49), "write (free ?r) or"),
        ("(free ?r))\n", "(forall ?x - place (at ?r ?x)))\n", (8, 35), "(forall (?x - type) …)"),
        ("(not (at ?r ?a))", "-(at ?r ?a)", (9, 18), "write (not (p))"),
        ("(not (at ?r ?a))", "!(at ?r ?a)", (9, 18), "write (not (p))"),
        ("(:action move", "(:action", (6, 3), "write (:action NAME …)"),
        ("(= (n) 1)", "(= (n) - 1)", (3, 32), "the sign touches its number"),
        ("(= (n) 1)", "(= bob bob)", (3, 32), "an object equals itself only"),
        ("(= (n) 1)", "(at 5s (free bob))", (3, 36), "write 5"),
        ("(= (n) 1)", "(at 5 (and (free bob) (at bob y)))", (3, 32), "one for each fact"),
        ("(at bob x)", "at(bob x)", (3, 10), "(at bob x)"),
        ("(at bob y)", "(and at(bob y) (free bob))", (4, 15), "(at bob y)"),
        ("(at bob y)", "(sometime (at bob y))", (4, 11), "(:constraints (sometime …))"),
        ("(at bob y)", "(when (free bob) (at bob y))", (4, 11), "write (imply A B)"),
        ("(at bob y)", "[at bob y]", (4, 10), "write ( and )"),
        ("(at bob y)", "(at bob y) /* (free */", (4, 21), "write ; here"),
        ("bob - robot", "bob \u2013 robot", (2, 17), "write -"),
        ("bob - robot", "bob -- robot", (2, 18), "'NAME - type'"),
        ("minimize (total-cost)", "minimize (n) (total-cost)", (5, 3), "(+ A B)"),
        ("minimize (total-cost)", "minimize (makespan)", (5, 22), "write (total-time)"),
        ("(free ?r))\n", "(free r))\n", (8, 41), "did you mean '?r'?"),
        ("(free ?r))\n", "(free ? r))\n", (8, 35), "write ?r without a space"),
        ("(free ?r))\n", "(at ?r (free ?r)))\n", (8, 42), "one condition after the other"),
        ("(free ?r))\n", "(< 0 (n) 5))\n", (8, 35), "(and (< A B) (< B C))"),
        ("(free ?r))\n", "(increase (n) 1))\n", (8, 36), "move it into :effect"),
        ("(free ?r))\n", "(forall (?x in place) (at ?r ?x)))\n", (8, 47), "before a type"),
        ("(not (at ?r ?a))", "(!at ?r ?a)", (9, 19), "write (not (at …))"),
        ("(not (at ?r ?a))", "(assign (at ?r ?a) false)", (9, 27), "write (at ?r ?a) or"),
        ("(not (at ?r ?a))", "(or (at ?r ?a))", (9, 18), "one action for each"),
    ],
)
def test_one_message_with_place_and_cure(
    right: str, wrong: str, place: tuple[int, int], cure: str, tmp_path: Path
) -> None:
    assert (right in DOMAIN) != (right in PROBLEM)
    (tmp_path / "d.pddl").write_text(DOMAIN.replace(right, wrong, 1))
    (tmp_path / "p.pddl").write_text(PROBLEM.replace(right, wrong, 1))
    found = check_files([tmp_path / "d.pddl", tmp_path / "p.pddl"])
    errors = [fault for fault in found if fault.severity == "error"]
    assert [(fault.line, fault.column) for fault in errors] == [place], errors
    assert cure in (errors[0].hint or "")


def test_a_type_without_a_name_is_a_warning_with_its_cure(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(DOMAIN.replace("(:types", "(:types - thing"))
    (fault,) = (d for d in check_files([tmp_path / "d.pddl"]) if d.code == "empty-typed-list")
    assert "'NAME - type'" in (fault.hint or "")
