"""The oracle of the task tests: PDDL read straight off the lifted model, nothing compiled."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple

import pytest

from hrcplan.core.numbers import Number
from hrcplan.pddl.check import load_domain, load_problem
from hrcplan.pddl.model import DURATION, TOTAL_COST, Action, FluentKey, Problem
from hrcplan.pddl.semantics import LiftedState, Undefined, changes, evaluate, holds
from hrcplan.task import Task
from hrcplan.task.changing import value_fact

DATA = Path(__file__).parents[1] / "data" / "task"
COST: FluentKey = (TOTAL_COST,)
Name = tuple[str, ...]


class After(NamedTuple):
    """What follows from one action: the state, and what it cost."""

    state: LiftedState
    cost: Number


class Lifted:
    """A problem, replayed by sets and dictionaries over every type-correct binding."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.initial = LiftedState(problem.facts, {**problem.values, COST: 0})
        self.bindings = [
            (action, dict(zip((p.name for p in action.params), args, strict=True)))
            for action in problem.domain.actions
            for args in product(*(problem.objects_of(p.types) for p in action.params))
        ]

    def all_after(self, state: LiftedState) -> dict[Name, After]:
        """Return what each ground action leads to that can run in ``state`` and changes it."""
        found = {}
        for action, binding in self.bindings:
            after = self.after(state, action, binding)
            if after is not None and not self.same(after.state, state):
                found[action.name, *binding.values()] = after
        return found

    def after(self, state: LiftedState, action: Action, binding: dict[str, str]) -> After | None:
        """Return the state after start and end of an action, or None if it cannot run."""
        try:
            values = {**state.values, COST: 0}
            for op, duration in action.durations:
                if op == "=":
                    values[DURATION,] = evaluate(duration, values, binding)
            now = LiftedState(state.facts, values)
            for before, when in (("start", "start"), ("all", None), ("end", "end")):
                if not all(
                    holds(c.formula, now, binding, self.problem)
                    for c in action.conditions
                    if c.when == before
                ):
                    return None
                if when is not None:
                    effects = [e for e in action.effects if e.when == when]
                    now = changes(effects, now, binding, self.problem).apply(now)
        except Undefined:
            return None
        left = {key: value for key, value in now.values.items() if key != (DURATION,)}
        return After(LiftedState(now.facts, {**left, COST: 0}), now.values[COST])

    def bits(self, task: Task, state: LiftedState) -> int:
        """Return a lifted state in the bits of a task."""
        numbers = [value_fact(key, value) for key, value in state.values.items()]
        return task.state_of([*state.facts, *numbers])

    def compare(self, task: Task, state: LiftedState) -> dict[Name, After]:
        """Compare one state's actions, successors and costs; return what follows from it."""
        here = self.bits(task, state)
        wanted = self.all_after(state)
        chosen = task.applicable(here)
        found = {(task.actions[i].name, *task.actions[i].args): i for i in chosen}
        assert chosen == sorted(chosen)
        assert len(found) == len(chosen), "one action, offered for two values of a function"
        assert found.keys() == wanted.keys()
        for name, index in found.items():
            assert task.successor(here, index) == self.bits(task, wanted[name].state), name
            if COST[0] in task.problem.domain.functions:
                assert task.costs[index] == wanted[name].cost, name
        assert task.is_goal(here) == holds(task.problem.goal, state, {}, task.problem)
        return wanted

    @staticmethod
    def same(one: LiftedState, other: LiftedState) -> bool:
        return one.facts == other.facts and dict(one.values) == dict(other.values)


@pytest.fixture(scope="session")
def oracle() -> type[Lifted]:
    """The lifted reading of a problem, to compare a task with."""
    return Lifted


def read(name: str) -> Problem:
    """Return ``tests/data/task/NAME.pddl`` with the problem beside it."""
    return load_problem(load_domain(DATA / f"{name}.pddl"), DATA / f"{name}-problem.pddl")


def names() -> Iterator[str]:
    """Yield the names of the small domains."""
    return (p.stem for p in sorted(DATA.glob("*.pddl")) if not p.stem.endswith("-problem"))


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test with an argument ``small_problem`` runs for every small domain."""
    if "small_problem" in metafunc.fixturenames:
        found = list(names())
        metafunc.parametrize("small_problem", [read(name) for name in found], ids=found)
