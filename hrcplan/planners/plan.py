"""From a problem to a checked plan, in one call."""

from __future__ import annotations

from collections.abc import Mapping

from hrcplan.core.numbers import Number
from hrcplan.pddl.inputs import Readable, as_problem
from hrcplan.pddl.model import Domain, FluentKey, Problem
from hrcplan.planners.contract import Planner
from hrcplan.planners.solve import AUTO, DEFAULT_TIMEOUT_S, Result, solve


def plan(
    domain: Readable | Domain | Problem,
    problem: Readable | None = None,
    planner: str | Planner = AUTO,
    *,
    values: Mapping[FluentKey, Number] | None = None,
    timeout_s: float = DEFAULT_TIMEOUT_S,
    any_plan: bool = False,
    lanes: bool = False,
) -> Result:
    """Return a checked plan for a problem.

    Args:
        domain: A `Problem`, or whatever `hrcplan.read` takes.
        problem: The problem, if ``domain`` is only its domain.
        planner: A name (see ``hrcplan planners``), a planner object, or ``auto``.
        values: Function values to put into the initial state, as ``{("motivation", "human"): 8}``.
        timeout_s: Seconds for all planners together.
        any_plan: The first valid plan is enough.
        lanes: Lay a sequential plan out in lanes.

    Raises:
        InputError: if a file is missing or has faults.
        UsageError: if the planner is unknown or cannot hold the task.
        PlannerError: if it is missing, crashed, or gave a wrong answer.

    >>> plan("transport/handover", values={("motivation", "human"): 3}).plan.is_schedule
    True
    """
    task_problem = as_problem(domain, problem).with_values(values or {})
    return solve(task_problem, planner, timeout_s=timeout_s, any_plan=any_plan, lanes=lanes)
