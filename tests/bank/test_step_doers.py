"""Who can do steps, asked for many at once, beside asking for one after the other."""

from itertools import combinations

import pytest

from hrcplan.bank import StepTable
from hrcplan.task import Task

# Doors open by either key, lamps stay as they are in the dark, and one thing needs no agent.
HOUSE = """
(define (domain house) (:requirements :strips :typing :disjunctive-preconditions
    :conditional-effects :negative-preconditions)
  (:types agent door - object) (:constants north south - door)
  (:predicates (may ?a - agent) (brass ?d - door) (steel ?d - door) (open ?d - door)
               (power) (light) (rain))
  (:action open :parameters (?a - agent ?d - door)
    :precondition (and (may ?a) (or (brass ?d) (steel ?d))) :effect (open ?d))
  (:action find :parameters (?a - agent ?d - door)
    :precondition (may ?a) :effect (and (steel ?d) (not (brass ?d))))
  (:action switch :parameters (?a - agent) :precondition (may ?a)
    :effect (and (power) (when (open north) (light))))
  (:action pour :parameters () :precondition (light) :effect (and (rain) (not (power)))))
"""
NIGHT = """
(define (problem night) (:domain house)
  (:objects ann bob robo - agent)
  (:init (may ann) (may robo) (brass south))
  (:goal (rain)))
"""
WALKERS = """
(define (domain walkers) (:requirements :strips :typing)
  (:types agent spot - object)
  (:predicates (at ?a - agent ?s - spot) (link ?s ?t - spot) (swept ?s - spot))
  (:action go :parameters (?a - agent ?s ?t - spot)
    :precondition (and (at ?a ?s) (link ?s ?t)) :effect (and (at ?a ?t) (not (at ?a ?s))))
  (:action sweep :parameters (?a - agent ?s - spot)
    :precondition (at ?a ?s) :effect (swept ?s)))
"""
SQUARE = """
(define (problem square) (:domain walkers)
  (:objects ann robo - agent a b c - spot)
  (:init (at ann a) (at robo b) (link a b) (link b c) (link c a))
  (:goal (swept c)))
"""


def states(task: Task) -> set[int]:
    found, waiting = {task.initial}, [task.initial]
    while waiting:
        state = waiting.pop()
        after = {task.successor(state, action) for action in task.applicable(state)} - found
        found |= after
        waiting += after
    return found


@pytest.mark.parametrize("world", [(HOUSE, NIGHT), (WALKERS, SQUARE)], ids=["house", "walkers"])
def test_asking_at_once_is_asking_one_by_one(read_world, world):
    task = read_world(*world).task
    table = StepTable(task)
    everyone = sorted(task.problem.agents)
    groups = [set(g) for n in range(len(everyone) + 1) for g in combinations(everyone, n)]
    everywhere, steps = states(task), [*range(len(table))][::-1]
    answers = set()
    for agents in groups:
        for state in everywhere:
            one_by_one = [s for s in steps if table.doer(state, s, agents) is not None]
            assert list(table.able(state, steps, agents)) == one_by_one
            answers.add((frozenset(agents), tuple(one_by_one)))
    assert len(answers) > len(groups)
    # Both ways of looking were taken: by one rule, and action by action.
    one_by_one = [None in table._rules[frozenset(agents)] for agents in groups]
    assert any(one_by_one) == (world[0] == HOUSE)
