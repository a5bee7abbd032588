"""What the planner keeps of the tasks that it was asked about."""

from __future__ import annotations

from hrcplan.planners.exact.arcs import Arcs
from hrcplan.planners.exact.estimates import Estimates, GraphDistances, Landmarks
from hrcplan.planners.exact.frame import StaticMasks, frame
from hrcplan.planners.exact.gaps import Gaps
from hrcplan.planners.exact.graph import Graph
from hrcplan.planners.exact.overlap import check_overlap, lanes_of
from hrcplan.planners.exact.weights import Weights
from hrcplan.search.reachable_pairs import ReachablePairs
from hrcplan.task import Task
from hrcplan.task.conditions import Test, meets

MAX_GRAPH = 20_000
"""States of a graph that is worth completing, in the hope that the next replan starts in it."""
MAX_KEPT_STATES = 100_000
"""States of other structures than the one that is asked for."""


class TaskMemory:
    """All that replans of one grounding share: masks, pairs, the graph, what actions touch."""

    def __init__(self, task: Task, deadline: float) -> None:
        self.structure = task.structure
        self.frame: StaticMasks = frame(task, deadline)
        self.pairs = ReachablePairs(self.frame)
        self.lanes: tuple[tuple[str, ...], ...] = ()
        self.graph = Graph()
        self.gaps = Gaps()
        self._arcs: Arcs | None = None
        self._n_asked = 0
        self._goal: tuple[Test, ...] = ()
        self._goals: list[int] = []
        self._n_checked = 0

    def admit(self, task: Task, deadline: float) -> None:
        """Check what can follow the initial state of ``task``, unless that was done before.

        Raises:
            UnsupportedError: if it is outside the class that `exact` holds.
            LimitError: at the deadline.
        """
        if task.initial not in self.graph:
            self.pairs.admit(task.initial, deadline)
            check_overlap(task, self.pairs, self.frame, deadline)
            self.lanes = lanes_of(task, self.pairs, self.frame)

    def estimates(self, task: Task, weights: Weights, deadline: float) -> Estimates:
        """Return bounds for a task: distances for one that is asked about again, if it is small.

        Raises:
            LimitError: at the deadline.
        """
        self._n_asked += 1
        if self._n_asked > 1 and self.graph.complete(task, MAX_GRAPH, deadline):
            self._arcs = self._arcs or Arcs(task, self.graph)
            return GraphDistances(
                self._arcs.distances(weights.work, self._goals_of(task), deadline)
            )
        return Landmarks(task, self.graph, weights, deadline)

    def _goals_of(self, task: Task) -> list[int]:
        """Return the states of the graph, as indices, in which the goal of ``task`` holds."""
        if self._goal != task.goal:
            self._goal, self._goals, self._n_checked = task.goal, [], 0
        states = self.graph.states
        new = range(self._n_checked, len(states))
        self._goals += [i for i in new if meets(states[i], task.goal)]
        self._n_checked = len(states)
        return self._goals


class TaskMemories:
    """TaskMemories of the last structures, the most recent one last."""

    def __init__(self) -> None:
        self.memories: list[TaskMemory] = []

    def of(self, task: Task, deadline: float) -> TaskMemory:
        """Return the memory of a task's structure; those of others may be given up for it.

        Raises:
            UnsupportedError: if the task is outside the class that `exact` holds.
            LimitError: at the deadline.
        """
        memory = next((m for m in self.memories if m.structure is task.structure), None)
        self.memories = [m for m in self.memories if m is not memory]
        while sum(len(m.graph.states) for m in self.memories) > MAX_KEPT_STATES:
            del self.memories[0]  # frees the graph of another task first
        self.memories.append(memory or TaskMemory(task, deadline))
        return self.memories[-1]
