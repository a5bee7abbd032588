"""PlanReplay a plan in PDDL's own semantics: is it valid, what does it cost, where does it break.

It works on the lifted model, so it also judges numeric plans that the bit task cannot hold,
and it shares no code with any planner.
"""

from __future__ import annotations

import os
from dataclasses import replace
from types import EllipsisType
from typing import overload

from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.inputs import Readable, as_problem
from hrcplan.pddl.model import Domain, Problem
from hrcplan.pddl.semantics import unmet
from hrcplan.plans import EPSILON_S, Plan
from hrcplan.validation.happenings import BrokenPlanError
from hrcplan.validation.replay import PlanReplay
from hrcplan.validation.report import Report, objective

__all__ = ["Report", "objective", "validate"]

PlanLike = Plan | str | os.PathLike[str]


@overload
def validate(
    domain: Problem | Readable, problem: PlanLike, /, *, epsilon_s: Number = ...
) -> Report: ...


@overload
def validate(
    domain: Domain | Readable | Problem,
    problem: Readable,
    plan: PlanLike,
    *,
    epsilon_s: Number = ...,
) -> Report: ...


@overload
def validate(domain: Problem | Readable, *, plan: PlanLike, epsilon_s: Number = ...) -> Report: ...


def validate(
    domain: Domain | Readable | Problem,
    problem: PlanLike | EllipsisType = ...,
    plan: PlanLike | EllipsisType = ...,
    *,
    epsilon_s: Number = EPSILON_S,
) -> Report:
    """Return whether a plan is valid, with its cost, makespan and metric.

    Called as ``validate(problem, plan)`` or ``validate(domain, problem, plan)``. A sequential plan
    of a temporal domain is read as one action after the other. Interfering happenings that are
    closer than ``epsilon_s`` are invalid (Fox and Long, PDDL2.1, JAIR 2003, section 8); others may
    coincide. VAL accepts gaps down to a tenth of its tolerance ``-t``. ``total-time`` of a
    classical plan is its number of actions, also if it is laid out in lanes.

    Args:
        domain: The problem that the plan is for: a `Problem`, or whatever `hrcplan.read` takes.
        problem: The problem, if ``domain`` is only its domain; else the plan.
        plan: A `Plan`, its text in IPC format, or a file's path. Unknown actions and objects make
            it invalid; they are no error. A planner's log counts as its last plan.
        epsilon_s: Smallest gap between interfering happenings, in seconds; above zero.

    Raises:
        InputError: if a file is missing or has faults, or the text is no plan.
        UnsupportedError: if numbers change while time passes.
        UsageError: if the problem is given twice.
        TypeError: if an argument is none of these.

    >>> validate("transport/two-boxes", "(move human wp1 wp4)").reason
    'the goal (box-at green wp2) does not hold at the end'
    """
    if isinstance(plan, EllipsisType):
        plan, problem = problem, ...
    if isinstance(plan, EllipsisType):
        raise TypeError("validate() needs a problem and a plan")
    if isinstance(problem, Plan):
        raise TypeError("the plan is the last argument of validate(), after the problem")
    parsed_problem = as_problem(domain, None if isinstance(problem, EllipsisType) else problem)
    if not isinstance(plan, Plan):
        from hrcplan.plans import as_plan

        plan = as_plan(plan, parsed_problem)
    return _replay(parsed_problem, plan, epsilon_s)


def _replay(problem: Problem, plan: Plan, epsilon_s: Number) -> Report:
    if problem.domain.is_continuous:
        message = "hrcplan cannot judge plans of domains with processes, events or #t"
        raise UnsupportedError(message, hint="VAL can")
    replay = PlanReplay(problem, plan, epsilon_s)
    try:
        replay.run()
        missing = unmet(problem.goal, replay.seen, {}, problem)
    except BrokenPlanError as broken:
        report = replay.report(reason=str(broken), failed_step=broken.step)
        return replace(report, gap_s=broken.gap_s)
    broken_constraint = replay.broken_constraint()
    if broken_constraint is not None:
        return replay.report(reason=f"the plan does not keep the constraint {broken_constraint}")
    if missing is not None:
        return replay.report(reason=f"the goal {missing} does not hold at the end")
    return replay.report()
