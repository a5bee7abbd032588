"""A task again: with the structure it has, and yet as if grounded anew."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.core.numbers import Number
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.task import Task
from hrcplan.task.regrounding import Groundings, Structure

MOTIVATION = ("motivation", "human")
RAISED = {MOTIVATION: 8, ("capacity", "human", "wp4"): 5}


@pytest.fixture(scope="module")
def coached() -> Problem:
    return read("transport-coached", "two-boxes")


def same(one: Task, other: Task) -> None:
    """Hold everything against each other that planners look at."""
    assert one.facts == other.facts
    assert one.costs == other.costs
    assert one.initial == other.initial
    assert [(str(a), a.values, a.tests, a.adds, a.deletes) for a in one.actions] == [
        (str(a), a.values, a.tests, a.adds, a.deletes) for a in other.actions
    ]
    assert one.applicable(one.initial) == other.applicable(other.initial)


@pytest.mark.parametrize("values", [
    {MOTIVATION: 3},
    {MOTIVATION: Fraction(19, 2), ("capacity", "human", "wp4"): 60},
    {("knowledge", "robot"): 7, ("capacity", "human", "wp4"): 2},
    {("help-price",): 11},
])  # fmt: skip
def test_other_numbers_keep_the_structure(
    coached: Problem, values: dict[FluentKey, Number]
) -> None:
    first = Task(coached.with_values(RAISED))
    problem = coached.with_values({**RAISED, **values})
    again = Structure(first).again(problem)
    assert again is not None
    assert again.structure is first.structure
    same(again, Task(problem))


def test_what_interactions_leave_is_a_role_as_well(coached: Problem) -> None:
    low = {key: 2 for key in coached.values if key[0] in ("motivation", "knowledge", "capacity")}
    first = Task(coached.with_values({("residual",): 2, **low, **RAISED}))
    problem = coached.with_values({("residual",): 3, **dict.fromkeys(low, 3), **RAISED})
    again = Structure(first).again(problem)
    assert again is not None
    same(again, Task(problem))


def test_a_value_that_is_left_already_is_a_state_of_the_same_structure(coached: Problem) -> None:
    first = Task(coached.with_values({MOTIVATION: 8}))
    again = Structure(first).again(coached)
    assert again is not None
    assert again.facts_of(again.initial) >= {("=", "motivation", "human", "1")}
    assert len(again.actions) > len(Task(coached).actions)  # it may hold more than is needed


def test_other_facts_keep_the_structure(coached: Problem) -> None:
    first = Task(coached.with_values(RAISED))
    facts = coached.facts - {("at", "human", "wp1")} | {("at", "human", "wp5")}
    problem = replace(coached.with_values({**RAISED, MOTIVATION: 6}), facts=facts)
    again = Structure(first).again(problem)
    assert again is not None
    assert ("at", "human", "wp5") in again.facts_of(again.initial)
    plain = replace(coached, facts=facts)
    assert Structure(Task(coached)).again(plain) is not None


@pytest.mark.parametrize("change", [
    lambda p: p.with_values({MOTIVATION: 8}),  # from one value to two
    lambda p: replace(p, facts=p.facts - {("path", "wp0", "wp1")}),
    lambda p: replace(p, facts=p.facts | {("reach", "robot", "nowhere")}),
    lambda p: replace(p, goal=read("transport", "handover").goal),
    lambda p: read("transport", "two-boxes"),
    lambda p: replace(p, values={k: v for k, v in p.values.items() if k != MOTIVATION}),
])  # fmt: skip
def test_another_structure_is_not_claimed(coached: Problem, change) -> None:  # type: ignore[no-untyped-def]
    assert Structure(Task(coached)).again(change(coached)) is None


DECREASE = """(define (domain calm) (:requirements :typing :numeric-fluents :durative-actions)
  (:types agent) (:predicates (idle ?a - agent) (done)) (:functions (anger ?a - agent) (total-cost))
  (:durative-action calm :parameters (?a - agent) :duration (= ?duration 1)
    :condition (and (at start (idle ?a)) (at start (>= (anger ?a) 2)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (decrease (anger ?a) 2))))
  (:durative-action act :parameters (?a - agent) :duration (= ?duration 1)
    :condition (and (at start (idle ?a)))
    :effect (and (at start (not (idle ?a))) (at end (idle ?a)) (at end (done))
      (at start (increase (total-cost) (anger ?a))))))"""
CALM = """(define (problem p) (:domain calm) (:objects a - agent)
  (:init (idle a) (= (anger a) 5) (= (total-cost) 0)) (:goal (done))
  (:metric minimize (total-cost)))"""


def test_interactions_that_are_no_assignments_are_grounded_anew(tmp_path: Path) -> None:
    (tmp_path / "calm.pddl").write_text(DECREASE)
    (tmp_path / "p.pddl").write_text(CALM)
    problem = read(tmp_path / "p.pddl")
    groundings = Groundings()
    first = groundings.task(problem)
    second = groundings.task(problem.with_values({("anger", "a"): 7}))
    assert first.structure is not second.structure
    same(second, Task(problem.with_values({("anger", "a"): 7})))


def test_groundings_are_found_again(coached: Problem) -> None:
    groundings = Groundings()
    plain = groundings.task(coached).structure
    raised = groundings.task(coached.with_values({MOTIVATION: 8})).structure
    assert groundings.task(coached.with_values({MOTIVATION: 5})).structure is raised
    assert groundings.task(coached).structure is plain
