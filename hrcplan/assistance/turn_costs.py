"""What a pair of people and robots still pays for a goal, where steps do not say who does them.

They take turns. In a human turn each next step of the plans is equally likely, at its price in the
hands of a person; in a robot turn the robot does what is best, or waits for a price of 1. With all
prices 1 it is the number of steps that are left.
"""

from __future__ import annotations

import numpy as np

from hrcplan.assistance.step_prices import StepPrices
from hrcplan.bank import PlanGraph
from hrcplan.core.arrays import Floats, Ids

OUT_OF_REACH = 1000.0  # what counts for a goal that no agent can bring nearer


def human_turn_costs(graph: PlanGraph, prices: StepPrices) -> Floats:
    """Return what is still to be paid from each node, at the beginning of a human turn.

    Args:
        graph: The plans of the goal.
        prices: The price of each step.
    """
    if not graph.n_nodes:  # the goal is out of reach
        return np.zeros(0)
    costs, robot_turn = np.zeros(graph.n_nodes), np.zeros(graph.n_nodes)
    by_human, by_robot = prices.human[graph.steps], prices.robot[graph.steps]
    ends = [*(first for _, first in graph.layers[1:]), graph.n_nodes]
    for (_, begin), end in zip(reversed(graph.layers), reversed(ends), strict=True):
        first = graph.first[begin : end + 1]
        edges = slice(first[0], first[-1])
        is_open = ~graph.is_goal[begin:end] & (np.diff(first) > 0)
        nodes, starts = begin + np.flatnonzero(is_open), first[:-1][is_open] - first[0]
        costs[begin:end] = robot_turn[begin:end] = np.where(
            graph.is_goal[begin:end], 0.0, OUT_OF_REACH
        )
        if not len(nodes):
            continue
        targets = graph.targets[edges]
        acts = np.minimum.reduceat(by_robot[edges] + costs[targets], starts)
        own = _mean(by_human[edges] + robot_turn[targets], starts)
        own = np.where(np.isfinite(own), own, 1 + acts)  # no step of a person: they wait
        costs[nodes] = np.minimum(own, OUT_OF_REACH)
        robot_turn[nodes] = np.minimum(acts, 1 + costs[nodes])
    return costs


def _mean(values: Floats, starts: Ids) -> Floats:
    """Return the mean of the finite values of each group; infinite where there are none."""
    counts = np.isfinite(values)
    totals = np.add.reduceat(np.where(counts, values, 0.0), starts)
    numbers = np.add.reduceat(counts.astype(np.float64), starts)
    mean: Floats = np.where(numbers > 0, totals / np.maximum(1, numbers), np.inf)
    return mean
