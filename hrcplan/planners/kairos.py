"""kairos (PlanSys2, Apache-2.0): temporal, numeric and weighted metrics, in this process.

In process because a search takes 10-20 ms. It was measured to release the interpreter lock, to
keep its time limit within 0.6 s, and to answer bad input and nesting with errors; Ctrl-C stops it.
No single search preset is best on weighted metrics, so several run and the best plan is kept, by
our own evaluation.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from typing import TYPE_CHECKING

from hrcplan.core.numbers import Number
from hrcplan.errors import LimitError, MissingPlannerError, PlannerError, UnsupportedError
from hrcplan.pddl.constructs import ALL
from hrcplan.pddl.guards import guarded
from hrcplan.pddl.model import (
    TOTAL_COST,
    TOTAL_TIME,
    VIOLATED,
    And,
    Arithmetic,
    Compare,
    Constant,
    Expr,
    Function,
)
from hrcplan.pddl.walks import functions_in
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.handover import Handover
from hrcplan.planners.lowering import Lowering, lower
from hrcplan.planners.number_range import decides_exactly, never_lowers_cost, prices_exactly
from hrcplan.planners.rounding import valid_form
from hrcplan.plans import Plan
from hrcplan.validation import Report, objective, validate

if TYPE_CHECKING:
    import kairos

# The ones that were best somewhere on the shipped problems; auto, lama and lama-novelty never were.
TIMED_PRESETS = ("ehc", "novelty", "ff", "eager-lama", "goals")
QUICK_PRESETS = ("goals", "ehc", "ff", "novelty", "eager-lama")  # for any plan
CLASSICAL_PRESETS = ("auto",)
LAST_PRESET = "auto"  # it has engines that choose durations, where the searches above give up
PATIENCE = 0.1
"""A search that finds nothing better for this part of its time is over."""

QUICK = 1 / 30
"""The part of the time left that each search for any plan has at first."""

STEP = 0.3
"""The part of the time left in which a plan with a higher metric must be found."""

_TICK_S = 0.1
_DECIMALS = 10**6
_FLOAT_BITS = 53
_GAVE_UP = "no_plan"  # its code for a search that ends without a plan and without a proof


class Kairos:
    """A portfolio of kairos' searches; classical tasks that it finishes are proven optimal."""

    def __init__(self, presets: tuple[str, ...] | None = None) -> None:
        self._presets = presets
        self.card = Capabilities(
            "kairos",
            "anytime portfolio for temporal, numeric and weighted problems",
            temporal=True,
            numeric=True,
            constructs=ALL,
            metric="cost+time",
            limits=True,
            needs="pip install kairos-planner",
        )

    def missing(self) -> str | None:
        """Return what is not installed; None if all is."""
        if find_spec("kairos") is None:
            return "the package is not installed; pip install kairos-planner"
        return None

    def solve(self, request: Request) -> Answer:
        """Return the best valid plan of all presets; the first one if any plan will do.

        Raises:
            UnsupportedError: if kairos does not know a feature of the problem.
            MissingPlannerError: if it is not installed.
            PlannerError: if it fails, or if all its plans are invalid.
        """
        missing = self.missing()
        if missing is not None:
            raise MissingPlannerError(f"kairos cannot run here: {missing}")
        if request.any_plan and guarded(request.problem, fills=False) is not request.problem:
            with contextlib.suppress(PlannerError):
                answer = _Portfolio(request, guards=False).solve(self._presets)
                if answer.plan is not None or request.time_left_s <= 0:
                    return answer
        return _Portfolio(request).solve(self._presets)


class _Portfolio:
    """The searches for one request and the best of their plans so far.

    Without ``guards`` it finds plans more quickly, but may not read missing values as hrcplan does.
    """

    def __init__(self, request: Request, guards: bool = True) -> None:
        self.request = request
        self.lowering = _lowering(request)
        self.handover = Handover.of(request.problem, memory_facts=True, guards=guards, fills=False)
        self.best: tuple[Number, Plan, Number | None] | None = None
        self.invalid: Report | None = None
        self.is_proven = False
        self.failures: list[UnsupportedError | PlannerError] = []
        self.notes: list[str] = []
        self.ended: set[str] = set()
        self.last = ""

    def solve(self, presets: tuple[str, ...] | None) -> Answer:
        problem = self._parse()
        temporal = self.request.problem.domain.is_temporal
        last = LAST_PRESET if temporal and presets is None else None
        if presets is None:
            presets = TIMED_PRESETS if temporal else CLASSICAL_PRESETS
        for preset, slice_s in self._turns(presets):
            result = self._search(problem, preset, slice_s)
            if result.status.name == "UNSOLVABLE":
                return self._unsolvable()
            self._check(result)
            if result.status.name != "TIMEOUT":
                self.ended.add(preset)
            if self.is_proven or (self.best and self.request.any_plan):
                break
        else:
            if last and self.best is None and self.request.time_left_s > 0:
                self._check(self._search(problem, last, self.request.time_left_s))
        self._raise_metric()
        return self._answer()

    def _turns(self, presets: Sequence[str]) -> Iterator[tuple[str, float]]:
        """Yield which search is to run next, and how long, as long as there is time.

        Searches for any plan have a short turn first: each is the quickest one somewhere.
        """
        if self.request.any_plan and len(presets) > 1:
            for preset in presets:
                yield preset, QUICK * self.request.time_left_s
        presets = [preset for preset in presets if preset not in self.ended]
        for position, preset in enumerate(presets):
            slice_s = self.request.time_left_s / (len(presets) - position)
            if slice_s <= 0:
                return
            yield preset, slice_s

    def _raise_metric(self) -> None:
        """Look for plans with a higher metric, as long as some are found.

        kairos does not maximize: it is asked for any plan beyond the last one, total-time left out.
        """
        request, metric = self.request, self.request.problem.metric
        if metric is None or not request.problem.maximize or request.any_plan or self.is_proven:
            return
        metric = _without_time(metric)
        names = {function.name for function in functions_in(metric)}
        if self.best is None or not names or names & {TOTAL_TIME, VIOLATED}:
            return
        timeless, plan = replace(request.problem, metric=metric), self.best[1]
        while request.time_left_s > 0:
            value = validate(timeless, plan).metric
            if value is None:
                return
            goal = And((request.problem.goal, Compare(">", metric, Constant(value))))
            harder = replace(request.problem, goal=goal, metric=None, maximize=False)
            deadline = time.monotonic() + STEP * request.time_left_s
            one = Request(harder, deadline, True, request.memory_bytes, n_threads=request.n_threads)
            try:
                answer = _Portfolio(one).solve(None)
            except (UnsupportedError, PlannerError):
                return
            if answer.plan is None:
                return
            plan = answer.plan
            self._keep(plan, None)

    def _parse(self) -> kairos.Problem:
        import kairos

        if self.lowering is not None:
            texts = self.lowering.domain_text, self.lowering.problem_text
        else:
            texts = self.handover.texts
        try:
            return kairos.parse_problem(texts[1], kairos.parse_domain(texts[0]))
        except kairos.PddlError as error:
            first = str(error).splitlines()[0]
            raise UnsupportedError(f"kairos does not read this problem: {first}") from None

    def _search(self, problem: kairos.Problem, preset: str, slice_s: float) -> kairos.SolveResult:
        import kairos

        planner = kairos.Planner()  # type: ignore[no-untyped-call]
        search = planner.start(
            problem,
            timeout=slice_s,
            search=preset,
            anytime=not self.request.any_plan,
            stop_after_no_improvement=max(0.5, PATIENCE * slice_s),
            memory_limit_mb=max(64, self.request.memory_bytes >> 20),
            threads=self.request.n_threads,
        )
        try:
            while search.running():  # in short steps, so that Ctrl-C gets through
                plan = search.next_plan(_TICK_S)
                if plan is not None:
                    self._take(plan)
        finally:
            search.stop()
        return search.wait()

    def _take(self, candidate: kairos.Plan) -> None:
        """Validate a plan and keep it if it is the best so far."""
        text = str(candidate)
        if text == self.last:
            return  # the search ends with the plan that it has shown before
        self.last = text
        source = self.handover if self.lowering is None else self.lowering
        plan = source.plan(text)
        if self.request.problem.domain.is_continuous:
            self.best = 0, plan, None  # hrcplan cannot judge it
            return
        self._keep(plan, self._objective(candidate.cost))

    def _keep(self, plan: Plan, figure: Number | None) -> None:
        """Keep a plan if it is valid and the best so far; ``figure`` is what kairos says of it."""
        plan, report = valid_form(self.request.problem, plan, self.request.replays)
        if not report.valid:
            self.invalid = report
            return
        ours = objective(self.request.problem, report) or 0
        if self.request.problem.maximize:
            ours = -ours
        if self.best is None or ours < self.best[0]:
            self.best = ours, plan, figure
            self.request.on_plan(plan)

    def _check(self, result: kairos.SolveResult) -> None:
        """Take the last plan and the proof, if there is one, or note what went wrong.

        A search that fails does not take away what another one has, or may find.
        """
        status = result.status.name
        if result.plan is not None:
            self._take(result.plan)
        elif status in ("UNSUPPORTED", "INVALID_INPUT", "INTERNAL_ERROR"):
            words = "; ".join(str(d) for d in result.diagnostics) or status.lower()
            if _GAVE_UP in words:
                self.notes.append("a search ended without a plan and without a proof")
                return
            kind = UnsupportedError if status == "UNSUPPORTED" else PlannerError
            self.failures.append(kind(f"kairos: {words}"))
        if result.stop_reason.name == "PROVEN_OPTIMAL":
            self.is_proven = self._proves()

    def _proves(self) -> bool:
        """Return whether kairos' proof is one for our metric.

        It minimizes what it calls the metric; where the problem states none, that is the number of
        actions, and that of hrcplan is the cost, if there is one.
        """
        problem = self.request.problem
        if problem.domain.is_temporal or self.best is None:
            return False
        if self.lowering is not None:
            small = self.lowering.fits(_FLOAT_BITS, self.best[0])
            return self.lowering.exact_for_metric and small
        exact = prices_exactly(problem, _FLOAT_BITS, self.best[0])
        if not (exact and decides_exactly(problem, _FLOAT_BITS) and never_lowers_cost(problem)):
            return False
        if problem.metric is None:
            return TOTAL_COST not in problem.domain.functions
        return problem.metric == Function(TOTAL_COST) and not problem.maximize

    def _objective(self, cost: float | None) -> Number | None:
        """Return kairos' own figure, where it speaks of our metric; it prints double precision."""
        problem = self.request.problem
        if cost is None or problem.metric is None:
            return None
        value = Fraction(cost).limit_denominator(_DECIMALS)
        if self.lowering is not None:
            return self.lowering.objective(value)
        return int(value) if value.denominator == 1 else value

    def _answer(self) -> Answer:
        if self.best is not None:
            status = Status.OPTIMAL if self.is_proven else Status.SOLVED
            return Answer(status, self.best[1], self.best[2])
        if self.invalid is not None:
            message = f"kairos gave only invalid plans: {self.invalid.reason}"
            raise PlannerError(message, code="invalid-plan")
        if self.failures and not self.notes:
            raise self.failures[0]
        note = "; ".join(dict.fromkeys(self.notes)) or "no search found a plan in time"
        return Answer(Status.UNSOLVED, note=note)

    def _unsolvable(self) -> Answer:
        """Return kairos' claim, if it has no plan, and counts nothing that it may have rounded."""
        if self.best is not None:
            return self._answer()
        if self.lowering is None and not decides_exactly(self.request.problem, _FLOAT_BITS):
            note = "it says unsolvable, but counts in floating point"
            return Answer(Status.UNSOLVED, note=note)
        return Answer(Status.UNSOLVABLE)


def _without_time(metric: Expr) -> Expr:
    """Return a metric with 0 for total-time where it is only part of sums and differences."""
    match metric:
        case Function(name) if name == TOTAL_TIME:
            return Constant(0)
        case Arithmetic("+" | "-", parts):
            return replace(metric, parts=tuple(map(_without_time, parts)))
        case Arithmetic("*", (Constant() as factor, part)) | Arithmetic(
            "*", (part, Constant() as factor)
        ):
            return Arithmetic("*", (factor, _without_time(part)))
    return metric


def _lowering(request: Request) -> Lowering | None:
    """Return the lowered task where actions change costs: kairos' search ignores such metrics.

    Where any plan is enough it gets the lifted files, which are smaller.
    """
    domain = request.problem.domain
    if request.any_plan or domain.is_temporal or domain.changed_functions <= {TOTAL_COST}:
        return None
    with contextlib.suppress(UnsupportedError, LimitError):
        return lower(request.task)
    return None
