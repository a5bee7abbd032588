"""``exact`` as a planner: from a request to a proven plan, or to the reason why there is none."""

from __future__ import annotations

import time
from fractions import Fraction

from hrcplan.core.numbers import Number, exact
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, Problem
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.exact.frame import StaticMasks, frame
from hrcplan.planners.exact.gaps import Gaps
from hrcplan.planners.exact.graph import FAR, Graph
from hrcplan.planners.exact.overlap import check_overlap, lanes_of
from hrcplan.planners.exact.search import WAIT, Search
from hrcplan.planners.exact.weights import Metric, Weights, metric, weights
from hrcplan.plans import Plan
from hrcplan.search.reachable_pairs import ReachablePairs
from hrcplan.task import Task
from hrcplan.task.conditions import Test, meets

GREED = 3
MAX_KEPT_STATES = 100_000  # of other structures than the one that is asked for


class _Memo:
    """All that replans of one grounding share: masks, pairs, the graph, what actions touch."""

    def __init__(self, task: Task) -> None:
        self.structure = task.structure
        self.frame: StaticMasks = frame(task)
        self.pairs = ReachablePairs(self.frame)
        self.lanes: tuple[tuple[str, ...], ...] = ()
        self.graph = Graph()
        self.gaps = Gaps()
        self._goal: tuple[Test, ...] = ()
        self._goals: list[int] = []
        self._n_checked = 0

    def admit(self, task: Task) -> None:
        """Check what can follow the initial state of ``task``, unless that is known already."""
        if task.initial not in self.graph.index:
            self.pairs.admit(task.initial)
            check_overlap(task, self.pairs, self.frame)
            self.lanes = lanes_of(task, self.pairs, self.frame)

    def goals(self, task: Task) -> list[int]:
        """Return the states of the graph, as indices, in which the goal of ``task`` holds."""
        if self._goal != task.goal:
            self._goal, self._goals, self._n_checked = task.goal, [], 0
        states = self.graph.states
        new = range(self._n_checked, len(states))
        self._goals += [i for i in new if meets(states[i], task.goal)]
        self._n_checked = len(states)
        return self._goals


class ExactPlanner:
    """Proves weighted metrics of cost and time in tasks where no concurrency is required.

    It keeps what does not depend on costs of the last structures it saw: hold on to one object and
    give it ``task.with_values(...)`` to replan in milliseconds.

    >>> from hrcplan import ground
    >>> task, planner = ground("transport", "two-boxes"), ExactPlanner()
    >>> len(planner.replan(task).plan.actions)
    8
    >>> tired = task.with_values({("motivation", "human"): 10})
    >>> {action.args[0] for action in planner.replan(tired).plan.actions}
    {'robot'}
    """

    def __init__(self) -> None:
        self.card = Capabilities(
            "exact",
            "A* over two-lane schedules: proves weighted metrics of cost and time",
            classical=False,
            temporal=True,
            metric="cost+time",
            proves=True,
            limits=True,
            own=True,
        )
        self._memos: list[_Memo] = []

    def missing(self) -> str | None:
        """Return None: it is part of this package."""
        return None

    def solve(self, request: Request) -> Answer:
        """Return a proven plan, a proof that there is none, or what was not enough for one.

        Raises:
            UnsupportedError: if the task is outside the class that ``frame.py`` describes.
            LimitError: if there are too many ground actions.
        """
        return self.replan(request.task, request.deadline, any_plan=request.any_plan)

    def replan(
        self, task: Task, deadline: float | None = None, *, any_plan: bool = False
    ) -> Answer:
        """Return the answer for a task; quick if its grounding is that of the call before.

        Args:
            task: The task, with the costs and the initial state of now.
            deadline: When to give up, by ``time.monotonic()``; a minute from now by default.
            any_plan: A plan that is found sooner, without a proof, is enough.

        Raises:
            UnsupportedError: if the task is outside the class that ``frame.py`` describes.
        """
        until = time.monotonic() + 60 if deadline is None else deadline
        try:
            objective = metric(task.problem)
            return _answer(task, self._find(task), objective, until, any_plan)
        except UnsupportedError as error:
            raise UnsupportedError(f"exact declines: {error.message}", hint=error.hint) from None
        except LimitError as error:
            return Answer(Status.UNSOLVED, note=error.message)

    def _find(self, task: Task) -> _Memo:
        """Return the memory of the structure of a task, as the most recent one."""
        memo = next((each for each in self._memos if each.structure is task.structure), None)
        self._memos = [each for each in self._memos if each is not memo]
        while sum(len(each.graph.states) for each in self._memos) > MAX_KEPT_STATES:
            del self._memos[0]  # frees the graph of another task first
        self._memos.append(memo or _Memo(task))
        return self._memos[-1]


def _answer(task: Task, memo: _Memo, objective: Metric, deadline: float, any_plan: bool) -> Answer:
    memo.admit(task)
    costs = weights(task, objective, memo.frame, memo.lanes)
    graph = memo.graph
    graph.grow(task, deadline)
    goals = memo.goals(task)
    ahead = graph.distances(costs.work, goals, deadline)
    if ahead[graph.index[task.initial]] == FAR:
        return Answer(Status.UNSOLVABLE)
    search = Search(
        memo.frame, graph, costs, ahead, frozenset(goals), deadline,
        GREED if any_plan else 1,
    )  # fmt: skip
    try:
        path = search.run(task.initial)
    except LimitError as error:
        bound = None if any_plan else _bound(search, costs, objective)
        return Answer(Status.UNSOLVED, note=error.message, bound=bound)
    assert path is not None  # the sequential plan is a schedule too
    plan = memo.gaps.plan(task, path, memo.frame)
    price = sum(task.costs[ord(letter)] for letter in path if letter != WAIT)
    value = _objective(task.problem, objective, plan, price)
    if any_plan:
        return Answer(Status.SOLVED, plan, value)
    return Answer(Status.OPTIMAL, plan, value, bound=_bound(search, costs, objective))


def _bound(search: Search, costs: Weights, objective: Metric) -> Number:
    """Return what no plan is better than, as far as the search has got."""
    return exact(Fraction(search.bound, costs.scale) + objective.constant)


def _objective(problem: Problem, objective: Metric, plan: Plan, price: Number) -> Number | None:
    """Return the metric of the plan as printed; None where it has none but a cost."""
    if problem.metric is None and TOTAL_COST in problem.domain.functions:
        return None
    value = objective.cost * price + objective.time * (plan.makespan_s or 0) + objective.constant
    return int(value) if value == int(value) else value
