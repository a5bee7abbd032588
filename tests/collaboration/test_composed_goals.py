"""People who want none of the goals that are listed: goals composed of goal facts are weighed."""

import random
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import pytest

from hrcplan.assistance.joint_help import NONE_PRIOR, JointHelp
from hrcplan.bank import Bank, build, build_bank, composed_goals
from hrcplan.bank.composed_goals import (
    GoalComposer,
    composed_formula,
    composed_name,
    with_composed,
)
from hrcplan.bank.cost_to_go import NEVER, CostToGo, cost_to_go_of
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import MOST_COMPOSED, Adviser
from hrcplan.collaboration.collaborate import (
    Collaboration,
    CollaborationParts,
    assistant_of,
    carry_out_collaboration,
    make_setup,
    parts_with,
)
from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.history import (
    BegunAction,
    ComposedGoals,
    PassedTurn,
    SeenWait,
    composed_in,
    evidence_in,
)
from hrcplan.collaboration.journal import replay_collaboration
from hrcplan.collaboration.persons import SimulatedPerson
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import CollaborationSetup
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.execution.journal import read_journal
from tests.worlds import world

SHELVES = """
(define (domain shelves) (:requirements :strips :typing)
  (:types agent thing shelf - object)
  (:predicates (controllable ?a - agent) (loose ?x - thing) (clean ?x - thing)
               (on ?x - thing ?s - shelf))
  (:action clean :parameters (?a - agent ?x - thing)
    :precondition (loose ?x) :effect (clean ?x))
  (:action put :parameters (?a - agent ?x - thing ?s - shelf)
    :precondition (clean ?x) :effect (and (on ?x ?s) (not (loose ?x)))))
"""
SHELF_PROBLEM = """
(define (problem {name}) (:domain shelves)
  (:objects ann robo - agent cup jar pot can - thing top low - shelf)
  (:init (controllable robo) (loose cup) (loose jar) (loose pot) (loose can))
  (:goal (and {goal})))
"""
LISTED = {
    "cups": "(on cup top) (on jar low)",
    "pots": "(on pot top) (on can low)",
    "mixed": "(on cup low) (on can top)",
}
OUTSIDE = "on can low + on cup top"
EXCHANGED = "box-at blue wp5 + box-at red wp0"


@lru_cache
def shelves() -> Bank:
    return build(world(SHELVES, SHELF_PROBLEM, LISTED))


@lru_cache
def transport() -> Bank:
    return build_bank("transport", "transport-goals")


def bank_of(name: str) -> tuple[Bank, str]:
    return (shelves(), OUTSIDE) if name == "shelves" else (transport(), EXCHANGED)


def collaborate_outside(
    name: str, seed: int, pace: str, journal: Path | None = None, resume: bool = False
) -> Collaboration:
    """Return a collaboration with people whose goal is not listed."""
    bank, goal = bank_of(name)
    full = build(bank.goals.plus([goal], [composed_formula(goal)]))

    def make_parts(setup: CollaborationSetup) -> CollaborationParts:
        adviser = Adviser(setup, bank, assistant_of(setup))
        course = Course((len(full.names) - 1,), seed=str(setup.seed))
        human = HUMANS.make("frontier", full, course)
        return parts_with(setup, bank, adviser, SimulatedPerson(setup, full, human, course))

    setup = make_setup(bank, pace=pace, method="joint", seed=seed)
    return carry_out_collaboration(setup, make_parts, journal=journal, resume=resume)


@pytest.mark.parametrize("pace", ["free", "turns"])
@pytest.mark.parametrize("name", ["shelves", "transport"])
def test_people_with_a_goal_outside_of_the_list_are_helped_to_it(name: str, pace: str) -> None:
    runs = [collaborate_outside(name, seed, pace) for seed in range(2 if name == "shelves" else 1)]
    assert any(done.outcome.success for done in runs)
    for done in runs:
        assert len(composed_in(done.run.history)) <= MOST_COMPOSED
        if done.outcome.success:
            assert bank_of(name)[1] in done.outcome.reached


def test_a_journal_with_composed_goals_is_derived_again_and_resumed(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    whole = collaborate_outside("shelves", 1, "turns", path)
    assert any(isinstance(mark, ComposedGoals) for mark in whole.run.history)
    assert replay_collaboration(read_journal(path)).difference is None
    lines = path.read_text().splitlines(keepends=True)
    for n in random.Random(0).sample(range(2, len(lines)), 4):
        path.write_text("".join(lines[:n]))
        resumed = collaborate_outside("shelves", 1, "turns", path, resume=True)
        assert resumed.outcome == whole.outcome
        assert path.read_text() == "".join(lines)


def test_goals_are_composed_a_few_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A prompt never waits for all of them; to rank them costs no look at all states."""
    bank = transport()
    cost_to_go_of(bank).of(0, 0)
    monkeypatch.setattr(composed_goals, "MOST_LOOKED_AT", 1)
    done = collaborate_outside("transport", 0, "free")
    assert EXCHANGED in done.outcome.reached
    history = done.run.history
    places = [i for i, mark in enumerate(history) if isinstance(mark, ComposedGoals)]
    assert len(composed_in(history)) == len(places) > 1
    for first, second in pairwise(places):
        assert any(isinstance(m, BegunAction | PassedTurn) for m in history[first:second])
    passes: list[int] = []
    monkeypatch.setattr(CostToGo, "_lower", lambda *args: passes.append(1))
    composer = GoalComposer(bank)
    states = [bank.initial, bank.table.successor(bank.initial, 0)]
    composer.compose([(states[0], states[1] or states[0])], 3)
    assert passes == []
    with_composed(bank, [EXCHANGED])
    assert 1 <= len(passes) <= len(cost_to_go_of(bank)._costs)


def test_a_name_says_which_facts_a_goal_has() -> None:
    facts = frozenset({("on", "cup", "top"), ("on", "can", "low")})
    assert composed_name(facts) == OUTSIDE
    goals = shelves().goals
    larger = goals.plus([OUTSIDE], [composed_formula(OUTSIDE)])
    assert larger.task is goals.task
    assert larger.names[:-1] == goals.names


def test_composed_goals_explain_what_people_did() -> None:
    bank = shelves()
    moves, state = [], bank.initial
    for words in (("clean", "cup"), ("put", "cup", "top"), ("clean", "can"), ("put", "can", "low")):
        step = bank.table.find(words)
        assert step is not None
        after = bank.table.successor(state, step)
        assert after is not None
        moves.append((state, after))
        state = after
    names = GoalComposer(bank).compose(moves, 3)
    assert names[0] == OUTSIDE
    assert len(names) == 3
    assert GoalComposer(bank).compose(moves, 2, names[:1]) == names[1:]
    assert GoalComposer(bank).compose([], 3) == []


def test_goals_of_a_team_are_added_without_looking_at_all_states_again() -> None:
    bank = transport()
    held = cost_to_go_of(bank)
    plain = held.of(held.place(bank.initial), 0)
    larger = with_composed(bank, [EXCHANGED, "box-at red wp0 + box-at red wp1"])
    assert larger.names == (*bank.names, EXCHANGED)  # a box is at one place only
    costs = cost_to_go_of(larger)
    assert costs._targets is held._targets
    to_go = costs.of(costs.place(bank.initial), 0)
    assert to_go[:-1].tolist() == plain.tolist()
    assert 0 < to_go[-1] < NEVER


def test_composed_goals_have_a_small_prior() -> None:
    larger = with_composed(shelves(), [OUTSIDE, "on cup top"])
    posterior = JointHelp(larger).posterior(JointHelp(larger).start())
    assert posterior[-2:].sum() < 2 * NONE_PRIOR


def test_of_composed_goals_only_a_probable_one_ends_it() -> None:
    setup = make_setup(shelves(), method="joint")
    machine = Companion(setup)
    run = machine.begin().plus(ComposedGoals((OUTSIDE,)))
    for p, is_asked in ((0.4, False), (0.6, True)):
        run = with_facts(run, p)
        question = machine._done_question(run)
        assert (question is not None and question.options == (OUTSIDE,)) == is_asked


def with_facts(run: CompanionRun, p: float) -> CompanionRun:
    """Return a run in which the outside goal holds, and has a probability."""
    facts = frozenset({*run.run.state.facts, ("on", "cup", "top"), ("on", "can", "low")})
    state = replace(run.run.state, facts=facts)
    belief = shared.Chosen(0.0, goals=((OUTSIDE, p), ("cups", 1 - p)))
    return replace(run, run=replace(run.run, state=state), belief=belief)


def test_standing_still_is_an_event_of_free_pace_only() -> None:
    for pace, n in (("free", 1), ("turns", 0)):
        machine = Companion(make_setup(shelves(), pace=pace, method="joint"))
        run, _ = machine.step(machine.begin(), shared.Idle(5.0, 5.0))
        assert run.t == 5.0
        assert [mark.agent for mark in run.history if isinstance(mark, PassedTurn)] == ["ann"] * n


def test_who_stands_still_on_and_on_shows_something_when_it_has_lasted_twice_as_long() -> None:
    history = (PassedTurn("ann"),) * 9
    goes_on = [mark.goes_on for mark in evidence_in(history) if isinstance(mark, SeenWait)]
    assert [n for n, more in enumerate(goes_on, start=1) if not more] == [1, 2, 4, 8]
