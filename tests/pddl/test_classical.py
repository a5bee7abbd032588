"""The plainest reading of a problem has the same actions and the same successors, or is refused."""

import random
from pathlib import Path

import pytest

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.classical import classical, classical_texts
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import SourceText
from hrcplan.task import Task


def one_action(action: str) -> Problem:
    domain = domain_in(SourceText("d", f"""
      (define (domain d) (:requirements :adl :durative-actions) (:types thing - object)
        (:predicates (a ?x - thing) (b ?x - thing)) {action})"""))  # fmt: skip
    text = "(define (problem p) (:domain d) (:objects t - thing) (:init (a t)) (:goal (b t)))"
    return problem_in(domain, SourceText("p", text))


def lasting(condition: str, effect: str) -> str:
    return f"""(:durative-action act :parameters (?x - thing) :duration (= ?duration 1)
      :condition (and {condition}) :effect (and {effect}))"""


def instant(condition: str, effect: str) -> str:
    return f"(:action act :parameters (?x - thing) :precondition {condition} :effect {effect})"


@pytest.mark.parametrize(
    ("domain", "name"),
    [("kitchen", "stew-lentil"), ("transport", "two-boxes"), ("transport", "handover")],
)
def test_walks_are_the_same(domain: str, name: str, tmp_path: Path) -> None:
    """Read back from its text, where every variable has a type of its own."""
    problem = read(domain, name)
    for file, text in zip(("d.pddl", "p.pddl"), classical_texts(problem), strict=True):
        (tmp_path / file).write_text(text)
    plain = read(tmp_path / "d.pddl", tmp_path / "p.pddl")
    assert not plain.domain.is_temporal
    assert not plain.values
    ours, theirs = Task(problem), Task(plain)
    chance, here, there = random.Random(name), ours.initial, theirs.initial
    for _ in range(60):
        can = {(a.name, *a.args): i for i in ours.applicable(here) for a in [ours.actions[i]]}
        also = {(a.name, *a.args): i for i in theirs.applicable(there) for a in [theirs.actions[i]]}
        assert can.keys() == also.keys()
        chosen = chance.choice(sorted(can))
        here, there = ours.successor(here, can[chosen]), theirs.successor(there, also[chosen])
        idle = {fact for fact in ours.facts_of(here) if fact not in theirs.bits}
        assert ours.facts_of(here) - idle == theirs.facts_of(there)
        assert all(fact in plain.facts for fact in idle)  # tokens, which never change any more


def test_what_is_taken_away_and_given_back_at_once_is_there() -> None:
    plain = classical(one_action(instant("(a ?x)", "(and (not (a ?x)) (a ?x) (b ?x))")))
    assert [str(effect) for effect in plain.domain.actions[0].effects] == ["(a ?x)", "(b ?x)"]


def test_an_untyped_text_names_no_type() -> None:
    domain = domain_in(SourceText("d", """(define (domain d) (:predicates (a ?x) (b ?x))
      (:action act :parameters (?x ?y) :precondition (a ?x) :effect (b ?y)))"""))  # fmt: skip
    text = "(define (problem p) (:domain d) (:objects s t) (:init (a s)) (:goal (b t)))"
    texts = classical_texts(problem_in(domain, SourceText("p", text)))
    assert all("object " not in written and " - " not in written for written in texts)


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (instant("(or (a ?x) (b ?x))", "(b ?x)"), "more than a conjunction of literals"),
        (instant("(not (not (a ?x)))", "(b ?x)"), "more than a conjunction of literals"),
        (instant("(a ?x)", "(when (a ?x) (b ?x))"), "an effect of 'act' is conditional"),
        (instant("(a ?x)", "(forall (?y - thing) (b ?y))"), "an effect of 'act' is conditional"),
        (lasting("(over all (a ?x))", "(at start (not (a ?x))) (at end (b ?x))"), "depends on 'a'"),
        (lasting("(at end (not (b ?x)))", "(at start (b ?x))"), "depends on 'b'"),
        (lasting("(at start (a ?x))", "(at start (b ?x)) (at end (not (b ?x)))"), "depends on 'b'"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused(action: str, reason: str) -> None:
    with pytest.raises(UnsupportedError, match=reason):
        classical(one_action(action))
