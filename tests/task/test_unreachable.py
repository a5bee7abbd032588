"""Goals that not even the relaxed problem reaches; and those that it must not give up."""

import time
from collections.abc import Iterator
from typing import Any

import pytest

from hrcplan.errors import LimitError
from hrcplan.pddl.joins import Join
from hrcplan.planners.contract import Status
from hrcplan.planners.solve import solve
from hrcplan.task.actions import ground_actions
from hrcplan.task.conditions import Grounder
from hrcplan.task.reachable import reachable
from hrcplan.task.task import Task
from hrcplan.task.unreachable import is_out_of_reach
from tests.texts import problem_of

DOMAIN = """(define (domain workshop)
  (:requirements :durative-actions :fluents :derived-predicates :timed-initial-literals :adl)
  (:predicates (lit) (repaired) (done) (open) (never) (ready)) (:functions (level))
  (:derived (ready) (and (repaired) (open)))
  (:durative-action light :parameters () :duration (= ?duration 5)
    :condition (at end (repaired)) :effect (and (at start (lit)) (at end (not (lit)))))
  (:durative-action repair :parameters () :duration (= ?duration 3)
    :condition (over all (lit)) :effect (at end (repaired)))
  (:durative-action finish :parameters () :duration (= ?duration 1)
    :condition (at start {condition}) :effect (at end {effect})))"""
PROBLEM = """(define (problem p) (:domain workshop)
  (:init (= (level) 1) (at 7 (open))) (:goal {goal}))"""


@pytest.mark.parametrize(
    ("condition", "effect", "goal", "is_out"),
    [
        ("(never)", "(done)", "(done)", True),
        ("(done)", "(done)", "(and (repaired) (done))", True),
        ("(> (level) 3)", "(done)", "(done)", True),
        ("(and)", "(done)", "(> (level) 3)", True),
        ("(and)", "(done)", "(or (never) (not (or (done) (not (never)))))", True),
        ("(never)", "(and (done) (increase (level) 1))", "(done)", True),
        ("(repaired)", "(done)", "(done)", False),
        ("(open)", "(done)", "(done)", False),
        ("(ready)", "(done)", "(done)", False),
        ("(> (level) 3)", "(increase (level) 1)", "(> (level) 9)", False),
        ("(and)", "(not (open))", "(not (open))", False),
    ],
)
def test_a_goal_out_of_reach(condition: str, effect: str, goal: str, is_out: bool) -> None:
    domain = DOMAIN.format(condition=condition, effect=effect)
    problem = problem_of(domain, PROBLEM.format(goal=goal))
    assert is_out_of_reach(problem) == is_out
    if is_out:
        result = solve(problem, timeout_s=20)
        assert result.status is Status.UNSOLVABLE, result.attempts


def test_what_two_actions_make_true_for_each_other_can_be_reached() -> None:
    """Light ends only once a repair is done, which needs the light."""
    domain = DOMAIN.format(condition="(repaired)", effect="(done)")
    problem = problem_of(domain, PROBLEM.format(goal="(done)"))
    instances, facts = reachable(problem)
    assert {i.action.name for i in instances} == {"light", "repair", "finish"}
    assert ("repaired",) in facts


def test_equalities_are_looked_at_before_all_objects_are_tried() -> None:
    names = " ".join(f"o{i}" for i in range(20))
    domain = """(define (domain d) (:requirements :equality) (:constants o0)
      (:predicates (same ?a ?b ?c ?d ?e ?f))
      (:action pair :parameters (?a ?b ?c ?d ?e ?f)
        :precondition (and (= ?a ?b) (= ?b ?c) (= ?c ?d) (= ?d ?e) (not (= ?e ?f)) (= ?f o0))
        :effect (same ?a ?b ?c ?d ?e ?f)))"""
    text = f"(define (problem p) (:domain d) (:objects {names}) (:init) (:goal (and)))"
    instances, _ = reachable(problem_of(domain, text), deadline=time.monotonic() + 60)
    assert len(instances) == 19  # of 64 million


def test_grounding_looks_at_the_clock_where_every_binding_is_refused() -> None:
    names = " ".join(f"o{i}" for i in range(30))
    domain = """(define (domain d) (:requirements :fluents) (:predicates (p)) (:functions (n ?x))
      (:action a :parameters (?a ?b ?c ?d ?e) :precondition (> (n ?e) 5) :effect (p)))"""
    values = " ".join(f"(= (n {name}) 1)" for name in names.split())
    text = f"(define (problem p) (:domain d) (:objects {names}) (:init {values}) (:goal (p)))"
    with pytest.raises(LimitError, match="no time for more than 0 ground actions"):
        reachable(problem_of(domain, text), deadline=time.monotonic() - 1)


def test_static_disjunctions_take_part_in_joins() -> None:
    """Each choice is joined by itself; whole they would be looked at for all pairs of objects."""
    domain = """(define (domain line) (:requirements :adl) (:constants o0)
      (:predicates (next ?a ?b) (wall ?a) (at ?a) (seen ?a ?b))
      (:action step :parameters (?a ?b) :precondition (and (at ?a) (not (= ?a ?b))
          (or (next ?a ?b) (and (next ?b ?a) (or (wall ?b) (not (wall ?a)))) (= ?b o0)))
        :effect (and (at ?b) (seen ?a ?b))))"""
    n = 40
    facts = " ".join(f"(next o{i} o{i + 1})" for i in range(n - 1))
    text = f"""(define (problem p) (:domain line)
      (:objects {" ".join(f"o{i}" for i in range(1, n))})
      (:init (at o3) (wall o5) (wall o6) {facts}) (:goal (at o9)))"""
    rows = {i.args for i in reachable(problem_of(domain, text))[0]}
    walls = {5, 6}
    assert rows == {
        (f"o{a}", f"o{b}")
        for a in range(n)
        for b in range(n)
        if a != b
        if b == a + 1 or (b == a - 1 and (b in walls or a not in walls)) or b == 0
    }


def test_the_clock_is_looked_at_while_instances_become_ground_actions() -> None:
    domain = """(define (domain d) (:predicates (p ?x) (q ?x))
      (:action a :parameters (?x) :effect (forall (?y) (when (q ?y) (and (p ?y) (not (q ?y)))))))"""
    names = " ".join(f"o{i}" for i in range(20))
    facts = " ".join(f"(q o{i})" for i in range(20))
    text = f"(define (problem x) (:domain d) (:objects {names}) (:init {facts}) (:goal (p o1)))"
    problem = problem_of(domain, text)
    schema_instances, _ = reachable(problem)
    grounding = Task(problem).grounding
    grounder = Grounder(problem, grounding.bits, grounding.constant)
    with pytest.raises(LimitError, match="no time for more than 0 ground actions"):
        ground_actions(grounder, schema_instances, {}, deadline=time.monotonic() - 1)
    assert len(ground_actions(grounder, schema_instances, {})) == 20


def test_a_fact_is_joined_only_where_its_object_is_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A chain whose every step is a schema of its own: one join for each, not one for all."""
    n, joins, rows = 50, list[str](), Join.rows
    schemas = " ".join(
        f"(:action a{i} :parameters () :precondition (at o{i}) :effect (at o{i + 1}))"
        for i in range(n)
    )
    names = " ".join(f"o{i}" for i in range(n + 1))
    domain = f"(define (domain chain) (:constants {names}) (:predicates (at ?x)) {schemas})"
    text = f"(define (problem p) (:domain chain) (:init (at o0)) (:goal (at o{n})))"

    def counted(join: Join, *args: Any, **options: Any) -> Iterator[tuple[str, ...]]:
        joins.append(join.action.name)
        return rows(join, *args, **options)

    monkeypatch.setattr(Join, "rows", counted)
    instances, _ = reachable(problem_of(domain, text))
    assert [instance.action.name for instance in instances] == joins == [f"a{i}" for i in range(n)]
