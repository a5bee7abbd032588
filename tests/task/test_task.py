"""Laws of the task that need no oracle: names, order, limits, changed values, determinism."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan import ground
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.task import Task, reachable


def test_names_agents_and_steps() -> None:
    task = ground("transport", "two-boxes")
    move = task.actions[task.find("move", ["human", "wp1", "wp4"])[0]]
    assert (move.agent, move.step, move.duration) == ("human", ("move", "wp1", "wp4"), 50)
    take = task.actions[task.find("take", ["robot", "green", "human", "wp2"])[0]]
    assert (take.agent, take.step) == ("robot", ("take", "green", "human", "wp2"))
    assert str(take) == "(take robot green human wp2)"
    assert task.find("fly", ["robot"]) == []


def test_actions_stand_in_the_order_of_the_files() -> None:
    task = ground("transport", "two-boxes")
    schemas = [action.name for action in task.problem.domain.actions]
    objects = list(task.problem.all_objects)
    keys = [(schemas.index(a.name), [objects.index(o) for o in a.args]) for a in task.actions]
    assert keys == sorted(keys)
    assert [a.index for a in task.actions] == list(range(len(task.actions)))


def test_facts_that_never_change_have_no_bit() -> None:
    task = ground("transport", "two-boxes")
    assert {fact[0] for fact in task.facts} == {"at", "box-at", "free", "holding", "idle"}
    assert task.state_of(task.problem.facts) == task.initial


def test_agent_free() -> None:
    assert ground("kitchen", "stew-lentil").is_agent_free
    assert not ground("transport", "two-boxes").is_agent_free


def test_prices_follow_the_agent_state_without_grounding_anew() -> None:
    task = ground("transport", "two-boxes")
    changed = task.with_values({("motivation", "human"): 8, ("capacity", "human", "wp4"): 2})
    assert changed.actions is task.actions
    index = task.find("move", ["human", "wp1", "wp4"])[0]
    assert (task.costs[index], changed.costs[index]) == (3, 11)
    robot = task.find("move", ["robot", "wp0", "wp4"])[0]
    assert (task.costs[robot], changed.costs[robot]) == (3, 3)
    assert task.costs[index] == 3, "the old task keeps its prices"


def test_values_that_shape_actions_ground_anew(small_problem: Problem) -> None:
    task = Task(small_problem)
    for key, value in list(small_problem.values.items())[:6]:
        for new in (0, value + 1, Fraction(5, 2)):
            problem = small_problem.with_values({key: new})
            changed, fresh = task.with_values({key: new}), Task(problem)
            assert changed.actions == fresh.actions
            assert changed.costs == fresh.costs
            assert (changed.initial, changed.goal) == (fresh.initial, fresh.goal)


def test_a_task_can_be_sent_to_another_process() -> None:
    task = ground("kitchen", "stew-lentil")
    other: Task = pickle.loads(pickle.dumps(task))
    assert other.applicable(other.initial) == task.applicable(task.initial)
    assert other.costs == task.costs


WALK = """
import random
from hrcplan import ground
for name in ("transport/boxes-4", "kitchen/stew-lentil"):
    task = ground(*name.split("/"))
    print(task.facts, [str(a) for a in task.actions], task.costs, task.initial, task.goal)
    state, chance = task.initial, random.Random(1)
    for _ in range(40):
        state = task.successor(state, chance.choice(task.applicable(state)))
    print(state)
"""


def test_hash_seeds_change_nothing() -> None:
    runs = [
        subprocess.run(
            [sys.executable, "-c", WALK],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    ]
    assert runs[0] == runs[1]
    assert "move" in runs[0]


def made(folder: Path, effect: str, goal: str = "(p)", init: str = "", pre: str = "(and)") -> Task:
    (folder / "domain.pddl").write_text(f"""
      (define (domain d) (:requirements :adl :typing :numeric-fluents)
        (:types agent) (:predicates (p))
        (:functions (total-cost) (mood ?a - agent) (level))
        (:action pay :parameters (?a - agent) :precondition {pre}
          :effect (and (p) (increase (total-cost) (mood ?a)) {effect})))""")
    (folder / "problem.pddl").write_text(f"""
      (define (problem p) (:domain d) (:objects ann - agent)
        (:init (= (total-cost) 0) (= (mood ann) 20) (= (level) 1) {init}) (:goal {goal}))""")
    return Task(read(folder / "domain.pddl", folder / "problem.pddl"))


def test_sixteen_values_and_no_more(tmp_path: Path) -> None:
    task = made(tmp_path, "(decrease (mood ?a) 1)", pre="(> (mood ?a) 5)")
    assert len(task.actions) == 15
    assert [str(task.actions[i]) for i in task.applicable(task.initial)] == ["(pay ann)"]
    assert sorted(task.costs) == list(range(6, 21))
    with pytest.raises(UnsupportedError, match=r"\(mood ann\) takes more than 16 values"):
        made(tmp_path, "(decrease (mood ?a) 1)", pre="(> (mood ?a) 4)")


@pytest.mark.parametrize(
    ("effect", "goal", "words"),
    [
        ("(increase (level) 1)", "(p)", r"'pay' changes \(level …\), which is not agent state"),
        ("(assign (total-cost) 1)", "(p)", "does more with total-cost"),
        ("(increase (total-cost) (total-cost))", "(p)", "looks at total-cost"),
        ("", "(< (total-cost) 9)", "the goal looks at the cost"),
    ],
)
def test_numbers_that_bits_cannot_hold(tmp_path: Path, effect: str, goal: str, words: str) -> None:
    with pytest.raises(UnsupportedError, match=words) as caught:
        made(tmp_path, effect, goal)
    assert "enhsp" in str(caught.value.hint)


def test_too_many_alternatives_are_refused(tmp_path: Path) -> None:
    parts = " ".join(f"(or (q{i}) (r{i}))" for i in range(9))
    atoms = " ".join(f"(q{i}) (r{i})" for i in range(9))
    flips = " ".join(f"(when (q{i}) (and (r{i}) (not (q{i}))))" for i in range(9))
    (tmp_path / "domain.pddl").write_text(f"""
      (define (domain d) (:requirements :adl) (:predicates {atoms})
        (:action flip :parameters () :effect (and {flips}))
        (:action go :parameters () :precondition (and {parts}) :effect (not (r0))))""")
    (tmp_path / "problem.pddl").write_text(f"""
      (define (problem p) (:domain d) (:init {" ".join(f"(q{i})" for i in range(9))})
        (:goal (r0)))""")
    problem = read(tmp_path / "domain.pddl", tmp_path / "problem.pddl")
    with pytest.raises(UnsupportedError, match="more than 256 alternatives"):
        Task(problem)


def test_grounding_gives_up_where_memory_is_short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reachable, "_CHECK", 100)
    monkeypatch.setattr(reachable, "_CHECK_MEMORY", 100)
    assert reachable.available_bytes() > 0
    monkeypatch.setattr(reachable, "available_bytes", lambda: reachable.MIN_FREE_BYTES - 1)
    with pytest.raises(LimitError, match=r"no memory for more than \d+ ground actions"):
        Task(read("transport", "two-boxes"))


def test_a_goal_that_no_state_meets(tmp_path: Path) -> None:
    task = made(tmp_path, "", goal="(and (p) (not (p)))")
    assert task.goal == ()
    assert not task.is_goal(task.initial)


def test_start_and_finish_are_the_two_halves_of_an_action() -> None:
    task = ground("transport", "two-boxes")
    for index in task.applicable(task.initial):
        halfway = task.start(task.initial, index)
        action = task.actions[index]
        assert ("idle", action.agent) not in task.facts_of(halfway)
        assert task.finish(halfway, index) == task.successor(task.initial, index)
