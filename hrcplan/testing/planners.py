"""Laws of plans and planners."""

from __future__ import annotations

from collections.abc import Iterable

from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.planners.contract import Planner
from hrcplan.planners.solve import Result, compare, solve
from hrcplan.validation import Report, validate


def check_plan(domain: str, problem: str, plan: str) -> Report:
    """Return the replay of a plan, given as text in IPC format or as a file's path.

    Raises:
        AssertionError: if the plan is invalid; the message names the first wrong step.
    """
    text = plan if "(" in plan or not plan.strip() else read_text(plan)
    report = validate(domain, problem, text)
    step = "" if report.failed_step is None else f"step {report.failed_step + 1}: "
    if not report.valid:
        raise AssertionError(f"invalid plan for {domain}/{problem}: {step}{report.reason}")
    return report


def check_planner(
    planner: Planner, problems: Iterable[Problem], *, timeout_s: float = 20.0, slack_s: float = 3.0
) -> list[Result]:
    """Test the laws of planners, and return the planner's results.

    The planner answers in time. Its plans are valid and have the cost it reports (``solve`` checks
    that). A plan that it claims to be optimal is not worse than that of ``auto``; a problem that it
    calls unsolvable has no plan.

    Args:
        planner: The planner (see `hrcplan.planners.contract.Planner`).
        problems: Problems within the planner's capabilities.
        timeout_s: The limit for each problem, in seconds.
        slack_s: How much later than the limit the planner may answer, in seconds.

    Raises:
        AssertionError: if it has not the methods of a planner, or answers too late.
        PlannerError: if it is missing, gives an invalid plan, or its figures differ from hrcplan's.
    """
    assert isinstance(planner, Planner), f"{type(planner).__name__} lacks methods of a planner"
    results: list[Result] = []
    for problem in problems:
        mine = solve(problem, planner, timeout_s=timeout_s)
        if mine.wall_s > timeout_s + slack_s:
            raise AssertionError(f"{planner.card.name} answered after {mine.wall_s:.1f} s")
        compare([mine, solve(problem, timeout_s=timeout_s)])
        results.append(mine)
    return results
