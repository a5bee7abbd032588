"""Plan graphs from listed plans, for goals of which the whole graph does not fit.

The plans come from K*; their states are merged, so the graph holds also what can be put together
from parts of them. All of it is valid and optimal; what is missing is not known to be missing.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hrcplan.bank.construct import assemble, empty_graph, merge_equivalent_nodes
from hrcplan.bank.goals import Goals
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits, StateSpaceLayers
from hrcplan.pddl.model import Formula
from hrcplan.planners import kstar, process
from hrcplan.planners.lowering import lower
from hrcplan.search.packed_states import FactPacking
from hrcplan.search.relevance import relevant
from hrcplan.task import Task
from hrcplan.task.conditions import Tests, meets
from hrcplan.task.steps import StepTable

LONGEST_S = 86_400.0  # a planner process without a limit of its own


def sampled_graph(
    table: StepTable, goals: Goals, goal: int, n: int, *, limits: BuildLimits
) -> PlanGraph:
    """Return the graph made of up to ``n`` optimal plans of a goal.

    Raises:
        MissingPlannerError: if K* is not installed.
        LimitError: if time or memory runs out.
        PlannerError: if K* crashes.
    """
    task, steps = step_task(table, goals.formulas[goal])
    process_limits = process.ProcessLimits(
        min(LONGEST_S, max(0.0, limits.deadline - time.monotonic())),
        memory_bytes=max(limits.mib, 1024) << 20,
        output_bytes=1 << 28,
    )
    listing = kstar.list_plans(lower(task), process_limits, n=n)
    plans = {tuple(steps[action.index] for action in plan) for plan in listing.plans}
    graph = graph_of_plans(table, goals, goal, sorted(plans))
    return replace(graph, complete=listing.complete)


def step_task(table: StepTable, goal: Formula) -> tuple[Task, list[int]]:
    """Return the task with one action for each way to do a step, and the step of each action.

    Actions cost what steps cost in the bank.
    """
    task = table.task.with_goal(goal)
    cheapest: dict[object, int] = {}
    for action in task.actions:
        way = (table.of_action[action.index], action.tests, action.at_start, action.at_end)
        best = cheapest.setdefault(way, action.index)
        if table.price(action.index) < table.price(best):
            cheapest[way] = action.index
    cheapest_actions = sorted(cheapest.values())
    actions = tuple(
        replace(task.actions[old], index=new) for new, old in enumerate(cheapest_actions)
    )
    prices = tuple(table.price(old) for old in cheapest_actions)
    return task.with_actions(actions, prices), [table.of_action[old] for old in cheapest_actions]


def graph_of_plans(
    table: StepTable, goals: Goals, goal: int, plans: Sequence[Sequence[int]]
) -> PlanGraph:
    """Return the graph whose nodes are the states that optimal plans go through."""
    tests, name = goals.tests[goal], goals.names[goal]
    _, literals = relevant(table.ops, tests)
    packing = FactPacking.of_facts(literals.facts)
    if not plans:
        return empty_graph(name, packing)
    edges: dict[tuple[int, int, int], tuple[int, int]] = {}
    for plan in plans:
        state, cost = goals.task.initial, 0
        for step in plan:
            op = next(op for op in table.ways(step) if meets(state, op.tests))
            after = op.apply(state)
            edges[cost, state & literals.facts, step] = (cost + op.cost, after & literals.facts)
            state, cost = after, cost + op.cost
    root = (0, goals.task.initial & literals.facts)
    graph = assemble(table, _as_space(packing, root, edges, tests), packing, name)
    return merge_equivalent_nodes(graph, table, tests)


def _as_space(
    packing: FactPacking, root: tuple[int, int],
    edges: dict[tuple[int, int, int], tuple[int, int]], goal: Tests,
) -> StateSpaceLayers:  # fmt: skip
    nodes = sorted({root, *edges.values()})
    index = {node: i for i, node in enumerate(nodes)}
    prices = np.array([cost for cost, _ in nodes], dtype=object)
    starts = [i for i, cost in enumerate(prices) if not i or prices[i - 1] != cost]
    rows = [(index[key[:2]], key[2], index[after]) for key, after in edges.items()]
    table = np.array(sorted(rows, key=lambda row: row[2]), dtype=np.int64).reshape(-1, 3)
    parts = tuple(
        (part[:, 0], part[:, 1].astype(np.int32), part[:, 2])
        for part in np.split(table, np.searchsorted(table[:, 2], starts[1:]))
    )
    states = [state for _, state in nodes]
    is_goal = np.array([meets(state, goal) for state in states])
    layers = tuple((int(prices[i]), i) for i in starts)
    return StateSpaceLayers(packing.rows(states), layers, parts, is_goal, None, None)
