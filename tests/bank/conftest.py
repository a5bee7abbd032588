"""Small worlds, and plans counted the slow way: by walking every sequence."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.bank import Bank, Goals, build_bank, from_problems
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText
from hrcplan.task import Task

DATA = Path(__file__).parents[1] / "data" / "goal-recognition"


@pytest.fixture(scope="session")
def kitchen() -> Bank:
    return build_bank("kitchen")


@pytest.fixture(scope="session")
def instances() -> Path:
    return DATA


def _read_world(domain: str, *problems: str) -> Goals:
    model = domain_in(SourceText("domain", domain))
    return from_problems([problem_in(model, SourceText("problem", text)) for text in problems])


@pytest.fixture(scope="session")
def read_world() -> Callable[..., Goals]:
    return _read_world


@dataclass(frozen=True)
class Brute:
    """All sequences of labels up to a cost, found by depth-first search over whole states."""

    task: Task
    labels: tuple[tuple[str, ...], ...]
    costs: tuple[Fraction, ...]

    def optimum(self) -> Fraction | None:
        best: dict[int, Fraction] = {self.task.initial: Fraction(0)}
        waiting = [self.task.initial]
        while waiting:
            waiting.sort(key=lambda s: best[s])
            state = waiting.pop(0)
            if self.task.is_goal(state):
                return best[state]
            for action in self.task.applicable(state):
                after, cost = self.task.successor(state, action), best[state] + self.costs[action]
                if cost < best.get(after, cost + 1):
                    best[after] = cost
                    waiting.append(after)
        return None

    def plans(
        self, bound: Fraction, max_steps: int = 1000
    ) -> dict[tuple[tuple[str, ...], ...], Fraction]:
        """Return label sequences that first reach the goal within a cost, and what they cost."""
        found: dict[tuple[tuple[str, ...], ...], Fraction] = {}

        def walk(state: int, path: tuple[tuple[str, ...], ...], paid: Fraction) -> None:
            if self.task.is_goal(state):
                found[path] = min(paid, found.get(path, paid))
                return
            if len(path) == max_steps:
                return
            options: dict[tuple[str, ...], tuple[Fraction, int]] = {}
            for action in self.task.applicable(state):
                option = (self.costs[action], self.task.successor(state, action))
                label = self.labels[action]
                if label not in options or option[0] < options[label][0]:
                    options[label] = option
            for label, (cost, after) in options.items():
                if paid + cost <= bound:
                    walk(after, (*path, label), paid + cost)

        walk(self.task.initial, (), Fraction(0))
        return found

    def reaches(self, path: Sequence[tuple[str, ...]]) -> bool:
        """Whether labels can be done one after the other (a step may change nothing) to a goal."""
        state = self.task.initial
        for label in path:
            can = [
                i for i, other in enumerate(self.labels)
                if other == label
                and any(state & mask == value for mask, value in self.task.actions[i].tests)
            ]  # fmt: skip
            if not can:
                return False
            state = self.task.successor(state, can[0])
        return self.task.is_goal(state)

    def irredundant(self, path: Sequence[tuple[str, ...]]) -> bool:
        return not any(self.reaches([*path[:i], *path[i + 1 :]]) for i in range(len(path)))


def _brute(bank: Bank, goal: int = 0) -> Brute:
    task = bank.goals.task.with_goal(bank.goals.formulas[goal])
    kept = bank.agents == "kept"
    labels = tuple((a.name, *a.args) if kept else a.step for a in task.actions)
    unit = bank.recipe.cost == "steps"
    return Brute(task, labels, tuple(Fraction(1) if unit else Fraction(c) for c in task.costs))


@pytest.fixture(scope="session")
def brute() -> Callable[..., Brute]:
    return _brute


def _words(bank: Bank, plans: Iterator[tuple[int, ...]]) -> list[tuple[tuple[str, ...], ...]]:
    return [tuple(bank.table[step].words for step in plan) for plan in plans]


@pytest.fixture(scope="session")
def words() -> Callable[..., list[tuple[tuple[str, ...], ...]]]:
    return _words
