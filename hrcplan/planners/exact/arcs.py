"""How far each state of a complete graph is from the goal, under changing weights.

States often reach each other, each in one step of one kind: an agent can walk from any place to any
other. Where the first of them is at some distance from the goal, all others are at most one step
farther away, so such a *set* of states is looked at once, instead of each edge. It is plain Python:
for two thousand states that is faster than importing numpy.
"""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappop, heappush

from hrcplan.core.clock import check_time
from hrcplan.planners.exact.graph import FAR, Graph
from hrcplan.task import Task

_CHECK = 256  # states between two looks at the clock
_SHARED = 3  # predecessors of a state, from which on other states may have the same set


class Arcs:
    """The edges of a complete graph, backward, by kinds of actions that weigh the same.

    Which actions these are is a guess at first (schema and agent), and kinds are split when weights
    refute it.

    Args:
        task: A task of the graph's structure.
        graph: The graph; it must be complete.
    """

    def __init__(self, task: Task, graph: Graph) -> None:
        self._task, self._graph = task, graph
        kinds: dict[object, int] = {}
        self._kinds = [kinds.setdefault((a.name, a.agent), len(kinds)) for a in task.actions]
        self._n_states = 0
        self._arcs: list[list[int]] = []
        self._sets: list[Sequence[int]] = []
        self._kinds_of_sets: list[int] = []

    def distances(self, weights: Sequence[int], goals: Sequence[int], deadline: float) -> list[int]:
        """Return the least sum of action weights from each state to a goal, or ``FAR``.

        Dijkstra's algorithm, backward, with one bucket for each distance: few distances occur.

        Raises:
            LimitError: at the deadline.
        """
        of_kind = self._weights_of_kinds(weights)
        if self._n_states < len(self._graph.states):
            self._collect(deadline)
        sets, arcs = self._sets, self._arcs
        steps = [of_kind[kind] for kind in self._kinds_of_sets]  # FAR once a set was looked at
        least = [FAR] * len(self._graph.states)
        for goal in goals:
            least[goal] = 0
        buckets = {0: list(goals)}
        waiting = [0]
        while waiting:
            distance = heappop(waiting)
            for n, state in enumerate(buckets.pop(distance)):
                if n % _CHECK == 0:
                    check_time(deadline, "while measuring distances to the goal")
                if least[state] < distance:
                    continue
                for number in arcs[state]:
                    longer = distance + steps[number]
                    if longer >= FAR:
                        continue
                    steps[number] = FAR
                    for source in sets[number]:
                        if longer < least[source]:
                            least[source] = longer
                            bucket = buckets.get(longer)
                            if bucket is None:
                                buckets[longer] = [source]
                                heappush(waiting, longer)
                            else:
                                bucket.append(source)
        return least

    def _weights_of_kinds(self, weights: Sequence[int]) -> list[int]:
        """Return the weight of each kind; kinds whose actions do not weigh the same are split."""
        of_kind = dict(zip(self._kinds, weights, strict=True))
        if any(of_kind[k] != w for k, w in zip(self._kinds, weights, strict=True)):
            split: dict[tuple[int, int], int] = {}
            pairs = zip(self._kinds, weights, strict=True)
            self._kinds = [split.setdefault(pair, len(split)) for pair in pairs]
            self._n_states = 0
            return [weight for _, weight in split]
        return [of_kind[k] for k in range(len(of_kind))]

    def _collect(self, deadline: float) -> None:
        """Collect the sets of predecessors of every state.

        Raises:
            LimitError: at the deadline.
        """
        n_states = len(self._graph.states)
        by_target: list[dict[int, list[int]]] = [{} for _ in range(n_states)]
        for source in range(n_states):
            check_time(deadline, "while collecting what reaches each state")
            edges = iter(self._graph.edges(self._task, source))
            for action, target in zip(edges, edges, strict=True):
                by_target[target].setdefault(self._kinds[action], []).append(source)
        self._n_states, self._sets, self._kinds_of_sets = n_states, [], []
        shared: dict[tuple[int, frozenset[int]], int] = {}
        self._arcs = [
            [self._set_of(kind, target, sources, shared) for kind, sources in by_kind.items()]
            for target, by_kind in enumerate(by_target)
        ]

    def _set_of(
        self, kind: int, target: int, sources: list[int],
        shared: dict[tuple[int, frozenset[int]], int],
    ) -> int:  # fmt: skip
        """Return the index of the set of a state's predecessors, the state itself included.

        A way from a state to itself makes nothing nearer, and more states have the same set.
        """
        number = len(self._sets)
        if len(sources) >= _SHARED:
            sources.append(target)
            number = shared.setdefault((kind, frozenset(sources)), number)
        if number == len(self._sets):
            self._sets.append(sources)
            self._kinds_of_sets.append(kind)
        return number
