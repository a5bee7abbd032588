"""What a human with a goal does next, looked up for many states at once.

The tables hold what ``bank.locate`` and ``PlanGraph.next`` say. The goals' own graphs are tabulated
once; a state that is off the graph of its goal is looked up in the bank when it is met, and then
remembered.
"""

from __future__ import annotations

import numpy as np

from hrcplan.bank import Bank, PlanGraph
from hrcplan.core import bit_rows
from hrcplan.core.arrays import Bools, Ids, Words
from hrcplan.task.transitions import Rule

_SALT = np.uint64(0x9E3779B97F4A7C15)
_NEVER = Rule(mask=0, value=1, writes=0, adds=0)


class FrontierTable:
    """The next steps of humans, by goal and state.

    Args:
        bank: The plans, as sequences of steps without turns.
        people: The humans.

    Attributes:
        first: Where the steps of each entry begin in ``steps``.
        count: How many steps each entry has.
        steps: The steps of all entries, in order; without those that no human can ever do.
        used: For each entry, the row of ``is_used`` that says which steps its plans have.
        is_used: Rows of steps.
        is_certain: Whether a human can do every step of an entry in every state of it.
    """

    def __init__(self, bank: Bank, people: frozenset[str]) -> None:
        self._bank = bank
        n_facts = len(bank.goals.task.facts)
        own = bank.table.rules_of(people)
        anyone = bank.table.rules_of(frozenset(bank.goals.problem.agents))
        self._is_possible = np.array([rule is None or rule != _NEVER for rule in own])
        self.is_certain = all(
            mine is not None and mine in (others, _NEVER)
            for mine, others in zip(own, anyone, strict=True)
        )
        graphs = bank.graphs
        self._masks = bit_rows.pack([graph.relevant_facts for graph in graphs], n_facts)
        self._wide = bit_rows.pack([bank.relevant_facts(g) for g in range(len(graphs))], n_facts)
        rows = np.concatenate([_node_rows(graph, n_facts) for graph in graphs])
        sizes = np.array([graph.n_nodes for graph in graphs])
        goals, self._offsets = np.repeat(np.arange(len(graphs)), sizes), np.cumsum(sizes) - sizes
        self._tabulate(graphs, goals)
        hashes = _hash(rows, goals)
        order = np.argsort(hashes, kind="stable")  # of equal nodes the first, the cheapest, counts
        self._hashes, self._rows, self._goals = hashes[order], rows[order], goals[order]
        self._entries = order
        n_bits = len(order).bit_length() + 1  # of a hash that say where its bucket begins
        self._shift = np.uint64(64 - n_bits)
        buckets = np.arange(1 << n_bits, dtype=np.uint64) << self._shift
        self._buckets = np.searchsorted(self._hashes, buckets)
        self._off_graph: dict[tuple[int, bytes], int] = {}

    def _tabulate(self, graphs: tuple[PlanGraph, ...], goals: Ids) -> None:
        steps = np.concatenate([graph.steps for graph in graphs]).astype(np.int64)
        counts = np.concatenate([np.diff(graph.first) for graph in graphs])
        owners = np.repeat(np.arange(len(counts)), counts)
        is_possible = self._is_possible[steps]
        self.steps = steps[is_possible]
        self.count = np.bincount(owners[is_possible], minlength=len(counts))
        self.first = np.cumsum(self.count) - self.count
        self.used = goals.astype(np.int64)
        self.is_used = np.array([self._used_steps(graph) for graph in graphs])

    def _used_steps(self, graph: PlanGraph) -> Bools:
        row = np.zeros(len(self._bank.table), dtype=np.bool_)
        row[list(graph.used_steps)] = True
        return row

    def entries(self, goals: Ids, states: Words) -> Ids:
        """Return the entry of each pair of a goal and a state."""
        rows = states & self._masks[goals]
        hashes = _hash(rows, goals)
        place = self._places(hashes)
        is_hit = (self._hashes[place] == hashes) & (self._goals[place] == goals)
        is_hit &= (self._rows[place] == rows).all(axis=1)
        entries = self._entries[place]
        misses = np.flatnonzero(~is_hit)
        if len(misses):
            entries[misses] = self._look_up(goals[misses], states[misses])
        return entries

    def _places(self, hashes: Words) -> Ids:
        """Return for each hash where it stands, or some other place if it is not there."""
        place: Ids = self._buckets[hashes >> self._shift]
        place[place == len(self._hashes)] = 0
        open_ = np.flatnonzero(self._hashes[place] < hashes)
        while len(open_):
            place[open_] += 1
            open_ = open_[place[open_] < len(self._hashes)]
            open_ = open_[self._hashes[place[open_]] < hashes[open_]]
        place[place == len(self._hashes)] = 0
        return place

    def _look_up(self, goals: Ids, states: Words) -> list[int]:
        """Return the entries of states that are off the graphs of their goals."""
        keys = [
            (goal, row.tobytes())
            for goal, row in zip(goals.tolist(), states & self._wide[goals], strict=True)
        ]
        unknown = {key: i for i, key in enumerate(keys) if key not in self._off_graph}
        if unknown:
            worlds = bit_rows.unpack(states[list(unknown.values())])
            self._add({key: (key[0], world) for key, world in zip(unknown, worlds, strict=True)})
        return [self._off_graph[key] for key in keys]

    def _add(self, unknown: dict[tuple[int, bytes], tuple[int, int]]) -> None:
        """Take in states, by the key of each, that are not nodes of the graphs as they stand."""
        followers: list[list[int]] = []
        used: list[Bools] = []
        for key, (goal, world) in unknown.items():
            graph, node = self._bank.locate(goal, world)
            if node is not None and graph is self._bank.graphs[goal]:
                self._off_graph[key] = int(self._offsets[goal]) + node
                continue
            self._off_graph[key] = len(self.first) + len(followers)
            following = () if node is None else graph.next(node)
            followers.append([step for step in following if self._is_possible[step]])
            used.append(self._used_steps(graph))
        if followers:
            counts = np.array([len(steps) for steps in followers])
            rows = np.arange(len(followers)) + len(self.is_used)
            steps = np.array([step for steps in followers for step in steps], dtype=np.int64)
            first = np.cumsum(counts) - counts + len(self.steps)
            self.first = np.concatenate([self.first, first])
            self.count = np.concatenate([self.count, counts])
            self.used = np.concatenate([self.used, rows])
            self.steps = np.concatenate([self.steps, steps])
            self.is_used = np.concatenate([self.is_used, used])


def _node_rows(graph: PlanGraph, n_facts: int) -> Words:
    """Return the states of a graph's nodes as rows of all facts; those it does not hold are 0."""
    kept = list(graph.packing.positions)
    bits = np.unpackbits(graph.rows.view(np.uint8), axis=1, bitorder="little")[:, : len(kept)]
    wide = np.zeros((graph.n_nodes, n_facts), dtype=np.bool_)
    wide[:, kept] = bits
    return bit_rows.of_bools(wide)


def _hash(rows: Words, goals: Ids) -> Words:
    hashes = goals.astype(np.uint64) * _SALT
    for word in range(rows.shape[1]):
        hashes = (hashes ^ (hashes >> np.uint64(29))) * _SALT + rows[:, word]
    return hashes ^ (hashes >> np.uint64(32))
