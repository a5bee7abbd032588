"""The monitor, event by event: draining, coalescing, deviations, faults and named endings."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.execution import events as ev
from hrcplan.execution.run import Phase
from tests.execution.scripted import PLAN, ROBOT_ONLY, Script, adopted, dispatched

MOTIVATION = ("motivation", "human")


def sensed(t: float, value: float) -> ev.Sensed:
    return ev.Sensed(t, {MOTIVATION: value})


def test_a_plan_is_carried_out_to_the_goal() -> None:
    script = Script()
    assert dispatched(script.begin()) == ["(move robot wp0 wp3)", "(move human wp1 wp4)"]
    for step in range(4):
        t = 50.0 * (step + 1)
        script.tell(ev.Ended(t, 2 * step, ev.DONE), ev.Ended(t, 2 * step + 1, ev.DONE))
        script.settle(t)
    assert script.commands == (ev.Finish(200.0, ev.GOAL),)
    assert script.run.counts.done == {"robot": 4, "human": 4}
    assert script.run.counts.last_end_s == 200.0


def test_an_agent_goes_on_as_soon_as_its_own_action_ends() -> None:
    """Durations differ from the plan: the robot does not wait for the human's longer action."""
    script = Script()
    script.begin()
    script.tell(ev.Ended(30.0, 0, ev.DONE))
    assert dispatched(script.settle(30.0)) == ["(grasp robot green wp3)"]


def test_a_change_drains_and_then_replans_once() -> None:
    script = Script()
    script.begin()
    script.tell(sensed(25.0, 9))
    assert script.settle(25.0) == ()
    assert script.run.phase is Phase.DRAINING
    script.tell(ev.Ended(50.0, 0, ev.DONE))
    assert script.settle(50.0) == ()  # the human's action still runs
    script.tell(sensed(55.0, 10))
    script.tell(ev.Ended(60.0, 1, ev.FAILED))
    (ask,) = script.settle(60.0)
    assert isinstance(ask, ev.AskPlan)
    assert ask.values[MOTIVATION] == 10
    assert len(ask.reasons) == 3  # two changes and a failure, one replan
    assert ("at", "human", "wp1") in ask.facts  # the failed move left no trace
    assert ("at", "robot", "wp3") in ask.facts  # the robot's took effect
    script.plan(ROBOT_ONLY, 60.0)
    assert script.run.counts.replans == {"failure": 1}
    assert script.run.counts.failed == {"human": 1}
    assert script.run.counts.assigned == {"robot": 11, "human": 4}


def test_a_draining_human_is_cancelled_if_the_profile_says_so() -> None:
    script = Script()
    own = replace(script.monitor.profile, while_draining="cancel")
    script.monitor = replace(script.monitor, profile=own)
    script.begin()
    script.tell(sensed(25.0, 9))
    assert script.settle(25.0) == (ev.Cancel(25.0, 1),)
    script.tell(ev.Ended(25.0, 1, ev.CANCELLED))
    assert script.settle(25.0) == ()
    script.tell(ev.Ended(50.0, 0, ev.DONE))
    script.settle(50.0)
    assert script.has(ev.AskPlan)
    assert script.run.counts.cancelled == {"human": 1}
    assert script.run.counts.failed == {}


def test_the_planner_is_asked_again_if_something_changed_while_it_thought() -> None:
    script = Script()
    script.begin()
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.FAILED))
    script.settle(50.0)
    script.tell(sensed(51.0, 9))
    commands = script.plan(ROBOT_ONLY, 52.0)
    assert [type(c) for c in commands] == [ev.AskPlan]
    script.plan(ROBOT_ONLY, 53.0)
    assert script.run.counts.n_replans == 1


def test_hrcplan_confirms_a_plan_that_stays_the_best() -> None:
    script = Script("hrcplan")
    script.begin()
    script.tell(ev.Sensed(25.0, {("capacity", "human", "wp0"): 10}))
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    script.settle(50.0)
    commands = script.plan(ROBOT_ONLY, 50.0)  # worse: the human would do it for less
    assert script.run.counts.plans_confirmed == 1
    assert script.run.counts.n_replans == 0
    assert dispatched(commands) == ["(grasp robot green wp3)", "(grasp human blue wp4)"]


def test_paper_counts_a_replan_also_if_the_plan_stays_the_same() -> None:
    script = Script("replan-always")
    script.begin()
    script.tell(ev.Sensed(25.0, {("capacity", "human", "wp0"): 10}))
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    script.settle(50.0)
    commands = script.plan(ROBOT_ONLY, 50.0)
    assert script.run.counts.replans == {"change": 1}
    assert len(adopted(commands).actions) == 6  # what was left of the better plan, kept


def test_an_observation_that_differs_is_a_deviation() -> None:
    script = Script()
    script.begin()
    facts = script.monitor.model.actions.changing(script.run.state)
    moved = facts - {("box-at", "blue", "wp4")} | {("box-at", "blue", "wp0")}
    script.tell(ev.Observed(10.0, moved))
    script.settle(10.0)
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    (ask,) = script.settle(50.0)
    assert isinstance(ask, ev.AskPlan)
    assert "(box-at blue wp0) holds" in ask.reasons[0]
    assert ("box-at", "blue", "wp0") in ask.facts


def test_an_observation_as_expected_is_none() -> None:
    script = Script()
    script.begin()
    script.tell(ev.Observed(10.0, script.monitor.model.actions.changing(script.run.state)))
    assert script.settle(10.0) == ()
    assert script.run.reasons == ()


def test_conditions_are_checked_again_at_every_dispatch() -> None:
    script = Script()
    script.settle(0.0)
    wrong = PLAN.replace("grasp human blue wp4", "grasp human blue wp5")
    script.plan(wrong)
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    commands = script.settle(50.0)
    assert "(grasp human blue wp5)" not in dispatched(commands)
    assert "needs (box-at blue wp5)" in script.run.reasons[0].text


@pytest.mark.parametrize("value", [-1.0, 10.5, math.nan, math.inf])
def test_bad_sensed_values_are_rejected_and_the_last_good_one_stays(value: float) -> None:
    script = Script()
    script.begin()
    script.tell(sensed(10.0, 4))
    (told,) = script.tell(sensed(20.0, value))
    assert isinstance(told, ev.Tell)
    assert told.code == "bad-sensed-value"
    assert "[0, 10]" in told.message
    assert script.run.sensed_values[MOTIVATION] == 4


def test_one_bad_value_does_not_spoil_the_others() -> None:
    script = Script()
    script.begin()
    script.tell(ev.Sensed(5.0, {("mood", "human"): 3, MOTIVATION: 7}))
    assert script.run.sensed_values == {MOTIVATION: 7}


def test_an_action_that_was_never_dispatched_changes_nothing() -> None:
    script = Script()
    script.begin()
    before = script.run
    (told,) = script.tell(ev.Ended(0.0, 17, ev.DONE))
    assert isinstance(told, ev.Tell)
    assert "never dispatched" in told.message
    assert script.run == before


def test_a_duplicate_outcome_changes_nothing() -> None:
    script = Script()
    script.begin()
    script.tell(ev.Ended(50.0, 0, ev.DONE))
    before = script.run
    (told,) = script.tell(ev.Ended(50.0, 0, ev.FAILED))
    assert isinstance(told, ev.Tell)
    assert "ended before" in told.message
    assert script.run == before


def test_time_never_runs_backwards() -> None:
    script = Script()
    script.begin()
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(20.0, 1, ev.DONE))
    assert script.run.t == 50.0
    assert {c.t for c in script.settle(10.0)} == {50.0}


def test_events_of_one_instant_may_come_in_any_order() -> None:
    one, other = Script(), Script()
    for script in (one, other):
        script.begin()
    happened = [ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.FAILED), sensed(50.0, 9)]
    one.tell(*happened)
    other.tell(*reversed(happened))
    (ask,), (same,) = one.settle(50.0), other.settle(50.0)
    assert isinstance(ask, ev.AskPlan)
    assert isinstance(same, ev.AskPlan)
    assert (ask.facts, ask.values, sorted(ask.reasons)) == (
        same.facts, same.values, sorted(same.reasons),
    )  # fmt: skip


def test_a_plan_that_nobody_asked_for_is_not_followed() -> None:
    script = Script()
    script.begin()
    (told, *_) = script.plan(ROBOT_ONLY, 10.0)
    assert isinstance(told, ev.Tell)
    assert script.run.counts.n_replans == 0


def test_the_sixth_failure_ends_the_run() -> None:
    script = Script(sensing=False)
    script.begin()
    number = 1
    for failure in range(6):
        t = 50.0 * (failure + 1)
        running = [r.number for r in script.run.running]
        number = next(r.number for r in script.run.running if r.step.agent == "human")
        script.tell(*(ev.Ended(t, n, ev.FAILED if n == number else ev.DONE) for n in running))
        script.settle(t)
        if failure < 5:
            # No better plan: what is left of the running one is tried again.
            script.tell(ev.Planned(t, None), ev.Settled(t))
    assert script.run.ending == ev.REPLAN_LIMIT
    assert script.run.counts.n_replans == 5
    assert script.run.counts.assigned == {"robot": 10, "human": 24}


def test_no_plan_is_a_named_ending_and_stops_everybody() -> None:
    script = Script()
    script.settle(0.0)
    (finish,) = script.tell(ev.Planned(0.0, None, note="exact: crashed"))
    assert finish == ev.Finish(0.0, ev.NO_PLAN, "exact: crashed")


def test_a_running_plan_survives_planners_that_fail() -> None:
    script = Script()
    script.begin()
    script.tell(sensed(25.0, 9))
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    script.settle(50.0)
    script.tell(ev.Planned(50.0, None, note="all planners crashed"))
    assert len(dispatched(script.settle(50.0))) == 2


def test_after_the_last_replan_changes_do_not_end_the_run() -> None:
    script = Script()
    script.monitor = replace(script.monitor, profile=script.monitor.profile.limited_to(0))
    script.begin()
    script.tell(sensed(25.0, 9))
    script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Ended(50.0, 1, ev.DONE))
    commands = script.settle(50.0)
    assert len(dispatched(commands)) == 2
    assert script.has(ev.Tell)


def test_an_overdue_action_counts_as_failed_and_is_broken_off() -> None:
    script = Script()
    script.begin()
    assert script.tell(ev.Overdue(500.0, 1)) == (ev.Cancel(500.0, 1),)
    assert script.run.counts.failed == {"human": 1}
    assert script.run.running_action(1) is None


def test_stopping_is_a_named_ending_and_the_last_word() -> None:
    script = Script()
    script.begin()
    assert script.tell(ev.StopAsked(5.0, "enough")) == (ev.Finish(5.0, ev.STOPPED, "enough"),)
    assert script.tell(ev.Ended(50.0, 0, ev.DONE), ev.Settled(50.0)) == ()


ANY_EVENT = st.one_of(
    st.builds(
        ev.Ended, st.floats(0, 500), st.integers(-1, 12), st.sampled_from([*ev.OUTCOMES, "x"])
    ),
    st.builds(ev.Overdue, st.floats(0, 500), st.integers(-1, 12)),
    st.builds(sensed, st.floats(0, 500), st.one_of(st.integers(0, 10), st.floats())),
    st.builds(ev.Settled, st.floats(0, 500)),
    st.builds(ev.Planned, st.floats(0, 500), st.none()),
)


@given(st.lists(ANY_EVENT, max_size=40), st.sampled_from(["replan-always", "hrcplan"]))
def test_no_sequence_of_events_confuses_the_monitor(events: list[ev.Event], name: str) -> None:
    """Whatever comes, nobody does two things at once, counts add up, and an end is an end."""
    script = Script(name)
    script.begin()
    for event in events:
        script.tell(event)
        if script.has(ev.AskPlan):
            script.tell(ev.Planned(event.t, None), ev.Settled(event.t))
        busy = [agent for r in script.run.running for agent in r.step.busy]
        assert len(busy) == len(set(busy))
        tally = script.run.counts
        closed = sum(map(sum, (d.values() for d in (tally.done, tally.failed, tally.cancelled))))
        assert closed + len(script.run.running) == script.run.n_dispatched
        assert tally.n_replans <= 5
        assert script.run.is_over == (script.run.ending is not None)
        if not script.run.is_over:
            working = script.run.running or script.run.phase is Phase.PLANNING
            assert working or not isinstance(event, ev.Settled)
