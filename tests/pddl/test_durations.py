"""Durations and actions with times as people write them: each fault is one message."""

import pytest

from hrcplan.errors import Diagnostic
from hrcplan.pddl.check import check_files

DOMAIN = """(define (domain d) (:requirements :durative-actions :timed-initial-literals)
 (:predicates (on) (done)) (:functions (level))
 {})"""
WORK = """(:durative-action work :parameters () :duration {}
  :condition (at start (on)) :effect (at end (done)))"""


def faults(tmp_path, action: str, init: str = "") -> list[Diagnostic]:
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(DOMAIN.format(action))
    problem.write_text(f"(define (problem p) (:domain d) (:init (on) {init}) (:goal (done)))")
    return check_files([domain, problem])


@pytest.mark.parametrize(
    ("duration", "cure"),
    [
        ("(= ?dur 3)", "write (= ?duration 3)"),
        ("(>= duration 3)", "write (>= ?duration 3)"),
        ("(= (duration) 3)", "write (= ?duration 3)"),
        ("(:= ?duration 3)", "write (= ?duration 3)"),
        ("(< ?duration (level))", "write (<= ?duration …)"),
        ("(= ?duration [3])", "write ( and )"),
        ("(or (= ?duration 3) (= ?duration 4))", "one action for each"),
        ("(= ?duration (+ 1 ?duration))", "numbers and functions only"),
        ("(and)", "write :duration (= ?duration 1)"),
    ],
)
def test_a_faulty_duration_is_one_message_with_its_cure(tmp_path, duration, cure):
    (fault,) = faults(tmp_path, WORK.format(duration))
    assert fault.severity == "error"
    assert cure in (fault.hint or "")


@pytest.mark.parametrize(
    "action",
    [
        """(:action work :parameters () :duration (= ?duration 3)
         :condition (and (at start (on)) (over all (on)))
         :effect (and (at start (not (on))) (at end (done))))""",
        """(:action work :parameters () :precondition (and (at start (on)) (over all (on)))
         :effect (and (at start (not (on))) (at end (done))))""",
        "(:ACTION work :parameters ()\r\n\t:effect (AT END (done)))",
    ],
)
def test_a_durative_action_called_action_is_one_message(tmp_path, action):
    (fault,) = faults(tmp_path, action)
    assert fault.code == "unexpected-time"
    assert "(:durative-action work …)" in (fault.hint or "")


def test_a_fault_inside_a_durative_action_called_action_is_reported_too(tmp_path):
    codes = [f.code for f in faults(tmp_path, "(:action work :effect (at end (dnoe)))")]
    assert sorted(codes) == ["unexpected-time", "unknown-predicate"]


@pytest.mark.parametrize(
    "literals",
    ["(at 4 (not (on))) (at 4 (on))", "(at 4 (on)) (at 4.0 (not (on)))",
     "(at 4 (= (level) 1)) (at 4 (= (level) 2))"],
)  # fmt: skip
def test_literals_of_one_instant_must_not_contradict_each_other(tmp_path, literals):
    (fault,) = faults(tmp_path, WORK.format("(= ?duration 3)"), literals)
    assert (fault.severity, fault.code) == ("error", "duplicate-value")


def test_literals_of_one_instant_may_agree(tmp_path):
    literals = "(at 4 (not (on))) (at 4 (not (on))) (at 4.5 (on)) (at 4 (= (level) 2))"
    assert not faults(tmp_path, WORK.format("(= ?duration 3)"), literals)
