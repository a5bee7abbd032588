"""A second look at a finished bank, with the task's own semantics: every node, every edge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.bank import Bank
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.state_tables import group_rows
from hrcplan.bank.team import ANY_AGENT, step_owners
from hrcplan.core.arrays import Bools, Ids, Words
from hrcplan.search.packed_states import PackedRules


def fault(bank: Bank, goal: int) -> str | None:
    """Return what is wrong with the graph of a goal, or None if nothing is.

    Looked at: the root is the initial state; every edge is a step that can be done in its node
    and leads to its target at a higher cost; nodes without edges are the goal states, and only
    these; no node is out of reach.
    """
    graph, name = bank.graphs[goal], bank.names[goal]
    if graph.goal != name:
        return f"the graph of '{name}' says that it is of '{graph.goal}'"
    if not graph.n_nodes:
        return None
    shape = structure_fault(graph, len(bank.table), len(bank.goals.task.facts))
    return (shape and f"'{name}': {shape}") or _meaning(bank, goal)


def structure_fault(graph: PlanGraph, n_steps: int, n_facts: int) -> str | None:
    """Return why arrays are no graph of plans, or None; what its states mean is not looked at."""
    arrays = (graph.rows, graph.first, graph.steps, graph.targets, graph.is_goal)
    if [array.ndim for array in arrays] != [2, 1, 1, 1, 1]:
        return "its arrays have the wrong shapes"
    n, positions = graph.n_nodes, graph.packing.positions
    if sorted(set(positions)) != list(positions) or not set(positions) <= set(range(n_facts)):
        return "its facts are not those of the task"
    shapes = [array.shape for array in (graph.rows, graph.first, graph.is_goal)]
    if shapes != [(n, graph.packing.n_words), (n + 1,), (n,)]:
        return "its arrays have the wrong shapes"
    if graph.steps.shape != graph.targets.shape or (graph.is_goal.view(np.uint8) > 1).any():
        return "its arrays have the wrong shapes"
    starts = [first for _, first in graph.layers]
    if starts[:1] != [0][:n] or starts != sorted({*starts}) or any(s >= n for s in starts):
        return "its layers are not where its nodes are"
    return _edge_fault(graph, n_steps) if n else None


def _edge_fault(graph: PlanGraph, n_steps: int) -> str | None:
    n, m = graph.n_nodes, graph.n_edges
    if graph.first[0] != 0 or graph.first[-1] != m or (np.diff(graph.first) < 0).any():
        return "edges are not where the nodes say"
    if m and not (graph.targets.min() >= 0 and graph.targets.max() < n):
        return "an edge leads to no node"
    if m and not (graph.steps.min() >= 0 and graph.steps.max() < n_steps):
        return "an edge is no step"
    sources = np.repeat(np.arange(n), np.diff(graph.first))
    if (graph.layer_of[graph.targets] <= graph.layer_of[sources]).any():
        return "a step does not raise the cost"
    if ((np.diff(graph.first) == 0) != graph.is_goal).any():
        return "a dead end, or a goal that goes on"
    is_target = np.zeros(n, dtype=np.bool_)
    is_target[graph.targets] = is_target[0] = True
    if not is_target.all() and (graph.team is None or not _are_waits(graph, is_target)):
        return "a node is out of reach"
    return None


def _are_waits(graph: PlanGraph, is_target: Bools) -> bool:
    """Return whether the nodes that are no targets have the state of a node one timestep before."""
    states = graph.packing.states(graph.rows)
    timesteps = [graph.layers[layer][0] for layer in graph.layer_of]
    places = set(zip(states, timesteps, strict=True))
    return all((states[n], timesteps[n] - 1) in places for n in np.flatnonzero(~is_target))


def _meaning(bank: Bank, goal: int) -> str | None:
    graph, name = bank.graphs[goal], bank.names[goal]
    if (graph.packing.row(bank.initial) != graph.rows[0]).any():
        return f"'{name}': the root is not the initial state"
    used = [op for op in bank.table.ops if op.step in graph.used_steps]
    rules = PackedRules(used, graph.packing)
    if (rules.meets(graph.rows, bank.goals.tests[goal]) != graph.is_goal).any():
        return f"'{name}': a goal node is no goal state, or the other way round"
    wrong = _wrong_edges(graph, rules, len(bank.table))
    if wrong:
        return f"'{name}': {wrong} edges are not what the steps do"
    late = _wrong_turns(graph, bank)
    return f"'{name}': {late} edges are not in the turns of their agents" if late else None


def _wrong_turns(graph: PlanGraph, bank: Bank) -> int:
    """Return how many edges do not lead to the timestep after their agent's next turn."""
    if graph.team is None:
        return 0
    agents = graph.team.agents
    owners = np.array(step_owners(bank.table, agents))[graph.steps]
    times = np.array([int(cost) for cost, _ in graph.layers])[graph.layer_of]
    sources = np.repeat(times, np.diff(graph.first))
    n_waits = np.where(owners == ANY_AGENT, 0, (owners - graph.team.first - sources) % len(agents))
    return int((times[graph.targets] != sources + n_waits + 1).sum())


def _wrong_edges(graph: PlanGraph, rules: PackedRules, n_steps: int) -> int:
    """Return how many edges are not among the changes that can be made to their nodes."""
    steps = np.array([op.step for op in rules.ops], dtype=np.int64)
    sources = np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    edges = _table(sources, graph.steps, graph.rows[graph.targets], n_steps)
    numbers = [
        _table(rows, steps[ops], after, n_steps) for rows, ops, after in rules.expand(graph.rows)
    ]
    possible = np.concatenate([edges[:0], *numbers])
    _, which, _, _ = group_rows(np.concatenate([possible, edges]))
    return int((~np.isin(which[len(possible) :], which[: len(possible)])).sum())


def _table(sources: Ids, steps: NDArray[np.integer], after: Words, n_steps: int) -> Words:
    """Return one row for each change: what it starts from, the step, and what comes of it."""
    key = (sources * n_steps + steps).astype(np.uint64)
    return np.concatenate([key[:, None], after], axis=1)
