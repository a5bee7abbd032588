"""Planners side by side for callers with several threads: the same answers, and nothing is left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from hrcplan.errors import PlannerError, UnsupportedError
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.race import can_race
from hrcplan.planners.solve import Result, solve
from tests.planners.actors import Actor, dies, improves, only, refuses_to_end, walk
from tests.planners.test_process import await_that, children, is_running

ROOT = Path(__file__).parents[2]
CODE = "from tests.planners.actors import main; main()"


@pytest.fixture
def cast(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    def put(**acts: Callable[[Request], Answer]) -> None:
        only(monkeypatch, {name: Actor(name, act) for name, act in acts.items()})

    return put


def in_threads(n: int = 1, **options: Any) -> list[Result]:
    """Return what ``auto`` says in ``n`` threads at the same time."""
    with ThreadPoolExecutor(n) as threads:
        calls = [threads.submit(solve, walk(), timeout_s=30, **options) for _ in range(n)]
        assert not can_race()
        return [call.result() for call in calls]


def test_threads_get_the_plans_of_planners_side_by_side(cast: Callable[..., None]) -> None:
    cast(one=improves)
    objectives = list[object]()
    for result in in_threads(2, on_better=lambda result: objectives.append(result.objective)):
        assert (result.planner, result.objective, result.status) == ("one", 1, Status.SOLVED)
        assert result.problem == walk()
    assert objectives.count(2) == 2


def test_a_planner_that_does_not_end_is_ended(cast: Callable[..., None]) -> None:
    before = set(children(os.getpid()))
    cast(one=refuses_to_end, two=improves)
    (result,) = in_threads(any_plan=True)
    assert result.planner == "two"
    assert set(children(os.getpid())) <= before


def test_a_race_whose_process_is_killed_is_an_error(cast: Callable[..., None]) -> None:
    cast(one=dies)
    with pytest.raises(PlannerError, match="race of planners was lost"):
        in_threads()


def test_errors_of_a_race_are_those_of_the_planners(cast: Callable[..., None]) -> None:
    cast(one=unsupported)
    with pytest.raises(UnsupportedError, match="cannot hold it"):
        in_threads()


def unsupported(request: Request) -> Answer:
    raise UnsupportedError("it cannot hold it")


def test_built_in_planners_prove_the_same_in_a_thread() -> None:
    with ThreadPoolExecutor(1) as threads:
        result = threads.submit(solve, read("transport", "two-boxes"), timeout_s=30).result()
    assert (result.planner, result.status, result.gap) == ("exact", Status.OPTIMAL, 0)


@pytest.mark.parametrize("thread", ["main", "another"])
def test_nothing_outlives_a_killed_process(thread: str) -> None:
    program = [sys.executable, "-c", CODE, thread]
    caller = subprocess.Popen(program, cwd=ROOT)
    try:
        await_that(lambda: "sleep" in names(below(caller.pid)))
        pids = below(caller.pid)
    finally:
        caller.kill()
        caller.wait()
    await_that(lambda: not any(map(is_running, pids)))
    assert -caller.returncode == signal.SIGKILL


def below(pid: int) -> list[int]:
    """Return all processes below one."""
    pids = [pid]
    for one in pids:  # grows while it is walked
        pids.extend(children(one))
    return pids[1:]


def names(pids: list[int]) -> set[str]:
    """Return the names of the programs of processes that still run."""
    paths = [Path(f"/proc/{pid}/comm") for pid in pids]
    return {path.read_text().strip() for path in paths if path.exists()}
