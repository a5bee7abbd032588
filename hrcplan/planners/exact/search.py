"""A* over left-shifted schedules.

A node is what holds, and which actions run for how long still. At time 0 and whenever an action
ends, any idle agent may start, or time passes to the next end. A path is a string with one letter
for each decision: a ground action started, or ``WAIT``. Letters stand in ground-action order with
``WAIT`` last, and of equal plans the one with the first path is kept: starting comes before
waiting, then ground-action order decides. Three rules leave out paths of which another one costs
no more; all leave the first of the best plans in:

* two starts of one instant that commute stand in ground-action order;
* who could have started before the last wait, and disturbed no other, does not start now;
* of nodes that are images of each other (``symmetry.py``) the cheapest is expanded, and of equally
  cheap ones that with the first path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush

from hrcplan.core.clock import check_time
from hrcplan.errors import LimitError
from hrcplan.planners.contract import MEMORY_BYTES
from hrcplan.planners.exact.estimates import Estimates
from hrcplan.planners.exact.frame import RunningActions, StaticMasks
from hrcplan.planners.exact.graph import FAR, MAX_STATES, Graph
from hrcplan.planners.exact.symmetry import Swap, representative
from hrcplan.planners.exact.weights import Weights
from hrcplan.task import Task
from hrcplan.task.conditions import meets

MAX_NODES = 1_000_000
NODE_BYTES = 1500
"""What a node takes, with its share of the states and of what is known about them."""
WAIT = chr(0x10FFFF)

_Node = tuple[int, str, int, int, RunningActions, int, int]
"""Bound of the whole metric, path, metric so far, facts, running actions, the state in the graph
when they have ended, and the actions that should have started before (as bits)."""
_Prices = dict[tuple[int, RunningActions], tuple[int, str]]
"""Metric so far and path, by facts and running actions."""


@dataclass
class Search:
    """One search: what it moves in, the bounds (``ahead``), and until when.

    ``greed`` multiplies the bounds; above 1 it finds plans sooner and proves nothing. With 1,
    ``bound`` is what no plan is better than, as far as the search has got. ``most`` is the metric
    of a plan: costlier ones are not looked for. ``swaps`` are symmetries of the task. Nodes may
    take ``memory_bytes``, but there are never more than ``MAX_NODES``.
    """

    task: Task
    frame: StaticMasks
    graph: Graph
    weights: Weights
    ahead: Estimates
    deadline: float
    greed: int = 1
    most: int = FAR
    swaps: Sequence[Swap] = ()
    memory_bytes: int = MEMORY_BYTES
    n_expanded: int = 0

    def __post_init__(self) -> None:
        self._best: _Prices = {}
        self._images: _Prices = {}
        self._open: list[_Node] = []
        self.bound = 0
        initial = self.task.initial
        self._push(0, "", 0, initial, (), self.graph.state(initial), 0)

    @property
    def is_over(self) -> bool:
        """Whether all paths have been looked at."""
        return not self._open

    def run(self, most_expanded: int | None = None) -> str | None:
        """Return the path of the best plan; None if there is none, or the search is not over.

        Args:
            most_expanded: How many nodes to expand; another call goes on from there.

        Raises:
            LimitError: at the deadline, or if there are too many nodes or states.
        """
        end = None if most_expanded is None else self.n_expanded + most_expanded
        while self._open and self.n_expanded != end:
            node = heappop(self._open)
            self._check(node)
            if self._is_beaten(node) or self._is_pushed_again(node):
                continue
            self.bound = max(self.bound, node[0])
            if self.task.is_goal(self.graph.states[node[5]]):
                return node[1]
            self.n_expanded += 1
            self._expand(node)
        return None

    def _check(self, node: _Node) -> None:
        try:
            check_time(self.deadline, f"after {self.n_expanded:,} nodes")
            most = min(MAX_NODES, self.memory_bytes // NODE_BYTES)
            if len(self._best) > most:
                raise LimitError(f"no proof within {most:,} nodes")
            if len(self.graph.states) > MAX_STATES:
                raise LimitError(f"no proof within {MAX_STATES:,} states in sequence")
        except LimitError:
            self.bound = max(self.bound, node[0])
            raise

    def _is_beaten(self, node: _Node) -> bool:
        """Return whether a node, or an image of it, was reached by a better path."""
        _, path, price, facts, running, _, _ = node
        mine = (price, path)
        if self._best[facts, running] != mine:
            return True
        if self.swaps:
            key = representative(facts, running, self.swaps)
            if self._images.setdefault(key, mine) < mine:
                return True
            self._images[key] = mine
        return False

    def _is_pushed_again(self, node: _Node) -> bool:
        """Look closer at the state of a node; return whether the node is not the next one then."""
        value, _, price, _, running, state, _ = node
        if not self.ahead.refine(state):
            return False
        if self.ahead[state].work >= FAR:
            return True
        least = price + self.greed * self._rest(state, running)
        if least <= value:
            return False
        heappush(self._open, (least, *node[1:]))
        return True

    def _push(
        self, least: int, path: str, price: int, facts: int, running: RunningActions, state: int,
        late: int,
    ) -> None:  # fmt: skip
        """Put a node on the heap unless it was reached as well before."""
        best = self._best.get((facts, running))
        if best is not None and best <= (price, path):
            return
        value = price + self.greed * self._rest(state, running)
        if value > self.most:
            return
        self._best[facts, running] = (price, path)
        heappush(self._open, (max(least, value), path, price, facts, running, state, late))

    def _rest(self, state: int, running: RunningActions) -> int:
        """Return a bound on what is still to be paid, from the work or from the makespan."""
        work, cost, busy, chain = self.ahead[state]
        weights = self.weights
        if running:
            share, lanes = weights.share, weights.n_lanes
            for ticks, action in running:
                work += ticks * share[action]
                busy += ticks * lanes[action]
            chain = max(chain, running[-1][0])
        makespan = max(chain, -(-busy // weights.n_agents))
        return max(work, cost + weights.tick * makespan)

    def _expand(self, node: _Node) -> None:
        value, path, price, facts, running, state, late = node
        frame, ahead, cost = self.frame, self.ahead, self.weights.cost
        guards = [frame.over[action] for _, action in running if frame.over[action]]
        last = ord(path[-1]) if path and path[-1] != WAIT else -1
        after_last = frame.dependent[last] if last >= 0 else 0
        possible = 0
        edges = iter(self.graph.edges(self.task, state))
        for action, target in zip(edges, edges, strict=True):
            for mask, bits in frame.tests[action]:
                if facts & mask == bits:
                    break
            else:
                continue
            facts_during = facts & ~frame.deletes[action]
            if guards and not all(meets(facts_during, over) for over in guards):
                continue
            possible |= 1 << action
            if late >> action & 1 or (action < last and not after_last >> action & 1):
                continue
            ahead.inherit(state, action, target)
            if ahead[target].work < FAR:
                self._push(
                    value, path + chr(action), price + cost[action], facts_during,
                    tuple(sorted((*running, (frame.ticks[action], action)))),
                    target, late & ~frame.dependent[action],
                )  # fmt: skip
        if running:
            self._wait(node, possible)

    def _wait(self, node: _Node, possible: int) -> None:
        """Let time pass until the next running actions end."""
        value, path, price, facts, running, state, _ = node
        ticks, facts, rest = pass_time(self.frame, facts, running)
        price += ticks * self.weights.tick
        self._push(value, path + WAIT, price, facts, rest, state, possible)


def pass_time(
    frame: StaticMasks, facts: int, running: RunningActions
) -> tuple[int, int, RunningActions]:
    """Return how many ticks pass until the next end, and what holds and runs just after it."""
    first = running[0][0]
    for ticks, action in running:
        if ticks == first:
            facts |= frame.adds[action]
    return first, facts, tuple([(ticks - first, a) for ticks, a in running if ticks > first])
