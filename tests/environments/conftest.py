"""Banks of a few goals, in which it does not matter who acts, or agents take turns."""

from collections.abc import Iterator

import pytest

from hrcplan import build_bank
from hrcplan.bank import Bank
from hrcplan.bank.turn_moves import team_moves
from tests.episodes.test_own_goals import TWO, lamps
from tests.episodes.test_team import ONE_EACH, TWO_HUMANS, TWO_ROBOTS, yard

YARDS = {"one-each": ONE_EACH, "two-robots": TWO_ROBOTS, "two-humans": TWO_HUMANS}


@pytest.fixture(scope="session")
def kitchen() -> Bank:
    return build_bank("kitchen", only=["parfait-fruit", "parfait-nut", "smoothie-berry"])


@pytest.fixture(scope="session")
def transport() -> Iterator[Bank]:
    bank = build_bank("transport", "transport-goals", only=["blue-out", "door"])
    moves = team_moves(bank)  # which all tests share while it lives
    yield bank
    del moves


@pytest.fixture(scope="session")
def household() -> Iterator[Bank]:
    bank = build_bank("household", only=["dinner", "plant-care"])
    moves = team_moves(bank)
    yield bank
    del moves


@pytest.fixture(scope="session", params=["kitchen", "transport", "household"])
def bank(request: pytest.FixtureRequest) -> Bank:
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="session", params=YARDS)
def team(request: pytest.FixtureRequest) -> Iterator[Bank]:
    bank = yard(*YARDS[request.param])
    moves = team_moves(bank)
    yield bank
    del moves


@pytest.fixture(scope="session")
def own_goals() -> Bank:
    return lamps(*TWO)
