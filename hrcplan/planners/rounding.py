"""Schedules whose times a planner has rounded: gaps that became too short get their length again.

A planner that keeps a gap of 0.001 s and prints six decimals may leave one of 0.000999 s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan
from hrcplan.validation import Report

MOST_DECIMALS = 9
SHIFT = 2
"""By how many units of the last decimal each start is later than its predecessor's shift.

A start and the end before it are apart by three rounded numbers, each off by half a unit.
"""


def valid_form(
    problem: Problem, plan: Plan, replay: Callable[[Problem, Plan], Report]
) -> tuple[Plan, Report]:
    """Return a plan with its replay: as it is, or with wider gaps if only that makes it valid."""
    report = replay(problem, plan)
    wider = plan if report.valid else with_wider_gaps(plan)
    if wider is plan:
        return plan, report
    again = replay(problem, wider)
    return (wider, again) if again.valid else (plan, report)


def with_wider_gaps(plan: Plan) -> Plan:
    r"""Return a schedule in which every start is later than the one before it by a little more.

    The little is `SHIFT` units of the last decimal that the plan has. A plan without times, or
    with times that are no decimals, stays as it is.

    >>> from hrcplan.plans import parse_plan
    >>> plan = with_wider_gaps(parse_plan("0: (a) [1.5]\n1.501: (b) [1]"))
    >>> [str(action.start_s) for action in plan.actions]
    ['0', '1503/1000']
    """
    starts = sorted({a.start_s for a in plan.actions if a.start_s is not None})
    times = [*starts, *(a.duration_s for a in plan.actions if a.duration_s is not None)]
    scales = (10**n for n in range(MOST_DECIMALS + 1))
    scale = next((s for s in scales if all(Fraction(s * t).denominator == 1 for t in times)), None)
    if len(starts) < 2 or scale is None:
        return plan
    shifts = {start: Fraction(SHIFT * rank, scale) for rank, start in enumerate(starts)}
    return Plan(tuple(
        a if a.start_s is None else replace(a, start_s=a.start_s + shifts[a.start_s])
        for a in plan.actions
    ))  # fmt: skip
