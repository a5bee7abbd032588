"""A robot that weighs goal and agent state in the live loop: it asks, takes over, never nags."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.joint_help import JointHelp, JointState
from hrcplan.bank import Bank, build, build_bank
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.agent_fold import AgentFold
from hrcplan.collaboration.belief_fold import BeliefFold
from hrcplan.collaboration.collaborate import (
    Collaboration,
    carry_out_collaboration,
    make_setup,
    parts_with,
    simulated,
)
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import PersonEvent, SharedCommand, SharedEvent
from hrcplan.collaboration.history import AskedGoal, BegunAction, DeniedGoals, History, PassedTurn
from hrcplan.collaboration.journal import replay_collaboration
from hrcplan.collaboration.robots import JOINT_ROBOTS, check_robot
from hrcplan.collaboration.run import CompanionRun
from hrcplan.episodes.episode import play
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.journal import read_journal
from hrcplan.execution.worlds.simulated import Nature, StateChange
from tests.worlds import ERRAND, ERRANDS, HALL, PACKED, PARCELS, WORKSHOP, world

COACHED = """
(define (domain coached) (:requirements :strips :typing :numeric-fluents :action-costs)
  (:types agent thing box - object)
  (:predicates (controllable ?a - agent) (whole ?x - thing) (cut ?x - thing)
               (in ?x - thing ?b - box))
  (:functions (motivation ?a - agent) (residual) (total-cost))
  ;; hrcplan: success remind 0.8
  (:action cut :parameters (?a - agent ?x - thing)
    :precondition (whole ?x)
    :effect (and (cut ?x) (not (whole ?x)) (increase (total-cost) (motivation ?a))))
  (:action pack :parameters (?a - agent ?x - thing ?b - box)
    :precondition (cut ?x) :effect (and (in ?x ?b) (increase (total-cost) (motivation ?a))))
  (:action remind :parameters (?a ?other - agent)
    :precondition (and (controllable ?a) (> (motivation ?other) (residual)))
    :effect (and (assign (motivation ?other) (residual)) (increase (total-cost) 1))))
"""
COACHED_PROBLEM = """
(define (problem {name}) (:domain coached)
  (:objects ann robo - agent rope wire pipe - thing red blue - box)
  (:init (controllable robo) (whole rope) (whole wire) (whole pipe) (= (residual) 1)
         (= (motivation ann) 1) (= (motivation robo) 1) (= (total-cost) 0))
  (:goal (and {goal})) (:metric minimize (total-cost)))
"""
BOXES = {"all-red": "(in rope red) (in wire red) (in pipe red)",
         "all-blue": "(in rope blue) (in wire blue) (in pipe blue)"}  # fmt: skip


@lru_cache
def bank_of(name: str) -> Bank:
    match name:
        case "coached":
            return build(world(COACHED, COACHED_PROBLEM, BOXES))
        case "hall":
            return build(world(HALL, ERRAND, ERRANDS))
        case "kitchen":
            return build_bank("kitchen", only=["pasta-bean", "pasta-tomato", "salad-bean"])
        case "transport":
            goals = ["blue-out", "door", "swap", "red-out"]
            return build_bank("transport", "problems/transport-goals", only=goals)
    return build(world(WORKSHOP, PACKED, PARCELS))


@lru_cache
def robot_of(name: str, method: str = "joint") -> JointHelp:
    return JOINT_ROBOTS[method].make(bank_of(name))


class Table:
    """One collaboration under the hands of a test; the robot answers by itself."""

    def __init__(self, name: str, pace: str = "turns", method: str = "joint") -> None:
        self.bank = bank_of(name)
        self.setup = make_setup(self.bank, pace=pace, method=method)
        self.machine = Companion(self.setup)
        self.adviser = Adviser(self.setup, self.bank, lambda _: robot_of(name, method))
        self.run: CompanionRun = self.machine.begin()
        self.commands: list[SharedCommand] = []

    def tell(self, *events: SharedEvent) -> list[SharedCommand]:
        self.commands = []
        for event in events:
            self.run, commands = self.machine.step(self.run, event)
            self.adviser.watch(self.run, event, commands)
            self.commands += commands
        return self.commands

    def do(
        self, text: str, t: float = 0.0, outcome: str = ev.DONE, until: float | None = None
    ) -> int:
        name, *args = text.split()
        self.tell(shared.Begun(t, "", name, tuple(args)))
        number = next(c.number for c in self.commands if isinstance(c, ev.Dispatch))
        self.tell(ev.Ended(t if until is None else until, number, outcome))
        return number

    def robot(self, t: float = 0.0) -> shared.Chosen:
        """Let the robot decide, and what it begins end at once."""
        self.tell(ev.Settled(t))
        (ask,) = (c for c in self.commands if isinstance(c, shared.AskStep))
        chosen = self.adviser.answer(ask)
        assert isinstance(chosen, shared.Chosen)
        self.tell(chosen)
        for command in self.commands:
            if isinstance(command, ev.Dispatch):
                self.tell(ev.Ended(t, command.number, ev.DONE))
        return chosen

    @property
    def state(self) -> JointState:
        state = self.adviser.fold.state(self.run.history)
        assert isinstance(state, JointState)
        return state

    @property
    def posterior(self) -> list[float]:
        return self.adviser.assistant.posterior(self.state).tolist()  # type: ignore[no-any-return]

    @property
    def agents(self) -> dict[Any, Any]:
        fold = self.adviser.joint.agents
        return fold.values(fold.belief(self.run.history))


def asked(table: Table) -> shared.Ask:
    """Ask a question about the goal, whatever the robot thinks of it."""
    table.tell(ev.Settled(0.0))
    names = table.bank.names[:2]
    table.tell(shared.Chosen(0.0, asks=names))
    (ask,) = (c for c in table.commands if isinstance(c, shared.Ask))
    assert ask == shared.Ask(0.0, shared.GOAL, (*names, shared.OTHER))
    return ask


def test_an_answer_is_evidence_and_the_robot_still_has_its_turn() -> None:
    table = Table("hall")
    table.do("go ann b a")
    ask = asked(table)
    table.tell(shared.Answered(0.0, "no such goal"))
    assert table.run.question == ask
    before = table.posterior
    table.tell(shared.Answered(0.0, ask.options[1]))
    assert table.run.history[-1] == AskedGoal(ask.options[:-1], ask.options[1])
    assert table.posterior[1] > 0.5 > before[1]
    assert table.robot().action or table.run.has_acted


def test_something_else_rules_out_what_was_asked_about() -> None:
    table = Table("hall")
    table.do("go ann b a")
    ask = asked(table)
    table.tell(shared.Answered(0.0, shared.OTHER))
    assert sum(table.posterior[: len(ask.options) - 1]) < 0.1


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_who_goes_on_has_not_answered(pace: str) -> None:
    table = Table("hall", pace)
    table.do("go ann b a")
    ask = asked(table)
    table.do("take ann cup a")
    assert AskedGoal(ask.options[:-1], "") in table.run.history
    assert table.run.question is None
    assert not [c for c in table.commands if isinstance(c, ev.Tell)]


def test_who_says_nothing_is_asked_again_at_a_higher_price_only() -> None:
    table = Table("hall")
    table.do("go ann b a")
    asked(table)
    before = table.posterior
    table.tell(shared.Passed(0.0))
    assert table.posterior == before
    situation = table.adviser.joint._situation(table.run.history, None, ("robot",))
    assert situation.asking.n_asked == 1
    assert situation.asking.chance_of_answer == 0.5


class Silent:
    """A person who stands still and answers nothing."""

    is_live = True

    def __init__(self, patience: int) -> None:
        self.patience = patience

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        self.patience -= 1
        if self.patience < 0:
            return (ev.StopAsked(run.t, "enough"),)
        return (shared.Passed(run.t, agents[0]),)


@pytest.mark.parametrize("pace", ["turns", "free"])
@pytest.mark.parametrize("name", ["hall", "kitchen"])
def test_people_who_stand_still_are_not_nagged(name: str, pace: str) -> None:
    """Questions become dearer, and the robot does nothing that it would undo."""
    setup = make_setup(bank_of(name), pace=pace, method="joint")
    adviser = Adviser(setup, bank_of(name), lambda _: robot_of(name))
    run = parts_with(setup, bank_of(name), adviser, Silent(30)).run()
    assert sum(isinstance(mark, AskedGoal) for mark in run.history) <= 7
    if name == "hall":
        assert not [mark for mark in run.history[-8:] if isinstance(mark, BegunAction)]


def test_a_goal_that_is_not_all_is_less_likely_afterwards() -> None:
    table = Table("hall", "free")
    table.do("go ann b c")
    table.do("take ann key c")
    table.do("use ann key")
    before = table.posterior
    table.tell(ev.Settled(0.0))
    table.tell(shared.Answered(0.0, shared.NO))
    assert DeniedGoals(("key",)) in table.run.history
    key = table.bank.names.index("key")
    assert table.posterior[key] < before[key] / 5


def test_what_people_say_about_themselves_takes_steps_over() -> None:
    table = Table("kitchen")
    for thing in ("pan", "pasta"):
        table.do(f"get human {thing}")
        table.tell(ev.Settled(0.0), shared.Chosen(0.0), ev.Settled(0.0))
    table.do("pour human pasta pan")
    table.tell(shared.StateTold(0.0, {("capacity", "human", "stove"): 9}))
    assert table.agents[("capacity", "human", "stove")] > 20
    chosen = table.robot()
    assert "stove" in chosen.args
    assert chosen.takes_over == f"{chosen.action} would fail with human (90 %)"


def test_an_interaction_is_an_option_like_a_step() -> None:
    """Who is tired is reminded; who is not, is not."""
    table = Table("coached")
    table.do("cut ann rope")
    assert table.robot().action in ("cut", "pack", "")
    tired = Table("coached")
    tired.tell(shared.StateTold(0.0, {("motivation", "ann"): 8}))
    tired.do("cut ann rope")
    assert tired.agents[("motivation", "ann")] > 10
    chosen = tired.robot()
    assert (chosen.action, chosen.args) == ("remind", ("robo", "ann"))
    assert tired.agents.get(("motivation", "ann"), 1) == 1
    tired.tell(ev.Settled(0.0))
    tired.do("pack ann rope red")
    assert tired.robot().action != "remind"


def test_failures_and_lateness_are_evidence_of_the_agent_state() -> None:
    table = Table("kitchen", "free")
    assert table.agents == {}
    for t in range(3):
        table.do("get human pan", t, ev.FAILED)
    assert table.agents[("motivation", "human")] > 2
    late = Table("kitchen", "free")
    late.do("get human pan", 0.0, until=4.0)
    assert late.agents
    assert Table("kitchen", "free", "goal-only").do("get human pan", 0.0, ev.FAILED) == 0


def test_a_pause_says_something_where_there_is_something_to_do() -> None:
    fold = AgentFold(Table("kitchen").setup.model, Table("kitchen").setup.profile,
                     lambda history, agent: 0.2)  # fmt: skip
    idle = AgentFold(Table("kitchen").setup.model, Table("kitchen").setup.profile,
                     lambda history, agent: 1.0)  # fmt: skip
    pause, tired = (PassedTurn("human"),), ("motivation", "human")

    def risk(fold: AgentFold, history: History) -> float:
        return fold.belief(history).experience.failing()[tired]  # type: ignore[union-attr]

    assert risk(fold, pause) > 3 * risk(idle, pause)
    assert risk(fold, pause * 3) == risk(fold, pause)  # a pause that goes on is one pause
    assert risk(fold, (PassedTurn("robot"),)) == risk(fold, ())


def test_an_observed_state_corrects_the_beliefs_world() -> None:
    """The cup is suddenly with ann, while the robot is on its way."""
    table = Table("hall", "free", "goal-only")
    table.tell(ev.Settled(0.0), shared.Chosen(0.0, "go", ("robot", "c", "b")))
    facts = frozenset(table.run.run.state.facts)
    seen = table.machine.observer.actions.changing(table.run.run.state)
    moved = seen - {("on", "cup", "a")} | {("has", "ann", "cup")}
    assert ("on", "cup", "a") in facts
    table.tell(ev.Observed(0.5, moved), ev.Settled(0.5))
    task = table.bank.goals.task
    believed = task.facts_of(table.state.world)
    assert ("has", "ann", "cup") in believed
    assert ("at", "robot", "b") in believed  # what runs counts as done
    table.tell(ev.Ended(1.0, 0, ev.DONE))
    assert task.facts_of(table.state.world) == believed
    table.do("use ann cup", 2.0)
    assert ("ready", "cup") in task.facts_of(table.state.world)


def test_an_action_that_fails_after_the_correction_has_not_happened() -> None:
    table = Table("hall", "free", "goal-only")
    table.tell(ev.Settled(0.0), shared.Chosen(0.0, "go", ("robot", "c", "b")))
    seen = table.machine.observer.actions.changing(table.run.run.state)
    table.tell(ev.Observed(0.5, seen - {("on", "key", "c")} | {("has", "ann", "key")}))
    table.tell(ev.Settled(0.5))
    table.tell(ev.Ended(1.0, 0, ev.FAILED))
    believed = table.bank.goals.task.facts_of(table.state.world)
    assert ("at", "robot", "c") in believed
    assert ("has", "ann", "key") in believed


@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_undo_is_never_having_done_it_for_goal_and_agent_state(data: st.DataObject) -> None:
    with_x, without_x = Table("workshop", "free"), Table("workshop", "free")
    task = with_x.bank.goals.task

    def possible(table: Table) -> list[str]:
        state = task.state_of(table.run.run.state.facts)
        actions = (task.actions[i] for i in task.applicable(state))
        return sorted(" ".join((a.name, *a.args)) for a in actions if a.agent == "ann")

    def both() -> None:
        kind = data.draw(st.sampled_from(["step", "failed", "pass", "answer"]))
        left = sorted(set(possible(with_x)) & set(possible(without_x)))
        text = data.draw(st.sampled_from(left)) if left else ""
        for table in (with_x, without_x):
            if kind == "pass":
                table.tell(shared.Passed(0.0, "ann"))
            elif kind == "answer":
                asked(table)
                table.tell(shared.Answered(0.0, table.bank.names[0]))
            elif text:
                table.do(text, outcome=ev.DONE if kind == "step" else ev.FAILED)

    for _ in range(data.draw(st.integers(0, 3))):
        both()
    outcome = data.draw(st.sampled_from([ev.DONE, ev.FAILED]))
    x = with_x.do(data.draw(st.sampled_from(possible(with_x))), outcome=outcome)
    for _ in range(data.draw(st.integers(0, 2))):
        both()
    with_x.tell(shared.Undone(0.0, x))
    assert with_x.posterior == pytest.approx(without_x.posterior, abs=1e-12)
    assert with_x.state.none == pytest.approx(without_x.state.none, abs=1e-12)
    assert with_x.state.world == without_x.state.world
    assert with_x.agents == without_x.agents


def played(path: Path | None, name: str, pace: str, resume: bool = False) -> Collaboration:
    bank = bank_of(name)
    course = Course((1, 0), turns=(2,), mistake_rate=0.2, wait_rate=0.2, seed="b")
    return carry_out_collaboration(
        make_setup(bank, pace=pace, method="joint"),
        lambda setup: simulated(
            setup, bank, course, make_assistant=lambda _: robot_of(name), nature=Nature(1)
        ),
        journal=path, resume=resume,
    )  # fmt: skip


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_a_collaboration_with_questions_killed_at_any_line_goes_on(
    tmp_path: Path, pace: str
) -> None:
    path = tmp_path / "whole.jsonl"
    whole = played(path, "transport", pace)
    assert whole.outcome.success
    assert replay_collaboration(read_journal(path)).difference is None
    lines = path.read_bytes().splitlines(keepends=True)
    for n in range(0, len(lines) + 1, 16):
        killed = tmp_path / "killed.jsonl"
        killed.write_bytes(b"".join(lines[:n]))
        again = played(killed, "transport", pace, resume=True)
        assert again.outcome == whole.outcome
        assert killed.read_bytes() == b"".join(lines)


def test_steady_agents_make_it_the_robot_of_changed_mind() -> None:
    """In an episode of turns, without questions and waits: step by step."""
    bank, robot = bank_of("kitchen"), robot_of("kitchen", "joint-without-asking")
    for seed in ("a", "b", "c"):
        course = Course((1, 0), turns=(3,), mistake_rate=0.1, seed=seed)
        record = play(bank, Frontier(bank, course), ExpectedHelp(bank), course)
        steps = [(turn.is_human, turn.step) for turn in record.turns]
        setup = make_setup(bank, method="joint-without-asking")
        ours: list[tuple[bool, int | None]] = []

        def watch(run: Any, event: Any, commands: Any, ours: Any = ours) -> None:
            if isinstance(event, shared.Begun | shared.Chosen):
                words = (event.action, *event.args)
                is_human = isinstance(event, shared.Begun)
                ours.append((is_human, bank.table.find(words) if event.action else None))

        simulated(setup, bank, course, make_assistant=lambda _: robot).run(watch=watch)
        assert ours[: len(steps)] == steps


def test_a_human_who_becomes_tired_is_helped_more() -> None:
    """The same episodes; what fails is drawn alike for both robots."""
    bank = bank_of("kitchen")
    change = StateChange(2.0, {("capacity", "human", "stove"): 10})
    failures = {}
    for method in ("joint-without-asking", "goal-only"):
        n = 0
        for seed in range(3):
            course = Course((seed % 3,), seed=str(seed))
            setup = make_setup(bank, method=method, seed=seed)
            nature = Nature(seed, (change,), sensed="before")
            robot = robot_of("kitchen", method)
            parts = simulated(setup, bank, course, nature=nature,
                              make_assistant=lambda _, robot=robot: robot)  # fmt: skip
            n += sum(parts.run().run.counts.failed.values())
        failures[method] = n
    assert failures["joint-without-asking"] < failures["goal-only"]


def test_robots_have_names() -> None:
    for name in (*JOINT_ROBOTS, "hrcplan", "rhp"):
        check_robot(name)
    with pytest.raises(UsageError) as error:
        check_robot("jont")
    assert "joint" in str(error.value.hint)
    assert isinstance(BeliefFold(bank_of("hall"), robot_of("hall")).state(()), JointState)
