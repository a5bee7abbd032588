"""The laws of planners, kept by a built-in one and broken on purpose."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest

from hrcplan import read
from hrcplan.errors import PlannerError
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.registry import make
from hrcplan.plans import Plan
from hrcplan.testing import check_planner


@pytest.fixture(scope="module")
def problem() -> Problem:
    return read("transport", "handover")


class Wrapped:
    """A good planner; each class below changes its answer."""

    def __init__(self) -> None:
        self.inner = make("exact")
        self.card: Capabilities = replace(self.inner.card, name="wrapped")

    def missing(self) -> str | None:
        return None

    def solve(self, request: Request) -> Answer:
        return self.inner.solve(request)


class Late(Wrapped):
    def solve(self, request: Request) -> Answer:
        answer = self.inner.solve(request)
        time.sleep(0.2)
        return answer


class Hasty(Wrapped):
    """Its plan has no steps."""

    def solve(self, request: Request) -> Answer:
        return Answer(Status.SOLVED, Plan(()))


class Boastful(Wrapped):
    """It reports another cost than its plan has."""

    def solve(self, request: Request) -> Answer:
        return replace(self.inner.solve(request), objective=1)


class Hopeless(Wrapped):
    def solve(self, request: Request) -> Answer:
        return Answer(Status.UNSOLVABLE)


class Silent:
    card = Capabilities("silent", "cannot solve")


def test_a_good_planner_keeps_the_laws(problem: Problem) -> None:
    (result,) = check_planner(Wrapped(), [problem])
    assert result.status is Status.OPTIMAL


@pytest.mark.parametrize("kind", [Hasty, Boastful, Hopeless])
def test_a_planner_with_a_wrong_answer(problem: Problem, kind: type[Wrapped]) -> None:
    with pytest.raises(PlannerError):
        check_planner(kind(), [problem])


def test_a_planner_that_is_late(problem: Problem) -> None:
    with pytest.raises(AssertionError, match="wrapped answered after"):
        check_planner(Late(), [problem], timeout_s=20, slack_s=-20)


def test_what_is_no_planner(problem: Problem) -> None:
    with pytest.raises(AssertionError, match="Silent lacks"):
        check_planner(Silent(), [problem])  # type: ignore[arg-type]
