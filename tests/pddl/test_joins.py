"""Joins give the bindings that trying out all objects gives, whatever the order of atoms."""

from __future__ import annotations

import random
from itertools import product

import pytest

from hrcplan.pddl.joins import FactIndex, Join, needed_atoms
from hrcplan.pddl.model import Action, Equal, Fact, Not, Problem
from hrcplan.pddl.semantics import LiftedState, holds
from hrcplan.pddl.walks import conjuncts
from tests.worlds import problem_from

DOMAIN = """(define (domain pairs) (:requirements :typing :equality :negative-preconditions)
  (:types thing place - object) (:constants hub - place)
  (:predicates (p ?x ?y - object) (q ?x - object) (r ?x ?y ?z - object) (n))
  (:action chain :parameters (?a - thing ?b - object ?c - place)
    :precondition (and (p ?a ?b) (p ?b ?c)) :effect (n))
  (:action loop :parameters (?a - thing) :precondition (and (p ?a ?a) (n)) :effect (q ?a))
  (:action fixed :parameters (?a - object ?b - place)
    :precondition (and (r ?a hub ?b) (q hub) (not (= ?a ?b)) (not (= ?b hub))) :effect (q ?a))
  (:action free :parameters (?a ?b - thing ?c - place)
    :precondition (and (q ?a) (not (= ?a ?b)) (= ?c hub)) :effect (q ?b))
  (:action twice :parameters (?a - object ?b - thing)
    :precondition (and (r ?a ?b ?a) (p ?b ?a)) :effect (n))
  (:action never :parameters () :precondition (and (n) (= hub hub)) :effect (q hub)))"""
PROBLEM = """(define (problem one) (:domain pairs) (:objects a b c - thing d e - place)
  (:init) (:goal (n)))"""


def random_facts(problem: Problem, rng: random.Random) -> list[Fact]:
    names = list(problem.all_objects)
    facts = {("p", *rng.choices(names, k=2)) for _ in range(14)}
    facts |= {("q", rng.choice(names)) for _ in range(4)}
    facts |= {("r", *rng.choices(names, k=3)) for _ in range(30)}
    return sorted(facts | ({("n",)} if rng.random() < 0.7 else set()))


def by_trial(action: Action, facts: list[Fact], problem: Problem) -> set[tuple[str, ...]]:
    """Return the objects of every binding for which the atoms and equalities hold."""
    state = LiftedState(frozenset(facts), {})
    names = [param.name for param in action.params]
    parts = [part for c in action.conditions for part in conjuncts(c.formula)]
    assert all(not isinstance(part, Not) or isinstance(part.body, Equal) for part in parts)
    return {
        args
        for args in product(*(problem.objects_of(param.types) for param in action.params))
        if all(holds(part, state, dict(zip(names, args, strict=True)), problem) for part in parts)
    }


@pytest.mark.parametrize("seed", range(25))
def test_a_join_gives_what_trying_all_objects_gives(seed: int) -> None:
    problem, rng = problem_from(DOMAIN, PROBLEM), random.Random(seed)
    facts = random_facts(problem, rng)
    index = FactIndex(facts)
    for action in problem.domain.actions:
        join = Join(action, needed_atoms(action, problem.domain), problem)
        rows = list(join.rows(index))
        assert len(rows) == len(set(rows))
        assert set(rows) == by_trial(action, facts, problem)
        bindings = [tuple(binding.values()) for binding in join.bindings(index)]
        assert bindings == rows


@pytest.mark.parametrize("seed", range(25))
def test_new_facts_give_the_rows_that_need_them(seed: int) -> None:
    """Plans that were made for few facts serve the tables that have grown since."""
    problem, rng = problem_from(DOMAIN, PROBLEM), random.Random(seed)
    facts = random_facts(problem, rng)
    rng.shuffle(facts)
    joins = {a.name: Join(a, needed_atoms(a, problem.domain), problem)
             for a in problem.domain.actions}  # fmt: skip
    index, rows = FactIndex(), {name: set[tuple[str, ...]]() for name in joins}
    while facts:
        name = facts[-1][0]
        group = [fact for fact in facts if fact[0] == name][: rng.randint(1, 5)]
        facts = [fact for fact in facts if fact not in group]
        index.add(group)
        for action in problem.domain.actions:
            join = joins[action.name]
            for position, atom in enumerate(join.atoms):
                if atom.name == name:
                    rows[action.name].update(join.rows(index, position, group))
    for action in problem.domain.actions:
        if joins[action.name].atoms:
            assert rows[action.name] == by_trial(action, sorted(index.facts), problem)


def test_a_long_join_looks_at_the_clock_also_while_it_yields_nothing() -> None:
    objects = [f"o{i}" for i in range(60)]
    problem = problem_from(
        """(define (domain wide) (:predicates (p ?x) (q ?x) (r ?x ?y))
          (:action a :parameters (?x ?y) :precondition (and (p ?x) (q ?y) (r ?x ?y))
            :effect (not (p ?x))))""",
        f"(define (problem w) (:domain wide) (:objects {' '.join(objects)}) (:goal (and)))",
    )
    (action,) = problem.domain.actions
    join, looks = Join(action, needed_atoms(action, problem.domain), problem), list[str]()
    index = FactIndex([("p", o) for o in objects] + [("q", o) for o in objects])
    index.add([("r", f"x{i % 2}", f"y{i}") for i in range(5000)])
    assert list(join.rows(index, look=lambda: looks.append("now"))) == []
    assert len(looks) == len(objects) ** 2 // 1024
