"""What a pair of people and robots still pays for a goal, where steps do not say who does them.

Who acts next is open: each of the two as likely as the other. Were their turns strict, a step would
be worth nothing or twice as much, by whether the number of steps that are left is even or odd. A
person does any next step of the plans, each as likely, at its price in their hands; the robot does
what is best, or waits for a price of 1. With all prices 1 it is the number of steps that are left.
"""

from __future__ import annotations

import numpy as np

from hrcplan.assistance.step_prices import StepPrices
from hrcplan.bank import PlanGraph
from hrcplan.core.arrays import Floats, Ids

OUT_OF_REACH = 1000.0  # what counts for a goal that no agent can bring nearer


def costs_to_go(graph: PlanGraph, prices: StepPrices) -> Floats:
    """Return what is still to be paid from each node.

    Args:
        graph: The plans of the goal.
        prices: The price of each step.
    """
    if not graph.n_nodes:  # the goal is out of reach
        return np.zeros(0)
    costs = np.where(graph.is_goal, 0.0, OUT_OF_REACH)
    by_human, by_robot = prices.human[graph.steps], prices.robot[graph.steps]
    ends = [*(first for _, first in graph.layers[1:]), graph.n_nodes]
    for (_, begin), end in zip(reversed(graph.layers), reversed(ends), strict=True):
        first = graph.first[begin : end + 1]
        edges = slice(first[0], first[-1])
        is_open = ~graph.is_goal[begin:end] & (np.diff(first) > 0)
        nodes, starts = begin + np.flatnonzero(is_open), first[:-1][is_open] - first[0]
        if not len(nodes):
            continue
        after = costs[graph.targets[edges]]
        acts = np.minimum.reduceat(by_robot[edges] + after, starts)
        own = _mean(by_human[edges] + after, starts)
        # Who waits pays 1 and is where they were: the other one acts, after one wait on average.
        both = np.where(np.isfinite(own), (own + acts) / 2, 1 + acts)
        costs[nodes] = np.minimum(np.minimum(both, 1 + own), OUT_OF_REACH)
    return costs


def _mean(values: Floats, starts: Ids) -> Floats:
    """Return the mean of the finite values of each group; infinite where there are none."""
    counts = np.isfinite(values)
    totals = np.add.reduceat(np.where(counts, values, 0.0), starts)
    numbers = np.add.reduceat(counts.astype(np.float64), starts)
    mean: Floats = np.where(numbers > 0, totals / np.maximum(1, numbers), np.inf)
    return mean
