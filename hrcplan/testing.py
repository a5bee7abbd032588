"""Laws that every part of a kind must keep, as functions: call them in your own tests."""

from __future__ import annotations

from collections.abc import Iterable

from hrcplan.facade import validate
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.planners.answer import Planner
from hrcplan.planners.solve import Result, compare, solve
from hrcplan.validation import Report


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
    """Return a planner's results after holding it to the laws of planners.

    It answers in time; a plan it gives is valid and costs what it says (``solve`` sees to that);
    what it claims to have proven is no worse than what ``auto`` finds, and what it calls unsolvable
    has no plan.

    Args:
        planner: An object with ``card``, ``missing`` and ``solve`` (see planners/answer.py).
        problems: Problems that its card says it can hold.
        timeout_s: Limit for each problem, in seconds.
        slack_s: How much later than the limit it may answer, in seconds.

    Raises:
        AssertionError: if it answers too late.
        PlannerError: if it is missing, gives an invalid plan, or its figures differ from hrcplan's.
    """
    results: list[Result] = []
    for problem in problems:
        mine = solve(problem, planner, timeout_s=timeout_s)
        if mine.wall_s > timeout_s + slack_s:
            raise AssertionError(f"{planner.card.name} answered after {mine.wall_s:.1f} s")
        compare([mine, solve(problem, timeout_s=timeout_s)])
        results.append(mine)
    return results
