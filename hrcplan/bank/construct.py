"""Plan graphs of a goal: all optimal plans, or all sequences up to a multiple of their cost."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Protocol

import numpy as np

from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits, Explorer, StateSpaceLayers
from hrcplan.bank.state_tables import group_rows
from hrcplan.core.arrays import Ids, SmallIds, Words
from hrcplan.core.numbers import Number
from hrcplan.search.lm_cut import Landmark, landmarks
from hrcplan.search.packed_states import WORD, FactPacking, PackedRules
from hrcplan.search.relevance import read_by, relevant
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator, StepTable

NO_LIMITS = BuildLimits()


def optimal_graph(
    table: StepTable, goal: Tests, state: int, *, name: str = "goal",
    limits: BuildLimits = NO_LIMITS, blind: bool = False, ops: Sequence[Operator] | None = None,
) -> PlanGraph:  # fmt: skip
    """Return the graph of all optimal plans from a state to a goal.

    Args:
        table: The steps.
        goal: The goal's alternatives, over the facts of the table's task.
        state: Where plans begin.
        name: The goal's name.
        limits: Time and memory.
        blind: Search without landmarks: the slow way to the same graph, for tests.
        ops: The ways to do steps that count; by default all of the table.

    Raises:
        LimitError: if time or memory runs out.
    """
    return optimal_with_price(table, goal, state, name=name, limits=limits, blind=blind, ops=ops)[0]


def optimal_with_price(
    table: StepTable, goal: Tests, state: int, *, name: str = "goal",
    limits: BuildLimits = NO_LIMITS, blind: bool = False, ops: Sequence[Operator] | None = None,
) -> tuple[PlanGraph, int | None]:  # fmt: skip
    """Return the graph of all optimal plans, and their price (None if there is none).

    The first search looks only at steps of landmarks, within what these cost at least. If it
    reaches the goal, this is the proof that it has all optimal plans: any other step would be
    paid on top. Otherwise the bound rises until the goal is reached.
    """
    ops, literals = relevant(table.ops if ops is None else ops, goal)
    packing = FactPacking.of_facts(literals.facts)
    start = packing.row(state)
    marks = landmarks(ops, state, goal)
    if marks is None:
        return empty_graph(name, packing), None
    bound = sum(mark.cost for mark in marks)
    space: StateSpaceLayers | None = None
    if blind:
        marks = ()
    else:
        useful, own = _useful(ops, marks)
        rules = PackedRules(useful, packing)
        search = Explorer(rules, goal, own, bound, optimal=True, limits=limits, name=name)
        space = search.run(start)
    rules = PackedRules(ops, packing)
    while space is None or space.cost is None:
        search = Explorer(rules, goal, marks, bound, optimal=True, limits=limits, name=name)
        space = search.run(start)
        if space.cost is None:
            if space.next_bound is None:
                return empty_graph(name, packing), None
            bound = max(space.next_bound, bound + min(op.cost for op in ops))
    graph = assemble(table, space, packing, name)
    return merge_equivalent_nodes(graph, table, goal), space.cost


def _useful(
    ops: Sequence[Operator], marks: Sequence[Landmark]
) -> tuple[list[Operator], tuple[Landmark, ...]]:
    """Return the ops that are in a landmark, and the landmarks over these alone."""
    useful = sorted(frozenset[int]().union(*(mark.ops for mark in marks)))
    place = {op: i for i, op in enumerate(useful)}
    own = (Landmark(frozenset(place[op] for op in mark.ops), mark.cost) for mark in marks)
    return [ops[i] for i in useful], tuple(own)


def bounded_graph(
    table: StepTable, goal: Tests, state: int, quality: Fraction, *, name: str = "goal",
    limits: BuildLimits = NO_LIMITS,
) -> PlanGraph:  # fmt: skip
    """Return the graph of all sequences up to ``quality`` times the optimal cost.

    They end where they first reach the goal, whatever steps they hold. Nodes are whole states, at
    one cost so far each.

    Raises:
        LimitError: if time or memory runs out.
    """
    _, price = optimal_with_price(table, goal, state, name=name, limits=limits)
    packing = FactPacking(tuple(range(len(table.task.facts))))
    marks = landmarks(table.ops, state, goal)
    if price is None or marks is None:
        return empty_graph(name, packing)
    bound, max_ties = table.bound(price, quality)
    rules = PackedRules(table.ops, packing)
    search = Explorer(rules, goal, marks, bound, optimal=False, limits=limits, name=name,
                      max_ties=max_ties)  # fmt: skip
    return assemble(table, search.run(packing.row(state)), packing, name)


def empty_graph(name: str, packing: FactPacking) -> PlanGraph:
    """Return the graph of a goal that cannot be reached."""
    rows = np.zeros((0, packing.n_words), dtype=np.uint64)
    none = np.zeros(0, dtype=np.int32)
    first = np.zeros(1, dtype=np.int64)
    return PlanGraph(name, packing, rows, (), first, none, none, np.zeros(0, dtype=np.bool_))


class HasUnits(Protocol):
    """What knows the bank cost of an integer price, such as a step table."""

    def in_units(self, price: int) -> Number:
        """Return an integer price as bank cost."""
        ...


def assemble(
    table: HasUnits, space: StateSpaceLayers, packing: FactPacking, name: str
) -> PlanGraph:
    """Return what an exploration found, without the states that lead to no goal."""
    alive = space.is_goal.copy()
    for sources, _, targets in reversed(space.edges):
        alive[sources[alive[targets]]] = True
    before = np.concatenate([[0], np.cumsum(alive)])
    edges = space.edges
    if not alive.all():
        edges = tuple(
            (before[sources[keep]], steps[keep], before[targets[keep]])
            for sources, steps, targets in edges
            for keep in [np.flatnonzero(alive[sources] & alive[targets])]
        )
    layers = tuple((table.in_units(cost), int(before[first])) for cost, first in space.layers)
    sources, steps, targets = (np.concatenate([part[i] for part in edges]) for i in range(3))
    return PlanGraph(
        name, packing, space.states[alive], _nonempty(layers, int(alive.sum())),
        *by_source(sources, steps, targets, int(alive.sum())), space.is_goal[alive],
    )  # fmt: skip


def _nonempty(
    layers: tuple[tuple[Number, int], ...], n_nodes: int
) -> tuple[tuple[Number, int], ...]:
    ends = [first for _, first in layers[1:]] + [n_nodes]
    return tuple(layer for layer, end in zip(layers, ends, strict=True) if layer[1] < end)


def by_source(
    sources: Ids, steps: SmallIds, targets: Ids, n_nodes: int
) -> tuple[Ids, SmallIds, SmallIds]:
    """Return edges in order of their source and step, each once, and where a source's begin."""
    key = sources * (int(steps.max(initial=0)) + 1) + steps
    if (np.diff(key) < 0).any():  # searches with one cost find them in order
        order = np.argsort(key, kind="stable")
        sources, steps, targets = sources[order], steps[order], targets[order]
    once = np.ones(len(sources), dtype=np.bool_)
    once[1:] = (sources[1:] != sources[:-1]) | (steps[1:] != steps[:-1])
    if not once.all():
        sources, steps, targets = sources[once], steps[once], targets[once]
    first = np.concatenate([[0], np.cumsum(np.bincount(sources, minlength=n_nodes))])
    return first, steps, targets.astype(np.int32)


def merge_equivalent_nodes(graph: PlanGraph, table: StepTable, goal: Tests) -> PlanGraph:
    """Return a graph of optimal plans over fewer facts: what its steps and the goal look at.

    States that agree on these and have paid the same go on alike, so they become one node.
    """
    used = (op for step in graph.used_steps for op in table.ways(step))
    packing = FactPacking.of_facts(read_by(used, goal) & graph.relevant_facts)
    if packing.positions == graph.packing.positions or not graph.n_nodes:
        return graph
    rows = _select(graph.rows, graph.packing, packing)
    keys = np.concatenate([graph.layer_of[:, None].astype(np.uint64), rows], axis=1)
    distinct_rows, which, order, starts = group_rows(keys)
    sources = np.repeat(which, np.diff(graph.first))
    first = np.searchsorted(distinct_rows[:, 0], np.arange(len(graph.layers)))
    layers = tuple((cost, int(first[i])) for i, (cost, _) in enumerate(graph.layers))
    return PlanGraph(
        graph.goal, packing, distinct_rows[:, 1:].copy(), layers,
        *by_source(sources, graph.steps, which[graph.targets], len(distinct_rows)),
        graph.is_goal[order[starts]], team=graph.team,
    )  # fmt: skip


def _select(rows: Words, old: FactPacking, new: FactPacking) -> Words:
    bits = np.unpackbits(rows.view(np.uint8), axis=1, bitorder="little")
    place = {position: i for i, position in enumerate(old.positions)}
    columns = np.zeros((len(rows), new.n_words * WORD), dtype=np.uint8)
    columns[:, : len(new.positions)] = bits[:, [place[position] for position in new.positions]]
    return np.packbits(columns, axis=1, bitorder="little").view(np.uint64)
