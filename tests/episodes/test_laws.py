"""The laws of humans and worlds, kept by the built-in ones and broken on purpose."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from hrcplan.bank import Bank
from hrcplan.episodes.episode import SimulatedTurns
from hrcplan.episodes.humans import HUMANS, Course, Frontier, HumanMove
from hrcplan.testing import check_human, check_world

COURSES = [
    Course((0,), seed="steady"),
    Course((0, 1), turns=(2,), mistake_rate=0.3, wait_rate=0.2, seed="restless"),
]


@pytest.fixture(params=["workshop", "hall"])
def bank(request: pytest.FixtureRequest) -> Bank:
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("name", HUMANS.built_in)
def test_every_human_keeps_the_laws(bank: Bank, name: str) -> None:
    check_human(HUMANS.find(name), bank, COURSES)


class Unknown(Frontier):
    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        return HumanMove(len(self.bank.table))


class Impossible(Frontier):
    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        able = set(self.bank.table.able(world, range(len(self.bank.table)), self._doers))
        return HumanMove(next(s for s in range(len(self.bank.table)) if s not in able))


class Moody(Frontier):
    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        self.n_asked = getattr(self, "n_asked", 0) + 1
        return super().move(turn, world, last) if self.n_asked < 3 else HumanMove(None)


class Lucky(Frontier):
    """Its chance does not come from the course."""

    def __init__(self, bank: Bank, course: Course) -> None:
        super().__init__(bank, replace(course, wait_rate=0.5, seed=str(random.random())))


class Ashamed(Frontier):
    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        return HumanMove(None, is_mistake=True)


class Talking(Frontier):
    def move(self, turn: int, world: int, last: int | None) -> str:  # type: ignore[override]
        return "the red one"


class Absent:
    def __init__(self, bank: Bank, course: Course) -> None:
        pass


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Unknown, "there is no step"),
        (Impossible, "no human can do"),
        (Moody, "the same turn is answered differently"),
        (Lucky, "two humans of one course differ"),
        (Ashamed, "a wait is no mistake"),
        (Talking, "returns a HumanMove, not 'the red one'"),
        (Absent, "Absent has no move"),
    ],
)
def test_a_human_that_breaks_a_law(workshop: Bank, kind: type, message: str) -> None:
    with pytest.raises(AssertionError, match=message):
        check_human(kind, workshop, COURSES)


def plans(bank: Bank) -> list[tuple[int, ...]]:
    return [next(bank.plans(goal)) for goal in range(len(bank.names))]


def test_the_simulated_world_keeps_the_laws(bank: Bank) -> None:
    check_world(SimulatedTurns(bank), bank, plans(bank))


class Forgetful(SimulatedTurns):
    def do(self, state: int, action: int) -> int:
        return state


class Late(SimulatedTurns):
    """It goes on where the last episode ended."""

    state = None

    def begin(self) -> int:
        return super().begin() if self.state is None else self.state

    def do(self, state: int, action: int) -> int:
        self.state = super().do(state, action)
        return self.state


class Huge(SimulatedTurns):
    def do(self, state: int, action: int) -> int:
        return 1 << 10_000


class Wordy(SimulatedTurns):
    def do(self, state: int, action: int) -> str:  # type: ignore[override]
        return "cut"


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Forgetful, "has another effect"),
        (Late, "does not begin in the initial state"),
        (Huge, "facts that the task has not"),
        (Wordy, "returns the state as bits, not 'cut'"),
    ],
)
def test_a_world_that_breaks_a_law(workshop: Bank, kind: type, message: str) -> None:
    with pytest.raises(AssertionError, match=message):
        check_world(kind(workshop), workshop, plans(workshop))


def test_a_world_in_which_actions_may_fail(workshop: Bank) -> None:
    check_world(Forgetful(workshop), workshop, plans(workshop), is_exact=False)


def test_what_is_no_world(workshop: Bank) -> None:
    with pytest.raises(AssertionError, match="has no begin"):
        check_world(workshop, workshop, [])  # type: ignore[arg-type]
