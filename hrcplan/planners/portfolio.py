"""What several planners have said so far, put together: the best plan, and what is proven."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from hrcplan.core.numbers import Number, number_text
from hrcplan.errors import HrcplanError, LimitError, PlannerError, UnsupportedError
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Status
from hrcplan.planners.result import Attempt, Result, is_better

AUTO = "auto"


class Portfolio:
    """Checked results and failures of planners for one request.

    "Unsolvable" is believed from a search of hrcplan's own, or from two planners. A plan refutes
    it; a better plan refutes a proof of optimality.
    """

    def __init__(self, problem: Problem, any_plan: bool) -> None:
        self.problem = problem
        self.any_plan = any_plan
        self.best: Result | None = None
        self.bound: Number | None = None
        self._bound_note = ""
        self._is_proven = False
        self._claims: dict[str, Result] = {}
        self._unsolvable: Result | None = None
        self._attempts: list[Attempt] = []
        self._failures: list[HrcplanError] = []
        self._last: Result | None = None

    @property
    def is_settled(self) -> bool:
        """Whether nothing that another planner says could change the result."""
        if self.best is None:
            return self._unsolvable is not None
        return self._is_proven or self.any_plan

    @property
    def confirms_unsolvable(self) -> bool:
        """Whether a planner says that there is no plan, and none has one."""
        return self.best is None and bool(self._claims)

    def take_plan(self, result: Result) -> None:
        """Take a checked plan of a planner that may still go on."""
        problem = self.problem
        if result.plan is None:
            return
        mine = self.best.objective if self.best else None
        proof = result.status is Status.OPTIMAL
        if self.best is None or is_better(problem, result.objective, mine):
            is_refuted = self._is_proven and not self._within_gaps(result)
            self.best = result
            self._is_proven = proof or (self._is_proven and not is_refuted)
            if is_refuted:
                self.bound = None
        elif proof and not self._is_proven and not self._is_beaten(result):
            self.best, self._is_proven = result, True

    def take(self, result: Result) -> None:
        """Take what a planner said when it ended."""
        outcome = result.claim or result.status
        notes = [a.outcome for a in result.attempts if a.outcome != outcome.value]
        words = ": ".join([outcome.value, *notes])
        self._attempts.append(Attempt(result.planner, words, result.wall_s))
        self._take_bound(result.bound)
        if result.claim is Status.UNSOLVABLE:
            self._take_claim(result)
        self._last = result
        self.take_plan(result)

    def take_bound(self, result: Result) -> None:
        """Take what is known from a search for bounds; it is no planner that has been asked."""
        self._take_bound(result.bound)
        if result.claim is Status.UNSOLVABLE:
            self.take(result)

    def take_no_bound(self, error: HrcplanError) -> None:
        """Take why a search for bounds has none."""
        self._bound_note = error.message

    def take_failure(self, planner: str, error: HrcplanError, wall_s: float) -> None:
        """Take that a planner could not hold the task, or failed."""
        self._failures.append(error)
        self._attempts.append(Attempt(planner, error.message, wall_s))

    def _take_claim(self, result: Result) -> None:
        self._claims[result.planner] = result
        if result.status is Status.UNSOLVABLE:
            self._unsolvable = result
        elif len(self._claims) > 1:
            self._unsolvable = replace(result, status=Status.UNSOLVABLE)

    def _take_bound(self, bound: Number | None) -> None:
        """Keep the bound that says more: of two bounds, the one that fewer plans could reach."""
        if self.bound is None or is_better(self.problem, self.bound, bound):
            self.bound = self.bound if bound is None else bound

    def _within_gaps(self, result: Result) -> bool:
        """Return whether two plans differ by no more than the gaps between their actions."""
        assert self.best is not None
        if result.objective is None or self.best.objective is None:
            return True
        apart = abs(Fraction(result.objective - self.best.objective))
        return apart <= result.gaps or apart <= self.best.gaps

    def _is_beaten(self, result: Result) -> bool:
        """Return whether a plan is known that a claimed optimum should not allow."""
        assert self.best is not None
        better = is_better(self.problem, self.best.objective, result.objective)
        return better and not self._within_gaps(result)

    def only(self, planner: str) -> Result:
        """Return what the only planner that was asked said: its own words, not the portfolio's.

        Raises:
            HrcplanError: what went wrong with it.
        """
        if self.best is not None or self._last is None:
            return replace(self.result(), planner=planner)
        return replace(self._last, attempts=tuple(self._attempts))

    def result(self) -> Result:
        """Return the best plan with what is proven about it, or why there is none.

        Raises:
            HrcplanError: if no planner was able to say anything: the most telling failure.
        """
        attempts = tuple(self._attempts)
        if self.best is not None:
            attempts = tuple(map(self._refuted, attempts))
            return self._with_bound(replace(self.best, attempts=attempts))
        if self._unsolvable is not None:
            return replace(self._unsolvable, attempts=attempts)
        if self._last is None and self._failures:
            raise self._worst_failure()
        why = "no planner had an answer in time"
        if self._claims:
            why = f"{', '.join(self._claims)} said unsolvable, which nothing confirms"
        return Result(
            Status.UNSOLVED, AUTO, None, None, 0.0, why, attempts, bound=self.bound,
            claim=Status.UNSOLVED,
        )  # fmt: skip

    def _refuted(self, attempt: Attempt) -> Attempt:
        """Return an attempt; one that calls the task unsolvable with the plan that refutes it."""
        claim = Status.UNSOLVABLE.value
        if self.best is None or not attempt.outcome.startswith(claim):
            return attempt
        note = f"{claim}, which the plan of '{self.best.planner}' refutes"
        return replace(attempt, outcome=note)

    def _with_bound(self, best: Result) -> Result:
        """Return the best plan as proven, if a planner or the bound says so."""
        bound, value = self.bound, best.objective
        if bound is not None and value is not None:
            apart = abs(Fraction(value - bound))
            if is_better(self.problem, value, bound) and apart > best.gaps:
                bound = None  # a plan refutes a bound
                self._bound_note = f"the plan refutes a bound of {number_text(self.bound or 0)}"
            elif apart <= best.gaps:
                return replace(best, bound=bound, status=Status.OPTIMAL)
        status = Status.OPTIMAL if self._is_proven else Status.SOLVED
        note = "" if bound is not None else self._bound_note
        return replace(best, bound=bound, status=status, bound_note=note)

    def _worst_failure(self) -> HrcplanError:
        for kind in (LimitError, PlannerError, UnsupportedError):
            for error in self._failures:
                if isinstance(error, kind):
                    return error
        return self._failures[-1]
