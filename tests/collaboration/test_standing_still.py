"""Standing still: an event after a while, evidence, and a reason to ask again."""

from typing import Any

import pytest

from hrcplan.bank import Bank, build, build_bank
from hrcplan.cli.terminal import IdleAlarm
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import assistant_of, make_setup, simulated
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.history import (
    BegunAction,
    DeniedGoals,
    EndedAction,
    PassedTurn,
    SensedValues,
    WantedGoal,
)
from hrcplan.collaboration.persons import IDLE_S, MOST_IDLE, idle_wait_s
from hrcplan.collaboration.run import CompanionRun
from hrcplan.episodes.humans import Course
from hrcplan.execution import events as ev
from hrcplan.execution.worlds.simulated import Nature, StateChange
from hrcplan.web.page_person import PagePerson
from tests.worlds import PACKED, WORKSHOP, world

NESTED = {"small": "(cut rope)", "large": "(cut rope) (cut pipe)"}


@pytest.fixture(scope="module")
def nested() -> Bank:
    """Return two goals of which one contains the other."""
    return build(world(WORKSHOP, PACKED, NESTED))


@pytest.mark.parametrize("goals", [(0, 1), (1, 0)])
@pytest.mark.parametrize("pace", ["free", "turns"])
def test_a_goal_within_another_is_reached_whichever_people_want_last(
    nested: Bank, goals: tuple[int, int], pace: str
) -> None:
    for turn in (1, 2):
        setup = make_setup(nested, pace=pace, method="joint")
        run = simulated(setup, nested, Course(goals, (turn,), seed="0")).run()
        assert run.run.ending == ev.GOAL
        assert nested.names[goals[-1]] in run.reached


def test_who_waits_on_and_on_is_asked_again_about_a_goal_that_was_denied(nested: Bank) -> None:
    machine = Companion(make_setup(nested, method="joint"))
    run = machine.begin()
    facts = frozenset({*run.run.state.facts, ("cut", "rope")})
    inner = run.run.__class__(**{**_fields(run.run), "state": _with_facts(run, facts)})
    run = run.__class__(**{**_fields(run), "run": inner, "denied": frozenset({"small"})})
    asked = []
    for _ in range(5):
        run = run.plus(PassedTurn("ann"))
        asked.append(machine._done_question(run) is not None)
        assert machine._done_question(run.plus(DeniedGoals(("small",)))) is None
    assert asked == [False, True, False, True, False]


def _fields(item: Any) -> dict[str, Any]:
    return {name: getattr(item, name) for name in item.__dataclass_fields__}


def _with_facts(run: CompanionRun, facts: frozenset[tuple[str, ...]]) -> Any:
    return type(run.run.state)(facts, run.run.state.values)


def test_every_wait_of_people_is_twice_as_long_and_the_fifth_says_nothing(nested: Bank) -> None:
    free = make_setup(nested, pace="free", method="joint")
    run = Companion(free).begin()
    waits = []
    while (wait_s := idle_wait_s(run, free)) is not None:
        waits.append(wait_s)
        run, _ = Companion(free).step(run, shared.Idle(run.t, wait_s))
    assert waits == [IDLE_S * 2**n for n in range(MOST_IDLE)]
    acts = run.plus(BegunAction(1, "ann", "cut", ("ann", "rope"), 1.0, False))
    assert idle_wait_s(acts, free) == IDLE_S
    assert idle_wait_s(run, make_setup(nested, method="joint")) is None


def test_a_page_without_a_click_and_a_terminal_without_a_line_stand_still(nested: Bank) -> None:
    run = Companion(make_setup(nested, pace="free", method="joint")).begin()
    person = PagePerson(lambda run, agents: None, lambda: 0)
    person.wait_s = lambda run: 0.0
    assert person.act(run, ("ann",)) == (shared.Idle(0.0, 0.0),)
    alarm = IdleAlarm(0.0, None)
    assert alarm(0.0)
    assert alarm.is_over
    news = IdleAlarm(0.0, lambda seconds: True)
    assert news(0.0)
    assert not news.is_over


@pytest.fixture(scope="module")
def kitchen() -> Bank:
    return build_bank("kitchen", only=["pasta-bean", "salad-bean"])


def test_what_people_will_probably_fail_at_does_not_count_as_done(kitchen: Bank) -> None:
    setup = make_setup(kitchen, pace="free", method="joint")
    robot = Adviser(setup, kitchen, assistant_of(setup)).joint
    attempt = BegunAction(1, "human", "get", ("human", "pan"), 1.0, False)
    for value, ends in ((1, ()), (9, (EndedAction(1, ev.FAILED),))):
        history = (SensedValues({("motivation", "human"): value}), attempt)
        agents = robot.agents.belief(history)
        assert robot._as_it_will_end(history, agents) == (*history, *ends)
    assert robot._as_it_will_end(history, None) == history


def test_a_robot_that_knows_the_goal_hears_it_once_and_ends(kitchen: Bank) -> None:
    setup = make_setup(kitchen, pace="free", method="joint-oracle")
    nature = Nature("0", (StateChange(3.0, {("motivation", "human"): 9}),), draws="attempt")
    run = simulated(setup, kitchen, Course((0, 1), (3,), seed="0"), nature=nature).run()
    assert run.run.ending == ev.GOAL
    assert [m.goal for m in run.history if isinstance(m, WantedGoal)] == list(kitchen.names)


def test_of_words_for_an_action_that_cannot_be_done_now_it_is_said_what_it_needs(
    kitchen: Bank,
) -> None:
    setup = make_setup(kitchen, method="joint")
    adviser = Adviser(setup, kitchen, assistant_of(setup))
    read = adviser.read(shared.AskReading(0.0, ("human",), "i boil the pasta in the pan"))
    assert read.outcome == shared.NONE
    assert read.note == "(cook human pasta pan stove) needs (in pasta pan)"


def test_of_open_words_the_action_that_lacks_least_is_explained(kitchen: Bank) -> None:
    setup = make_setup(kitchen, method="joint")
    adviser = Adviser(setup, kitchen, assistant_of(setup))
    read = adviser.read(shared.AskReading(0.0, ("human",), "cook it"))
    assert (read.outcome, read.options) == (shared.NONE, ())
    assert read.note.startswith("(cook human")
    assert " needs (in " in read.note
