"""Small worlds with several goals, whose plans can be listed; fixtures of them are in conftest."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hrcplan.bank import Bank, Goals, from_problems
from hrcplan.bank.construct import optimal_graph
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import SourceText

# Things are cut and then packed; tape serves either box. Agents' facts never change.
WORKSHOP = """
(define (domain workshop) (:requirements :strips :typing)
  (:types agent thing box - object)
  (:predicates (controllable ?a - agent) (whole ?x - thing) (cut ?x - thing)
               (in ?x - thing ?b - box) (open ?b - box) (sealed ?b - box))
  (:action cut :parameters (?a - agent ?x - thing)
    :precondition (whole ?x) :effect (and (cut ?x) (not (whole ?x))))
  (:action unfold :parameters (?a - agent ?b - box)
    :precondition (not (sealed ?b)) :effect (open ?b))
  (:action pack :parameters (?a - agent ?x - thing ?b - box)
    :precondition (and (cut ?x) (open ?b)) :effect (in ?x ?b))
  (:action seal :parameters (?a - agent ?b - box)
    :precondition (open ?b) :effect (and (sealed ?b) (not (open ?b)))))
"""
PACKED = """
(define (problem {name}) (:domain workshop)
  (:objects ann robo - agent rope wire pipe - thing red blue - box)
  (:init (controllable robo) (whole rope) (whole wire) (whole pipe))
  (:goal (and {goal})))
"""
PARCELS = {
    "rope-red": "(in rope red) (sealed red)",
    "wire-red": "(in wire red) (sealed red)",
    "both-red": "(in rope red) (in wire red)",
    "pipe-blue": "(in pipe blue) (in rope blue)",
    "either": "(or (in wire blue) (in pipe red))",
}

# Agents walk, so who acts is part of a plan.
HALL = """
(define (domain hall) (:requirements :strips :typing)
  (:types agent place thing - object)
  (:predicates (at ?a - agent ?p - place) (link ?p ?q - place) (on ?x - thing ?p - place)
               (has ?a - agent ?x - thing) (ready ?x - thing))
  (:action go :parameters (?a - agent ?p ?q - place)
    :precondition (and (at ?a ?p) (link ?p ?q)) :effect (and (at ?a ?q) (not (at ?a ?p))))
  (:action take :parameters (?a - agent ?x - thing ?p - place)
    :precondition (and (at ?a ?p) (on ?x ?p)) :effect (and (has ?a ?x) (not (on ?x ?p))))
  (:action use :parameters (?a - agent ?x - thing)
    :precondition (has ?a ?x) :effect (ready ?x)))
"""
ERRAND = """
(define (problem {name}) (:domain hall)
  (:objects ann robot - agent a b c d - place cup pen key - thing)
  (:init (at ann b) (at robot c) (link a b) (link b a) (link b c) (link c b) (link c d) (link d c)
         (on cup a) (on pen d) (on key c))
  (:goal (and {goal})))
"""
ERRANDS = {"cup": "(ready cup)", "pen": "(ready pen)", "key": "(ready key)",
           "two": "(ready cup) (ready key)"}  # fmt: skip


def world(domain: str, problem: str, goals: dict[str, str]) -> Goals:
    model = domain_in(SourceText("domain", domain))
    texts = (problem.format(name=name, goal=goal) for name, goal in goals.items())
    return from_problems([problem_in(model, SourceText("problem", text)) for text in texts])


def without_turns(bank: Bank) -> Bank:
    """Return a bank of the shortest sequences of steps, instead of team plans."""
    graphs = tuple(
        optimal_graph(bank.table, tests, bank.initial, name=name)
        for name, tests in zip(bank.names, bank.goals.tests, strict=True)
    )
    return replace(bank, graphs=graphs)


def problem_from(domain: str, problem: str) -> Problem:
    """Return a problem from the texts of a domain and of a problem."""
    return problem_in(domain_in(SourceText("domain", domain)), SourceText("problem", problem))


Walk = Callable[[Bank, int, int], tuple[int, ...]]


def random_walk(bank: Bank, seed: int, length: int) -> tuple[int, ...]:
    """Return steps that can be done one after the other, most of them without a purpose."""
    rng = np.random.default_rng(seed)
    state, found = bank.initial, []
    for _ in range(length):
        options = bank.table.applicable(state)
        step = options[rng.integers(len(options))]
        after = bank.table.successor(state, step)
        assert after is not None
        state = after
        found.append(step)
    return tuple(found)
