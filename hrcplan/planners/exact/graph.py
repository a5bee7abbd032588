"""The states of the sequential reading, and the actions between them.

A state is expanded when a search first comes to it, and stays so: the graph does not depend on
costs or goal, and is kept between replans. Where there are few states the whole of it is worth
having, as distances in it (``arcs.py``) are the best bounds.
"""

from __future__ import annotations

from hrcplan.core.clock import check_time
from hrcplan.task import GroundAction, Task
from hrcplan.task.conditions import meets

MAX_STATES = 1_000_000  # about 0.7 kB each
FAR = 1 << 200
"""Above every distance: no goal can be reached."""


class Graph:
    """States by index, with the actions that lead from them."""

    def __init__(self) -> None:
        self.states: list[int] = []
        self._index: dict[int, int] = {}
        self._edges: list[tuple[int, ...] | None] = []
        self._idle: list[int] | None = None
        self._n_complete = 0

    def state(self, state: int) -> int:
        """Return the index of a state; it is added if it is new."""
        index = self._index.get(state)
        if index is None:
            index = self._index[state] = len(self.states)
            self.states.append(state)
            self._edges.append(None)
        return index

    def __contains__(self, state: int) -> bool:
        return state in self._index

    def edges(self, task: Task, source: int) -> tuple[int, ...]:
        """Return the actions that lead from a state, in order, each followed by its target.

        ``task`` may be any of the tasks of one structure.
        """
        edges = self._edges[source]
        if edges is None:
            state = self.states[source]
            flat: list[int] = []
            for action in self._actions(task, state):
                flat += (action, self.state(task.successor(state, action)))
            edges = self._edges[source] = tuple(flat)
        return edges

    def _actions(self, task: Task, state: int) -> list[int]:
        """Return the actions that can run, in order; also those that change nothing in sequence.

        Such an action can be worth its time while another one that adds the same facts still runs.
        """
        if self._idle is None:
            self._idle = [a.index for a in task.actions if may_change_nothing(a)]
        actions = task.applicable(state)
        silent = [
            i for i in self._idle
            if meets(state, task.actions[i].tests) and task.successor(state, i) == state
        ]  # fmt: skip
        return sorted(actions + silent) if silent else actions

    def complete(self, task: Task, most: int, deadline: float) -> bool:
        """Expand every state; return whether there are no more than ``most``.

        Raises:
            LimitError: at the deadline; the next call goes on from what is there.
        """
        self.state(task.initial)
        while self._n_complete < len(self.states) <= most:
            source = self._n_complete
            check_time(deadline, f"after {source:,} states in sequence")
            self.edges(task, source)
            self._n_complete += 1
        return self._n_complete == len(self.states)


def may_change_nothing(action: GroundAction) -> bool:
    """Return whether there may be a state in which an action can run and leaves it as it is."""
    change = action.adds | action.deletes
    return any(value & change == action.adds & mask for mask, value in action.tests)
