"""Ask planners, check what they say, and fall back to the next: the one checked result type."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from hrcplan.core.numbers import Number, number_text
from hrcplan.errors import (
    CostGuardError,
    LimitError,
    MissingPlannerError,
    PlannerError,
    UnsupportedError,
    UsageError,
)
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Problem
from hrcplan.pddl.semantics import evaluate
from hrcplan.planners import registry
from hrcplan.planners.contract import Answer, Capabilities, LazyTask, Planner, Request, Status
from hrcplan.planners.lanes import schedule
from hrcplan.plans import EPSILON_S, Plan
from hrcplan.task import Task
from hrcplan.validation import Report, objective, validate

AUTO = "auto"
DEFAULT_TIMEOUT_S = 60.0
_TOLERANCE = 1e-6  # relative; planners print metrics with a few decimals
_ROUNDING = 2e-3


@dataclass(frozen=True, slots=True)
class Attempt:
    """One planner's turn: what came of it, in a few words."""

    planner: str
    outcome: str
    wall_s: float


@dataclass(frozen=True, slots=True)
class Result:
    """A checked answer: the plan was replayed, its cost is hrcplan's own.

    ``status`` and ``planner`` are those of the answer that was kept; ``why`` says why that planner
    was asked; ``attempts`` tells of every planner that was, in order. ``shortest`` says of a
    sequential plan laid into lanes whether its makespan is proven minimal for its partial order
    (steps that interfere stay in the plan's order).
    ``objective`` is what planners minimize here (metric, else makespan or cost), ``gaps`` how much
    of it may be due to the gaps between actions.
    """

    status: Status
    planner: str
    plan: Plan | None
    report: Report | None
    wall_s: float
    why: str
    attempts: tuple[Attempt, ...] = ()
    shortest: bool | None = None
    objective: Number | None = None
    gaps: Number = 0


def _gaps(problem: Problem, plan: Plan) -> Number:
    """Return what gaps of ``EPSILON_S`` can add to the objective of a schedule."""
    if not problem.domain.is_temporal:
        return 0
    gaps = EPSILON_S * len(plan.actions)
    if problem.metric is None:
        return gaps
    values = {**problem.values, (TOTAL_COST,): 0}
    late = evaluate(problem.metric, {**values, (TOTAL_TIME,): gaps}, {})
    added: Number = late - evaluate(problem.metric, {**values, (TOTAL_TIME,): 0}, {})
    return max(added, -added)


def solve(
    problem: Problem,
    planner: str | Planner = AUTO,
    *,
    timeout_s: float = DEFAULT_TIMEOUT_S,
    any_plan: bool = False,
    lanes: bool = False,
    task: Task | None = None,
) -> Result:
    """Return a checked plan, or a proof that there is none, or that nobody knew in time.

    Args:
        problem: What to solve.
        planner: A name, a planner object, or ``auto``: capable planners one after the other, the
            ones that prove the metric first, until one has an answer.
        timeout_s: Seconds for all planners together.
        any_plan: The first valid plan is enough.
        lanes: Lay a sequential plan out in lanes, one action per agent at a time.
        task: The problem grounded, if that was done before.

    Raises:
        UnsupportedError: if the planner named cannot hold the task.
        MissingPlannerError: if it is not installed.
        PlannerError: if it crashed, its plan is invalid, or its figures differ from ours.
        LimitError: if grounding ran out of bounds and no other planner was left.
    """
    begun = time.monotonic()
    request = Request(problem, begun + timeout_s, any_plan, lazy_task=LazyTask(task))
    if planner != AUTO:
        chosen = registry.make(planner) if isinstance(planner, str) else planner
        result = _attempt(chosen, request, lanes, "it was asked for")
        return replace(result, wall_s=time.monotonic() - begun)
    return replace(_portfolio(request, lanes), wall_s=time.monotonic() - begun)


def _portfolio(request: Request, lanes: bool) -> Result:
    """Ask the candidates in turn; each may use at most half of the time left, the last all."""
    candidates = list(_candidates(request))
    attempts: list[Attempt] = []
    failure: PlannerError | UnsupportedError | LimitError | None = None
    for position, (planner, why) in enumerate(candidates):
        last = position == len(candidates) - 1
        share = request.time_left_s if last else request.time_left_s / 2
        begun = time.monotonic()
        try:
            result = _attempt(planner, request.until(begun + share), lanes, why)
        except (PlannerError, UnsupportedError, LimitError) as error:
            failure = error
            attempts.append(_turn(planner, error.message, begun))
            continue
        attempts.append(_turn(planner, result.status.value, begun, result.attempts))
        if result.status is not Status.UNSOLVED:
            return replace(result, attempts=tuple(attempts))
    if failure is not None and all(a.outcome != Status.UNSOLVED.value for a in attempts):
        raise failure
    return Result(Status.UNSOLVED, AUTO, None, None, 0.0, "no planner had an answer in time",
                  tuple(attempts))  # fmt: skip


def _turn(planner: Planner, outcome: str, begun: float, inner: Sequence[Attempt] = ()) -> Attempt:
    note = "".join(f": {a.outcome}" for a in inner if a.outcome != outcome)
    return Attempt(planner.card.name, outcome + note, time.monotonic() - begun)


def _candidates(request: Request) -> Iterator[tuple[Planner, str]]:
    """Yield the installed planners that can hold the request, those that prove it first."""
    planners = [planner for name in registry.names() for planner in _loaded(name)]
    able = [p for p in planners if _unable(p.card, request) is None]
    if not able:
        raise UnsupportedError("no planner here can hold this task")
    able.sort(key=lambda p: _rank(p.card, request))
    for planner in able:
        reason = _merit(planner.card, request)
        yield planner, f"first choice: {reason}" if planner is able[0] else f"next: {reason}"


def _loaded(name: str) -> Iterator[Planner]:
    """Yield the planner of a name, unless its package is broken: ``auto`` goes on without it."""
    try:
        yield registry.make(name)
    except (MissingPlannerError, UsageError):
        return


def _unable(card: Capabilities, request: Request) -> str | None:
    domain = request.problem.domain
    if domain.is_temporal and not card.temporal:
        return "it plans without time"
    if not domain.is_temporal and not card.classical:
        return "it plans with time only"
    if not card.numeric and _is_numeric(request):
        return "it holds no numbers that actions change"
    return None


def _is_numeric(request: Request) -> bool:
    if request.problem.domain.changed_functions <= {TOTAL_COST}:
        return False
    try:
        return request.task is None
    except (UnsupportedError, LimitError):
        return True


def _rank(card: Capabilities, request: Request) -> tuple[bool, bool]:
    """Return a sort key: provers of this metric first, or the quick ones if any plan will do."""
    if request.any_plan:
        return (card.name != "kairos", False)
    return (not _proves(card, request), card.metric == "none")


def _proves(card: Capabilities, request: Request) -> bool:
    return card.proves and (card.metric == "cost+time" or not request.weighs_time)


def _merit(card: Capabilities, request: Request) -> str:
    if request.any_plan:
        return "any plan is enough" if card.name == "kairos" else "it can hold this task"
    if _proves(card, request):
        return f"it proves optimality for {card.metric}"
    return "it can hold this task but proves nothing"


def _attempt(planner: Planner, request: Request, lanes: bool, why: str) -> Result:
    missing = planner.missing()
    if missing is not None:
        raise MissingPlannerError(f"planner '{planner.card.name}' cannot run here: {missing}")
    begun = time.monotonic()
    answer = planner.solve(request)
    found = Result(answer.status, planner.card.name, None, None, 0, why)
    if answer.plan is not None:
        found = _checked(found, planner, request.problem, answer, lanes)
    wall_s = time.monotonic() - begun
    attempts = (Attempt(planner.card.name, answer.note, wall_s),) if answer.note else ()
    return replace(found, wall_s=wall_s, attempts=attempts)


def _checked(
    found: Result, planner: Planner, problem: Problem, answer: Answer, lanes: bool
) -> Result:
    """Return ``found`` with an answer's plan: guarded, laid into lanes if need be, replayed."""
    check_answer(planner, problem, answer)
    plan, shortest = answer.plan, None
    assert plan is not None
    if not plan.is_schedule and (lanes or problem.domain.is_temporal):
        plan, shortest = schedule(problem, plan)
    report = validate(problem, plan)
    _demand_valid(planner, report)
    return replace(
        found, plan=plan, report=report, shortest=shortest,
        objective=objective(problem, report), gaps=_gaps(problem, plan),
    )  # fmt: skip


def check_answer(planner: Planner, problem: Problem, answer: Answer) -> Report:
    """Return the replay of an answer's plan: the cost guard.

    Raises:
        PlannerError: if the plan is invalid.
        CostGuardError: if the planner's figure is not the plan's metric in our semantics.
    """
    assert answer.plan is not None
    report = validate(problem, answer.plan)
    _demand_valid(planner, report)
    ours = objective(problem, report)
    if answer.objective is not None and ours is not None and _differ(answer.objective, ours):
        message = (
            f"planner '{planner.card.name}' reports {number_text(answer.objective)} for a plan "
            f"that costs {number_text(ours)}"
        )
        raise CostGuardError(message)
    return report


def _demand_valid(planner: Planner, report: Report) -> None:
    if not report.valid:
        raise PlannerError(
            f"planner '{planner.card.name}' gave an invalid plan: {report.reason}",
            code="invalid-plan",
        )


def _differ(theirs: Number, ours: Number) -> bool:
    return abs(float(theirs - ours)) > _ROUNDING + _TOLERANCE * abs(float(ours))


def compare(results: Sequence[Result]) -> None:
    """Hold results of several planners for one problem against each other.

    Raises:
        CostGuardError: if a plan is better than a proven one, two proven ones differ, or a task
            that is claimed unsolvable has a validated plan. The message names both planners.
    """
    proven = [r for r in results if r.status is Status.OPTIMAL]
    for result in (r for r in results if r.plan is not None):
        for other in results:
            if other.status is Status.UNSOLVABLE:
                message = f"'{other.planner}' says unsolvable, '{result.planner}' has a valid plan"
                raise CostGuardError(message)
        for best in proven:
            mine, theirs = result.objective, best.objective
            if mine is None or theirs is None:
                continue
            if mine < theirs - best.gaps and _differ(mine, theirs):
                raise CostGuardError(
                    f"'{best.planner}' claims {number_text(theirs)} is optimal, but "
                    f"'{result.planner}' has a plan for {number_text(mine)}"
                )
