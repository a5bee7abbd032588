"""What follows a state of the sequential reading costs at least this much.

Two sources: distances in the whole graph, where it is small; else landmarks. A landmark is a set of
actions of which every plan holds one (``search/lm_cut.py``). Those that a path has not met yet are
landmarks of the state at its end, too. So a state inherits what is left of its parent's landmarks,
and more are looked for only when the search comes to it (Pommerening and Helmert, ICAPS 2013).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from hrcplan.core.bits import positions
from hrcplan.core.clock import check_time
from hrcplan.planners.exact.graph import FAR, Graph
from hrcplan.planners.exact.weights import Weights
from hrcplan.search.lm_cut import RelaxedTask
from hrcplan.task import Task
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator


class Estimate(NamedTuple):
    """Lower bounds on the actions that follow a state, up to a goal.

    ``work`` is the sum of their costs and shares of time, or ``FAR`` if there is no goal; ``cost``
    the sum of their costs; ``busy`` the sum of their ticks, for each agent that they keep busy;
    ``chain`` the ticks of those that cannot overlap, one after the other.
    """

    work: int
    cost: int = 0
    busy: int = 0
    chain: int = 0


class Estimates(Protocol):
    """Estimates of the states of a graph, by index."""

    def __getitem__(self, state: int) -> Estimate:
        """Return the estimate of a state that was inherited or refined."""

    def inherit(self, parent: int, action: int, child: int) -> None:
        """Note that an action leads from a refined state to another one."""

    def refine(self, state: int) -> bool:
        """Improve the estimate of a state; return False if that was done before."""


class GraphDistances:
    """The least work from every state to a goal, which nothing improves.

    Args:
        least: The distances of all states.
    """

    def __init__(self, least: Sequence[int]) -> None:
        self._least = least

    def __getitem__(self, state: int) -> Estimate:
        return Estimate(self._least[state])

    def inherit(self, parent: int, action: int, child: int) -> None:
        """Do nothing."""

    def refine(self, state: int) -> bool:
        """Return False."""
        return False


class _Landmark(NamedTuple):
    """Actions, and the shares of their work, cost and ticks that no other landmark counts."""

    actions: tuple[int, ...]
    shares: Estimate


class Landmarks:
    """Estimates from landmarks; sets of them are bits over all that were ever found.

    Args:
        task: The task.
        graph: The states, by index.
        weights: What actions cost.
        deadline: When to give up, by ``time.monotonic()``.
    """

    def __init__(self, task: Task, graph: Graph, weights: Weights, deadline: float) -> None:
        self._graph, self._weights, self._deadline = graph, weights, deadline
        self._relaxed = RelaxedTask(_operators(task), task.goal)
        self._limits = tuple([*costs, 0] for costs in (weights.work, weights.cost, weights.busy))
        self._in_time = RelaxedTask(_halves(task), task.goal)
        self._half_ticks = [0 if half else ticks for ticks in weights.ticks for half in (1, 0)] + [
            0
        ]
        self._landmarks: list[_Landmark] = []
        self._hit_by = [0] * (len(weights.ticks) + 1)
        self._estimates: dict[int, Estimate] = {}
        self._ahead: dict[int, int] = {}
        self._final: set[int] = set()

    def __getitem__(self, state: int) -> Estimate:
        return self._estimates.get(state, _NOTHING)

    def inherit(self, parent: int, action: int, child: int) -> None:
        """Give a state what its parent's estimate says about it, unless it has a better one."""
        if child in self._final:
            return
        ahead = self._ahead[parent]
        hits = ahead & self._hit_by[action]
        work, cost, busy, chain = self._estimates[parent]
        for i in positions(hits):
            shares = self._landmarks[i].shares
            work -= shares.work
            cost -= shares.cost
            busy -= shares.busy
        before = self._estimates.get(child)
        if before is None or before.work < work:
            chain = max(0, chain - self._weights.ticks[action])
            self._estimates[child] = Estimate(work, cost, busy, chain)
            self._ahead[child] = ahead & ~hits

    def refine(self, state: int) -> bool:
        """Look for more landmarks, and for a longer chain; return False if that was done before.

        Raises:
            LimitError: at the deadline.
        """
        if state in self._final:
            return False
        facts = self._graph.states[state]
        more = self._more_landmarks(state, self._relaxed.start(facts), self[state])
        if more.work < FAR and self._may_decide(more):
            chain = self._in_time.h_max(self._in_time.start(facts), self._half_ticks)
            more = more._replace(chain=max(more.chain, chain))
        self._estimates[state] = more
        self._final.add(state)
        return True

    def _may_decide(self, estimate: Estimate) -> bool:
        """Return whether the longest chain may say more than the work, by what is inherited of it.

        To look for it takes as long as to look for a landmark.
        """
        if not self._weights.tick:
            return False
        return not self._final or 2 * estimate.chain * self._weights.n_agents >= estimate.busy

    def _more_landmarks(self, state: int, start: Sequence[int], estimate: Estimate) -> Estimate:
        ahead = self._ahead.setdefault(state, 0)
        left = self._left(ahead, 0)
        if self._relaxed.is_free(start, left):
            return estimate
        costs, ticks = self._left(ahead, 1), self._left(ahead, 2)
        work, cost, busy, chain = estimate
        for cut in self._relaxed.cuts(start, left):
            check_time(self._deadline, "while looking for landmarks")
            actions = tuple(sorted(cut.ops))
            shares = Estimate(cut.cost, _take(costs, actions), _take(ticks, actions))
            ahead |= self._add(_Landmark(actions, shares))
            work, cost, busy = work + cut.cost, cost + shares.cost, busy + shares.busy
        self._ahead[state] = ahead
        return Estimate(work if self._relaxed.reaches_goal else FAR, cost, busy, chain)

    def _left(self, ahead: int, part: int) -> list[int]:
        """Return what a set of landmarks leaves of the actions' work, cost or ticks."""
        left = list(self._limits[part])
        for i in positions(ahead):
            actions, shares = self._landmarks[i]
            share = shares[part]
            for action in actions:
                left[action] -= share
        return left

    def _add(self, landmark: _Landmark) -> int:
        """Return the bit of a new landmark."""
        bit = 1 << len(self._landmarks)
        self._landmarks.append(landmark)
        for action in landmark.actions:
            self._hit_by[action] |= bit
        return bit


_NOTHING = Estimate(0)


def _take(costs: list[int], actions: Sequence[int]) -> int:
    """Return what the cheapest of some actions costs, after taking it off all of them."""
    share = min(costs[action] for action in actions)
    for action in actions:
        costs[action] -= share
    return share


def _operators(task: Task) -> list[Operator]:
    """Return the actions as operators, without conditions that always hold."""
    always = _always(task)
    return [
        Operator(_without(action.tests, always), *action.sequential, action.index, 1)
        for action in task.actions
    ]


def _halves(task: Task) -> list[Operator]:
    """Return two operators for each action: what it does at its start, and what at its end.

    What a start deletes is false at once, and others may wait for that.
    """
    always = _always(task)
    halves: list[Operator] = []
    for action in task.actions:
        tests = _without(action.tests, always)
        halves.append(Operator(tests, action.at_start, (), action.index, 1))
        halves.append(Operator(tests, (), action.at_end, action.index, 1))
    return halves


def _always(task: Task) -> int:
    """Return the facts that hold in every state of the sequential reading."""
    always = task.initial
    for action in task.actions:
        always &= ~action.deletes
    return always


def _without(tests: Tests, facts: int) -> Tests:
    return tuple((mask & ~facts, value & ~facts) for mask, value in tests)
