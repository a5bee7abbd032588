"""Simulated humans keep their goal in mind: laws on small worlds, with agents in steps or not."""

from collections import Counter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.bank import build, from_problems
from hrcplan.episodes.humans import HUMANS, Course, HumanMove
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.conventions import people
from hrcplan.pddl.source import SourceText

# They only do what their present goal needs, but for the mistakes of their course.
NAMES = ["frontier", "cc-htn", "plans", "habit"]
N_GOALS, N_TURNS = 3, 6

# One of two steps comes first, and there are more ways to go on with the one than with the other.
FORK = """
(define (domain fork) (:requirements :strips :typing) (:types agent - object)
  (:predicates (controllable ?a - agent) (p) (q) (r) (s) (t) (done) (lit) (seen))
  (:action wide :parameters (?a - agent) :precondition (and) :effect (p))
  (:action left :parameters (?a - agent) :precondition (p) :effect (r))
  (:action right :parameters (?a - agent) :precondition (p) :effect (r))
  (:action narrow :parameters (?a - agent) :precondition (and) :effect (q))
  (:action only :parameters (?a - agent) :precondition (q) :effect (r))
  (:action stare :parameters (?a - agent) :precondition (and) :effect (seen))
  (:action light :parameters (?a - agent) :precondition (seen) :effect (lit)))
"""


def fork(objects="ann robot - agent", controllable="robot"):
    domain = domain_in(SourceText("d", FORK))
    text = f"""(define (problem r) (:domain fork) (:objects {objects})
      (:init (controllable {controllable})) (:goal (r)))"""
    return build(from_problems([problem_in(domain, SourceText("p", text))]))


def courses(most=N_GOALS, mistakes=(0.0, 0.4, 1.0), waits=(0.0, 0.3)):
    return st.integers(1, most).flatmap(
        lambda n: st.builds(
            Course,
            goals=st.permutations(range(N_GOALS)).map(lambda order: tuple(order[:n])),
            turns=st.lists(
                st.integers(1, N_TURNS), min_size=n - 1, max_size=n - 1, unique=True
            ).map(lambda turns: tuple(sorted(turns))),
            mistake_rate=st.sampled_from(mistakes),
            wait_rate=st.sampled_from(waits),
            seed=st.text(max_size=3),
        )
    )


def walk(bank, human, others):
    """Yield turn, state, last step and move; somebody else does one of ``others(state)`` between.

    That is chosen from the steps that can be done, and may be None.
    """
    state, last = bank.initial, None
    for turn in range(N_TURNS):
        move = human.move(turn, state, last)
        yield turn, state, last, move
        if move.step is not None:
            last, state = move.step, bank.table.successor(state, move.step)
        other = others(state)
        state = state if other is None else bank.table.successor(state, other)


def anything(bank, data):
    def choose(state):
        steps = bank.table.applicable(state)
        return data.draw(st.sampled_from([None, *steps])) if steps else None

    return choose


def by_people(bank, state):
    """Return the actions by which people can change a state."""
    task = bank.goals.task
    return [i for i in task.applicable(state) if task.actions[i].agent in ("ann", "bob")]


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=60)
@given(data=st.data())
def test_steps_bring_the_goal_nearer_and_mistakes_do_not(name, data, small_bank, distances):
    """From the states of optimal plans, against a search of all states; up to a mistake."""
    bank, course = data.draw(small_bank(kinds=("free", "able"))), data.draw(courses(most=1))
    to_go, task = distances(bank, course.goals[0]), bank.goals.task

    def nearer(state, actions):
        """Return those steps among actions that bring the goal nearer."""
        return {
            bank.table.of_action[i]
            for i in actions
            if to_go.get(state) and to_go.get(task.successor(state, i)) == to_go[state] - 1
        }

    def helpful(state):
        steps = sorted(nearer(state, task.applicable(state)))
        return data.draw(st.sampled_from([None, *steps])) if steps else None

    for _, state, _, move in walk(bank, HUMANS.find(name)(bank, course), helpful):
        useful = nearer(state, by_people(bank, state))
        if move.is_mistake:
            assert course.mistake_rate
            assert move.step not in useful
            break
        assert move.step in useful or move.step is None
        assert move.step is not None or course.wait_rate or not useful


@pytest.mark.parametrize("name", NAMES)
@settings(max_examples=60)
@given(data=st.data())
def test_a_step_begins_a_plan_or_is_a_mistake_that_is_in_none(name, data, small_bank):
    """From any state, with goals that change."""
    bank, course = data.draw(small_bank(kinds=("free", "able"))), data.draw(courses())
    agents = people(bank.goals.problem)
    assert agents == {"ann", "bob"}
    for turn, state, _, move in walk(bank, HUMANS.find(name)(bank, course), anything(bank, data)):
        goal = course.goal(turn)
        graph, node = bank.locate(goal, state)
        can = {bank.table.of_action[i] for i in by_people(bank, state)}
        unused = can - {step for n in range(graph.n_nodes) for step in graph.next(n)}
        if move.step is None:
            assert not move.is_mistake
            # Nothing was left to do, if it does not wait by choice.
            assert course.wait_rate or node is None or can.isdisjoint(graph.next(node))
        elif move.is_mistake:
            assert course.mistake_rate
            assert move.step in unused
        else:
            assert move.step in can
            assert course.mistake_rate < 1 or not unused
            steps = [move.step]
            while steps:
                state, node = bank.table.successor(state, steps[0]), graph.next(node)[steps[0]]
                steps = list(graph.next(node))
            assert bank.goals.is_reached(goal, state)


@settings(max_examples=60)
@given(data=st.data())
def test_the_same_course_makes_the_same_moves(data, small_bank):
    bank, course = data.draw(small_bank(kinds=("free", "able"))), data.draw(courses())
    for name in NAMES:
        kind = HUMANS.find(name)
        seen = list(walk(bank, kind(bank, course), anything(bank, data)))
        other = kind(bank, course)
        for turn, state, last, move in reversed(seen):  # nothing is remembered between turns
            assert other.move(turn, state, last) == move


@given(course=courses(), data=st.data())
def test_a_course_wants_one_goal_after_the_other(course, data):
    turn = data.draw(st.integers(0, 2 * N_TURNS))
    begun = [0, *course.turns]
    place = max(i for i, begin in enumerate(begun) if begin <= turn)
    assert course.goal(turn) == course.goals[place]


def test_a_goal_is_wanted_from_its_turn_on():
    course = Course((7, 5, 7), (2, 4))
    assert [course.goal(turn) for turn in range(6)] == [7, 7, 5, 5, 7, 7]


def first_moves(name, n=600, **rates):
    bank = fork()
    kind = HUMANS.find(name)
    moves = [
        kind(bank, Course((0,), seed=str(i), **rates)).move(0, bank.initial, None) for i in range(n)
    ]
    return Counter(
        (None if m.step is None else bank.table[m.step].name[0], m.is_mistake) for m in moves
    )


def test_steps_are_alike_on_the_frontier_and_plans_are_alike_for_who_follows_plans():
    """Two of the three plans begin with the wide step."""
    frontier, plans = first_moves("frontier"), first_moves("plans")
    assert frontier.keys() == plans.keys() == {("wide", False), ("narrow", False)}
    assert abs(frontier["wide", False] / 600 - 1 / 2) < 0.05
    assert abs(plans["wide", False] / 600 - 2 / 3) < 0.05


def test_rates_are_kept():
    found = first_moves("frontier", wait_rate=0.25, mistake_rate=0.2)
    assert abs(found[None, False] / 600 - 0.25) < 0.04
    assert abs(found["stare", True] / 600 - 0.75 * 0.2) < 0.04
    assert found.keys() == {(None, False), ("stare", True), ("wide", False), ("narrow", False)}
    assert first_moves("frontier", 20, wait_rate=1.0) == {(None, False): 20}
    assert first_moves("frontier", 20, mistake_rate=1.0) == {("stare", True): 20}


def test_what_only_the_robot_can_do_is_left_to_it():
    bank = fork(objects="robot - agent")
    assert people(bank.goals.problem) == frozenset()
    assert HUMANS.find("frontier")(bank, Course((0,))).move(0, bank.initial, None) == HumanMove(
        None
    )


def test_who_takes_no_commands_is_human():
    bank = fork(objects="ann bob - agent", controllable="bob")
    assert people(bank.goals.problem) == {"ann"}
