"""Every registered planner, belief and world of turns keeps its law.

Those of assistants, humans, natures, event worlds and studies are run where they are broken, too.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping

import pytest

from hrcplan.bank import Bank, build_bank
from hrcplan.episodes.worlds import WORLDS
from hrcplan.inference.registry import METHODS
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Status
from hrcplan.planners.registry import PLANNERS
from hrcplan.testing import check_belief, check_planner, check_world
from tests import worlds

CLASSICAL = read(
    """(define (domain errands) (:requirements :strips :typing :action-costs)
      (:types agent place - object)
      (:predicates (at ?a - agent ?p - place) (seen ?p - place))
      (:functions (far ?p - place) (total-cost))
      (:action go :parameters (?a - agent ?p ?q - place) :precondition (at ?a ?p)
        :effect (and (not (at ?a ?p)) (at ?a ?q) (seen ?q) (increase (total-cost) (far ?q)))))""",
    """(define (problem three) (:domain errands) (:objects ann - agent home shop post - place)
      (:init (at ann home) (= (far home) 1) (= (far shop) 2) (= (far post) 3))
      (:goal (and (seen shop) (seen post) (at ann home))) (:metric minimize (total-cost)))""",
)
TEMPORAL = read("transport", "handover")
UNSOLVABLE = read(
    CLASSICAL.domain,
    """(define (problem none) (:domain errands)
  (:objects ann - agent home - place) (:init (= (far home) 1)) (:goal (at ann home)))""",
)
SMALL: Mapping[str, dict[str, int]] = {"forest": {"n_samples": 400, "n_trees": 10}}
"""Options with which a belief is made quickly."""
PDDLGYM = {"pddlgym"} if sys.version_info >= (3, 12) else set()  # it has no wheels from 3.12 on


@pytest.mark.parametrize("name", [n for n in PLANNERS.names() if not PLANNERS.make(n).missing()])
def test_every_planner_keeps_the_laws(name: str) -> None:
    planner = PLANNERS.make(name)
    problems = [CLASSICAL, UNSOLVABLE] if planner.card.classical else [TEMPORAL]
    first, *others = check_planner(planner, problems, timeout_s=60)
    assert first.plan is not None
    assert all(other.status in (Status.UNSOLVABLE, Status.UNSOLVED) for other in others)


@pytest.mark.parametrize("name", METHODS.names())
def test_every_belief_keeps_the_laws(name: str, workshop: Bank, walk: worlds.Walk) -> None:
    source = workshop.goals if name == "cost" else workshop
    runs = [next(workshop.plans(0)), walk(workshop, 1, 4)]
    check_belief(METHODS.find(name)(source, **SMALL.get(name, {})), runs)


@pytest.mark.parametrize("name", [n for n in WORLDS.names() if n not in PDDLGYM])
def test_every_world_keeps_the_laws(name: str) -> None:
    bank = build_bank("kitchen", only=["parfait-nut", "smoothie-berry"])
    check_world(WORLDS.find(name)(bank), bank, [next(bank.plans(goal)) for goal in range(2)])
