"""A* over left-shifted schedules.

A node is what holds, and which actions run for how long still. At time 0 and whenever an action
ends, any idle agent may start, or time passes to the next end. A path is a string with one letter
for each decision: a ground action started, or ``WAIT``. Letters stand in ground-action order with
``WAIT`` last, and of equal plans the one with the first path is kept: starting comes before
waiting, then ground-action order decides. Two rules leave out paths of which an earlier one leads
to the same (both leave the first of the best plans in):

* two starts of one instant that commute stand in ground-action order;
* who could have started before the last wait, and disturbed no other, does not start now.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from heapq import heappop, heappush

from hrcplan.errors import LimitError
from hrcplan.planners.exact.frame import StaticMasks
from hrcplan.planners.exact.graph import FAR, Graph
from hrcplan.planners.exact.weights import Weights
from hrcplan.task.conditions import meets

MAX_NODES = 1_000_000  # about 0.8 kB each
WAIT = chr(0x10FFFF)
_CHECK = 0xFF  # nodes between two looks at the clock

RunningActions = tuple[tuple[int, int], ...]
"""Ticks that are left and action, of each running action; the next to end comes first."""

_Node = tuple[int, str, int, int, RunningActions, int, int]
"""Bound of the whole metric, path, metric so far, facts, running actions, the state in the graph
when they have ended, and the actions that should have started before (as bits)."""


@dataclass
class Search:
    """One search: what it moves in, the bound (``ahead``), and until when.

    ``greed`` multiplies the bound; above 1 it finds plans sooner and proves nothing. With 1,
    ``bound`` is what no plan is better than, as far as the search has got.
    """

    frame: StaticMasks
    graph: Graph
    weights: Weights
    ahead: list[int]
    goals: frozenset[int]
    deadline: float
    greed: int = 1
    n_expanded: int = 0

    def __post_init__(self) -> None:
        self._open: list[_Node] = []
        self.bound = 0
        self._best: dict[tuple[int, RunningActions], tuple[int, str]] = {}

    def run(self, initial: int) -> str | None:
        """Return the path of the best plan, None if there is none.

        Raises:
            LimitError: at the deadline, or if there are too many nodes.
        """
        state = self.graph.index[initial]
        if self.ahead[state] < FAR:
            self._push("", 0, initial, (), state, 0)
        while self._open:
            node = heappop(self._open)
            value, path, price, facts, running, state, _ = node
            if self._best[facts, running] != (price, path):
                continue
            self.bound = max(self.bound, value)
            if state in self.goals:
                return path
            if self.n_expanded & _CHECK == 0:
                self._check()
            self.n_expanded += 1
            self._expand(node)
        return None

    def _check(self) -> None:
        if len(self._best) > MAX_NODES:
            raise LimitError(f"no proof within {MAX_NODES:,} nodes")
        if time.monotonic() > self.deadline:
            raise LimitError(f"no proof in time, after {self.n_expanded:,} nodes")

    def _push(
        self, path: str, price: int, facts: int, running: RunningActions, state: int, late: int
    ) -> None:
        """Put a node on the heap unless it was reached as well before."""
        best = self._best.get((facts, running))
        if best is not None and best <= (price, path):
            return
        self._best[facts, running] = (price, path)
        bound = self.ahead[state]
        if running:
            share = self.weights.share
            bound += sum([rest * share[action] for rest, action in running])
            bound = max(bound, self.weights.tick * running[-1][0])
        node = (price + self.greed * bound, path, price, facts, running, state, late)
        heappush(self._open, node)

    def _expand(self, node: _Node) -> None:
        _, path, price, facts, running, state, late = node
        frame, ahead, cost = self.frame, self.ahead, self.weights.cost
        guards = [frame.over[action] for _, action in running if frame.over[action]]
        last = ord(path[-1]) if path and path[-1] != WAIT else -1
        after_last = frame.dependent[last] if last >= 0 else 0
        possible = 0
        for action, target in self.graph.edges(state):
            for mask, value in frame.tests[action]:
                if facts & mask == value:
                    break
            else:
                continue
            facts_during = facts & ~frame.deletes[action]
            if guards and not all(meets(facts_during, over) for over in guards):
                continue
            possible |= 1 << action
            if late >> action & 1 or (action < last and not after_last >> action & 1):
                continue
            if ahead[target] < FAR:
                self._push(
                    path + chr(action), price + cost[action], facts_during,
                    tuple(sorted((*running, (frame.ticks[action], action)))),
                    target, late & ~frame.dependent[action],
                )  # fmt: skip
        if running:
            self._wait(node, possible)

    def _wait(self, node: _Node, possible: int) -> None:
        """Let time pass until the next running actions end."""
        _, path, price, facts, running, state, _ = node
        first = running[0][0]
        for ticks, action in running:
            if ticks == first:
                facts |= self.frame.adds[action]
        rest = tuple([(ticks - first, action) for ticks, action in running if ticks > first])
        price += first * self.weights.tick
        self._push(path + WAIT, price, facts, rest, state, possible)
