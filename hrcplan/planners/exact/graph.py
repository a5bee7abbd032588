"""The reachable states of the sequential reading, and how far each is from the goal.

The graph does not depend on costs or goal, so it is kept between replans. It is plain Python: for
two thousand states that is faster than importing numpy, for a hundred thousand it takes seconds.
"""

from __future__ import annotations

import time
from array import array
from collections.abc import Sequence
from heapq import heappop, heappush

from hrcplan.errors import LimitError
from hrcplan.task import GroundAction, Task
from hrcplan.task.conditions import meets

MAX_STATES = 1_000_000
MAX_EDGES = 15_000_000
FAR = 1 << 200
"""Above every distance: no goal can be reached."""
_CHECK = 1024  # states between two looks at the clock

Edge = tuple[int, int]
"""An action and a state, as indices."""


class Graph:
    """States by index, with the actions that lead from them and to them."""

    def __init__(self) -> None:
        self.states: list[int] = []
        self.index: dict[int, int] = {}
        self._first = array("q", [0])
        self._edges = array("i")
        self._before: list[list[int]] = []
        self._after: dict[int, tuple[Edge, ...]] = {}
        self._idle: list[int] | None = None

    def grow(self, task: Task, deadline: float) -> None:
        """Add the initial state of ``task`` and all that can follow it.

        Raises:
            LimitError: at the deadline, or if there are too many states; what is there by then
                stays, and the next call goes on from it.
        """
        if self._idle is None:
            self._idle = [a.index for a in task.actions if may_change_nothing(a)]
        if task.initial not in self.index:
            self._new(task.initial)
        while len(self._first) <= len(self.states):
            state = len(self._first) - 1
            if state % _CHECK == 0:
                self._check(deadline)
            self._expand(task, state)

    def _new(self, state: int) -> int:
        position = self.index[state] = len(self.states)
        self.states.append(state)
        self._before.append([])
        return position

    def _expand(self, task: Task, source: int) -> None:
        state, index, before = self.states[source], self.index, self._before
        for action in self._actions(task, state):
            after = task.successor(state, action)
            target = index.get(after)
            if target is None:
                target = self._new(after)
            self._edges.append(action)
            self._edges.append(target)
            before[target] += (action, source)
        self._first.append(len(self._edges))

    def _actions(self, task: Task, state: int) -> list[int]:
        """Return the actions that can run, in order; also those that change nothing in sequence.

        Such an action can be worth its time while another one that adds the same facts still runs.
        """
        actions = task.applicable(state)
        silent = [
            i for i in self._idle or ()
            if meets(state, task.actions[i].tests) and task.successor(state, i) == state
        ]  # fmt: skip
        return sorted(actions + silent) if silent else actions

    def _check(self, deadline: float) -> None:
        if len(self.states) > MAX_STATES or len(self._edges) > 2 * MAX_EDGES:
            raise LimitError(f"more than {len(self._first):,} states in sequence")
        if time.monotonic() > deadline:
            raise LimitError(f"out of time after {len(self._first):,} states in sequence")

    def edges(self, state: int) -> tuple[Edge, ...]:
        """Return the actions that lead from a state, in order, with the states they lead to."""
        outgoing = self._after.get(state)
        if outgoing is None:
            flat = self._edges[self._first[state] : self._first[state + 1]]
            outgoing = self._after[state] = tuple(zip(flat[::2], flat[1::2], strict=True))
        return outgoing

    def distances(self, weights: Sequence[int], goals: Sequence[int], deadline: float) -> list[int]:
        """Return the least sum of action weights from each state to a goal, or ``FAR``.

        Dijkstra's algorithm, backward, with one bucket for each distance: few distances occur.

        Raises:
            LimitError: at the deadline.
        """
        least = [FAR] * len(self.states)
        for goal in goals:
            least[goal] = 0
        buckets = {0: list(goals)}
        waiting = [0]
        while waiting:
            distance = heappop(waiting)
            for n, state in enumerate(buckets.pop(distance)):
                if n % _CHECK == 0 and time.monotonic() > deadline:
                    raise LimitError("out of time while measuring distances to the goal")
                if least[state] < distance:
                    continue
                pairs = iter(self._before[state])
                for action, source in zip(pairs, pairs, strict=True):
                    longer = distance + weights[action]
                    if longer < least[source]:
                        least[source] = longer
                        bucket = buckets.get(longer)
                        if bucket is None:
                            buckets[longer] = [source]
                            heappush(waiting, longer)
                        else:
                            bucket.append(source)
        return least


def may_change_nothing(action: GroundAction) -> bool:
    """Return whether there may be a state in which an action can run and leaves it as it is."""
    change = action.adds | action.deletes
    return any(value & change == action.adds & mask for mask, value in action.tests)
