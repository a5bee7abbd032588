"""How far every goal is from a state: proven where time allows, else estimated."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from hrcplan.search.relaxed_plan import Relaxation
from hrcplan.task.conditions import Test
from hrcplan.task.steps import Operator

FIRST_SHARE = 0.3  # of the time is for the distances from the start
N_EXPECTED = 80  # observations that the rest of the time has to do for
MAX_S = 2.0  # for one search
MIN_S = 0.03


@dataclass(frozen=True, slots=True)
class Way:
    """A cheapest way to a goal: its cost, and its operators."""

    cost: int
    ops: tuple[int, ...]


class Prover(Protocol):
    """Finds cheapest ways, and proves that they are cheapest."""

    def relevant_facts(self, goal: Test) -> int:
        """Return the facts that matter to a goal, as bits."""

    def cheapest_ways(
        self, searches: Sequence[tuple[int, Test]], limit_s: float, total_s: float
    ) -> list[Way | None]:
        """Return a cheapest way for each (state, goal); None where there is none, or no time."""


@dataclass(frozen=True, slots=True)
class GoalDistance:
    """How far one goal is.

    ``way`` is a cheapest way, if there is a proof. ``estimate`` is the cost of a relaxed plan, None
    if there is none. ``distance`` is the best value: proven, or an earlier one plus the change of
    the estimate since. ``is_proven`` says whether the distance from the start was proven.
    """

    estimate: float | None
    distance: float | None
    way: Way | None = None
    is_proven: bool = False


class Clock:
    """Divides time: one share for the first state, the rest evenly among the observations."""

    def __init__(self, timeout_s: float) -> None:
        self.timeout_s = timeout_s
        self.spent_s = 0.0

    def left_s(self, n_observed: int) -> float:
        """Return the seconds that may be spent by now."""
        rest = (1 - FIRST_SHARE) * min(1.0, n_observed / N_EXPECTED)
        return self.timeout_s * (FIRST_SHARE + rest) - self.spent_s


class Distances:
    """Distances to goals from states.

    Args:
        ops: The operators. Proofs need them to be simple, and goals of one alternative.
        goals: The alternatives of each goal.
        timeout_s: Seconds for all proofs together.
        prover: Proves distances; without it all are estimates.
    """

    def __init__(
        self, ops: Sequence[Operator], goals: Sequence[Sequence[Test]], timeout_s: float,
        prover: Prover | None = None,
    ) -> None:  # fmt: skip
        self.ops, self.goals = ops, goals
        self.clock = Clock(timeout_s)
        began = time.monotonic()
        self.relaxation = Relaxation(ops, goals)
        self.clock.spent_s += time.monotonic() - began
        self.prover = prover if all(op.is_simple for op in ops) else None
        self._ways_by_key: dict[tuple[int, int], Way | None] = {}

    def estimates(self, states: Sequence[int]) -> list[list[float | None]]:
        """Return for each state and goal the cost of a relaxed plan; None if there is none."""
        began = time.monotonic()
        costs = self.relaxation.costs(states)
        self.clock.spent_s += time.monotonic() - began
        return costs

    def first(self, state: int) -> tuple[GoalDistance, ...]:
        """Return the places of all goals at the start."""
        estimates = self.estimates([state])[0]
        ways = self._ways(state, [g for g, e in enumerate(estimates) if e is not None], 0)
        return tuple(
            GoalDistance(e, e)
            if (way := ways.get(g)) is None
            else GoalDistance(e, way.cost, way, True)
            for g, e in enumerate(estimates)
        )

    def next(
        self, places: Sequence[GoalDistance], after: int, ops: Sequence[int],
        estimates: Sequence[float | None], order: Sequence[int], n_observed: int,
    ) -> tuple[GoalDistance, ...]:  # fmt: skip
        """Return the places in a later state.

        Args:
            places: The places before.
            after: The later state.
            ops: The ops that led to it.
            estimates: The relaxed distances from it.
            order: Goals, the most important first, in case time runs short.
            n_observed: How many observations there were.
        """
        ways: dict[int, Way | None] = {}
        for goal, place in enumerate(places):
            if place.way is not None:
                ways[goal] = self._rest_of(goal, place.way, ops, after)
        open_goals = [
            g for g in order
            if places[g].is_proven and ways.get(g) is None and estimates[g] is not None
        ]  # fmt: skip
        ways.update(self._ways(after, open_goals, n_observed))
        return tuple(
            _next_place(place, estimates[goal], ways.get(goal)) for goal, place in enumerate(places)
        )

    def _rest_of(self, goal: int, way: Way, ops: Sequence[int], after: int) -> Way | None:
        """Return the rest of a cheapest way if what was done can stand at its beginning."""
        rest = list(way.ops)
        for op in ops:
            if op not in rest:
                return None
            rest.remove(op)
        state = after
        for op in rest:
            if not self.ops[op].is_enabled(state):
                return None
            state = self.ops[op].apply(state)
        if not any(state & mask == value for mask, value in self.goals[goal]):
            return None
        return Way(way.cost - sum(self.ops[op].cost for op in ops), tuple(rest))

    def _ways(self, state: int, goals: Sequence[int], n_observed: int) -> dict[int, Way | None]:
        """Return cheapest ways to goals, where they are found in time."""
        if self.prover is None or self.clock.left_s(n_observed) <= MIN_S:
            return {}
        began = time.monotonic()
        tests = {goal: self.goals[goal][0] for goal in goals if len(self.goals[goal]) == 1}
        keys = {g: (g, state & self.prover.relevant_facts(test)) for g, test in tests.items()}
        new = [goal for goal in tests if keys[goal] not in self._ways_by_key]
        left_s = self.clock.left_s(n_observed)
        if new and left_s > MIN_S:
            limit_s = max(MIN_S, min(MAX_S, 2 * left_s / len(new)))
            searches = [(state, tests[goal]) for goal in new]
            ways = self.prover.cheapest_ways(searches, limit_s, left_s)
            self._ways_by_key.update((keys[goal], way) for goal, way in zip(new, ways, strict=True))
        self.clock.spent_s += time.monotonic() - began
        return {goal: self._ways_by_key.get(key) for goal, key in keys.items()}

    def bridge(self, state: int, tests: Sequence[Test], limit_s: float = 1.0) -> Way | None:
        """Return a cheapest way to where one of several tests holds; None if none is found."""
        if self.prover is None:
            return None
        searches = [(state, test) for test in tests]
        ways = self.prover.cheapest_ways(searches, limit_s, 2 * limit_s)
        return min((way for way in ways if way), key=lambda way: way.cost, default=None)


def _next_place(place: GoalDistance, estimate: float | None, way: Way | None) -> GoalDistance:
    if estimate is None:
        return GoalDistance(None, None, None, place.is_proven)
    if place.is_proven and way is not None:
        return GoalDistance(estimate, way.cost, way, True)
    if place.distance is None or place.estimate is None:
        return GoalDistance(estimate, estimate, None, place.is_proven)
    distance = max(0.0, place.distance + estimate - place.estimate)
    return GoalDistance(estimate, distance, None, place.is_proven)
