"""Who does what at which price: prices act on top of graphs that are built in steps.

A price is what a ground action costs, with the present agent state. In a team that takes turns
every timestep has a price too, the metric's weight of time; the cheapest team plan is looked for
among all plans, also those that take more timesteps than necessary. Elsewhere it is among the plans
of the graph, and each step is given to the agent for whom it is cheapest.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from hrcplan.bank.bank import Bank
from hrcplan.bank.builder import build
from hrcplan.bank.cost_to_go import CostToGo, cost_to_go_of
from hrcplan.bank.graph import PlanGraph
from hrcplan.core.arrays import Floats, Ids
from hrcplan.core.numbers import Number
from hrcplan.pddl.conventions import interactions
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, FluentKey, Problem
from hrcplan.task import Task
from hrcplan.task.numbers import linear
from hrcplan.task.steps import STEPS, TASK, StepTable

TIE = 1e-6  # the price of a timestep where time has none: of equal plans the shorter one


@dataclass(frozen=True)
class Allocation:
    """Who does what in a cheapest plan of a goal.

    Attributes:
        goal: The goal's name.
        cost: What the plan costs: actions and, in a team, time by the metric.
        timesteps: How many timesteps a team takes; None where agents do not take turns.
        actions: How many actions each agent does.
        either: Actions that cost several agents the same, or that name none.
        interactions: How many of the actions change the state of another agent.
    """

    goal: str
    cost: float
    timesteps: int | None
    actions: Mapping[str, int]
    either: int
    interactions: int


def allocations(bank: Bank, values: Mapping[FluentKey, Number] | None = None) -> list[Allocation]:
    """Return who does what for each goal that has a plan.

    Args:
        bank: The plans. Graphs that are built in the task's cost are built again if values differ.
        values: Function values, such as agent state, in place of those of the problem.

    Raises:
        LimitError: if graphs that have to be built again do not fit.
        UnsupportedError: if bits cannot hold the task with these values.
    """
    bank = with_prices(bank, values or {})
    if bank.turns == "exact":
        return list(_of_team(bank))
    prices = _step_prices(bank)
    return [_of_graph(bank, graph, prices) for graph in bank.graphs if graph.n_nodes]


def with_prices(bank: Bank, values: Mapping[FluentKey, Number]) -> Bank:
    """Return a bank whose task has other function values; graphs in steps are the same ones."""
    if not values:
        return bank
    goals = replace(bank.goals, problem=bank.goals.problem.with_values(values))
    if bank.recipe.cost != STEPS or bank.goals.task.with_values(values).actions is not (
        bank.goals.task.actions
    ):
        return build(goals, bank.recipe)
    return replace(bank, goals=goals)


def _costs(bank: Bank) -> tuple[Number, ...]:
    """Return what each ground action of a bank's table costs, by the values of its goals."""
    return bank.table.task.with_values(_values(bank)).costs


def _values(bank: Bank) -> dict[FluentKey, Number]:
    """Return the function values of a bank's goals."""
    return {k: v for k, v in bank.goals.problem.values.items() if k != (TOTAL_COST,)}


def _interacts(bank: Bank) -> list[bool]:
    """Return for each ground action whether it changes agent state."""
    changing = interactions(bank.goals.problem.domain)
    return [action.name in changing for action in bank.table.task.actions]


# Graphs without turns.


def _step_prices(bank: Bank) -> Floats:
    costs = _costs(bank)
    return np.array([
        float(min(costs[i] for i in bank.table[step].actions)) for step in range(len(bank.table))
    ])  # fmt: skip


def cheapest(graph: PlanGraph, prices: Floats) -> Floats:
    """Return what the cheapest rest of a plan costs from each node; one backward pass.

    Args:
        graph: The plans.
        prices: The price of each step.
    """
    costs = np.where(graph.is_goal, 0.0, np.inf)
    sources = np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    ends = [*(first for _, first in graph.layers[1:]), graph.n_nodes]
    for (_, begin), end in zip(reversed(graph.layers), reversed(ends), strict=True):
        edges = slice(graph.first[begin], graph.first[end])
        following = prices[graph.steps[edges]] + costs[graph.targets[edges]]
        np.minimum.at(costs, sources[edges], following)
    return costs


def _of_graph(bank: Bank, graph: PlanGraph, prices: Floats) -> Allocation:
    costs, task, interacts = _costs(bank), bank.table.task, _interacts(bank)
    to_go = cheapest(graph, prices)
    node, shares, either, n_interactions = 0, Counter[str](), 0, 0
    while not graph.is_goal[node]:
        edges = graph.next(node)
        step = min(edges, key=lambda s: (prices[s] + to_go[edges[s]], s))
        node, actions = edges[step], bank.table[step].actions
        least = min(costs[i] for i in actions)
        doers = {task.actions[i].agent for i in actions if costs[i] == least}
        agent = next(iter(doers)) if len(doers) == 1 else None
        n_interactions += interacts[actions[0]]
        either += agent is None
        shares.update([agent] if agent is not None else [])
    n = {agent: shares[agent] for agent in task.problem.agents}
    return Allocation(graph.goal, float(to_go[0]), None, n, either, n_interactions)


# Teams that take turns.


def _of_team(bank: Bank) -> Iterator[Allocation]:
    costs, (price_of_cost, timestep) = cost_to_go_of(bank), metric_weights(bank)
    table = StepTable(bank.table.task.with_values(_values(bank)), TASK)
    prices = np.array([float(table.in_units(op.cost)) for op in table.ops]) * price_of_cost
    interacts = _interacts(bank)
    for goal, name in enumerate(bank.names):
        to_go = costs.priced(goal, prices, timestep)
        place = costs.place(bank.table.task.initial)
        if np.isfinite(to_go[0, place]):
            steps = list(_cheapest_plan(costs, to_go, goal, prices, timestep))
            actions = [bank.table[step].actions[0] for step in steps if step is not None]
            doers = Counter(bank.table.task.actions[i].agent for i in actions)
            yield Allocation(
                name, float(to_go[0, place]), len(steps),
                {agent: doers[agent] for agent in bank.goals.problem.agents},
                doers[None], sum(interacts[i] for i in actions),
            )  # fmt: skip


def metric_weights(bank: Bank) -> tuple[float, float]:
    """Return the weights of cost and of a timestep in a team's metric.

    All agents act in the time of one action, so a timestep is a part of the mean duration.
    """
    problem: Problem = bank.goals.problem
    sums = linear(problem.metric, {}) if problem.metric is not None else None
    weights = {(TOTAL_COST,): 1} if sums is None or problem.maximize else sums
    task: Task = bank.table.task
    durations = [float(action.duration or 1) for action in task.actions] or [1.0]
    time = float(weights.get((TOTAL_TIME,), 0)) * float(np.mean(durations)) / len(bank.team)
    return float(weights.get((TOTAL_COST,), 0)), max(time, TIE)


def _cheapest_plan(
    costs: CostToGo, to_go: Floats, goal: int, prices: Floats, timestep: float
) -> Iterator[int | None]:
    """Yield the steps of a cheapest team plan, and None for a wait."""
    place, turn = costs.place(costs.bank.table.task.initial), 0
    while not costs.is_goal(goal, place):
        steps, targets = costs.actions(place, turn)
        own = costs.prices(place, turn, prices)
        turn = (turn + 1) % len(costs.bank.team)
        options: Ids = np.append(targets, place)
        values = np.append(own, 0.0) + timestep + to_go[turn, options]
        best = int(np.argmin(np.round(values, 9)))
        place = int(options[best])
        yield int(steps[best]) if best < len(steps) else None
