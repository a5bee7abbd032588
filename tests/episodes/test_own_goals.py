"""Humans with goals of their own: whose steps are evidence of what, and who helps whom."""

from collections import deque
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.oracle import Oracle
from hrcplan.assistance.per_human import PerHuman
from hrcplan.bank import Bank, build, build_bank
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.episodes.episode import REACHED, play
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.episodes.measures import changes, guesses
from hrcplan.episodes.own_goals import own_lengths, play_own_goals
from hrcplan.errors import UsageError
from hrcplan.inference.adaptive import AdaptiveBelief
from hrcplan.inference.exact import ExactBelief
from hrcplan.inference.run import infer
from hrcplan.studies import report_study, run_study
from tests.worlds import world

# Lamps in a row of rooms. Who can reach a switch lights its lamp; only the robot fits the last one.
LAMPS = """
(define (domain lamps) (:requirements :strips :typing)
  (:types agent room - object)
  (:predicates (controllable ?a - agent) (next ?p ?q - room) (at ?a - agent ?p - room)
    (reaches ?a - agent ?p - room) (lit ?p - room) (cut ?p - room))
  (:action go :parameters (?a - agent ?p ?q - room)
    :precondition (and (at ?a ?p) (next ?p ?q)) :effect (and (at ?a ?q) (not (at ?a ?p))))
  (:action light :parameters (?a - agent ?p - room)
    :precondition (and (at ?a ?p) (reaches ?a ?p)) :effect (lit ?p))
  (:action dim :parameters (?a - agent ?p - room)
    :precondition (and (at ?a ?p) (lit ?p)) :effect (not (lit ?p))))
"""
ROOMS = """
(define (problem {name}) (:domain lamps) (:objects robo HUMANS - agent a b c - room)
  (:init (controllable robo) (next a b) (next b a) (next b c) (next c b) (at robo b) STATE
    (reaches robo c))
  (:goal (and {goal})))
"""
GOALS = {"first": "(lit a)", "second": "(lit b)", "third": "(lit c)", "both": "(lit a) (lit b)"}
TWO = ("ann bob", "(at ann a) (at bob c) (reaches ann a) (reaches ann b) (reaches bob b)")
ONE = ("ann", "(at ann a) (reaches ann a) (reaches ann b)")


def lamps(humans: str, state: str) -> Bank:
    return build(world(LAMPS, ROOMS.replace("HUMANS", humans).replace("STATE", state), GOALS))


@pytest.fixture(scope="module")
def two():
    return lamps(*TWO)


@pytest.fixture(scope="module")
def one():
    return lamps(*ONE)


@pytest.fixture(scope="module")
def recipes():
    return build_bank("kitchen", only=["parfait-nut", "parfait-fruit", "smoothie-berry"])


def brute_force(bank: Bank, goal: int, state: int, turn: int, acting: set[str]) -> int | None:
    """Return the fewest timesteps to a goal if only some agents act, and the others wait."""
    task, queue, seen = bank.goals.task, deque([(state, turn, 0)]), {(state, turn)}
    while queue:
        state, turn, n = queue.popleft()
        if bank.goals.is_reached(goal, state):
            return n
        agent, after = bank.team[turn], [state]
        if agent in acting:
            after += [task.successor(state, i) for i, action in enumerate(task.actions)
                      if action.agent == agent and task.is_applicable(state, i)]  # fmt: skip
        for other in after:
            key = other, (turn + 1) % len(bank.team)
            if key not in seen:
                seen.add(key)
                queue.append((*key, n + 1))
    return None


@pytest.mark.parametrize("human", ["ann", "bob"])
def test_costs_of_a_human_count_on_no_other_human(two, human):
    moves, rng = TeamMoves(two.for_human(human)), np.random.default_rng(0)
    state, moment = two.initial, Moment()
    for _ in range(25):
        own = moves.costs.of(moves.costs.place(state), moment.turn, human=human)
        for goal in range(len(two.names)):
            expected = brute_force(two, goal, state, moment.turn, {human, "robo"})
            assert expected == (None if own[goal] >= NEVER else own[goal] // TIMESTEP)
        choices = moves.choices(state, moment)
        if two.team[moment.turn] not in (human, "robo"):
            assert not choices.is_next.any()
            assert choices.waits.all()
        step = rng.choice(np.array([*choices.steps, -1]))
        state = moves.state_after(state, None if step < 0 else int(step))
        moment = moves.after(moment, None if step < 0 else int(step))


def steps_of(bank: Bank, *texts: str) -> list[int]:
    return [bank.table.find(tuple(text.split())) for text in texts]


def test_what_one_human_does_is_evidence_of_its_own_goal_only(two):
    helper = PerHuman(two, AdaptiveBelief)
    start = helper.start()
    (light,) = steps_of(two, "light ann a")
    after = helper.observe(start, light)
    assert helper.posterior_of(after, "bob") == pytest.approx(helper.posterior_of(start, "bob"))
    assert helper.posterior_of(after, "ann")[two.goal_index("third")] < 0.05
    mean = (helper.posterior_of(after, "ann") + helper.posterior_of(after, "bob")) / 2
    assert helper.posterior(after) == pytest.approx(mean)


def test_a_goal_that_is_shared_is_the_product_of_what_each_human_has_shown(two):
    belief = ExactBelief(two)
    steps = steps_of(two, "light ann a", "go bob c b", "go robo b c", "go ann a b")
    doers = ["ann", "bob", "robo", "ann"]
    scores = []
    for evidence in ({"ann", "bob"}, {"ann"}, {"bob"}):
        state = belief.start()
        for step, who in zip(steps, doers, strict=True):
            state = belief.observe(state, step, robot=who not in evidence)
        scores.append(np.log(belief.posterior(state)))
    gap = scores[0] - scores[1] - scores[2]
    assert gap == pytest.approx(np.full(len(gap), gap[0]), abs=1e-6)


@settings(deadline=None, max_examples=6)
@given(st.data())
def test_with_one_human_nothing_changes(one, recipes, data):
    bank = data.draw(st.sampled_from([one, recipes]))
    first, second = data.draw(st.permutations(range(len(bank.names))))[:2]
    rate = data.draw(st.sampled_from([0.0, 0.2]))
    course = Course((first, second), (data.draw(st.integers(1, 4)),), rate, 0.0, "s")
    (human,) = bank.humans
    record = play(bank, Frontier(bank, course), ExpectedHelp(bank), course)
    own = play_own_goals(
        bank, {human: Frontier(bank.for_human(human), course)}, PerHuman(bank, AdaptiveBelief),
        {human: course},
    )  # fmt: skip
    assert tuple(replace(turn, agent=None) for turn in own.turns) == record.turns
    assert (own.ending, guesses(own), changes(own)) == (
        record.ending, guesses(record), changes(record),
    )  # fmt: skip


def test_everybody_gets_what_it_wants(two):
    first, second, both = map(two.goal_index, ("first", "second", "both"))
    courses = {"ann": Course((first, both), (2,), seed="a"), "bob": Course((second,), seed="b")}
    humans = {who: Frontier(two.for_human(who), course) for who, course in courses.items()}
    for make in (AdaptiveBelief, Oracle):
        record = play_own_goals(two, humans, PerHuman(two, make), courses)
        assert record.ending == REACHED
        assert {turn.agent for turn in record.turns} == set(two.team)
        assert guesses(record).first_correct is not None


def test_a_robot_alone_can_help_the_human_who_cannot(two):
    lengths = dict(zip(two.names, own_lengths(two.for_human("bob")), strict=True))
    assert lengths["first"] == np.inf
    assert lengths["third"] < 10
    courses = {"ann": Course((two.goal_index("first"),)), "bob": Course((two.goal_index("third"),))}
    humans = {who: Frontier(two.for_human(who), course) for who, course in courses.items()}
    assert play_own_goals(two, humans, PerHuman(two, Oracle), courses).ending == REACHED


def test_unknown_humans(two, one, recipes):
    with pytest.raises(UsageError, match="no human 'eve'"):
        two.for_human("eve")
    assert one.for_human("ann") is one
    actions = ["(light ann a)", "(go bob c b)"]
    found = infer(two, actions, "exact", goals_per="human")
    assert list(found.humans) == ["ann", "bob"]
    rows = [one.posterior[-1] for one in found.humans.values()]
    assert found.posterior[-1] == pytest.approx(np.mean(rows, axis=0))
    assert found.as_json()["humans"]["bob"]["posterior"][0] == found.as_json()["posterior"][0]
    assert found.humans["bob"].posterior[1] == found.humans["bob"].posterior[0]
    with pytest.raises(UsageError, match="not per 'robot'"):
        infer(two, actions, goals_per="robot")
    same = infer(recipes, ["(get berries)"], goals_per="human")
    assert same == infer(recipes, ["(get berries)"])
    assert not same.humans


def test_study_with_goals_per_human(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "domain.pddl").write_text(LAMPS)
    problem = ROOMS.replace("HUMANS", TWO[0]).replace("STATE", TWO[1])
    options = {"domain": "domain.pddl", "goals_per": "human", "methods": "hrcplan,oracle",
               "humans": "optimal", "chooser": "frontier"}  # fmt: skip

    def rows(folder: str, more: str = "") -> bytes:
        goals = f"goals{len(more)}"
        (tmp_path / goals).mkdir(exist_ok=True)
        for name in ("first", "second", "both"):
            text = problem.replace("(reaches bob b)", f"(reaches bob b) {more}")
            (tmp_path / goals / f"{name}.pddl").write_text(text.format(name=name, goal=GOALS[name]))
        target = tmp_path / folder
        run_study("changed-mind", target, limit=8, options={**options, "goals": goals},
                  tables=["rows"])  # fmt: skip
        return (target / "rows.sqlite").read_bytes()

    with pytest.raises(UsageError, match="bob can reach fewer than two goals"):
        rows("few")
    assert not (tmp_path / "few").exists()
    assert rows("one", "(reaches bob a)") == rows("two", "(reaches bob a)")
    report = report_study(tmp_path / "one")
    assert {row["measures"]["reached_pct"]["mean"] for row in report["rows"]} == {100.0}
