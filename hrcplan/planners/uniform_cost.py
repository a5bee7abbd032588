"""Uniform-cost search in our own semantics: proofs with exact numbers for small classical tasks.

Numbers are integers and fractions, so nothing is rounded. It takes metrics that other planners do
not: to be maximized, of functions that actions change, with negative costs. It knows no heuristic,
so it ends with a limit where there are many states.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Hashable, Iterator
from contextlib import suppress
from dataclasses import replace
from heapq import heappop, heappush
from typing import NamedTuple

from hrcplan.core.numbers import Number, exact
from hrcplan.core.records import record
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Problem
from hrcplan.pddl.semantics import Undefined
from hrcplan.pddl.walks import functions_in
from hrcplan.planners.contract import Answer, Capabilities, OwnPlanner, Request, Status
from hrcplan.planners.gains import idle_gain
from hrcplan.planners.state_spaces import BitSpace, LiftedSpace, StateSpace
from hrcplan.plans import Plan, PlannedAction
from hrcplan.task.numbers import linear

MAX_STATES = 400_000


class UniformCost(OwnPlanner):
    """Expands states by the metric of their path: small tasks, any metric, exact numbers."""

    card = Capabilities(
        "uniform-cost",
        "exhaustive search with exact numbers: small classical tasks, any metric",
        numeric=True,
        metric="cost",
        proves=True,
        limits=True,
        own=True,
    )

    def solve(self, request: Request) -> Answer:
        """Return a best plan with its proof, a proof that there is none, or a bound.

        Raises:
            UnsupportedError: for temporal tasks, and for metrics that are no sum of cost, time and
                a function of the last state, or that improve without end.
        """
        problem = request.problem
        if problem.domain.is_temporal:
            raise UnsupportedError("uniform-cost plans without time")
        try:
            space = _space(request)
            try:
                return _Search(space, path_metric(problem), request).answer()
            except UnsupportedError:
                steps = _Search(space, _STEPS, replace(request, any_plan=True)).answer()
                if steps.status is not Status.UNSOLVABLE:
                    raise
                return steps
        except LimitError as error:
            return Answer(Status.UNSOLVED, note=error.message)
        except Undefined as error:
            raise UnsupportedError(f"uniform-cost cannot evaluate the metric: {error}") from None


def _space(request: Request) -> StateSpace:
    """Return the states as bits; as facts and numbers where idle actions may gain."""
    if idle_gain(request.problem) is None:
        with suppress(UnsupportedError):
            return BitSpace(request.task)
    return LiftedSpace(plain(request.problem), request.deadline)


@record
class PathMetric:
    """A metric to be minimized: ``cost`` and ``step`` per action, and a value of the last state.

    ``sign`` is -1 where the problem's metric is to be maximized; ``on_state`` says that the rest
    of the metric depends on the last state.
    """

    cost: Number
    step: Number
    sign: int
    on_state: bool


_STEPS = PathMetric(0, 1, 1, False)


def path_metric(problem: Problem) -> PathMetric:
    """Return the metric of a classical problem, taken apart.

    Raises:
        UnsupportedError: if it multiplies or divides total-cost or total-time by what changes.
    """
    if problem.metric is None:
        counts = TOTAL_COST not in problem.domain.functions
        return PathMetric(0 if counts else 1, 1 if counts else 0, 1, False)
    sign = -1 if problem.maximize else 1
    names = {function.name for function in functions_in(problem.metric)}
    changing = names & problem.domain.changed_functions - {TOTAL_COST}
    parts = linear(problem.metric, {})
    if parts is None:
        if names & {TOTAL_COST, TOTAL_TIME}:
            raise UnsupportedError(f"the metric {problem.metric} is not a weighted sum")
        return PathMetric(0, 0, sign, True)
    cost, step = (sign * parts.get((name,), 0) for name in (TOTAL_COST, TOTAL_TIME))
    return PathMetric(cost, step, sign, bool(changing))


class _BestPath(NamedTuple):
    """How a state was reached at best."""

    cost: Number
    before: Hashable
    action: PlannedAction | None


class _Search:
    """Dijkstra's algorithm; states are opened again where negative costs make that necessary."""

    def __init__(self, space: StateSpace, metric: PathMetric, request: Request) -> None:
        self.space, self.metric, self.request = space, metric, request
        self.best_paths: dict[Hashable, _BestPath] = {}
        self.best: tuple[Number, Hashable] | None = None
        self.negative = False

    def answer(self) -> Answer:
        """Return what the search finds within the limits of the request."""
        bound = self._run()
        if self.best is None:
            if bound is None:
                return Answer(Status.UNSOLVABLE)
            return Answer(Status.UNSOLVED, note=self._reason(), bound=self._bound(bound))
        plan, value = Plan(tuple(self._path(self.best[1]))), self._outer(self.best[0])
        if bound is None:
            return Answer(Status.OPTIMAL, plan, value, bound=value)
        note = "" if self.request.any_plan else self._reason()
        return Answer(Status.SOLVED, plan, value, note, self._bound(bound))

    def _run(self) -> Number | None:
        """Search until nothing better can be found (None), or return how far it got."""
        start = self.space.initial
        self.best_paths[start] = _BestPath(0, None, None)
        queue: list[tuple[Number, int, Hashable]] = [(0, 0, start)]
        ticket = itertools.count(1)  # of states that are equally far, the first one comes first
        while queue:
            distance, _, state = heappop(queue)
            if self.best_paths[state].cost != distance:
                continue
            if self._is_enough(distance, state):
                return None
            if self._is_out_of_bounds():
                return distance
            if self.request.any_plan and self.best is not None:
                return distance
            for action, cost, after in self.space.successors(state):
                price = self.metric.cost * cost + self.metric.step
                old = self.best_paths.get(after)
                if old is not None and old.cost <= distance + price:
                    continue
                self.negative = self.negative or price < 0
                if self.negative and old is not None:
                    self._refuse_cycle(state, after)
                self.best_paths[after] = _BestPath(distance + price, state, action)
                heappush(queue, (distance + price, next(ticket), after))
        return None

    def _is_enough(self, cost: Number, state: Hashable) -> bool:
        """Take ``state`` as a goal if it is one, and return whether no other can be better."""
        if not self.space.is_goal(state):
            return False
        value = self._inner(cost, state)
        if self.best is None or value < self.best[0]:
            self.best = value, state
        return self._is_monotonic()

    def _is_monotonic(self) -> bool:
        """Return whether longer paths are never better, whatever their last state."""
        metric, space = self.metric, self.space
        lowers = metric.step < 0 or metric.cost < 0 or (metric.cost and space.has_negative_costs)
        return not metric.on_state and not lowers

    def _bound(self, cost: Number) -> Number | None:
        """Return what no plan is better than, after all states nearer than ``cost``."""
        if not self._is_monotonic():
            return None
        return self._outer(self._inner(cost, self.space.initial))

    def _refuse_cycle(self, state: Hashable, after: Hashable) -> None:
        """Raise if a better way to ``after`` leads through ``after`` itself."""
        place: Hashable = state
        while place is not None:
            if place == after:
                raise UnsupportedError("repeating some actions improves the metric without end")
            place = self.best_paths[place].before

    def _is_out_of_bounds(self) -> bool:
        return len(self.best_paths) > MAX_STATES or time.monotonic() > self.request.deadline

    def _reason(self) -> str:
        return f"stopped after {len(self.best_paths):,} states"

    def _inner(self, cost: Number, state: Hashable) -> Number:
        """Return the metric, with the sign that is minimized, of a path that ends in ``state``."""
        return exact(cost + self.metric.sign * self.space.value(state))

    def _outer(self, inner: Number) -> Number:
        return exact(self.metric.sign * inner)

    def _path(self, state: Hashable) -> Iterator[PlannedAction]:
        actions: list[PlannedAction] = []
        while (step := self.best_paths[state]).action is not None:
            actions.append(step.action)
            state = step.before
        yield from reversed(actions)
