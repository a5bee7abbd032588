"""Laws that every part of a kind must keep, as functions: call them in your own tests."""

from __future__ import annotations

import time
from collections.abc import Iterable

from hrcplan.facade import validate
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text
from hrcplan.planners.answer import Planner, Request, Status
from hrcplan.planners.solve import Result, check_answer, compare, solve
from hrcplan.validation import Report


def check_plan(domain: str, problem: str, plan: str) -> Report:
    """Return the replay of a plan, given as text in IPC format or as a file's path.

    Raises:
        AssertionError: if the plan is invalid; the message names the first wrong step.
    """
    text = plan if "(" in plan or not plan.strip() else read_text(plan)
    report = validate(domain, problem, text)
    step = "" if report.failed_step is None else f"step {report.failed_step + 1}: "
    assert report.valid, f"invalid plan for {domain}/{problem}: {step}{report.reason}"
    return report


def check_planner(
    planner: Planner, problems: Iterable[Problem], *, timeout_s: float = 20.0, slack_s: float = 3.0
) -> list[Result]:
    """Return a planner's results after holding it to the laws of planners.

    It answers in time; a plan it gives is valid and costs what it says; what it claims to have
    proven is no worse than what ``auto`` finds, and what it calls unsolvable has no plan.

    Args:
        planner: An object with ``card``, ``missing`` and ``solve`` (see planners/answer.py).
        problems: Problems that its card says it can hold.
        timeout_s: Limit for each problem, in seconds.
        slack_s: How much later than the limit it may answer, in seconds.

    Raises:
        AssertionError: if it breaks a law.
        CostGuardError: if its figures and hrcplan's differ.
    """
    assert planner.missing() is None, f"{planner.card.name}: {planner.missing()}"
    results: list[Result] = []
    for problem in problems:
        begun = time.monotonic()
        answer = planner.solve(Request(problem, begun + timeout_s))
        took = time.monotonic() - begun
        assert took <= timeout_s + slack_s, f"{planner.card.name} answered after {took:.1f} s"
        if answer.plan is not None:
            check_answer(planner, problem, answer)
        if answer.status is Status.OPTIMAL:
            assert planner.card.proves, f"{planner.card.name} proves, but its card says no"
        mine = solve(problem, planner, timeout_s=timeout_s)
        compare([mine, solve(problem, timeout_s=timeout_s)])
        results.append(mine)
    return results
