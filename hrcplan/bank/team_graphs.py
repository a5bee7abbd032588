"""Graphs of team plans from any state, out of the costs to go: the ones that a search finds.

Where the costs to go of all states are known, no search has to prove what the optimum is: a step is
in an optimal plan if the cost to go after it is less by what it costs.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from hrcplan.bank.bank import Bank
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP, CostToGo
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import StateSpaceLayers
from hrcplan.bank.state_tables import group_rows
from hrcplan.bank.team import TIMESTEP as IN_LAYERS  # a timestep in the costs of layers
from hrcplan.bank.team import TeamActions, graph_without_waits
from hrcplan.core.arrays import Bools, Ids, SmallIds, Words
from hrcplan.errors import UsageError
from hrcplan.search.packed_states import WORD, FactPacking
from hrcplan.search.relevance import relevant

MAX_NODES = 2_000_000  # of the graphs that are remembered

_Part = tuple[Ids, Ids, SmallIds]  # states by their indices, the nodes before them, and the steps


class TeamGraphs:
    """The graphs of a bank of team plans from states off the goals' own graphs.

    Args:
        bank: The plans.
        costs: Its costs to go.
    """

    def __init__(self, bank: Bank, costs: CostToGo) -> None:
        self.bank, self.costs = bank, costs
        self._actions = TeamActions(bank.table, bank.team)
        self._packings: dict[int, FactPacking] = {}
        self._graphs: dict[tuple[int, int, int], PlanGraph] = {}

    def locate(self, goal: int, state: int, turn: int) -> tuple[PlanGraph, int | None]:
        """Return a graph of a goal and the node in it, as `Bank.locate` does.

        Args:
            goal: The goal.
            state: The state.
            turn: Whose turn it is.
        """
        node = self.bank.node(goal, state, turn)
        if node is not None:
            return self.bank.graphs[goal], node
        graph = self.graph_from(goal, state, turn)
        return graph, 0 if graph.n_nodes else None

    def graph_from(self, goal: int, state: int, turn: int) -> PlanGraph:
        """Return the graph of all optimal team plans of a goal from a state."""
        key = goal, state & self.bank.relevant_facts(goal), turn
        graph = self._graphs.get(key)
        if graph is None:
            graph = self._graphs[key] = self._make(goal, state, turn)
            while sum(graph.n_nodes + 1 for graph in self._graphs.values()) > MAX_NODES:
                self._graphs.pop(next(iter(self._graphs)))
        return graph

    def _make(self, goal: int, state: int, turn: int) -> PlanGraph:
        try:
            place = self.costs.place(state)
        except UsageError:  # not a state that the team can get to
            return self.bank.graph_from(goal, state, turn=turn)
        space = None
        packing = self._packing(goal)
        if self.costs.of(place, turn)[goal] < NEVER:
            space = _Layers(self.costs, goal, packing).explore(place, turn)
        tests, name = self.bank.goals.tests[goal], self.bank.names[goal]
        return graph_without_waits(self._actions, space, packing, tests, turn, name)

    def _packing(self, goal: int) -> FactPacking:
        if goal not in self._packings:
            facts = relevant(self._actions.ops, self.bank.goals.tests[goal])[1].facts
            self._packings[goal] = FactPacking.of_facts(facts)
        return self._packings[goal]


@dataclass
class _Layers:
    """The states of all optimal plans of a goal, by cost so far, and the steps between them."""

    costs: CostToGo
    goal: int
    packing: FactPacking

    def explore(self, place: int, turn: int) -> StateSpaceLayers:
        """Return them from a state on, given by its index."""
        n_turns = len(self.costs.bank.team)
        none = np.array([-1])
        pending: dict[int, list[_Part]] = {0: [(np.array([place]), none, none.astype(np.int32))]}
        queue, layers, edges = [0], [], []
        rows: list[Words] = []
        goals: list[Bools] = []
        n_nodes = cost = 0
        while queue:
            cost = heapq.heappop(queue)
            now = (turn + cost // IN_LAYERS) % n_turns
            places, states, edge = self._merge(pending.pop(cost), now, n_nodes)
            layers.append((cost, n_nodes))
            edges.append(edge)
            rows.append(states)
            goals.append(np.array([self.costs.is_goal(self.goal, p) for p in places.tolist()]))
            for price, part in self._after(places, now, n_nodes):
                if cost + price not in pending:
                    pending[cost + price] = []
                    heapq.heappush(queue, cost + price)
                pending[cost + price].append(part)
            n_nodes += len(places)
        return StateSpaceLayers(
            np.concatenate(rows), tuple(layers), tuple(edges), np.concatenate(goals), cost, None
        )

    def _merge(
        self, parts: list[_Part], turn: int, n_nodes: int
    ) -> tuple[Ids, Words, tuple[Ids, SmallIds, Ids]]:
        """Return the distinct states of a layer, as indices and as rows, and the steps to them."""
        places, sources, steps = (np.concatenate([part[i] for part in parts]) for i in range(3))
        rows, which, order, starts = group_rows(self._rows(places, turn))
        real = sources >= 0
        return places[order[starts]], rows, (sources[real], steps[real], n_nodes + which[real])

    def _rows(self, places: Ids, turn: int) -> Words:
        """Return states in a turn as rows: the facts that matter, and that it is the turn."""
        n_turns = len(self.costs.bank.team)
        facts = self.costs.facts(places)
        turns = np.zeros((len(places), n_turns), dtype=np.uint8)
        turns[:, turn] = 1
        bits = np.concatenate([facts, turns], axis=1)[:, list(self.packing.positions)]
        columns = np.zeros((len(places), self.packing.n_words * WORD), dtype=np.uint8)
        columns[:, : bits.shape[1]] = bits
        return np.packbits(columns, axis=1, bitorder="little").view(np.uint64)

    def _after(self, places: Ids, turn: int, n_nodes: int) -> list[tuple[int, _Part]]:
        """Return what follows states in optimal plans, with its price: actions, then waits."""
        following = (turn + 1) % len(self.costs.bank.team)
        to_go = self._to_go(places, turn)
        which, steps, targets = self.costs.actions_of(places, turn)
        acts = (self._to_go(targets, following) + TIMESTEP + 1 == to_go[which]).nonzero()[0]
        waits = (self._to_go(places, following) + TIMESTEP == to_go).nonzero()[0]
        wait = np.full(len(waits), len(self.costs.bank.table) + turn, dtype=np.int32)
        parts = [
            (IN_LAYERS + 1, (targets[acts], n_nodes + which[acts], steps[acts].astype(np.int32))),
            (IN_LAYERS, (places[waits], n_nodes + waits, wait)),
        ]
        return [(price, part) for price, part in parts if len(part[0])]

    def _to_go(self, places: Ids, turn: int) -> Ids:
        to_go: Ids = self.costs.of(places, turn)[self.goal]
        return to_go
