"""Schemas of literals: look-ups give the same ground actions as the general reading of formulas."""

from __future__ import annotations

import pytest

import hrcplan.task.actions
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.task import Task
from hrcplan.task.literal_schemas import changed_names, is_literal
from tests.worlds import problem_from

DOMAIN = """(define (domain shed) (:requirements :adl :durative-actions :action-costs)
  (:types thing place) (:constants home - place)
  (:predicates (at ?t - thing ?p - place) (near ?p ?q - place) (free) (used ?t - thing))
  (:functions (total-cost) (weight ?t - thing) (length ?p ?q - place))
  (:durative-action move :parameters (?t - thing ?p ?q - place)
    :duration (= ?duration (* 2 (length ?p ?q)))
    :condition (and (at start (at ?t ?p)) (at start (near ?p ?q)) (at start (not (= ?p ?q)))
      (over all (not (used ?t))) (at end (free)))
    :effect (and (at start (not (at ?t ?p))) (at end (at ?t ?q)) (at end (free))
      (at end (not (free))) (at end (increase (total-cost) (+ 1 (weight ?t))))))
  (:durative-action use :parameters (?t - thing) :duration (>= ?duration 1)
    :condition (and (at start (at ?t home)) (at start (free)) (at start (not (free))))
    :effect (at end (used ?t)))
  (:durative-action reset :parameters () :duration (= ?duration 1)
    :condition (at start (exists (?t - thing) (used ?t)))
    :effect (forall (?t - thing) (at end (not (used ?t))))))"""
PROBLEM = """(define (problem p) (:domain shed) (:objects saw axe - thing yard - place)
  (:init (at saw yard) (at axe home) (near home yard) (near yard home) (free)
    (= (weight saw) 3) (= (length home yard) 2) (= (length yard home) 5/2))
  (:goal (at saw home)) (:metric minimize (total-cost)))"""
SHED = ("shed", DOMAIN, PROBLEM.replace("5/2", "2.5"))
NAMES = [("transport", "two-boxes"), ("kitchen", "pasta-bean"), ("transport-coached", "two-boxes")]


@pytest.fixture(params=[SHED, *NAMES], ids=lambda names: names[0])
def problem(request: pytest.FixtureRequest) -> Problem:
    name, *texts = request.param
    return problem_from(*texts) if len(texts) == 2 else read(name, *texts)


def test_both_ways_give_the_same_actions(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    actions = Task(problem).actions
    monkeypatch.setattr(hrcplan.task.actions, "is_literal", lambda *_: False)
    assert Task(problem).actions == actions


def test_which_schemas_are_of_literals() -> None:
    problem = problem_from(*SHED[1:])
    kinds = {a.name: is_literal(a, changed_names(problem), set()) for a in problem.domain.actions}
    assert kinds == {"move": True, "use": True, "reset": False}
    assert not is_literal(problem.domain.action("move"), changed_names(problem), {"length"})


def test_what_contradicts_itself_or_has_no_value_is_no_action() -> None:
    texts = [str(action) for action in Task(problem_from(*SHED[1:])).actions]
    assert texts == ["(move saw home yard)", "(move saw yard home)", "(reset)"]
