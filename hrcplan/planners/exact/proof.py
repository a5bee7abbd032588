"""From a task to a proven plan, a proof that there is none, or a plan with a bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from hrcplan.core.numbers import Number, exact
from hrcplan.errors import LimitError
from hrcplan.pddl.model import TOTAL_COST
from hrcplan.planners.contract import MEMORY_BYTES, Answer, Status
from hrcplan.planners.exact.first_plan import first_path
from hrcplan.planners.exact.gaps import starts
from hrcplan.planners.exact.memory import TaskMemory
from hrcplan.planners.exact.search import WAIT, Search
from hrcplan.planners.exact.symmetry import symmetries
from hrcplan.planners.exact.weights import Metric, weights
from hrcplan.plans import Plan
from hrcplan.task import Task

GREED = 3
QUICK = 300
"""Nodes of a search that is over soon; a longer one looks for a plan and for symmetries first."""
MAX_GREEDY = 1000
"""Nodes of a search for a better plan to begin with."""


@dataclass(frozen=True)
class Wish:
    """What to look for, and until when.

    With ``any_plan``, the first plan is enough. ``improves`` asks for the best plan that is there
    at the deadline; ``on_plan`` is called with plans that the search goes on from.
    """

    deadline: float
    any_plan: bool = False
    improves: bool = False
    on_plan: Callable[[Plan], None] = lambda plan: None
    memory_bytes: int = MEMORY_BYTES


class Proof:
    """The search for one task, under its costs of now.

    Raises:
        UnsupportedError: if an action has a negative cost.
        LimitError: at the deadline, before the search has begun.
    """

    def __init__(self, task: Task, memory: TaskMemory, metric: Metric, wish: Wish) -> None:
        self._task, self._memory, self._metric, self._wish = task, memory, metric, wish
        self._weights = weights(task, metric, memory.frame, memory.lanes)
        self._ahead = memory.estimates(task, self._weights, wish.deadline)
        self._first: str | None = None

    def answer(self) -> Answer:
        """Return what the search comes to within its limits."""
        search = self._search(GREED if self._wish.any_plan else 1)
        try:
            path = search.run(QUICK)
            if path is None and not search.is_over:
                path = self._continued(search)
        except LimitError as error:
            return self._unproven(error, search)
        if path is None:
            return Answer(Status.UNSOLVABLE)
        if self._wish.any_plan:
            return self._solved(Status.SOLVED, path)
        return self._solved(Status.OPTIMAL, path, bound=self._bound(search))

    def _search(self, greed: int) -> Search:
        memory = self._memory
        return Search(
            self._task, memory.frame, memory.graph, self._weights, self._ahead,
            self._wish.deadline, greed, memory_bytes=self._wish.memory_bytes,
        )  # fmt: skip

    def _continued(self, search: Search) -> str | None:
        """Return the path that a longer search finds."""
        task, memory, deadline = self._task, self._memory, self._wish.deadline
        search.swaps = symmetries(task, memory.frame, self._weights, deadline)
        self._first = first_path(
            task, memory.frame, memory.graph, self._weights, self._ahead, search.swaps, deadline
        )
        if self._first is None or self._wish.any_plan:
            return self._first
        if self._wish.improves:
            better = self._search(GREED).run(MAX_GREEDY) or self._first
            self._first = min(self._first, better, key=self._value)
            self._wish.on_plan(self._plan(self._first))
        search.most = self._value(self._first)
        return search.run()

    def _value(self, path: str) -> int:
        """Return the metric of a path in whole numbers, without gaps."""
        schedule = starts(path, self._memory.frame)
        ticks = self._weights.ticks
        cost = sum(self._weights.cost[action] for action, _ in schedule)
        return cost + self._weights.tick * max((t + ticks[a] for a, t in schedule), default=0)

    def _unproven(self, error: LimitError, search: Search) -> Answer:
        bound = None if self._wish.any_plan else self._bound(search)
        if self._first is None or not (self._wish.improves or self._wish.any_plan):
            return Answer(Status.UNSOLVED, note=error.message, bound=bound)
        return self._solved(Status.SOLVED, self._first, error.message, bound)

    def _bound(self, search: Search) -> Number:
        return exact(Fraction(search.bound, self._weights.scale) + self._metric.constant)

    def _plan(self, path: str) -> Plan:
        return self._memory.gaps.plan(self._task, path, self._memory.frame)

    def _solved(
        self, status: Status, path: str, note: str = "", bound: Number | None = None
    ) -> Answer:
        plan = self._plan(path)
        return Answer(status, plan, self._objective(path, plan), note, bound)

    def _objective(self, path: str, plan: Plan) -> Number | None:
        """Return the metric of the plan as printed; None where it has none but a cost."""
        problem, metric = self._task.problem, self._metric
        if problem.metric is None and TOTAL_COST in problem.domain.functions:
            return None
        price = sum(self._task.costs[ord(letter)] for letter in path if letter != WAIT)
        value = metric.cost * price + metric.time * (plan.makespan_s or 0) + metric.constant
        return int(value) if value == int(value) else value
