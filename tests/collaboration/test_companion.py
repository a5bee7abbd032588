"""The companion, event by event: evidence, failed attempts, corrections, questions and refusals."""

from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.bank import Bank, build
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.belief_fold import BeliefFold
from hrcplan.collaboration.collaborate import make_setup
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.history import evidence_in, state_after
from hrcplan.collaboration.run import CompanionPhase, CompanionRun
from hrcplan.execution import events as ev
from tests.worlds import ERRAND, ERRANDS, HALL, PACKED, PARCELS, WORKSHOP, world

# What a walk deletes goes at its end only, so that others can still see the walker on its way.
DURATIVE_HALL = """
(define (domain hall) (:requirements :strips :typing :durative-actions)
  (:types agent place thing - object)
  (:predicates (at ?a - agent ?p - place) (link ?p ?q - place) (on ?x - thing ?p - place)
               (has ?a - agent ?x - thing) (seen ?x - thing))
  (:durative-action go :parameters (?a - agent ?p ?q - place) :duration (= ?duration 5)
    :condition (and (at start (at ?a ?p)) (at start (link ?p ?q)))
    :effect (and (at end (at ?a ?q)) (at end (not (at ?a ?p)))))
  (:durative-action take :parameters (?a - agent ?x - thing ?p - place) :duration (= ?duration 9)
    :condition (and (at start (at ?a ?p)) (at start (on ?x ?p)))
    :effect (and (at end (has ?a ?x)) (at end (not (on ?x ?p)))))
  (:durative-action look :parameters (?a - agent ?x - thing ?p - place) :duration (= ?duration 2)
    :condition (and (at start (at ?a ?p)) (at start (on ?x ?p)))
    :effect (and (at end (seen ?x)))))
"""
LOOKS = {"cup": "(has ann cup)", "pen": "(has ann pen)", "seen": "(seen key)",
         "key": "(has robot key)"}  # fmt: skip


@lru_cache
def bank_of(name: str) -> Bank:
    match name:
        case "hall":
            return build(world(HALL, ERRAND, ERRANDS))
        case "durative":
            return build(world(DURATIVE_HALL, ERRAND, LOOKS))
    return build(world(WORKSHOP, PACKED, PARCELS))


@lru_cache
def robot_of(name: str) -> ExpectedHelp:
    return ExpectedHelp(bank_of(name))


class Script:
    """One collaboration under the hands of a test."""

    def __init__(self, name: str = "workshop", pace: str = "free") -> None:
        self.name, self.bank = name, bank_of(name)
        self.setup = make_setup(self.bank, pace=pace)
        self.machine = Companion(self.setup)
        self.run: CompanionRun = self.machine.begin()
        self.commands: list[SharedCommand] = []

    def tell(self, *events: SharedEvent) -> list[SharedCommand]:
        """Return the commands after these events."""
        self.commands = []
        for event in events:
            self.run, commands = self.machine.step(self.run, event)
            self.commands += commands
        return self.commands

    def begin(self, text: str, t: float = 0.0) -> int:
        """Begin an action of a person; return its number."""
        name, *args = text.split()
        self.tell(shared.Begun(t, "", name, tuple(args)))
        return next(c.number for c in self.commands if isinstance(c, ev.Dispatch))

    def do(self, text: str, t: float = 0.0, outcome: str = ev.DONE) -> int:
        number = self.begin(text, t)
        self.tell(ev.Ended(t, number, outcome))
        return number

    def settle(self, t: float = 0.0) -> list[SharedCommand]:
        return self.tell(ev.Settled(t))

    def robot(self, text: str, t: float = 0.0) -> list[SharedCommand]:
        """Let the robot choose an action when it is asked."""
        self.settle(t)
        assert any(isinstance(c, shared.AskStep) for c in self.commands)
        name, *args = text.split() or [""]
        return self.tell(shared.Chosen(t, name, tuple(args)))

    def codes(self) -> list[str]:
        return [c.code for c in self.commands if isinstance(c, ev.Tell)]

    def belief(self) -> Any:
        return BeliefFold(self.bank, robot_of(self.name)).state(self.run.history)

    def posterior(self) -> list[float]:
        return robot_of(self.name).posterior(self.belief()).tolist()  # type: ignore[no-any-return]


def test_what_is_begun_is_evidence_at_once() -> None:
    script = Script()
    before = script.posterior()
    script.begin("cut ann pipe")
    begun = script.posterior()
    assert begun != before
    script.tell(ev.Ended(1.0, 0, ev.DONE))
    assert script.posterior() == begun


def test_a_failed_attempt_stays_evidence_and_its_effect_is_taken_back() -> None:
    script = Script()
    initial = script.run.run.state
    before = script.posterior()
    script.do("cut ann pipe", outcome=ev.FAILED)
    assert script.run.run.state == initial
    assert script.belief().world == script.bank.initial
    after = script.posterior()
    assert after != before
    script.do("cut ann pipe", outcome=ev.FAILED)
    assert script.posterior() == after  # the same attempt again says nothing more
    script.do("cut ann pipe")
    done = Script()
    done.do("cut ann pipe")
    assert script.posterior() == done.posterior()
    assert script.belief().world == done.belief().world != script.bank.initial


def test_attempts_with_another_step_between_are_two_observations() -> None:
    script = Script()
    script.do("cut ann pipe", outcome=ev.FAILED)
    script.do("unfold ann blue")
    once = script.posterior()
    script.do("cut ann pipe", outcome=ev.FAILED)
    assert script.posterior() != once
    assert len(evidence_in(script.run.history)) == 4  # with the end of the step between


def test_what_the_robot_failed_to_do_has_not_happened() -> None:
    script = Script()
    before = script.posterior()
    script.robot("cut robo pipe")
    script.tell(ev.Ended(1.0, 0, ev.FAILED))
    assert evidence_in(script.run.history) == ()
    assert script.posterior() == before


def test_an_observation_impossible_in_the_beliefs_world_is_folded_at_its_end() -> None:
    """The robot takes the key, which the belief counts as done; ann can still look at it."""
    script = Script("durative")
    script.do("go ann b c", outcome=ev.DONE)
    script.robot("take robot key c", 5.0)
    before = script.posterior()
    number = script.begin("look ann key c", 6.0)
    assert script.posterior() == before
    other = Script("durative")
    other.do("go ann b c")
    other.begin("look ann key c", 5.0)
    assert other.posterior() != before
    script.tell(ev.Ended(8.0, number, ev.DONE))
    assert ("seen", "key") in script.run.run.state.facts


@pytest.mark.parametrize("name", ["workshop", "hall"])
@settings(max_examples=40)
@given(data=st.data())
def test_undo_is_never_having_done_it(name: str, data: st.DataObject) -> None:
    with_x, without_x = Script(name), Script(name)
    task = with_x.bank.goals.task

    def possible(script: Script) -> list[str]:
        state = task.state_of(script.run.run.state.facts)
        actions = (task.actions[i] for i in task.applicable(state))
        return [" ".join((a.name, *a.args)) for a in actions if a.agent == "ann"]

    def both(text: str) -> None:
        for script in (with_x, without_x):
            script.do(text)

    for _ in range(data.draw(st.integers(0, 3))):
        both(data.draw(st.sampled_from(possible(with_x))))
    outcome = data.draw(st.sampled_from([ev.DONE, ev.FAILED, "running"]))
    text = data.draw(st.sampled_from(possible(with_x)))
    x = with_x.begin(text) if outcome == "running" else with_x.do(text, outcome=outcome)
    for _ in range(data.draw(st.integers(0, 2)) if outcome != "running" else 0):
        left = sorted(set(possible(with_x)) & set(possible(without_x)))
        if left:
            both(data.draw(st.sampled_from(left)))
    commands = with_x.tell(shared.Undone(0.0, x))
    assert any(isinstance(c, shared.Correct) for c in commands)
    assert with_x.run.run.state == without_x.run.run.state
    assert with_x.run.running == ()
    assert np.array_equal(with_x.posterior(), without_x.posterior())
    assert with_x.belief().world == without_x.belief().world
    assert state_after(with_x.run.history, with_x.machine.reports.actions)[0] == (
        with_x.run.run.state
    )


def test_a_robots_wait_says_nothing_about_people_after_an_undo() -> None:
    script, other = Script("hall", "turns"), Script("hall", "turns")
    script.do("go ann b c")
    script.robot("")
    script.tell(shared.Undone(0.0, 0))
    for one in (script, other):
        one.do("go ann b a")
    assert script.posterior() == pytest.approx(other.posterior())


def test_undo_leaves_what_the_robot_has_done() -> None:
    script = Script()
    script.do("cut ann pipe")
    script.robot("unfold robo blue")
    script.tell(ev.Ended(1.0, 1, ev.DONE))
    script.tell(shared.Undone(1.0, 0))
    facts = script.run.run.state.facts
    assert ("open", "blue") in facts
    assert ("whole", "pipe") in facts
    script.tell(shared.Undone(1.0, 1))
    assert script.codes() == ["nothing-to-undo"]


def test_what_cannot_be_is_refused_with_the_reason() -> None:
    script = Script("hall", "turns")
    for action, args, code in (
        ("fly", ("ann",), "unknown-action"), ("go", ("robot", "c", "b"), "unknown-agent"),
        ("go", ("ann", "a", "b"), "impossible"), ("use", ("ann", "cup"), "impossible"),
    ):  # fmt: skip
        script.tell(shared.Begun(0.0, "", action, args))
        assert script.codes() == [code]
    assert script.run.history == ()
    script.do("go ann b a")
    script.tell(shared.Begun(0.0, "", "go", ("ann", "a", "b")))
    assert script.codes() == ["not-your-turn"]


def test_a_goal_that_holds_is_asked_about_once() -> None:
    script = Script("durative")
    script.do("go ann b c", outcome=ev.DONE)
    script.do("look ann key c", outcome=ev.DONE)
    (ask,) = script.settle(9.0)
    assert ask == shared.Ask(9.0, shared.DONE, ("seen",))
    script.tell(shared.Answered(9.0, shared.NO))
    script.settle(9.0)
    assert script.run.phase is CompanionPhase.CHOOSING  # the robot goes on
    script.tell(shared.Chosen(9.0))
    script.settle(10.0)
    assert script.run.question is None


def test_a_person_who_goes_on_has_not_ended_it() -> None:
    """The robot has reached a goal in its turn; the person's next step is the answer."""
    script = Script("hall", "turns")
    script.do("go ann b c")
    for action in ("take robot key c", "use robot key"):
        script.robot(action)
        script.tell(ev.Ended(1.0, script.run.running[0].number, ev.DONE))
        script.settle()
        if script.run.question is None:
            script.do("go ann c b")
    assert script.run.question is not None
    script.do("go ann b a")
    assert (script.codes(), script.run.question, script.run.denied) == ([], None, {"key"})


def test_who_confirms_ends_it() -> None:
    script = Script("durative")
    script.do("go ann b c")
    script.do("look ann key c")
    script.settle(9.0)
    script.tell(shared.Answered(9.0, shared.YES))
    assert script.run.is_over
    assert script.run.run.ending == ev.GOAL
    assert script.run.reached == {"seen"}


def test_a_pause_keeps_the_robot_from_beginning() -> None:
    script = Script()
    script.tell(shared.Paused(0.0))
    script.do("cut ann pipe")
    assert script.settle() == []
    script.tell(shared.Continued(0.0))
    assert [type(c) for c in script.settle()] == [shared.AskStep]


def test_words_that_are_understood_begin_an_action() -> None:
    script = Script()
    (ask,) = script.tell(shared.Said(0.0, "", "cut the pipe"))
    assert ask == shared.AskReading(0.0, ("ann",), "cut the pipe")
    script.tell(shared.Read(0.0, shared.ACT, ("(cut ann pipe)",)))
    assert [c.action for c in script.commands if isinstance(c, ev.Dispatch)] == ["cut"]


def test_words_with_several_meanings_lead_to_a_question() -> None:
    script = Script()
    script.tell(shared.Said(0.0, "", "cut it"))
    options = ("(cut ann pipe)", "(cut ann rope)")
    script.tell(shared.Read(0.0, shared.ASK, options))
    assert script.commands == [shared.Ask(0.0, shared.WHICH, options)]
    script.tell(shared.Answered(0.0, "(cut ann wire)"))
    assert script.codes() == ["unknown-answer"]
    script.tell(shared.Answered(0.0, "(cut ann rope)"))
    assert [c.args for c in script.commands if isinstance(c, ev.Dispatch)] == [("ann", "rope")]


def test_a_step_that_no_robot_was_asked_for_is_not_begun() -> None:
    script = Script()
    script.settle()
    script.tell(shared.Chosen(0.0, "cut", ("ann", "pipe")))
    assert script.codes() == ["unknown-step"]
    script.tell(shared.Chosen(0.0, "cut", ("robo", "pipe")))
    assert script.codes() == ["unasked-step"]


def test_new_evidence_asks_for_the_step_again() -> None:
    script = Script()
    script.settle()
    script.begin("cut ann pipe")
    script.tell(shared.Chosen(0.0, "cut", ("robo", "rope")))
    assert [type(c) for c in script.commands] == [shared.AskStep]
