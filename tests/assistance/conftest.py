"""The small worlds of the tests of beliefs, and one in which order decides what tells most."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from hrcplan.bank import build

_SPEC = spec_from_file_location(
    "inference_worlds", Path(__file__).parents[1] / "inference" / "conftest.py"
)
_worlds = module_from_spec(_SPEC)
_SPEC.loader.exec_module(_worlds)
workshop, hall, walk = _worlds.workshop, _worlds.hall, _worlds.walk

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
    return build(_worlds.world(DESK, DAY, LETTERS))
