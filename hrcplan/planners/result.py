"""The one checked result type: a planner's answer after a replay of its plan."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from hrcplan.core.numbers import Number, exact, number_text
from hrcplan.core.records import field, record, replace
from hrcplan.core.text import cut
from hrcplan.errors import (
    CostGuardError,
    MissingPlannerError,
    PlanFormatError,
    PlannerError,
    UnsupportedError,
)
from hrcplan.pddl.constructs import PREFERENCES
from hrcplan.pddl.inlining import remaining
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Problem
from hrcplan.pddl.semantics import Undefined, evaluate
from hrcplan.planners.contract import (
    Answer,
    Capabilities,
    LazyTask,
    Planner,
    Replays,
    Request,
    Status,
)
from hrcplan.planners.lanes import schedule, with_durations
from hrcplan.planners.rounding import valid_form
from hrcplan.plans import EPSILON_S, Plan
from hrcplan.validation import Report, objective, validate

if TYPE_CHECKING:
    from hrcplan.planners.soft_goals import HardGoals

_TOLERANCE = 1e-6  # relative; planners print metrics with a few decimals
_ROUNDING = 2e-3


Replay = Callable[[Problem, Plan], Report]


@record
class Attempt:
    """One planner's turn: what came of it, in a few words."""

    planner: str
    outcome: str
    wall_s: float


@record
class Result:
    """A checked answer: the plan was replayed, its cost is hrcplan's own.

    Attributes:
        status: What is certain: a claim of a planner that nothing confirms is not in here.
        planner: Who found the plan, or made the claim.
        plan: The plan; None if there is none.
        report: Its replay.
        wall_s: Seconds that the call took.
        why: Why that planner was asked.
        attempts: What came of every planner that was asked, in the order in which they ended.
        shortest: Of a sequential plan laid into lanes: whether its makespan is proven minimal for
            its partial order (steps that interfere stay in the plan's order).
        objective: What planners minimize here: the metric, else makespan or cost.
        gaps: How much of the objective may be due to the gaps between actions.
        bound: What no plan can be better than, in units of the objective; None if not known.
        bound_note: Why there is no bound, as far as a search for one has said it.
        claim: What the planner itself said.
        mismatch: How the planner's figure differs from the plan's; None if it does not.
        problem: What was solved; it says which agent an action belongs to.
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
    bound: Number | None = None
    bound_note: str = ""
    claim: Status | None = None
    mismatch: str | None = None
    problem: Problem | None = field(default=None, repr=False, compare=False)

    @property
    def gap(self) -> float | None:
        """How far the objective is from ``bound``, relative to it; None where that means nothing.

        0 if the plan is proven optimal: gaps between its actions are not counted. ``gap_reason``
        says why it is None.
        """
        if self.objective is not None and self.status is Status.OPTIMAL:
            return 0.0
        if self.objective is None or self.bound is None or self.bound <= 0:
            return None
        apart = abs(Fraction(self.objective - self.bound)) - self.gaps
        return round(max(0.0, float(apart / Fraction(self.bound))), 9)

    @property
    def gap_reason(self) -> str | None:
        """Why ``gap`` is None, in words; None if there is a gap."""
        if self.gap is not None:
            return None
        if self.plan is None:
            return "there is no plan"
        if self.objective is None:
            return self.mismatch or "the plan has no value to compare"
        if self.bound is not None:
            return f"relative to a bound of {number_text(self.bound)} a distance has no meaning"
        return self.bound_note or "no planner proved a bound"

    def __repr__(self) -> str:
        what = repr(self.plan) if self.report is None else f"{self.plan!r}, {self.report!r}"
        return f"<Result: {self.status.value} by {cut(self.planner, 40)}: {cut(what, 120)}>"

    def rows(self) -> list[dict[str, str | float | None]]:
        """Return one row per action of the plan, for ``pandas.DataFrame``; none without a plan.

        Keys: ``start_s``, ``duration_s`` (both None in a sequential plan), ``agent`` (None for an
        action without one), ``action``, ``args`` (separated by spaces), ``cost``.
        """
        if self.plan is None or self.report is None:
            return []
        costs = self.report.step_costs
        rows = self.plan.rows(self.problem)
        return [{**row, "cost": float(c)} for row, c in zip(rows, costs, strict=True)]

    def _repr_html_(self) -> str:
        """Return the plan as a picture with the result below it."""
        picture = "" if self.plan is None else self.plan.picture(self.problem)
        from html import escape

        return f"{picture}<p>{escape(repr(self))}</p>"


def ask(planner: Planner, request: Request, lanes: bool, why: str) -> Result:
    """Return the checked answer of one planner.

    Raises:
        UnsupportedError: if it cannot hold the task.
        MissingPlannerError: if it is not installed.
        PlannerError: if it crashes, or its plan is invalid.
        LimitError: if the task could not be made ready within the limits.
    """
    missing = planner.missing()
    if missing is not None:
        raise MissingPlannerError(f"planner '{planner.card.name}' cannot run here: {missing}")
    beyond = sorted(remaining(request.problem) - planner.card.constructs)
    hard_goals = None
    if beyond == [PREFERENCES]:
        from hrcplan.planners.soft_goals import without_preferences

        hard_goals = without_preferences(request.problem)
    if beyond and hard_goals is None:
        message = f"planner '{planner.card.name}' does not know {' and '.join(beyond)}"
        raise UnsupportedError(message, hint="kairos knows them" if planner.card.own else None)
    start_s = time.monotonic()
    with _files_of(planner.card):
        answer = _answer(planner, request, hard_goals)
    result = check_answer(planner.card, request.problem, answer, lanes, why, request.replays)
    wall_s = time.monotonic() - start_s
    notes = [note for note in (answer.note, result.mismatch) if note]
    attempts = tuple(Attempt(planner.card.name, note, wall_s) for note in notes)
    return replace(result, wall_s=wall_s, attempts=attempts)


@contextlib.contextmanager
def _files_of(card: Capabilities) -> Iterator[None]:
    """Say by whom a file is that is no plan, or that cannot be written.

    Raises:
        PlannerError: instead of the error of a plan's text or of the operating system.
    """
    try:
        yield
    except PlanFormatError as error:
        message = f"planner '{card.name}' wrote what is no plan: {error.message}"
        raise PlannerError(message, code="plan-not-read") from None
    except OSError as error:
        message = f"planner '{card.name}' cannot use its files: {error.strerror or error}"
        hint = "TMPDIR names the folder for them; is its disk full?"
        raise PlannerError(message, hint=hint) from None


def _answer(planner: Planner, request: Request, hard_goals: HardGoals | None) -> Answer:
    """Return what a planner says of a problem, or of the one without preferences."""
    if hard_goals is None:
        return planner.solve(request)

    def on_plan(plan: Plan) -> None:
        request.on_plan(hard_goals.plan(plan))

    own = replace(
        request, problem=hard_goals.problem, lazy_task=LazyTask(), replays=Replays(),
        on_plan=on_plan,
    )  # fmt: skip
    answer = planner.solve(own)
    if answer.plan is None:
        return answer
    return replace(answer, plan=hard_goals.plan(answer.plan))


def is_better(problem: Problem, one: Number | None, other: Number | None) -> bool:
    """Return whether an objective is better than another one; any is better than None."""
    if one is None or other is None:
        return one is not None
    return one > other if problem.metric is not None and problem.maximize else one < other


def check_answer(
    card: Capabilities, problem: Problem, answer: Answer, lanes: bool, why: str,
    replay: Replay = validate,
) -> Result:  # fmt: skip
    """Return an answer as a result: its plan laid into lanes if need be, and replayed.

    A proof counts only if the planner's figure is that of the plan. "Unsolvable" is no more than a
    claim, unless a search of hrcplan's own says so.

    Raises:
        PlannerError: if the plan is invalid.
    """
    result = Result(
        answer.status, card.name, None, None, 0, why, bound=answer.bound, claim=answer.status
    )
    if answer.plan is None:
        sure = answer.status is not Status.UNSOLVABLE or card.own
        return result if sure else replace(result, status=Status.UNSOLVED)
    if problem.domain.is_continuous:
        note = "hrcplan cannot judge plans where numbers change while time passes"
        return replace(result, plan=answer.plan, status=Status.SOLVED, bound=None, mismatch=note)
    plan, report = valid_form(problem, with_durations(problem, answer.plan), replay)
    _demand_valid(card, report)
    mismatch = _mismatch(card, answer.objective, objective(problem, report))
    shortest = None
    if not plan.is_schedule and (lanes or problem.domain.is_temporal):
        plan, shortest = schedule(problem, plan)
        report = validate(problem, plan)
        _demand_valid(card, report)
    value = objective(problem, report)
    is_optimal = answer.status is Status.OPTIMAL and mismatch is None
    bound = (value if answer.bound is None else answer.bound) if is_optimal else answer.bound
    return replace(
        result, plan=plan, report=report, shortest=shortest, objective=value, bound=bound,
        status=Status.OPTIMAL if is_optimal else Status.SOLVED,
        gaps=_gaps(problem, plan), mismatch=mismatch,
    )  # fmt: skip


def _demand_valid(card: Capabilities, report: Report) -> None:
    if not report.valid:
        message = f"planner '{card.name}' gave an invalid plan: {report.reason}"
        raise PlannerError(message, code="invalid-plan")


def _mismatch(card: Capabilities, theirs: Number | None, ours: Number | None) -> str | None:
    if theirs is None or ours is None or not _differ(theirs, ours):
        return None
    return (
        f"planner '{card.name}' reports {number_text(theirs)} for a plan that costs "
        f"{number_text(ours)}"
    )


def _differ(theirs: Number, ours: Number) -> bool:
    apart, size = abs(Fraction(theirs - ours)), abs(Fraction(ours))
    return apart > Fraction(_ROUNDING) + Fraction(_TOLERANCE) * size


def _gaps(problem: Problem, plan: Plan) -> Number:
    """Return what gaps of ``EPSILON_S`` can add to the objective of a schedule."""
    if not problem.domain.is_temporal:
        return 0
    gaps = EPSILON_S * len(plan.actions)
    if problem.metric is None:
        return gaps
    values = {**problem.values, (TOTAL_COST,): 0}
    try:
        late, early = (
            evaluate(problem.metric, {**values, (TOTAL_TIME,): time}, {}) for time in (gaps, 0)
        )
    except Undefined:
        return 0
    return exact(max(late - early, early - late))


def compare(results: Sequence[Result]) -> None:
    """Hold results of several planners for one problem against each other.

    Raises:
        CostGuardError: if a planner's figure is not that of its plan, a plan is better than a
            proven one, two proven ones differ, or a task that is claimed unsolvable has a validated
            plan. The message names both planners.
    """
    for result in results:
        if result.mismatch is not None:
            raise CostGuardError(result.mismatch)
    for result in (r for r in results if r.plan is not None):
        for other in results:
            if other.claim is Status.UNSOLVABLE:
                message = f"'{other.planner}' says unsolvable, '{result.planner}' has a valid plan"
                raise CostGuardError(message)
            if other.status is Status.OPTIMAL:
                _compare_values(result, other)


def _compare_values(result: Result, best: Result) -> None:
    mine, theirs = result.objective, best.objective
    if mine is None or theirs is None:
        return
    if mine < theirs - best.gaps and _differ(mine, theirs):
        raise CostGuardError(
            f"'{best.planner}' claims {number_text(theirs)} is optimal, but "
            f"'{result.planner}' has a plan for {number_text(mine)}"
        )
