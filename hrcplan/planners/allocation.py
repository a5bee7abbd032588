"""Who does what as one value changes: the allocation diagram, computed and not sampled.

What a plan costs is a line over a function value that its actions add up, and the best plan costs
the least of all lines: a concave function of straight pieces. Where two pieces meet the allocation
flips. Lines that are best somewhere are found where those known cross, and a crossing at which no
plan is better is a flip: two planner calls for each piece, and every number exact (Eisner and
Severance 1976, on parametric search).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import gcd, lcm

from hrcplan.core.numbers import Number, exact, number_text
from hrcplan.core.records import field, record
from hrcplan.errors import HrcplanError, LimitError, PlannerError, UnsupportedError, UsageError
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, FluentKey, Problem, fact_text
from hrcplan.pddl.semantics import evaluate
from hrcplan.planners import registry
from hrcplan.planners.contract import Planner, Status
from hrcplan.planners.result import Result
from hrcplan.planners.solve import AUTO, DEFAULT_TIMEOUT_S, solve
from hrcplan.plans import EPSILON_S, Plan, lane
from hrcplan.task import Task
from hrcplan.task.regrounding import Groundings
from hrcplan.validation import objective, validate

LEAST, MOST = 0, 10
MAX_PIECES = 200


@record
class Line:
    """What a plan costs without gaps: ``intercept`` plus ``slope`` times the value."""

    plan: Plan = field(compare=False)
    intercept: Number
    slope: Number

    def at(self, value: Number) -> Number:
        """Return the metric at a value."""
        return exact(Fraction(self.intercept + self.slope * value))


@record
class Piece:
    """From ``least`` to ``most`` a plan like ``line.plan`` is best; ``n_actions`` of each agent."""

    least: Number
    most: Number
    line: Line
    n_actions: Mapping[str, int]


@record
class Diagram:
    """The best allocation for every value of one function in a range; ``value`` is that of now.

    It is approximate unless ``is_proven``: better plans may exist than those that were found.
    """

    key: FluentKey
    value: Number
    pieces: tuple[Piece, ...]
    is_proven: bool = True

    @property
    def flips(self) -> tuple[Number, ...]:
        """The values at which another allocation becomes best."""
        return tuple(piece.most for piece in self.pieces[:-1])

    @property
    def at_now(self) -> Line:
        """The line of the plan that is best at the value of now; where two are, the second."""
        pieces = [p for p in self.pieces if p.least <= self.value <= p.most]
        outside = self.pieces[0 if self.value < self.pieces[0].least else -1]
        return (pieces[-1] if pieces else outside).line

    def stays_best(self, line: Line) -> tuple[Number, Number] | None:
        """Return from where to where no plan beats that of ``line``; None if it is best nowhere."""
        values = [v for v in self._corners() if line.at(v) <= self.metric(v)]
        return (min(values), max(values)) if values else None

    def metric(self, value: Number) -> Number:
        """Return the metric of the best plan at a value in the range."""
        return min(piece.line.at(value) for piece in self.pieces)

    def radius(self, value: Number | None = None) -> Number | None:
        """Return how far the value may move, up or down, before another allocation is better.

        None if there is no flip in the range.
        """
        now = self.value if value is None else value
        away = [max(flip - now, now - flip) for flip in self.flips]
        return min(away) if away else None

    def _corners(self) -> tuple[Number, ...]:
        return (self.pieces[0].least, *self.flips, self.pieces[-1].most)


def diagram(
    problem: Problem,
    key: FluentKey,
    least: Number = LEAST,
    most: Number = MOST,
    *,
    planner: str | Planner = AUTO,
    timeout_s: float = DEFAULT_TIMEOUT_S,
) -> Diagram:
    """Return the best allocation for every value of a function from ``least`` to ``most``.

    Raises:
        UsageError: if the problem gives the function no value, or the range is empty.
        HrcplanError: if there is no plan at some value.
        LimitError: if none was found there within the limits.
        UnsupportedError: if no planner holds the task.

    >>> from hrcplan.pddl.inputs import read
    >>> found = diagram(read("transport", "two-boxes"), ("motivation", "human"))
    >>> [str(flip) for flip in found.flips], str(found.radius())
    (['19/2'], '17/2')
    """
    if key not in problem.values:
        raise UsageError(f"{fact_text(key)} has no value in the problem", code="bad-setting")
    if not least < most:
        raise UsageError(f"from {least} to {most} there is nothing to look at", code="bad-range")
    best = _Best(problem, key, planner, timeout_s)
    pieces = _pieces(best, (least, best(least)), (most, best(most)))
    if not best.is_proven:
        pieces = lowest(best.lines, least, most, problem)
    return Diagram(key, problem.values[key], tuple(pieces), best.is_proven)


def line_of(problem: Problem, plan: Plan, key: FluentKey) -> Line:
    """Return what a plan costs by the value of a function, from that of the problem on.

    Raises:
        UsageError: if the plan is not valid, or its cost is no line over this function.
    """
    now = problem.values[key]
    first, second, third = (
        _metric(problem.with_values({key: now + more}), plan) for more in (0, 1, 2)
    )
    slope = second - first
    if third - second != slope:
        raise UsageError(f"the cost is no multiple of {fact_text(key)}", code="bad-setting")
    return Line(plan, exact(Fraction(first - slope * now)), slope)


def _metric(problem: Problem, plan: Plan) -> Number:
    """Return what planners minimize, as if actions could follow each other without gaps."""
    report = validate(problem, plan)
    value = objective(problem, report)
    if not report.valid or value is None:
        raise UsageError(f"the plan is not valid: {report.reason}", code="invalid-plan")
    late = _gaps(plan)
    if problem.metric is None:
        return exact(Fraction(value - late if problem.domain.is_temporal else value))
    values = {**problem.values, (TOTAL_COST,): 0}
    times = (evaluate(problem.metric, {**values, (TOTAL_TIME,): t}, {}) for t in (late, 0))
    with_gaps, without = times
    return exact(Fraction(value - (with_gaps - without)))


def _gaps(plan: Plan) -> Number:
    """Return by how much gaps lengthen a plan: without them it lasts a multiple of the tick.

    The tick is the largest time of which all durations are multiples; where all gaps together could
    be as long they are left in.
    """
    durations = [Fraction(a.duration_s) for a in plan.actions if a.duration_s]
    if not durations or plan.makespan_s is None:
        return 0
    scale = lcm(*(d.denominator for d in durations))
    tick = Fraction(gcd(*(int(d * scale) for d in durations)), scale)
    return plan.makespan_s % tick if tick > EPSILON_S * len(plan.actions) else 0


class _Best:
    """The best plans of one problem, by the value of a function.

    ``is_proven`` says that all of them are proven to be the best; else a plan that was found for
    another value may be the best one known.
    """

    def __init__(
        self, problem: Problem, key: FluentKey, planner: str | Planner, timeout_s: float
    ) -> None:
        self.problem, self.key = problem, key
        self._planner, self._timeout_s = planner, timeout_s
        self._groundings = Groundings()
        self.lines: list[Line] = []
        self.is_proven = True

    def _task(self, problem: Problem) -> Task | None:
        """Return the problem grounded; None where bits cannot hold it."""
        try:
            return self._groundings.task(problem)
        except (UnsupportedError, LimitError):
            return None

    def __call__(self, value: Number) -> Line:
        """Return the line of the best plan at a value.

        Raises:
            HrcplanError: if there is no plan (exit code 1), or none was found within the limits.
        """
        problem = self.problem.with_values({self.key: value})
        result = solve(problem, self._planner, timeout_s=self._timeout_s, task=self._task(problem))
        if result.plan is None:
            raise _no_plan(result, f"{fact_text(self.key)} = {number_text(value)}")
        if result.status is not Status.OPTIMAL:
            self.is_proven = False
        elif isinstance(self._planner, str):
            self._planner = registry.make(result.planner)  # it keeps what it found out
        self.lines.append(line_of(problem, result.plan, self.key))
        return min(self.lines, key=lambda line: (line.at(value), line is not self.lines[-1]))


def _no_plan(result: Result, where: str) -> HrcplanError:
    if result.status is Status.UNSOLVABLE:
        return HrcplanError(f"there is no plan at {where}", code="unsolvable")
    return LimitError(f"no plan at {where} within the limits", hint="try a longer --timeout")


def _pieces(best: _Best, first: tuple[Number, Line], last: tuple[Number, Line]) -> Sequence[Piece]:
    """Return the pieces between two values with their best lines."""
    waiting, pieces = [(first, last)], list[Piece]()
    while waiting:
        (start, left), (end, right) = waiting.pop()
        if left == right or left.slope == right.slope:
            _extend(pieces, start, end, left, best.problem)
            continue
        cross = _crossing(left, right)
        if not start <= cross <= end:  # not proven: a plan that came later is better at one end
            continue
        middle = best(cross)
        if middle.at(cross) >= left.at(cross):
            _extend(pieces, start, cross, left, best.problem)
            _extend(pieces, cross, end, right, best.problem)
        else:
            waiting += [((cross, middle), (end, right)), ((start, left), (cross, middle))]
        if len(pieces) > MAX_PIECES:
            raise PlannerError(f"more than {MAX_PIECES} allocations", code="too-many-pieces")
    return pieces


def _crossing(left: Line, right: Line) -> Number:
    return exact(Fraction(right.intercept - left.intercept) / (left.slope - right.slope))


def lowest(lines: Sequence[Line], least: Number, most: Number, problem: Problem) -> Sequence[Piece]:
    """Return the lowest of some lines from ``least`` to ``most``, as pieces."""
    pieces = list[Piece]()
    start = least
    while start < most:
        line = min(lines, key=lambda line: (line.at(start), line.slope))
        crossings = (_crossing(line, other) for other in lines if other.slope < line.slope)
        end = min([most, *(cross for cross in crossings if cross > start)])
        _extend(pieces, start, end, line, problem)
        start = end
    return pieces


def _extend(pieces: list[Piece], least: Number, most: Number, line: Line, problem: Problem) -> None:
    """Add a piece, or make the last one longer if it is the same line; nothing if it is empty."""
    if least == most:
        return
    if pieces and pieces[-1].line == line:
        least = pieces.pop().least
    counts = Counter(lane(action.args, problem) or "" for action in line.plan.actions)
    n_actions = {agent: counts[agent] for agent in sorted({*problem.agents, *counts})}
    pieces.append(Piece(least, most, line, n_actions))
