"""The plans of one goal as a graph of states, never as a list: counted exactly, walked, tested.

A node is a state restricted to the facts that matter to the goal, at one cost so far. Every path
from the root (node 0) to a goal node is a plan, and no two paths read the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hrcplan.core.arrays import Bools, Ids, SmallIds, Words
from hrcplan.core.numbers import Number
from hrcplan.core.text import cut, plural
from hrcplan.search.packed_states import FactPacking

BIG = float(1 << 62)  # above it counts are Python integers, below it 64-bit ones: both are exact

PathCounts = NDArray[Any]
FEW = 32  # nodes that are looked for among the rows, before a dictionary of all is made


class _NodeIndex:
    """Finds the first node of a state; where only a few are looked for, that takes no dictionary.

    Args:
        packing: How states are packed.
        rows: The states of the nodes.
    """

    def __init__(self, packing: FactPacking, rows: Words) -> None:
        self._packing, self._rows = packing, rows
        self._n_searches = 0
        self._node_of: dict[int, int] | None = None

    def find(self, state: int) -> int | None:
        """Return the first node of a state; None if there is none."""
        if self._node_of is None and self._n_searches < FEW:
            self._n_searches += 1
            hits = np.flatnonzero((self._rows == self._packing.row(state)).all(axis=1))
            return int(hits[0]) if len(hits) else None
        if self._node_of is None:
            self._node_of = {}
            for node, other in enumerate(self._packing.states(self._rows)):
                self._node_of.setdefault(other, node)
        return self._node_of.get(state)


@dataclass(frozen=True, slots=True)
class Team:
    """Agents in the order of their turns, and the index of the one whose turn the root is."""

    agents: tuple[str, ...]
    first: int = 0


@dataclass(frozen=True, eq=False, repr=False)
class PlanGraph:
    """The valid plans of a goal, from one state on.

    In a graph of team plans the cost is the number of timesteps, so a layer tells whose turn it is.
    Edges are actions; the agents whose turns lie between two actions wait.

    Nodes stand in order of cost so far; the edges of node ``n`` are ``first[n]`` to
    ``first[n + 1]``, in order of their steps. Step ids are those of the bank.

    Attributes:
        goal: The goal's name.
        packing: Which facts of the task the nodes hold.
        rows: The states of the nodes, packed.
        layers: (cost so far, first node) of each layer.
        first: Where the edges of each node begin; one more than nodes.
        steps: The step of each edge.
        targets: The node that each edge leads to.
        is_goal: Which nodes are goal states; nothing follows them.
        complete: False if the graph was made of some plans only (``--sample``).
        team: Who takes turns; None if plans are sequences without turns.
    """

    goal: str
    packing: FactPacking
    rows: Words
    layers: tuple[tuple[Number, int], ...]
    first: Ids
    steps: SmallIds
    targets: SmallIds
    is_goal: Bools
    complete: bool = True
    team: Team | None = None

    def __repr__(self) -> str:
        size = f"{plural(self.n_nodes, 'node')}, {plural(self.n_edges, 'edge')}"
        return f"<PlanGraph {cut(self.goal, 100)}: {size}>"

    # Size.

    @property
    def n_nodes(self) -> int:
        """Number of nodes; 0 if the goal cannot be reached."""
        return len(self.rows)

    @property
    def n_edges(self) -> int:
        """Number of edges."""
        return len(self.steps)

    @property
    def relevant_facts(self) -> int:
        """The facts that the nodes hold, as bits of the task: what matters to this goal."""
        return self.packing.mask

    @cached_property
    def plans(self) -> int:
        """Number of plans, exactly."""
        return self.plans_from(0) if self.n_nodes else 0

    # Where a history leads.

    @cached_property
    def _nodes(self) -> _NodeIndex:
        return _NodeIndex(self.packing, self.rows)

    @cached_property
    def _in_turn(self) -> dict[tuple[int, int], int]:
        states = enumerate(self.packing.states(self.rows))
        return {(state, self.turn_of(node)): node for node, state in states}

    def node_of(self, state: int, turn: int | None = None) -> int | None:
        """Return the cheapest node of a state of the task, or None if it is off the graph.

        Args:
            state: The state.
            turn: Whose turn it is, as an index of the team's agents; None if that is not known.
        """
        state &= self.relevant_facts
        return self._nodes.find(state) if turn is None else self._in_turn.get((state, turn))

    def turn_of(self, node: int) -> int:
        """Return whose turn it is in a node, as an index of the team's agents; 0 without turns."""
        if self.team is None:
            return 0
        timesteps = int(self.layers[self.layer_of[node]][0])
        return (self.team.first + timesteps) % len(self.team.agents)

    def state(self, node: int) -> int:
        """Return the facts of a node, as bits of the task."""
        return self.packing.states(self.rows[node : node + 1])[0]

    @cached_property
    def _next(self) -> list[dict[int, int] | None]:
        return [None] * self.n_nodes

    def next(self, node: int) -> dict[int, int]:
        """Return what can follow a node: steps, in order, and the nodes they lead to."""
        edges = self._next[node]
        if edges is None:
            a, b = self.first[node], self.first[node + 1]
            edges = dict(zip(self.steps[a:b].tolist(), self.targets[a:b].tolist(), strict=True))
            self._next[node] = edges
        return edges

    def after(self, steps: Sequence[int], node: int = 0) -> int | None:
        """Return the node after steps that are the beginning of a plan; None if they are not."""
        for step in steps:
            follower = self.next(node).get(step) if self.n_nodes else None
            if follower is None:
                return None
            node = follower
        return node if self.n_nodes else None

    # Counts.

    @cached_property
    def layer_of(self) -> SmallIds:
        """The layer of each node."""
        starts = [first for _, first in self.layers] + [self.n_nodes]
        return np.repeat(np.arange(len(self.layers), dtype=np.int32), np.diff(starts))

    @cached_property
    def n_paths_to_goal(self) -> PathCounts:
        """How many paths lead from each node to a goal: int64, or Python integers where large."""
        with np.errstate(over="ignore"):
            rough = self._count_paths(np.float64)
        large = self.n_nodes and rough.max() >= BIG
        return self._count_paths(np.object_ if large else np.int64)

    def _count_paths(self, dtype: type[np.generic]) -> PathCounts:
        counts = np.zeros(self.n_nodes, dtype=dtype)
        if dtype is np.object_:
            counts[:] = 0
        counts[self.is_goal] = 1
        for begin, end in reversed(self._spans):
            inner = begin + np.flatnonzero(self.first[begin + 1 : end + 1] > self.first[begin:end])
            if len(inner):
                edges = slice(self.first[begin], self.first[end])
                starts = self.first[inner] - self.first[begin]
                counts[inner] = np.add.reduceat(counts[self.targets[edges]], starts)
        return counts

    @cached_property
    def n_paths_from_root(self) -> PathCounts:
        """How many paths lead from the root to each node."""
        dtype = self.n_paths_to_goal.dtype.type
        counts = np.zeros(self.n_nodes, dtype=dtype)
        if dtype is np.object_:
            counts[:] = 0
        if self.n_nodes:
            counts[0] = 1
        for edges, sources in self.edges_by_layer():
            np.add.at(counts, self.targets[edges], counts[sources])
        return counts

    @cached_property
    def _spans(self) -> list[tuple[int, int]]:
        return list(pairwise([*(first for _, first in self.layers), self.n_nodes]))

    def plans_from(self, node: int) -> int:
        """Return how many paths lead from a node to a goal."""
        return int(self.n_paths_to_goal[node])

    def ways_to(self, node: int) -> int:
        """Return how many paths lead from the root to a node."""
        return int(self.n_paths_from_root[node])

    def plans_with_prefix(self, steps: Sequence[int]) -> int:
        """Return how many plans begin with steps."""
        node = self.after(steps)
        return 0 if node is None else self.plans_from(node)

    # Cost and length.

    @property
    def optimal_cost(self) -> Number | None:
        """Cost of the cheapest plan; None if there is none."""
        costs = self.final_costs
        return costs[0] if costs else None

    @cached_property
    def final_layers(self) -> tuple[int, ...]:
        """The layers with goal nodes, cheapest first."""
        return tuple(int(layer) for layer in np.unique(self.layer_of[self.is_goal]))

    @property
    def final_costs(self) -> tuple[Number, ...]:
        """The distinct costs of plans, cheapest first."""
        return tuple(dict.fromkeys(self.layers[layer][0] for layer in self.final_layers))

    @cached_property
    def steps_left(self) -> Ids:
        """How few steps lead from each node to a goal node."""
        distance = np.where(self.is_goal, 0, np.iinfo(np.int64).max - 1)
        for edges, sources in reversed(list(self.edges_by_layer())):
            np.minimum.at(distance, sources, distance[self.targets[edges]] + 1)
        return distance

    @cached_property
    def n_steps(self) -> int:
        """Steps of the shortest among the cheapest plans; 0 if there is no plan."""
        if not self.n_nodes:
            return 0
        depth = np.full(self.n_nodes, np.iinfo(np.int64).max - 1)
        depth[0] = 0
        for edges, sources in self.edges_by_layer():
            np.minimum.at(depth, self.targets[edges], depth[sources] + 1)
        cheapest = self.is_goal & (self.layer_of == self.layer_of[self.is_goal].min())
        return int(depth[cheapest].min())

    def edges_by_layer(self) -> Iterator[tuple[slice, Ids]]:
        """Yield the edges that leave each layer, in order, and the nodes that they leave."""
        for begin, end in self._spans:
            lengths = np.diff(self.first[begin : end + 1])
            sources = np.repeat(np.arange(begin, end), lengths)
            yield slice(int(self.first[begin]), int(self.first[end])), sources

    @cached_property
    def used_steps(self) -> frozenset[int]:
        """The steps that occur in some plan."""
        return frozenset(np.unique(self.steps).tolist())
