"""A small world in which order decides what tells most."""

import pytest

from hrcplan.bank import build
from tests.worlds import world

# Whoever unlocks lets everybody do what is behind the lock, which tells nothing.
DESK = """
(define (domain desk) (:requirements :strips :typing)
  (:types agent job - object)
  (:predicates (controllable ?a - agent) (done ?j - job) (locked ?j - job) (key ?j - job)
               (open))
  (:action unlock :parameters (?a - agent) :precondition () :effect (open))
  (:action fetch :parameters (?a - agent ?j - job)
    :precondition (and (locked ?j) (open)) :effect (done ?j))
  (:action work :parameters (?a - agent ?j - job)
    :precondition (key ?j) :effect (done ?j)))
"""
DAY = """
(define (problem {name}) (:domain desk)
  (:objects ann robo - agent one two all s1 s2 s3 s4 - job)
  (:init (controllable robo) (locked one) (locked two)
         (key all) (key s1) (key s2) (key s3) (key s4))
  (:goal (and (done one) (done two) {goal})))
"""
LETTERS = {
    "first": "(done all) (done s1)",
    "second": "(done all) (done s2)",
    "third": "(done all) (done s3)",
    "fourth": "(done s4)",
}


@pytest.fixture(scope="session")
def desk():
    return build(world(DESK, DAY, LETTERS))
