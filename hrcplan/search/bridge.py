"""A short way from a state to where a condition holds: greedy search with a counted budget."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heappop, heappush

from hrcplan.search.relaxed_plans import RelaxedPlans
from hrcplan.task.conditions import Test
from hrcplan.task.steps import StepTable

MAX_EXPANSIONS = 200


def find_bridge(
    steps: StepTable, state: int, tests: Sequence[Test], max_expansions: int = MAX_EXPANSIONS
) -> tuple[int, ...] | None:
    """Return steps after which one of several tests holds, in order.

    Args:
        steps: What can be done.
        state: Where the way begins.
        tests: What is to hold at its end.
        max_expansions: The most states whose successors are looked at.

    Returns:
        The steps, not necessarily as few as possible; None if none were found.
    """
    plans = RelaxedPlans(steps.ops, [tests], n_plans=1)
    queue: list[tuple[float, int, int]] = [(0.0, 0, state)]
    ways: dict[int, tuple[int, ...]] = {state: ()}
    for _ in range(max_expansions):
        if not queue:
            return None
        _, _, current = heappop(queue)
        if any(current & mask == value for mask, value in tests):
            return ways[current]
        for step in steps.applicable(current):
            after = steps.successor(current, step)
            if after is None or after in ways:
                continue
            ways[after] = (*ways[current], step)
            cost = float(plans.shares(after).costs[0])
            if cost < float("inf"):
                heappush(queue, (cost + len(ways[after]), len(ways), after))
    return None
