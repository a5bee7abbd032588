"""A step that changes nothing is no evidence, also where another agent's would be progress."""

import pytest

from hrcplan.bank import build_bank
from hrcplan.inference.belief import UNEXPLAINED
from hrcplan.inference.exact import ExactBelief
from tests.worlds import without_turns

DOMAIN = """
(define (domain hands) (:requirements :strips :typing)
  (:types agent)
  (:predicates (clean ?a - agent) (soup) (salad))
  (:action wash :parameters (?a - agent) :precondition () :effect (clean ?a))
  (:action cook :parameters (?a - agent) :precondition (clean ?a) :effect (soup))
  (:action cut :parameters (?a - agent) :precondition () :effect (salad)))
"""
PROBLEM = """
(define (problem {goal}) (:domain hands)
  (:objects ann bob - agent) (:init) (:goal (and ({goal}) (clean ann) (clean bob))))
"""


@pytest.fixture(scope="module", params=["sequences", "turns"])
def belief(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> ExactBelief:
    folder = tmp_path_factory.mktemp("hands")
    domain, goals = folder / "domain.pddl", folder / "goals"
    domain.write_text(DOMAIN)
    goals.mkdir()
    for goal in ("soup", "salad"):
        (goals / f"{goal}.pddl").write_text(PROBLEM.format(goal=goal))
    bank = build_bank(str(domain), str(goals))
    return ExactBelief(without_turns(bank) if request.param == "sequences" else bank)


def test_a_step_that_changes_nothing_leaves_the_belief(belief: ExactBelief) -> None:
    names = [belief.steps[i].words for i in range(len(belief.steps))]
    wash = names.index(("wash", "ann"))
    first = belief.observe(belief.start(), wash)
    again = belief.observe(first, wash)
    assert first.ignored is None
    assert again.ignored == UNEXPLAINED
    assert again.progress == first.progress
    assert belief.posterior(again).tolist() == belief.posterior(first).tolist()


def test_the_same_step_of_the_other_agent_is_evidence(belief: ExactBelief) -> None:
    names = [belief.steps[i].words for i in range(len(belief.steps))]
    first = belief.observe(belief.start(), names.index(("wash", "ann")))
    other = belief.observe(first, names.index(("wash", "bob")))
    assert other.ignored is None
    if belief.tracker.moves is None:  # in turns both goals have the same next steps here
        assert belief.posterior(other).tolist() != belief.posterior(first).tolist()
