"""Humans who choose otherwise than beliefs assume, with agents in steps or not, and in teams."""

from collections import Counter

import pytest

from hrcplan.assistance.oracle import Oracle
from hrcplan.bank import build
from hrcplan.bank.team_moves import TeamMoves
from hrcplan.episodes.choosers import NoisyRational
from hrcplan.episodes.episode import REACHED, play
from hrcplan.episodes.humans import HUMANS, Course, Frontier
from tests.episodes.test_team import ONE_EACH, yard
from tests.worlds import world

OTHERS = ("habit", "inertia", "general-first", "special-first", "noisy-rational")
# Every goal needs the tray, two need the cup, and one each its own thing; the hatch shuts for good.
CANTEEN = """
(define (domain canteen) (:requirements :strips :typing :negative-preconditions)
  (:types agent thing - object)
  (:predicates (controllable ?a - agent) (served ?t - thing) (shut))
  (:action serve :parameters (?a - agent ?t - thing)
    :precondition (not (shut)) :effect (served ?t))
  (:action shut :parameters (?a - agent) :precondition (not (shut)) :effect (shut)))
"""
LUNCH = """
(define (problem {name}) (:domain canteen)
  (:objects ann robo - agent tray cup soup roll cake fork mug pan - thing)
  (:init (controllable robo)) (:goal (and (served tray) {goal})))
"""
MEALS = {
    "soup": "(served cup) (served soup)",
    "roll": "(served cup) (served roll)",
    "cake": "(served cake) (served fork)",
}


@pytest.fixture(scope="module")
def canteen():
    return build(world(CANTEEN, LUNCH, MEALS))


def steps_of(bank, name, course, n=3):
    """Return what the human serves, turn by turn, where the robot does nothing."""
    human, state, last, done = HUMANS.find(name)(bank, course), bank.initial, None, []
    for turn in range(n):
        move = human.move(turn, state, last)
        if move.step is not None:
            last, state = move.step, bank.table.successor(state, move.step)
        done.append(None if move.step is None else bank.table[move.step].name[-1])
    return done


def test_general_steps_first_or_last(canteen):
    for seed in "abcdef":
        soup = Course((canteen.goal_index("soup"),), seed=seed)
        assert steps_of(canteen, "general-first", soup) == ["tray", "cup", "soup"]
        assert steps_of(canteen, "special-first", soup) == ["soup", "cup", "tray"]
    ends = {tuple(steps_of(canteen, "special-first", Course((2,), seed=s))) for s in "abcdefgh"}
    assert len(ends) == len(canteen.names) - 1  # two things only one goal needs: either is first


def test_a_habit_is_an_order_that_does_not_depend_on_the_goal(canteen):
    firsts = set()
    for seed in range(30):
        soup, roll = (
            steps_of(canteen, "habit", Course((canteen.goal_index(name),), seed=str(seed)))
            for name in ("soup", "roll")
        )
        assert soup == steps_of(canteen, "habit", Course((canteen.goal_index("soup"),),
                                                         seed=str(seed)))  # fmt: skip
        shared = [[thing for thing in meal if thing in ("tray", "cup")] for meal in (soup, roll)]
        assert shared[0] == shared[1]
        firsts.add(soup[0])
    assert firsts == {"tray", "cup", "soup"}  # but it is another one for each human


def test_inertia_goes_on_with_the_old_goal_for_up_to_three_turns(canteen):
    soup, cake = canteen.goal_index("soup"), canteen.goal_index("cake")
    firsts = Counter()
    for seed in range(40):
        done = steps_of(canteen, "inertia", Course((soup, cake), (1,), seed=str(seed)), 6)
        firsts[min(done.index(thing) for thing in ("cake", "fork"))] += 1
        assert {"cake", "fork", "tray"} <= {*done}
    assert set(firsts) == {2, 3}  # the old goal is reached by then
    # A goal that is reached holds nobody back.
    assert {*steps_of(canteen, "inertia", Course((soup, cake), (3,)), 5)[3:]} == {"cake", "fork"}


def test_a_noisy_rational_human_errs_by_its_temperature_and_never_loses_the_goal(canteen):
    bank, goal = canteen, canteen.goal_index("soup")
    n = wrong = 0
    expected = 0.0
    for seed in range(400):
        human = NoisyRational(bank, Course((goal,), seed=str(seed)))
        move = human.move(0, bank.initial, None)
        assert bank.table[move.step].name[0] != "shut"
        n, wrong = n + 1, wrong + move.is_mistake
        odd = 5 * 2.718281828**-human.beta  # roll, cake, fork, mug and pan; three are needed
        expected += odd / (3 + odd)
        is_needed = bank.table[move.step].name[-1] in ("tray", "cup", "soup")
        assert move.is_mistake != is_needed
    assert abs(wrong - expected) < 4 * expected**0.5
    assert wrong


@pytest.fixture(scope="module")
def team():
    bank = yard(*ONE_EACH)
    moves = TeamMoves(bank)  # which all tests share while it lives
    return bank, moves


@pytest.mark.parametrize("rate", [0.0, 0.1])
@pytest.mark.parametrize("name", OTHERS)
def test_teams_whose_agents_move_reach_their_goals_with_every_human(team, name, rate):
    bank, robot = team[0], Oracle(team[0])
    for seed in range(6):
        course = Course((seed, (seed + 3) % 8), (2,), rate, seed=str(seed))
        record = play(bank, HUMANS.find(name)(bank, course), robot, course)
        assert record.ending == REACHED


def test_what_every_human_prefers_is_used_in_teams_too(team):
    bank = team[0]

    class First(Frontier):
        def prefer(self, steps, last, draw):
            seen.append(len(steps))
            return steps[0]

    seen: list[int] = []
    course = Course((bank.goal_index("both"),))
    play(bank, First(bank, course), Oracle(bank), course)
    assert seen
