"""What is believed of several planners, and that the best plan that was seen is returned."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from joblib.externals.loky import get_reusable_executor

from hrcplan.errors import LimitError, PlannerError, UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.planners.choice import fixed_order
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.race import cores
from hrcplan.planners.solve import Result, solve
from hrcplan.plans import Plan, parse_plan
from tests.planners.actors import LONG, SHORT, Actor, only, walk


def says(status: Status, plan: str | None = None, **more: Any) -> Callable[[Request], Answer]:
    found = None if plan is None else parse_plan(plan)
    return lambda request: Answer(status, found, **more)


@pytest.fixture(autouse=True)
def one_thread() -> None:
    """Planners run side by side where there is one thread; workers of earlier studies have some."""
    get_reusable_executor().shutdown(wait=True)


@pytest.fixture
def cast(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    def put(**acts: Callable[[Request], Answer]) -> None:
        only(monkeypatch, {name: Actor(name, act) for name, act in acts.items()})

    return put


def test_one_claim_of_unsolvable_is_not_believed(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVABLE), two=says(Status.UNSOLVED))
    found = solve(walk(), timeout_s=10)
    assert found.status is Status.UNSOLVED
    assert "one said unsolvable" in found.why


def test_two_claims_of_unsolvable_are_believed(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVABLE), two=says(Status.UNSOLVABLE))
    assert solve(walk(), timeout_s=10).status is Status.UNSOLVABLE


def test_a_plan_refutes_a_claim_of_unsolvable(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVABLE), two=says(Status.SOLVED, LONG))
    found = solve(walk(), timeout_s=10)
    assert (found.status, found.planner) == (Status.SOLVED, "two")
    refuted = [a.outcome for a in found.attempts if a.planner == "one"]
    assert refuted == ["unsolvable, which the plan of 'two' refutes"]


def test_a_claim_of_a_planner_that_was_named_is_checked(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVABLE), two=says(Status.SOLVED, LONG))
    found = solve(walk(), "one", timeout_s=10)
    assert found.status is Status.UNSOLVED
    assert any("'two' has a valid plan" in attempt.outcome for attempt in found.attempts)


@pytest.mark.parametrize("order", ["better-first", "better-last"])
def test_the_best_plan_is_returned(order: str, cast: Callable[..., None]) -> None:
    good, bad = says(Status.SOLVED, SHORT), says(Status.SOLVED, LONG)
    first, second = (good, bad) if order == "better-first" else (bad, good)
    cast(one=first, two=second)
    found = solve(walk(), timeout_s=10)
    assert (found.objective, found.status) == (1, Status.SOLVED)


def test_a_better_plan_refutes_a_proof(cast: Callable[..., None]) -> None:
    def wrong(request: Request) -> Answer:
        time.sleep(0.3)
        return Answer(Status.OPTIMAL, parse_plan(LONG))

    cast(one=wrong, two=says(Status.SOLVED, SHORT))
    found = solve(walk(), timeout_s=10)
    assert (found.objective, found.status) == (1, Status.SOLVED)


def test_a_bound_and_a_plan_of_two_planners_are_a_proof(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVED, bound=1), two=says(Status.SOLVED, SHORT))
    found = solve(walk(), timeout_s=10)
    assert (found.status, found.bound, found.gap) == (Status.OPTIMAL, 1, 0)


def test_the_gap_is_relative_to_the_bound(cast: Callable[..., None]) -> None:
    cast(one=says(Status.UNSOLVED, bound=1), two=says(Status.SOLVED, LONG))
    found = solve(walk(), timeout_s=10)
    assert (found.status, found.bound, found.gap) == (Status.SOLVED, 1, 1)


@pytest.mark.parametrize(
    ("bound", "reason"),
    [
        (1, None),
        (None, "not agent state"),
        (0, "a bound of 0"),
        (3, "refutes"),
    ],
)
def test_a_gap_that_is_missing_has_a_reason(
    bound: int | None, reason: str | None, cast: Callable[..., None]
) -> None:
    cast(one=says(Status.UNSOLVED, bound=bound), two=says(Status.SOLVED, LONG))
    result = solve(walk(), timeout_s=10)
    assert (result.gap is None) == (reason is not None)
    assert (reason or "None") in str(result.gap_reason)


def test_of_plans_to_maximize_the_larger_is_better(cast: Callable[..., None]) -> None:
    cast(one=says(Status.SOLVED, SHORT), two=says(Status.SOLVED, LONG))
    found = solve(walk("(:metric maximize (views))"), timeout_s=10)
    assert found.objective == 2


def test_plans_on_the_way_are_kept_when_time_is_up(cast: Callable[..., None]) -> None:
    def slow(request: Request) -> Answer:
        request.on_plan(parse_plan(LONG))
        time.sleep(60)
        raise AssertionError

    cast(one=slow)
    told: list[Result] = []
    begun = time.monotonic()
    found = solve(walk(), timeout_s=3, on_better=told.append)
    assert time.monotonic() - begun < 30
    assert (found.objective, found.planner) == (2, "one")
    assert [result.objective for result in told] == [2]


def test_only_planners_that_race_search_with_several_threads(cast: Callable[..., None]) -> None:
    def act(request: Request) -> Answer:
        return Answer(Status.UNSOLVED, note=f"{request.n_threads} threads")

    cast(one=act)
    notes = [solve(walk(), name, timeout_s=10).attempts[0].outcome for name in ("auto", "one")]
    assert all(note.endswith(f"{cores()} threads") for note in notes)
    assert solve(walk(), Actor("one", act), timeout_s=10).attempts[0].outcome == "1 threads"


def test_an_invalid_plan_on_the_way_counts_for_nothing(cast: Callable[..., None]) -> None:
    def act(request: Request) -> Answer:
        request.on_plan(parse_plan("(go b c)"))
        return Answer(Status.SOLVED, parse_plan(LONG))

    cast(one=act)
    assert solve(walk(), timeout_s=10).objective == 2


def test_a_crash_of_one_leaves_the_others(cast: Callable[..., None]) -> None:
    def crash(request: Request) -> Answer:
        os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(60)
        raise AssertionError

    cast(one=crash, two=says(Status.SOLVED, SHORT))
    found = solve(walk(), timeout_s=20)
    assert found.plan == Plan(parse_plan(SHORT).actions)
    cast(one=crash)
    with pytest.raises(PlannerError, match="without an answer"):
        solve(walk(), timeout_s=20)


def test_a_limit_is_told_from_a_refusal(cast: Callable[..., None]) -> None:
    def declines(request: Request) -> Answer:
        raise UnsupportedError("it declines")

    def runs_out(request: Request) -> Answer:
        raise LimitError("too large")

    cast(one=declines, two=says(Status.UNSOLVED, note="no plan in time"))
    assert solve(walk(), timeout_s=10).status is Status.UNSOLVED
    cast(one=declines, two=runs_out)
    with pytest.raises(LimitError):
        solve(walk(), timeout_s=10)
    cast(one=declines)
    with pytest.raises(UnsupportedError):
        solve(walk(), timeout_s=10)


def test_no_planner_outlives_the_call(cast: Callable[..., None]) -> None:
    seen = os.pipe()

    def stays(request: Request) -> Answer:
        os.write(seen[1], f"{os.getpid()} ".encode())
        time.sleep(60)
        raise AssertionError

    cast(one=stays, two=stays)
    solve(walk(), timeout_s=0.4)
    for pid in os.read(seen[0], 100).split():
        with pytest.raises(ProcessLookupError):
            os.kill(int(pid), 0)


def test_memory_is_for_all_planners_together(cast: Callable[..., None]) -> None:
    def eats(request: Request) -> Answer:
        held = bytearray(os.urandom(1 << 20)) * 600
        time.sleep(60)
        return Answer(Status.UNSOLVED, note=str(len(held)))

    cast(one=eats, two=says(Status.SOLVED, SHORT))
    begun = time.monotonic()
    found = solve(replace(walk()), timeout_s=30, memory_bytes=600 << 20)
    assert found.objective == 1
    assert time.monotonic() - begun < 25
    assert any("memory" in attempt.outcome for attempt in found.attempts)


def test_shipped_problems_are_still_proven_by_exact() -> None:
    found = solve(read("transport", "two-boxes"))
    assert (found.planner, found.status, found.gap) == ("exact", Status.OPTIMAL, 0)


def test_planners_of_sequences_come_last_where_time_counts() -> None:
    order = fixed_order(read("transport", "two-boxes"))
    assert order.index("kairos") < order.index("fast-downward")
    order = fixed_order(read("kitchen", "pasta-bean"))
    assert order.index("fast-downward") < order.index("kairos")
