"""Notes about what people say: read, written, and checked for names and likeness."""

from pathlib import Path

import pytest

from hrcplan.pddl.check import check, domain_in, problem_in
from hrcplan.pddl.model import Note
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.write import domain_text, problem_text

DOMAIN = """{notes}
(define (domain shelf) (:requirements :strips :typing) (:types agent thing place - object)
  (:constants box - thing)
  (:predicates (controllable ?a - agent) (up ?x - thing) (free ?p - place))
  (:action lift :parameters (?a - agent ?x - thing) :effect (up ?x))
  (:action drop :parameters (?a - agent ?x - thing) :precondition (up ?x) :effect (not (up ?x)))
  (:action clear :parameters (?a - agent ?p - place) :effect (free ?p)))
"""
PROBLEM = """{notes}
(define (problem top) (:domain shelf)
  (:objects robo - agent cup mug - thing corner - place)
  (:init (controllable robo)) (:goal (up cup)))
"""


def codes(tmp_path: Path, domain: str = "", problem: str | None = "") -> list[tuple[str, str]]:
    files = [tmp_path / "shelf.pddl"]
    files[0].write_text(DOMAIN.format(notes=domain))
    if problem is not None:
        files.append(tmp_path / "top.pddl")
        files[1].write_text(PROBLEM.format(notes=problem))
    return [(Path(d.path).stem, d.code) for d in check(files).diagnostics]


def test_words_add_up_and_survive_writing() -> None:
    notes = ";; hrcplan: say lift pick  up, raise\n;; hrcplan: SAY Lift hoist ; gladly"
    domain = domain_in(SourceText("", DOMAIN.format(notes=notes)))
    said = (Note("say", "lift", (), ("pick up", "raise")), Note("say", "lift", (), ("hoist",)))
    assert domain.notes == said
    assert domain_in(SourceText("", domain_text(domain))).notes == said
    own = PROBLEM.format(notes=";; hrcplan: call cup beaker, goblet")
    problem = problem_in(domain, SourceText("", own))
    assert [str(note) for note in problem.notes] == ["call cup beaker, goblet"]
    assert problem_in(domain, SourceText("", problem_text(problem))).notes == problem.notes


def test_a_domain_calls_what_its_problems_declare(tmp_path: Path) -> None:
    notes = ";; hrcplan: call cup beaker\n;; hrcplan: call cpu chip\n;; hrcplan: call thing stuff"
    assert codes(tmp_path, notes, None) == []
    assert codes(tmp_path, notes) == [("shelf", "unknown-note")]


@pytest.mark.parametrize(
    ("note", "code"),
    [
        ("say lfit raise", "unknown-note"),
        ("call cpu chip", "unknown-note"),
        ("say lift", "bad-note"),
        ("say lift raise,, hoist", "bad-note"),
        ("call", "bad-note"),
        ("success lift 0.5", "bad-note"),
        ("range speed 0 1", "bad-note"),
        ("speak lift raise", "unknown-note"),
    ],
)
def test_a_note_of_a_problem_that_says_nothing_is_a_warning(
    tmp_path: Path, note: str, code: str
) -> None:
    assert codes(tmp_path, problem=f";; hrcplan: {note}") == [("top", code)]


@pytest.mark.parametrize(
    ("domain", "problem", "alike"),
    [
        (";; hrcplan: say lift drop", "", ["shelf"]),
        (";; hrcplan: say lift move\n;; hrcplan: say drop move", "", ["shelf"]),
        (";; hrcplan: say lift move", ";; hrcplan: say drop move", ["top"]),
        (";; hrcplan: say lift move\n;; hrcplan: say clear move", "", []),  # other objects
        ("", ";; hrcplan: call cup mug", ["top"]),
        (";; hrcplan: call cup pot\n;; hrcplan: call mug pot", "", ["shelf"]),
        (";; hrcplan: call cup pot\n;; hrcplan: call corner pot", "", []),  # other kinds
        (";; hrcplan: call box pot", ";; hrcplan: call cup pot", ["top"]),
    ],
)
def test_words_for_two_steps_are_a_warning(
    tmp_path: Path, domain: str, problem: str, alike: list[str]
) -> None:
    assert codes(tmp_path, domain, problem) == [(name, "reads-alike") for name in alike]
