"""The choice of steps in teams that take turns: expected timesteps, and the likeliest goal."""

import numpy as np
import pytest

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.field_similarity import FieldSimilarity
from hrcplan.assistance.rhp.maximal_subsets import MAX_PARTS, largest_first
from hrcplan.assistance.team_help import TeamHelp
from hrcplan.bank import Bank, build
from hrcplan.bank.team_moves import Moment
from hrcplan.episodes.episode import REACHED, play
from hrcplan.episodes.humans import Course, Frontier
from tests.worlds import ERRAND, ERRANDS, HALL, world

# A wall takes one colour and keeps it. The robot stands at the wall, the human has a way to go.
PAINT = """
(define (domain paint) (:requirements :strips :typing)
  (:types agent place colour - object)
  (:predicates (controllable ?a - agent) (at ?a - agent ?p - place) (way ?p ?q - place)
    (wall ?p - place) (bare) (has ?c - colour) (rang))
  (:action go :parameters (?a - agent ?p ?q - place)
    :precondition (and (at ?a ?p) (way ?p ?q)) :effect (and (at ?a ?q) (not (at ?a ?p))))
  (:action paint :parameters (?a - agent ?c - colour ?p - place)
    :precondition (and (at ?a ?p) (wall ?p) (bare)) :effect (and (has ?c) (not (bare)))))
"""
WALL = """
(define (problem {name}) (:domain paint)
  (:objects ann robo - agent door yard hall - place red blue - colour)
  (:init (controllable robo) (at ann door) (at robo hall) (way door yard) (way yard hall)
         (way hall yard) (way yard door) (wall hall) (bare))
  (:goal {goal}))
"""
COLOURS = {"red": "(has red)", "blue": "(has blue)"}


@pytest.fixture(scope="module")
def wall() -> Bank:
    return build(world(PAINT, WALL, COLOURS))


@pytest.fixture(scope="module")
def hall() -> Bank:
    return build(world(HALL, ERRAND, ERRANDS))


def test_a_robot_that_knows_the_goal_follows_the_cost_to_go(hall):
    robot = ExpectedHelp(hall)
    assert robot.team_help is not None
    moment = robot.step_values.next_robot(robot.tracker.start)
    choices = robot.team_help.moves.choices(hall.initial, moment)
    for goal, weights in enumerate(np.eye(len(hall.names))):
        costs = robot.team_help.costs(hall.initial, moment, weights)
        assert costs == pytest.approx(choices.costs[goal], abs=0.01)


@pytest.mark.parametrize("goal", range(2))
def test_a_goal_is_not_lost_by_a_guess(wall, goal):
    """The human waits for the robot, which must not choose the colour by chance."""
    course = Course((goal,), seed="wall")
    assert play(wall, Frontier(wall, course), ExpectedHelp(wall), course).ending == REACHED


def test_a_lost_goal_costs_more_than_any_wait(wall):
    robot = ExpectedHelp(wall)
    moves = robot.tracker.moves
    assert moves is not None
    costs = TeamHelp(moves).costs(wall.initial, Moment(1, 1, 0), np.array([0.9, 0.1]))
    red = moves.choices(wall.initial, Moment(1)).place(
        wall.table.find(["paint", "robo", "red", "hall"])
    )
    assert costs[red] > costs[-1] + 50


def test_whether_a_goal_was_lost_is_part_of_the_record(wall):
    class Blue(ExpectedHelp):
        def choose(self, state):
            blue = wall.table.find(["paint", "robo", "blue", "hall"])
            return blue if wall.table.successor(state.world, blue) is not None else None

    course = Course((0,), seed="lost")
    record = play(wall, Frontier(wall, course), Blue(wall), course)
    assert not record.is_reachable
    assert record.cost == record.cap > 0


def test_a_baseline_helps_the_likeliest_goal(hall):
    for goal in range(len(hall.names)):
        course = Course((goal,), seed="base")
        robot = FieldSimilarity(hall)
        assert play(hall, Frontier(hall, course), robot, course).ending == REACHED
        explanation = robot.explain(robot.start())
        assert explanation.chosen is None or explanation.candidates[0].action == explanation.chosen


def test_parts_of_a_long_history_are_counted():
    looked = []
    steps = [0, 1] * 12

    def fits(sequence):
        looked.append(sequence)
        return len(sequence) == 1

    parts = largest_first([(1 << len(steps)) - 1], steps, 2, [1] * len(steps), 1, fits)
    assert parts == [(2,)]
    assert len(looked) <= MAX_PARTS + 1
