"""An interaction is a candidate like any other step, where the plans that cost least have it."""

import pytest

from hrcplan.assistance import explain
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.bank import BuildOptions, build, from_problems
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText

DOMAIN = """
(define (domain office) (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent letter - object)
  (:predicates (controllable ?a - agent) (can-sign ?a - agent) (coach ?a ?b - agent)
    (signed ?l - letter))
  (:functions (motivation ?a - agent) (total-cost))
  (:action sign :parameters (?a - agent ?l - letter) :precondition (can-sign ?a)
    :effect (and (signed ?l) (increase (total-cost) (motivation ?a))))
  (:action remind :parameters (?a - agent ?b - agent)
    :precondition (and (coach ?a ?b) (> (motivation ?b) 1))
    :effect (and (assign (motivation ?b) 1) (increase (total-cost) 2))))
"""
PROBLEM = """
(define (problem {name}) (:domain office)
  (:objects robot human - agent a b c - letter)
  (:init (controllable robot) (can-sign human) (coach robot human) (= (total-cost) 0)
    (= (motivation human) {motivation}) (= (motivation robot) 1))
  (:goal (and {goal})) (:metric minimize (total-cost)))
"""


def office(motivation):
    domain = domain_in(SourceText("office", DOMAIN))
    goals = {"first": "(signed a) (signed b)", "last": "(signed b) (signed c)"}
    problems = [
        problem_in(
            domain, SourceText(name, PROBLEM.format(name=name, goal=goal, motivation=motivation))
        )
        for name, goal in goals.items()
    ]
    return build(from_problems(problems), BuildOptions(cost="task"))


def test_a_human_who_needs_it_is_reminded():
    bank = office(9)
    assert bank.agents == "kept"
    robot = ExpectedHelp(bank)
    state = robot.start()
    step = robot.choose(state)
    assert bank.table[step].words == ("remind", "robot", "human")
    told = explain(robot, state)
    assert told.chosen == "(remind robot human)"
    assert {goal for goal, _ in told.candidates[0].helps} == {"first", "last"}
    # Once is enough: then there is nothing that the robot could do.
    assert robot.choose(robot.observe(state, step, robot=True)) is None


def test_a_human_who_does_not_need_it_is_left_alone():
    assert ExpectedHelp(office(1)).choose(ExpectedHelp(office(1)).start()) is None


@pytest.mark.parametrize("cost", ["steps"])
def test_where_only_steps_count_nobody_is_reminded(cost):
    domain = domain_in(SourceText("office", DOMAIN))
    text = PROBLEM.format(name="only", goal="(signed a)", motivation=9)
    bank = build(
        from_problems([problem_in(domain, SourceText("only", text))]), BuildOptions(cost=cost)
    )
    robot = ExpectedHelp(bank)
    assert robot.choose(robot.start()) is None
