"""Timed initial literals in a run: waited for, foreseen, planned around, and told."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hrcplan
from hrcplan.agents import load_profile
from hrcplan.errors import UnsupportedError
from hrcplan.execution import events as ev
from hrcplan.execution.execute import Execution, carry_out, prepare_run
from hrcplan.execution.journal import read_journal
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.world import LinkWorld
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replay import replay
from hrcplan.execution.simulate import Engine
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.plans import parse_plan
from hrcplan.validation import validate
from tests.execution.scripted import Plans, carried_out

HARBOR = """
(define (domain harbor)
  (:requirements :typing :fluents :durative-actions :timed-initial-literals)
  (:types agent place crate - object)
  (:predicates (controllable ?a - agent) (at ?a - agent ?p - place) (on ?c - crate ?p - place)
               (has ?a - agent ?c - crate) (open ?p - place) (lit ?p - place))
  (:functions (tide) (pace))
  (:durative-action go :parameters (?a - agent ?p ?q - place)
    :duration (= ?duration (pace)) :condition (and (at start (at ?a ?p)) (over all (open ?q)))
    :effect (and (at start (not (at ?a ?p))) (at end (at ?a ?q))))
  (:durative-action take :parameters (?a - agent ?c - crate ?p - place) :duration (= ?duration 2)
    :condition (and (over all (at ?a ?p)) (at start (on ?c ?p)))
    :effect (and (at start (not (on ?c ?p))) (at end (has ?a ?c))))
  (:durative-action ship :parameters (?a - agent ?c - crate ?p - place) :duration (= ?duration 3)
    :condition (and (over all (at ?a ?p)) (at start (has ?a ?c)) (at start (>= (tide) 2))
                    (at end (lit ?p)))
    :effect (and (at start (not (has ?a ?c))) (at end (on ?c ?p)))))
"""
PROBLEM = """
(define (problem tide) (:domain harbor)
  (:objects robo kim lee - agent store quay pier - place c1 c2 - crate)
  (:init (controllable robo) (at robo store) (at kim store) (at lee quay) (on c1 store)
         (on c2 store) (open quay) (open store) (open pier) (lit quay) (lit pier) (= (pace) 10)
         (= (tide) {tide}) {literals})
  (:goal {goal}))
"""
TAKE_AND_GO = "0: (take kim c1 store) [2]\n2.001: (go kim store quay) [10]\n"


def harbor(literals: str, goal: str = "(on c1 quay)", tide: int = 3) -> Problem:
    return read(HARBOR, PROBLEM.format(literals=literals, goal=goal, tide=tide))


def starts(done: Execution) -> dict[str, float]:
    return {bar.action: bar.start_s for bar in done.timeline.bars.values()}


def reasons(provider: Plans) -> list[str]:
    return [reason for ask in provider.asks for reason in ask.reasons]


def test_an_action_waits_for_the_literal_that_allows_it() -> None:
    problem = harbor("(at 20 (= (tide) 3))", tide=0)
    done, provider = carried_out(problem, TAKE_AND_GO + "20.001: (ship kim c1 quay) [3]")
    assert done.outcome.success
    assert done.outcome.replans == 0
    assert starts(done) == {"take": 0.0, "go": 2.0, "ship": 20.0}
    assert [(h.t, h.text) for h in done.timeline.literals] == [(20.0, "(= (tide) 3)")]
    assert provider.asks[0].n_happened == 0


def test_an_action_that_needs_a_literal_at_its_end_keeps_its_start() -> None:
    problem = harbor("(at 5 (not (lit quay))) (at 30 (lit quay))")
    done, _ = carried_out(problem, TAKE_AND_GO + "28: (ship kim c1 quay) [3]")
    assert done.outcome.success
    assert starts(done)["ship"] == 28.0


LATE = Nature(stretch=(2.0, 2.0))  # people take twice as long
DIVERT = "0: (go kim store pier) [10]\n10.001: (ship kim c1 pier) [3]"
ANYWHERE = "(exists (?p - place) (and (on c1 ?p) (lit ?p) (not (= ?p store))))"


def test_an_action_that_a_literal_will_make_impossible_is_not_begun() -> None:
    problem = harbor("(at 13 (not (open quay)))", ANYWHERE)
    done, provider = carried_out(
        problem, TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]", DIVERT, nature=LATE
    )
    assert done.outcome.success
    assert done.outcome.failed_human == 0  # foreseen, not failed
    assert done.outcome.replans_change == 1
    assert reasons(provider) == [
        "change: (go kim store quay) would need (open quay) until 14 s, but (not (open quay)) "
        "comes at 13 s"
    ]
    coming = provider.model.timed.coming(provider.asks[1].n_happened, provider.asks[1].t)
    assert [change.time for change in coming] == [9]  # shifted by the 4 s that were needed


def test_a_running_action_breaks_when_a_literal_comes() -> None:
    problem = harbor("(at 16 (not (open quay)))", ANYWHERE)
    done, provider = carried_out(
        problem, TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]",
        DIVERT, nature=LATE,
    )  # fmt: skip
    assert [(b.action, b.end_s, b.outcome) for b in done.timeline.bars.values()][1] == (
        "go", 16.0, ev.FAILED,
    )  # fmt: skip
    assert reasons(provider)[-1] == (
        "failure: (go kim store quay) failed, (open quay) does not hold any more"
    )
    assert done.outcome.success
    assert provider.asks[1].n_happened == 1


def test_a_missed_deadline_of_the_goal_is_foreseen() -> None:
    problem = harbor("(at 16 (not (lit quay)))", "(and (on c1 quay) (lit quay))")
    with pytest.raises(AssertionError, match="goal"):
        carried_out(problem, TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]")
    problem = harbor("(at 12 (not (lit quay))) (at 40 (lit quay))", "(and (on c1 quay) (lit quay))")
    done, _ = carried_out(problem, TAKE_AND_GO + "38: (ship kim c1 quay) [3]")
    assert done.outcome.success  # it comes by itself after the last action has begun


def test_a_goal_that_comes_by_itself_is_waited_for() -> None:
    problem = harbor("(at 9 (not (open quay))) (at 50 (lit store))", "(lit store)")
    done, _ = carried_out(problem, "")
    assert done.outcome.success
    assert done.run.t == 50.0


def test_a_changed_duration_is_foreseen() -> None:
    problem = harbor("(at 3 (= (pace) 30)) (at 100 (not (lit pier)))")
    done, provider = carried_out(
        problem, TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]",
        "0: (go kim store quay) [30]\n30.001: (ship kim c1 quay) [3]", nature=LATE,
    )  # fmt: skip
    assert reasons(provider) == ["change: (go kim store quay) would last 30 s at 3 s"]
    assert done.outcome.success


def test_three_agents_with_a_deadline_planned_by_a_planner() -> None:
    problem = harbor("(at 25 (not (open quay))) (at 5 (= (tide) 2))", "(on c1 quay)", tide=0)
    done = carry_out(prepare_run(problem, planner="kairos", timeout_s=4))
    assert done.outcome.success
    assert starts(done)["ship"] >= 5.0


def test_a_journal_of_a_run_with_literals_goes_on_anywhere(tmp_path: Path) -> None:
    problem = harbor("(at 13 (not (open quay))) (at 14 (= (tide) 4))", ANYWHERE)
    plans = TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]", DIVERT
    path = tmp_path / "run.jsonl"
    done, _ = carried_out(problem, *plans, nature=LATE, journal=path)
    lines = path.read_bytes().splitlines(keepends=True)
    assert sum(b'"happened"' in line for line in lines) == 2
    assert replay(read_journal(path)).difference is None
    for n in range(2, len(lines), 8):
        killed = tmp_path / f"killed-{n}.jsonl"
        killed.write_bytes(b"".join(lines[:n]))
        n_answers = sum(b'"planned"' in line for line in lines[:n])
        again, _ = carried_out(problem, *plans[n_answers:], nature=LATE, journal=killed,
                               resume=True)  # fmt: skip
        assert again.outcome == done.outcome
        assert again.run.n_happened == done.run.n_happened


class StubbornDoor:
    """A robot on a clock of its own: it sees at 7 s that the quay is open nevertheless."""

    def __init__(self) -> None:
        self.now = 0.0
        self.replies: list[tuple[float, msg.LinkMessage]] = []

    def start(self) -> None:
        opened = msg.FactsObserved(frozenset({("open", "quay")}))
        self.replies = [(0.0, msg.LinkReady()), (7.0, opened)]

    def send(self, message: Mapping[str, Any]) -> bool:
        if message["do"] == "dispatch":
            n = message["n"]
            end_s = self.now + message["duration_s"]
            self.replies += [(self.now, msg.Accepted(n)), (end_s, msg.ActionEnded(n, ev.DONE))]
        return True

    def receive(self, timeout_s: float) -> list[msg.LinkMessage]:
        self.replies.sort(key=lambda reply: reply[0])
        due = min([self.now + timeout_s, *(t for t, _ in self.replies[:1])])
        self.now = max(self.now, due)
        replies = [message for t, message in self.replies if t <= self.now]
        self.replies = [reply for reply in self.replies if reply[0] > self.now]
        return replies

    def close(self) -> None:
        self.replies = []


class ByPlace(Plans):
    """Sends the robot to the quay by way of the pier."""

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return the next move."""
        is_at_store = ("at", "robo", "store") in ask.facts
        way = "0: (go robo store pier) [10]" if is_at_store else "0: (go robo pier quay) [10]"
        self.asks.append(ask)
        return ev.Planned(ask.t, parse_plan(way), 1, "by hand")


def test_what_a_robot_observes_counts_more_than_a_literal() -> None:
    problem = harbor("(at 5 (not (open quay)))", "(at robo quay)")
    provider = ByPlace(problem, [])
    model, robot = provider.model, StubbornDoor()
    world = LinkWorld(model, Nature(), robot, clock=lambda: robot.now)
    engine = Engine(Monitor(model, load_profile("hrcplan")), provider)
    run = engine.run(Nature(), world=world)
    assert run.ending == ev.GOAL
    assert reasons(provider) == ["deviation: (open quay) holds"]
    assert provider.asks[1].n_happened == 1


def test_a_world_that_tells_no_literals_is_believed_by_its_clock() -> None:
    problem = harbor("(at 5 (not (open quay)))")
    prepared = prepare_run(problem, provider=Plans(problem, []))
    monitor = prepared.engine.monitor
    run, _ = monitor.step(monitor.begin(), ev.Settled(6.0))
    assert run.n_happened == 1
    assert ("open", "quay") not in run.state.facts
    again, _ = monitor.step(run, ev.Happened(6.0, 0, "(not (open quay))"))
    assert again.n_happened == 1


def test_a_literal_that_touches_nothing_of_the_plan_is_no_obstacle() -> None:
    problem = harbor("(at 13 (not (open pier)))")
    done, provider = carried_out(problem, TAKE_AND_GO + "12.002: (ship kim c1 quay) [3]")
    assert done.outcome.success
    assert len(provider.asks) == 1


SWITCHES = ("(open quay)", "(not (open quay))", "(lit quay)", "(not (lit quay))", "(= (tide) 1)",
            "(= (tide) 5)", "(= (pace) 20)", "(open pier)", "(not (open pier))")  # fmt: skip


def _switch(literal: tuple[int, str]) -> tuple[int, str]:
    """Return when what is switched: two literals of one time must not contradict each other."""
    return literal[0], literal[1].removeprefix("(not ").strip("(= )").partition(")")[0]


@given(
    st.lists(
        st.tuples(st.integers(1, 45), st.sampled_from(SWITCHES)), max_size=6, unique_by=_switch
    ),
    st.tuples(st.integers(0, 6), st.integers(0, 12), st.integers(0, 12)),
)
@settings(max_examples=120, deadline=None)
def test_a_valid_plan_is_carried_out_without_a_replan(
    literals: list[tuple[int, str]], delays: tuple[int, int, int]
) -> None:
    problem = harbor(" ".join(f"(at {t} {text})" for t, text in literals))
    take_s, go_s = delays[0], delays[0] + 2 + delays[1]
    plans = [
        f"{take_s}.002: (take kim c1 store) [2]\n{go_s}.005: (go kim store quay) [{lasts_s}]\n"
        f"{go_s + lasts_s + delays[2]}.007: (ship kim c1 quay) [3]"
        for lasts_s in (10, 20)
    ]
    for plan in plans:
        if validate(problem, plan).valid:
            done, _ = carried_out(problem, plan)
            assert done.outcome.success
            assert (done.outcome.replans, done.outcome.failed_human) == (0, 0)
            for bar, action in zip(
                done.timeline.bars.values(), parse_plan(plan).actions, strict=True
            ):
                assert bar.start_s <= float(action.start_s or 0) + ev.INSTANT_S


def test_what_cannot_hold_literals_declines_by_name() -> None:
    problem = harbor("(at 20 (= (tide) 3))", tide=0)
    with pytest.raises(UnsupportedError, match="'exact' does not know timed initial literals"):
        hrcplan.plan(problem, planner="exact")
    with pytest.raises(UnsupportedError, match="timed initial literals cannot be held") as error:
        hrcplan.ground(problem)
    assert "'execute'" in (error.value.hint or "")
