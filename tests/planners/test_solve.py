"""The checked result: fallback, the cost guard, and every lie a planner could tell."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace

import pytest

from hrcplan.errors import (
    CostGuardError,
    MissingPlannerError,
    PlannerError,
    UnsupportedError,
    UsageError,
)
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Arithmetic, Constant, Function, Problem
from hrcplan.planners import registry
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.solve import compare, solve
from hrcplan.plans import parse_plan
from tests.planners.actors import only
from tests.worlds import problem_from

GOOD = """\
0.000: (move human wp1 wp4) [50]
0.000: (move robot wp0 wp3) [50]
50.001: (grasp human blue wp4) [50]
50.001: (grasp robot green wp3) [50]
100.002: (move human wp4 wp5) [50]
100.002: (move robot wp3 wp2) [50]
150.003: (place human blue wp5) [50]
150.003: (place robot green wp2) [50]
"""


@dataclass
class Scripted:
    """A planner that answers what it was told to."""

    answer: Answer | Exception
    absent: str | None = None
    card: Capabilities = field(
        default_factory=lambda: Capabilities("scripted", "answers by heart", temporal=True)
    )

    def missing(self) -> str | None:
        return self.absent

    def solve(self, request: Request) -> Answer:
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


class Impatient:
    """A planner that uses up its time: a class that ``module:Class`` can name."""

    card = Capabilities("impatient", "sleeps", temporal=True)

    def missing(self) -> str | None:
        return None

    def solve(self, request: Request) -> Answer:
        time.sleep(min(request.time_left_s, 2))
        return Answer(Status.UNSOLVED, note=f"slept with {request.time_left_s:.0f} s left")


@pytest.fixture(scope="module")
def two_boxes() -> Problem:
    return read("transport", "two-boxes")


def solved(text: str, **claims: object) -> Answer:
    return Answer(Status.SOLVED, parse_plan(text), **claims)  # type: ignore[arg-type]


def test_a_good_answer_is_replayed(two_boxes: Problem) -> None:
    found = solve(two_boxes, Scripted(solved(GOOD)))
    assert found.report is not None
    assert found.report.valid
    assert found.report.cost == 24
    assert float(found.objective or 0) == pytest.approx(24 + 0.17 * 200.003)


def test_an_invalid_plan_is_the_planners_error(two_boxes: Problem) -> None:
    broken = GOOD.replace("50.001: (grasp human blue wp4) [50]\n", "")
    with pytest.raises(PlannerError, match=r"invalid plan.*holding human blue"):
        solve(two_boxes, Scripted(solved(broken)))


def test_a_plan_is_kept_where_the_planner_has_another_figure_for_it(two_boxes: Problem) -> None:
    claim = Answer(Status.OPTIMAL, parse_plan(GOOD), objective=57)
    found = solve(two_boxes, Scripted(claim))
    assert found.status is Status.SOLVED  # what it counted, it counted wrong
    assert float(found.objective or 0) == pytest.approx(58, abs=0.01)
    assert found.mismatch is not None
    assert "reports 57 for a plan that costs 58.00051" in found.mismatch
    with pytest.raises(CostGuardError, match=r"reports 57 .* costs 58\.00051"):
        compare([found])


def test_rounding_of_a_reported_metric_is_no_lie(two_boxes: Problem) -> None:
    from fractions import Fraction

    assert solve(two_boxes, Scripted(solved(GOOD, objective=Fraction("58.001")))).plan is not None


def test_unsolvable_is_refuted_by_a_plan(two_boxes: Problem) -> None:
    no = solve(two_boxes, Scripted(Answer(Status.UNSOLVABLE)))
    yes = solve(two_boxes, Scripted(solved(GOOD)))
    with pytest.raises(CostGuardError, match="says unsolvable"):
        compare([no, yes])


def test_an_unproven_answer_is_never_better_than_a_proven_one(two_boxes: Problem) -> None:
    slow = GOOD.replace("150.003: (place human", "160.003: (place human")
    proven = solve(two_boxes, Scripted(Answer(Status.OPTIMAL, parse_plan(slow))))
    better = solve(two_boxes, Scripted(solved(GOOD)))
    compare([proven, proven])
    with pytest.raises(CostGuardError, match=r"claims 59\.70051 is optimal"):
        compare([proven, better])


def test_an_answer_holds_plan_and_status_together() -> None:
    with pytest.raises(ValueError, match="with plan None"):
        Answer(Status.SOLVED)
    with pytest.raises(ValueError, match="UNSOLVED"):
        Answer(Status.UNSOLVED, parse_plan("(a)"))


def test_a_missing_planner_says_what_to_install(two_boxes: Problem) -> None:
    with pytest.raises(MissingPlannerError, match="install it"):
        solve(two_boxes, Scripted(Answer(Status.UNSOLVED), absent="install it"))


@pytest.mark.parametrize(
    "trouble",
    [PlannerError("crashed with code 139"), UnsupportedError("too odd"), None],
    ids=["crash", "declines", "timeout"],
)
def test_auto_goes_on_with_the_next_planner(
    two_boxes: Problem, trouble: Exception | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = Scripted(trouble or Answer(Status.UNSOLVED), card=Capabilities(
        "first", "fails", temporal=True, metric="cost+time", proves=True))  # fmt: skip
    second = Scripted(solved(GOOD))
    only(monkeypatch, {"second": second, "first": first})
    found = solve(two_boxes)
    assert found.planner == "scripted"
    assert [a.planner for a in found.attempts] == ["first", "scripted"]
    assert found.attempts[0].outcome.startswith(str(trouble) if trouble else "unsolved")


def test_auto_gives_the_error_if_nobody_can(
    two_boxes: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "names", lambda: ("only",))
    monkeypatch.setattr(registry, "make", lambda name: Scripted(PlannerError("crashed")))
    with pytest.raises(PlannerError, match="crashed"):
        solve(two_boxes)


def test_the_limit_is_for_all_planners_together(
    two_boxes: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "names", lambda: ("a", "b", "c"))
    monkeypatch.setattr(registry, "make", lambda name: Impatient())
    begun = time.monotonic()
    found = solve(two_boxes, timeout_s=3)  # six seconds if each had its own
    assert time.monotonic() - begun < 5.9
    assert found.status is Status.UNSOLVED
    assert len(found.attempts) == 3


def test_a_planner_can_be_named_by_its_class(two_boxes: Problem) -> None:
    assert registry.make("hrcplan.planners.exact:ExactPlanner").card.name == "exact"
    with pytest.raises(UsageError, match=r"there is no module 'nowhere\.at_all'"):
        registry.make("nowhere.at_all:Planner")


def test_an_unknown_planner_gets_a_hint() -> None:
    with pytest.raises(UsageError) as error:
        registry.make("fast-downwart")
    assert error.value.hint == "did you mean 'fast-downward'?"


def test_a_gap_more_is_no_contradiction(two_boxes: Problem) -> None:
    from fractions import Fraction

    dear = replace(two_boxes, metric=Arithmetic("*", (Constant(9), Function("total-time"))))
    more = GOOD.replace(
        "150.003: (place human blue wp5) [50]", "150.007: (place human blue wp5) [50]"
    )
    proven = solve(dear, Scripted(Answer(Status.OPTIMAL, parse_plan(more))))
    better = solve(dear, Scripted(solved(GOOD)))
    assert proven.objective == Fraction("200.007") * 9
    compare([proven, better])


def test_without_a_metric_a_temporal_plan_is_as_good_as_it_is_short(two_boxes: Problem) -> None:
    found = solve(replace(two_boxes, metric=None), Scripted(solved(GOOD)))
    assert found.report is not None
    assert found.objective == found.report.makespan_s


FREE = """(define (domain warm) (:requirements :strips :durative-actions)
  (:predicates (cold) (warm)) (:durative-action heat :parameters ()
    :duration (and (>= ?duration 2) (<= ?duration 5))
    :condition (at start (cold)) :effect (at end (warm))))"""
FREE_PROBLEM = "(define (problem p) (:domain warm) (:init (cold)) (:goal (warm)))"


def test_a_planner_without_time_gets_the_shortest_duration_that_is_free() -> None:
    problem = problem_from(FREE, FREE_PROBLEM)
    found = solve(problem, Scripted(Answer(Status.SOLVED, parse_plan("(heat)"))))
    assert found.plan is not None
    assert [action.duration_s for action in found.plan.actions] == [2]
