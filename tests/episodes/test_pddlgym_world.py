"""Episodes in turns: pddlgym as the world, and the world as our own reading of the PDDL."""

import random
import sys

import pytest

from hrcplan.assistance import ASSISTANTS
from hrcplan.bank import Bank, build, build_bank, from_problems
from hrcplan.episodes.episode import REACHED, SimulatedTurns, play
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.episodes.pddlgym_world import PddlgymWorld, environment
from hrcplan.episodes.worlds import WORLDS
from hrcplan.errors import UnsupportedError, UsageError
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.inputs import read
from hrcplan.pddl.source import SourceText

MEALS = ["oatmeal-apple", "oatmeal-berry", "smoothie-green", "salad-greek", "stew-lentil"]
HALL = """
(define (domain hall) (:requirements :strips :typing :negative-preconditions :equality)
  (:types place - object) (:constants home - place)
  (:predicates (at ?p - place) (link ?p ?q - place) (shut ?p - place))
  (:action go :parameters (?p ?q - place) :precondition (and (at ?p) (link ?p ?q) {})
    :effect (and (at ?q) (not (at ?p)))))
"""

needs_pddlgym = pytest.mark.skipif(
    sys.version_info >= (3, 12), reason="pddlgym needs a Pillow without wheels for this Python"
)


@pytest.fixture(scope="module")
def meals() -> Bank:
    return build_bank("kitchen", only=MEALS)


def hall(condition: str = "", objects: str = "(:objects far - place)") -> Bank:
    domain = domain_in(SourceText("d", HALL.format(condition)))
    links = "(link home far) (link far home)" if objects else "(link home home)"
    text = f"""(define (problem p) (:domain hall) {objects} (:init (at home) {links})
      (:goal (at home)))"""
    return build(from_problems([problem_in(domain, SourceText("p", text))]))


@needs_pddlgym
def test_the_same_hundred_episodes_in_both_worlds(
    meals: Bank, capfd: pytest.CaptureFixture[str]
) -> None:
    world = WORLDS.find("pddlgym")(meals)
    robots = [ASSISTANTS.find(name)(meals) for name in ("oracle", "hrcplan")]
    chance, endings, n_mistakes = random.Random(3), [], 0
    for episode in range(100):
        course = Course(
            goals=tuple(chance.sample(range(len(MEALS)), 2)), turns=(chance.randrange(1, 8),),
            mistake_rate=chance.choice([0.0, 0.1, 0.4]), wait_rate=0.1, seed=str(episode),
        )  # fmt: skip
        robot = robots[episode % 2]
        here = play(meals, Frontier(meals, course), robot, course)
        there = play(meals, Frontier(meals, course), robot, course, world)
        assert there.turns == here.turns
        assert there.ending == here.ending
        endings.append(here.ending)
        n_mistakes += sum(turn.is_mistake for turn in here.turns)
    assert endings.count(REACHED) == 100
    assert n_mistakes > 100
    assert capfd.readouterr() == ("", "")


@needs_pddlgym
@pytest.mark.parametrize("name", ["two-boxes", "handover"])
def test_durations_become_instants(name: str) -> None:
    """A walk through transport, where agents' facts change and tokens are given back."""
    bank = build(from_problems([read("transport", name)]))
    ours, theirs = SimulatedTurns(bank), PddlgymWorld(bank)
    task, chance = bank.goals.task, random.Random(name)
    for _ in range(4):
        state = ours.begin()
        assert theirs.begin() == state
        for _ in range(25):
            action = chance.choice(task.applicable(state))
            after = ours.do(state, action)
            assert theirs.do(state, action) == after
            state = after


@needs_pddlgym
def test_what_cannot_be_done_is_refused_and_changes_nothing() -> None:
    bank = hall()
    task, world = bank.goals.task, PddlgymWorld(bank)
    go, back = task.find("go", ("home", "far"))[0], task.find("go", ("far", "home"))[0]
    with pytest.raises(UsageError, match=r"\(go far home\) cannot be done here"):
        world.do(task.initial, back)
    away = world.do(task.initial, go)
    assert away == task.successor(task.initial, go)
    assert world.do(away, back) == task.initial


@needs_pddlgym
def test_every_action_in_every_state_is_refused_where_it_should_be() -> None:
    bank = hall("(not (shut ?q))")
    task, world = bank.goals.task, PddlgymWorld(bank)
    for first in task.applicable(task.initial):
        state = task.successor(task.initial, first)
        for action in task.actions:
            world.begin()
            world.do(task.initial, first)
            if any(state & mask == value for mask, value in action.tests):
                assert world.do(state, action.index) == task.successor(state, action.index)
            else:
                with pytest.raises(UsageError, match="cannot be done"):
                    world.do(state, action.index)


@needs_pddlgym
def test_another_state_than_the_worlds_is_refused(meals: Bank) -> None:
    task, world = meals.goals.task, PddlgymWorld(meals)
    first = task.applicable(task.initial)[0]
    after = world.do(task.initial, first)
    with pytest.raises(UsageError, match=r"another state: \(available .*differ"):
        world.do(task.initial, first)
    with pytest.raises(UsageError, match=r"and \d+ more differ"):
        world.do(task.initial ^ (1 << len(task.facts)) - 1, first)
    assert world.begin() == task.initial
    assert world.do(task.initial, first) == after


@needs_pddlgym
@pytest.mark.parametrize(
    ("bank", "reason"),
    [
        (hall("(not (= ?p ?q))"), r"cannot hold \(= \?p \?q\) in 'go'"),
        (hall("(not (link ?q ?q))"), r"cannot hold \(link \?q \?q\) in 'go'"),
        (hall("(not (shut home))"), r"never looks at \(shut home\) in 'go'"),
        (hall(objects=""), "cannot hold this problem"),
    ],
    ids=["equality", "twice", "constants", "no-objects"],
)
def test_what_pddlgym_cannot_hold_is_refused(bank: Bank, reason: str) -> None:
    with pytest.raises(UnsupportedError, match=reason):
        PddlgymWorld(bank)


def test_changing_numbers_are_refused() -> None:
    bank = build(from_problems([read("transport-coached", "two-boxes")]))
    with pytest.raises(UnsupportedError, match="an action changes one"):
        PddlgymWorld(bank)


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pddlgym", None)
    with pytest.raises(UsageError, match="pddlgym cannot be imported") as caught:
        environment(read("kitchen", "stew-lentil"))
    assert "pip install 'hrcplan[pddlgym]'" in str(caught.value.hint)


def test_worlds_by_name(meals: Bank) -> None:
    assert WORLDS.names()[:2] == ["simulated", "pddlgym"]
    assert WORLDS.find("simulated")(meals).begin() == meals.initial
    with pytest.raises(UsageError, match="there is no world 'pddlgim'"):
        WORLDS.find("pddlgim")
