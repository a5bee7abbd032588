"""Changes of the world at given times: text or objects, of any fact, or refused with a reason."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hrcplan import execute, read
from hrcplan.agents import load_profile
from hrcplan.errors import UsageError
from hrcplan.execution.execute import prepare_run
from hrcplan.execution.journal import read_journal
from hrcplan.execution.replay import replay
from hrcplan.execution.worlds.simulated import FactChange, Nature, StateChange

TASK = "transport/two-boxes"
MOTIVATION = ("motivation", "human")


def test_text_is_read_as_on_the_command_line() -> None:
    texts = ["motivation human=9@0", "(Box-At blue wp0)@60", "not (box-at blue wp4)@60"]
    objects = [
        StateChange(0.0, {MOTIVATION: 9}),
        FactChange(60.0, adds=frozenset({("box-at", "blue", "wp0")})),
        FactChange(60.0, deletes=frozenset({("box-at", "blue", "wp4")})),
    ]
    natures = [prepare_run(read(TASK), changes=c).setup.nature for c in (texts, objects)]
    assert natures[0] == natures[1]
    assert execute(TASK, changes=texts).outcome == execute(TASK, changes=objects).outcome


def test_a_problem_and_a_profile_may_be_objects() -> None:
    by_name = execute(
        "transport", "two-boxes", profile="replan-always", changes=["motivation human=9@0"]
    )
    by_object = execute(read(TASK), profile=load_profile("replan-always"),
                        changes=[StateChange(0, {MOTIVATION: 9})])  # fmt: skip
    assert by_name.outcome == by_object.outcome
    assert by_name.outcome.replans == 1


@pytest.mark.parametrize(
    "change", ["not reach robot wp2@10", "not path wp3 wp2@60", "not reach robot wp2@0"]
)
def test_a_fact_that_no_action_changes_takes_effect(change: str, tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    done = execute(TASK, changes=[change], journal=path)
    words = change[4:].split("@")[0]
    (message, *_) = [p.why for p in done.timeline.plans if p.why]
    assert message == f"deviation: ({words}) does not hold"
    # After the replan no action needs the fact: neither a move between the two, nor there.
    moved = [bar.args for bar in done.timeline.bars.values() if bar.action == "move"]
    assert ("robot", "wp3", "wp2") not in moved
    assert done.outcome.success
    assert replay(read_journal(path)).difference is None
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[: len(lines) // 2]))
    assert execute(TASK, changes=[change], journal=path, resume=True).outcome == done.outcome


def test_without_the_only_way_there_is_no_plan() -> None:
    done = execute(TASK, changes=["not reach robot wp2@10", "not reach human wp2@10"])
    assert done.outcome.ending == "no plan"


def test_a_fact_that_is_new_takes_effect_too() -> None:
    problem = read(TASK)
    apart = problem.facts - {("path", "wp3", "wp2")}
    done = execute(replace(problem, facts=apart), changes=["path wp3 wp2@20"])
    assert done.outcome.replans_deviation == 1
    assert done.outcome.makespan_s == execute(TASK).outcome.makespan_s


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ({"changes": "motivation human=9@0"}, "a list of changes, not one text"),
        ({"changes": [3]}, "a change is a text, a StateChange or a FactChange, not int"),
        ({"profile": 3}, "profile is str or Profile, not int"),
        ({"human": 3}, "human is a text, or an object with a method nature"),
        ({"seed": 1.5}, "seed is int or str, not float"),
        ({"replan_limit": "many"}, "replan_limit is int or None, not str"),
        ({"planner": 3}, "planner is str or Planner, not int"),
    ],
)
def test_wrong_types_are_refused(argument: dict[str, Any], words: str) -> None:
    with pytest.raises(TypeError, match=words):
        execute(TASK, **argument)


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ({"changes": [FactChange(5.0, frozenset({("box-at", "blue")}))]}, "takes 2 objects"),
        ({"changes": [FactChange(-1.0)]}, "not a number from 0 on"),
        ({"changes": [StateChange(0.0, {("mood", "human"): 3})]}, "no function 'mood'"),
        ({"values": {("motivatio", "human"): 3}}, "no function 'motivatio'"),
        ({"planner": "exat"}, "there is no planner 'exat'"),
    ],
)
def test_unknown_words_are_refused(argument: dict[str, Any], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        execute(TASK, **argument)


class Distracted:
    """A human of one's own, given as an object."""

    def nature(self, problem: object, seed: object) -> Nature:
        return Nature(seed, (StateChange(0.0, {MOTIVATION: 9}),))


def test_a_human_may_be_an_object() -> None:
    assert (
        execute(TASK, human=Distracted()).outcome
        == execute(TASK, changes=["motivation human=9@0"]).outcome
    )


@pytest.mark.parametrize(
    ("old", "new"), [("case1", "uncooperative"), ("case2,random", "partly-cooperative,random")]
)
def test_humans_by_their_earlier_names(old: str, new: str) -> None:
    expected = execute(TASK, human=new, seed=3)
    with pytest.warns(DeprecationWarning, match=f"'{old.split(',')[0]}' is deprecated"):
        done = execute(TASK, human=old, seed=3)
    assert done.outcome == expected.outcome
    with pytest.warns(DeprecationWarning, match="'row' is deprecated; its name is 'outcome'"):
        assert done.row == done.outcome


def test_runs_are_short_in_print() -> None:
    done = execute(TASK)
    assert len(repr(done)) < 200
    assert repr(done.run).startswith("Run(goal reached, t=200, 8 actions done, 0 failed")
    assert repr(done.outcome) == "Outcome(goal reached, 200 s, 0 replans, 8 actions done, 0 failed)"


HAUL = """(define (domain haul) (:requirements :strips :typing :numeric-fluents :durative-actions)
 (:types agent place - object)
 (:predicates (controllable ?a - agent) (at ?a - agent ?p - place) (road ?x ?y - place))
 (:functions (fuel ?a - agent) (far ?x ?y - place))
 (:durative-action go :parameters (?a - agent ?x ?y - place) :duration (= ?duration (far ?x ?y))
  :condition (and (at start (at ?a ?x)) (at start (road ?x ?y)) (at start (>= (fuel ?a) 2)))
  :effect (and (at start (not (at ?a ?x))) (at end (at ?a ?y)) (at start (decrease (fuel ?a) 2))))
 (:durative-action refuel :parameters (?a - agent ?x - place) :duration (= ?duration 5)
  :condition (over all (at ?a ?x)) :effect (at end (increase (fuel ?a) 4))))"""
HAUL_PROBLEM = """(define (problem one) (:domain haul) (:objects r - agent a b c d - place)
 (:init (controllable r) (at r a) (road a b) (road b d) (road b c) (road c d) (= (fuel r) 4)
  (= (far a b) 10) (= (far b d) 10) (= (far b c) 11) (= (far c d) 11))
 (:goal (at r d)) (:metric minimize (total-time)))"""


@pytest.mark.parametrize(
    ("change", "reason", "roads"),
    [
        ("fuel r=0@3", "(fuel r) is 0", ["a b", "b d"]),
        ("far b d=100@3", "(far b d) is 100", ["a b", "b c", "c d"]),
        ("not road b d@3", "(road b d) does not hold", ["a b", "b c", "c d"]),
    ],
)
def test_numbers_and_static_facts_are_planned_with_before_an_action_fails(
    change: str, reason: str, roads: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "run.jsonl"
    done = execute(HAUL, HAUL_PROBLEM, changes=[change], journal=path)
    assert done.outcome.success
    assert done.outcome.failed_robot == 0
    bars = done.timeline.bars.values()
    assert [" ".join(bar.args[1:]) for bar in bars if bar.action == "go"] == roads
    assert [bar.action for bar in bars].count("refuel") == 1
    assert [plan.why for plan in done.timeline.plans] == ["", f"deviation: {reason}"]
    assert replay(read_journal(path)).difference is None


def test_an_object_that_appears_is_refused_with_what_to_do() -> None:
    with pytest.raises(UsageError, match="'red' is no box of the problem") as caught:
        execute(TASK, changes=["box-at red wp2@10"])
    assert "has to stand in :objects" in (caught.value.hint or "")
