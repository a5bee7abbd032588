"""Ask planners, check what they say, and return the best plan with what is proven about it."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace

from hrcplan.pddl.model import Problem
from hrcplan.planners import registry
from hrcplan.planners.choice import Job, jobs
from hrcplan.planners.contract import MEMORY_BYTES, LazyTask, Planner, Request, Status
from hrcplan.planners.metric_costs import with_total_cost
from hrcplan.planners.portfolio import AUTO, Portfolio
from hrcplan.planners.race import OnBetter, can_race, race
from hrcplan.planners.result import Attempt, Result, ask, compare
from hrcplan.task import Task
from hrcplan.validation import validate

__all__ = ["AUTO", "DEFAULT_TIMEOUT_S", "Attempt", "Result", "compare", "solve"]

DEFAULT_TIMEOUT_S = 60.0


def solve(
    problem: Problem,
    planner: str | Planner = AUTO,
    *,
    timeout_s: float = DEFAULT_TIMEOUT_S,
    any_plan: bool = False,
    lanes: bool = False,
    task: Task | None = None,
    memory_bytes: int = MEMORY_BYTES,
    on_better: OnBetter = lambda result: None,
) -> Result:
    """Return a checked plan, a proof that there is none, or ``unsolved`` at the deadline.

    Args:
        problem: What to solve.
        planner: A name, a planner object (asked in this process), or ``auto``: capable planners
            side by side, until the best plan is proven or time is up.
        timeout_s: Seconds for all planners together.
        any_plan: The first valid plan is enough.
        lanes: Lay a sequential plan out in lanes, one action per agent at a time.
        task: The problem grounded, if that was done before.
        memory_bytes: Memory for all planners together.
        on_better: Is called with every plan that is better than those before it.

    Raises:
        UnsupportedError: if no planner that was asked can hold the task.
        MissingPlannerError: if the planner named is not installed.
        PlannerError: if it crashed, or its plan is invalid.
        LimitError: if grounding ran out of bounds and no other planner was left.
    """
    start_s = time.monotonic()
    if planner in (AUTO, *registry.BUILT_IN):
        costs = with_total_cost(problem)
        if costs is not problem:
            result = solve(
                costs, planner, timeout_s=timeout_s, any_plan=any_plan, lanes=lanes,
                memory_bytes=memory_bytes, on_better=lambda r: on_better(_of(problem, r)),
            )  # fmt: skip
            return _of(problem, result)
    request = Request(problem, start_s + timeout_s, any_plan, memory_bytes, LazyTask(task))
    if planner == AUTO:
        if not any_plan:  # planners that look for any plan can do without, or ground it themselves
            request.ground_quickly()
        answer = _run(request, jobs(request), lanes, on_better).result()
    else:
        one = registry.make(planner) if isinstance(planner, str) else planner
        job = Job(one, any_plan, "it was asked for")
        answer = _confirm(_ask_one(request, job, planner is not one, lanes, on_better), request)
    return replace(answer, wall_s=time.monotonic() - start_s, problem=problem)


def _of(problem: Problem, result: Result) -> Result:
    """Return a result for a problem whose metric is the same under other names."""
    if result.plan is None or result.report is None:
        return replace(result, problem=problem)
    report = validate(problem, result.plan)
    return replace(result, report=report, problem=problem)


def _run(request: Request, waiting: Iterable[Job], lanes: bool, on_better: OnBetter) -> Portfolio:
    if can_race():
        return race(request, waiting, lanes, on_better)
    from hrcplan.planners.race_process import race_in_process

    return race_in_process(request, waiting, lanes, on_better)


def _ask_one(
    request: Request, job: Job, is_named: bool, lanes: bool, on_better: OnBetter
) -> Result:
    """Return the answer of the one planner that was asked for; its failures are the caller's."""
    if not (is_named and can_race()):
        return ask(job.planner, request, lanes, job.why)
    return race(request, [job], lanes, on_better).only(job.name)


def _confirm(first: Result, request: Request) -> Result:
    """Return a result; a claim that a task is unsolvable is checked with other planners."""
    if first.claim is not Status.UNSOLVABLE or first.status is Status.UNSOLVABLE:
        return first
    rest = replace(request, any_plan=True)
    others = [job for job in jobs(rest) if job.name != first.planner]
    second = _run(rest, others, False, lambda result: None)
    if second.confirms_unsolvable:
        return replace(first, status=Status.UNSOLVABLE)
    if second.best is not None:
        note = f"it says unsolvable, but '{second.best.planner}' has a valid plan"
    else:
        note = "it says unsolvable, which nothing confirms"
    attempt = Attempt(first.planner, note, first.wall_s)
    return replace(first, attempts=(*first.attempts, attempt))
