"""Where goals stand depends on what was done, not on what was asked before."""

from hrcplan.bank import build, from_problems
from hrcplan.bank.progress import ProgressTracker
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText

# Stirring does one thing in the heat and another in the cold, to facts that plans look at.
POT = """
(define (domain pot) (:requirements :strips :typing :conditional-effects)
  (:types agent - object)
  (:predicates (controllable ?a - agent) (hot) (cold) (thick) (white))
  (:action heat :parameters (?a - agent) :precondition (not (cold)) :effect (hot))
  (:action cool :parameters (?a - agent) :precondition (not (hot)) :effect (cold))
  (:action add :parameters (?a - agent) :precondition () :effect (thick))
  (:action stir :parameters (?a - agent) :precondition ()
    :effect (and (when (hot) (thick)) (when (cold) (not (white))))))
"""
SAUCE = """
(define (problem {name}) (:domain pot) (:objects ann robot - agent) (:init (white))
  (:goal (and (white) ({name}))))
"""


def test_what_a_step_does_to_a_goal_is_not_remembered_for_another_state() -> None:
    model = domain_in(SourceText("d", POT))
    bank = build(from_problems([
        problem_in(model, SourceText("p", SAUCE.format(name=name))) for name in ("thick", "hot")
    ]))  # fmt: skip
    heat, cool, stir = (bank.table.find([name]) for name in ("heat", "cool", "stir"))
    used = ProgressTracker(bank)
    for steps in ((heat, stir), (cool, stir)):
        old, new = used.start, (fresh := ProgressTracker(bank)).start
        for step in steps:
            old, new = used.follow(old, step)[0], fresh.follow(new, step)[0]
        assert old.nodes.tolist() == new.nodes.tolist()
        assert old.off.keys() == new.off.keys()
