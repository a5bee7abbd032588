"""Which planners are asked, in which order, and what is grounded for that."""

from __future__ import annotations

import subprocess
import sys

import pytest

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.choice import all_jobs, jobs
from hrcplan.planners.contract import LazyTask, Request
from hrcplan.planners.fast_downward_input import downward_input
from tests.planners.actors import walk


def names(request: Request) -> list[str]:
    return [job.name for job in jobs(request)]


def test_quick_planners_stand_first_for_any_plan() -> None:
    order = names(Request(read("kitchen", "pasta-bean"), any_plan=True))
    assert order[:2] == ["kairos", "fast-downward"]
    assert order.index("uniform-cost") > order.index("enhsp")


def test_kairos_searches_in_two_ways_for_any_plan_with_times() -> None:
    problem = read("transport", "two-boxes")
    assert names(Request(problem, any_plan=True))[:2] == ["kairos", "kairos"]
    assert names(Request(problem)).count("kairos") == 1


def test_nothing_is_grounded_for_any_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    def begin(*_: object) -> bool:
        raise AssertionError("it grounds")

    monkeypatch.setattr(LazyTask, "begin", begin)
    request = Request(read("kitchen", "pasta-bean"), any_plan=True)
    assert list(jobs(request))
    assert downward_input(request).lowering is None


def test_grounding_is_tried_once_to_tell_what_is_numeric() -> None:
    request = Request(walk("(:metric maximize (views))"))
    assert request.ground_quickly() is False
    assert "enhsp" in names(request)
    assert "fast-downward" not in names(request)


@pytest.mark.parametrize("any_plan", [True, False])
@pytest.mark.parametrize(
    "problem",
    [
        read("kitchen", "pasta-bean"),
        read("transport", "two-boxes"),
        walk("(:metric maximize (views))"),
    ],
    ids=["classical", "temporal", "numeric"],
)
def test_the_first_job_is_the_first_of_all(problem: Problem, any_plan: bool) -> None:
    request = Request(problem, any_plan=any_plan)
    in_turn = [(job.name, job.any_plan, job.why) for job in jobs(request)]
    assert in_turn == [(job.name, job.any_plan, job.why) for job in all_jobs(request)]


def test_other_planners_are_imported_after_the_first_was_taken() -> None:
    code = """if True:
        import sys
        from hrcplan.pddl.inputs import read
        from hrcplan.planners.choice import jobs
        from hrcplan.planners.contract import Request
        waiting = jobs(Request(read("transport", "two-boxes")))
        assert next(waiting).name == "exact"
        assert "hrcplan.planners.kairos" not in sys.modules
        assert "kairos" in [job.name for job in waiting]
    """
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
