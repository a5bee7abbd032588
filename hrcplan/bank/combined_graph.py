"""All plan graphs of a bank in one set of arrays, so that one look-up serves every goal."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from weakref import WeakValueDictionary

import numpy as np

from hrcplan.bank import Bank, PlanGraph
from hrcplan.core.arrays import Bools, Floats, Ids
from hrcplan.core.bits import positions
from hrcplan.task.transitions import Rule

_BitRules = tuple[tuple[int, int, int, int, int], ...]
_Part = tuple[int, _BitRules, tuple[tuple[int, tuple[int, ...]], ...]]
"""Labels: all others as bits, their rules with their bits, and their actions that are no rules."""


class CombinedGraph:
    """Nodes and edges of all graphs, numbered through.

    A *label* is what a step is called without its agent: where agents are kept, several steps
    share one. ``off`` is the number of a node without edges, for goals that have left their graph.

    Attributes:
        bank: The bank.
        label: The label of each step.
        roots: The first node of each goal.
        n_next: How many labels can follow each node.
        step_of: The step of each edge.
        first: Where the edges of each node begin; those of ``off`` are none.
        off: The node of goals that have left their graph.
    """

    def __init__(self, bank: Bank) -> None:
        self.bank = bank
        table = bank.table
        self.label, self.n_labels, self.n_steps = table.labels, table.n_labels, len(table)
        self.one_label_each = self.n_labels == self.n_steps
        self._goals_of: dict[tuple[int, int], Ids] = {}
        sizes = [graph.n_nodes for graph in bank.graphs]
        self.off = sum(sizes)
        self.offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        empty = np.array(sizes) == 0
        self.roots = np.where(empty, self.off, self.offsets[:-1])
        self._lay_out_edges()

    def _lay_out_edges(self) -> None:
        graphs, starts = self.bank.graphs, self.offsets
        sources = _concatenate(
            np.repeat(np.arange(g.n_nodes), np.diff(g.first)) + o
            for g, o in zip(graphs, starts, strict=False)
        )
        steps = _concatenate(g.steps.astype(np.int64) for g in graphs)
        self.targets = _concatenate(g.targets + o for g, o in zip(graphs, starts, strict=False))
        self._moves = _with_sentinel(sources * self.n_steps + steps)
        self.step_of = steps.astype(np.int32)
        self.first = np.searchsorted(sources, np.arange(self.off + 2))
        both = [_shares(graph) for graph in graphs]
        shares, logs = (np.concatenate([np.zeros(0), *(p[i] for p in both)]) for i in (0, 1))
        label = np.array(self.label, dtype=np.int64)
        pairs = sources * self.n_labels + (label[steps] if len(steps) else steps)
        if self.one_label_each:
            self._pairs, owners = self._moves, sources
        else:
            distinct, which = np.unique(pairs, return_inverse=True)
            self._pairs, owners = _with_sentinel(distinct), distinct // self.n_labels
            logs = _log_sums(shares, logs, which, len(distinct))
        self.log_shares = np.append(logs, -math.inf)
        self.n_next = np.bincount(owners, minlength=self.off + 1).astype(np.int64)

    def edges(self, nodes: Ids, step: int) -> tuple[Bools, Ids]:
        """Return which nodes have an edge for a step, and the places of these edges."""
        keys = nodes * self.n_steps + step
        places = self._moves.searchsorted(keys)
        return self._moves.take(places) == keys, places

    def edges_of_label(self, nodes: Ids, label: int) -> tuple[Bools, Ids]:
        """Return which nodes a label can follow, and the places of its shares."""
        keys = nodes * self.n_labels + label
        places = self._pairs.searchsorted(keys)
        return self._pairs[places] == keys, places

    def label_sums(self, weights: Floats) -> Floats:
        """Return for each node the sum of a weight per label over the labels that can follow it."""
        pairs = self._pairs[:-1]
        sums = np.bincount(pairs // self.n_labels, weights[pairs % self.n_labels], self.off + 1)
        return sums.astype(np.float64)

    def goals_of(self, step: int, pattern: int) -> Ids:
        """Return the goals whose nodes a step may move, or that it may say something about.

        Args:
            step: The step.
            pattern: The facts that it has changed, as bits.
        """
        goals = self._goals_of.get((step, pattern))
        if goals is None:
            users = self._users[self.label[step]]
            relevant = (g for g, facts in enumerate(self._relevant) if facts & pattern)
            goals = np.array(sorted(users.union(relevant)), dtype=np.int64)
            self._goals_of[step, pattern] = goals
        return goals

    @cached_property
    def _relevant(self) -> list[int]:
        return [graph.relevant_facts for graph in self.bank.graphs]

    @cached_property
    def needs(self) -> Bools:
        """For each goal and label, whether some plan of the goal has it."""
        needs = np.zeros((len(self.bank.graphs), self.n_labels), dtype=np.bool_)
        for label, goals in enumerate(self._users):
            needs[sorted(goals), label] = True
        return needs

    @cached_property
    def _users(self) -> list[set[int]]:
        users: list[set[int]] = [set() for _ in range(self.n_labels)]
        for goal, graph in enumerate(self.bank.graphs):
            for step in graph.used_steps:
                users[self.label[step]].add(goal)
        return users


_SHARED: WeakValueDictionary[tuple[int, int], CombinedGraph] = WeakValueDictionary()


def combined_graph_of(bank: Bank) -> CombinedGraph:
    """Return the graphs of a bank in one; beliefs about the same bank share it.

    Of 30 goals with 13,000 nodes each it takes 80 MB. The last belief frees it.
    """
    key = id(bank.table), id(bank.graphs)  # the same for all humans of a bank
    graph = _SHARED.get(key)  # while it lives, so does its bank: no other one has these ids
    if graph is None:
        graph = _SHARED[key] = CombinedGraph(bank)
    return graph


class ApplicableSteps:
    """Which labels some agent can do in a state, as bits; kept up to date from state to state."""

    def __init__(self, graph: CombinedGraph) -> None:
        table, task = graph.bank.table, graph.bank.goals.task
        self._task = task
        self._rules: list[list[Rule]] = [[] for _ in range(graph.n_labels)]
        self._odd: list[list[int]] = [[] for _ in range(graph.n_labels)]
        self._mentions: dict[int, set[int]] = {}
        for step in range(len(table)):
            for index in table[step].actions:
                self._take(index, graph.label[step])
        self._parts: dict[int, _Part] = {}
        self._all = self._part(range(graph.n_labels))

    def _take(self, index: int, label: int) -> None:
        action = self._task.actions[index]
        if action.rules is None:
            self._odd[label].append(index)
        else:
            self._rules[label].extend(action.rules)
        for position in positions(action.footprint):
            self._mentions.setdefault(position, set()).add(label)

    def _part(self, labels: Iterable[int]) -> _Part:
        """Return how some labels are looked at."""
        part_labels = sorted(labels)
        rules = tuple(
            (1 << label, *rule)
            for label in part_labels
            for rule in dict.fromkeys(self._rules[label])
        )
        odd = tuple(
            (1 << label, tuple(self._odd[label])) for label in part_labels if self._odd[label]
        )
        return ~sum(1 << label for label in part_labels), rules, odd

    def of(self, state: int) -> int:
        """Return the labels that can be done in a state, as bits."""
        return self._update(state, 0, self._all)

    def after(self, doable: int, before: int, state: int) -> int:
        """Return the labels that can be done in ``state``, from those of a state ``before``."""
        pattern = before ^ state
        part = self._parts.get(pattern)
        if part is None:
            labels: set[int] = set()
            for position in positions(pattern):
                labels |= self._mentions.get(position, set())
            part = self._parts[pattern] = self._part(labels)
        return self._update(state, doable, part)

    def _update(self, state: int, doable: int, part: _Part) -> int:
        others, rules, odd = part
        doable &= others
        for bit, mask, value, writes, adds in rules:
            if state & mask == value and state & writes != adds:
                doable |= bit
        for bit, actions in odd:
            if any(self._task.is_applicable(state, index) for index in actions):
                doable |= bit
        return doable


def _concatenate(parts: Iterable[Ids]) -> Ids:
    return np.concatenate([np.zeros(0, dtype=np.int64), *parts])


def _with_sentinel(keys: Ids) -> Ids:
    """Return keys with one behind them that is never looked for."""
    return np.append(keys, np.iinfo(np.int64).max)


def _shares(graph: PlanGraph) -> tuple[Floats, Floats]:
    """Return for each edge the share of its node's plans that go along it, and its logarithm."""
    sources = np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    try:
        counts = graph.n_paths_to_goal.astype(np.float64)
    except OverflowError:  # beyond what a float holds, and so may be the shares
        logs = np.array([math.log(count) for count in graph.n_paths_to_goal])
        of_edges: Floats = logs[graph.targets] - logs[sources]
        return np.exp(of_edges), of_edges
    shares: Floats = counts[graph.targets] / counts[sources]
    return shares, np.log(shares)


def _log_sums(shares: Floats, logs: Floats, which: Ids, n: int) -> Floats:
    """Return the logarithm of the sum of what belongs together, also where a sum is no float."""
    sums = np.bincount(which, weights=shares, minlength=n)
    if (sums > np.finfo(np.float64).tiny).all():
        plain: Floats = np.log(sums)
        return plain
    log_totals = np.full(n, -math.inf)
    np.logaddexp.at(log_totals, which, logs)
    return log_totals
