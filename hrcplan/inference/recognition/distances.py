"""How far every goal is from where someone stands: proven where time allows, else estimated."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

from hrcplan.inference.recognition.optimal import Searcher, Way, search
from hrcplan.search.relaxed_plan import Relaxation
from hrcplan.task.conditions import Test
from hrcplan.task.steps import Operator

FIRST_SHARE = 0.3  # of the time is for the distances from the start
N_EXPECTED = 80  # observations that the rest of the time has to do for
MAX_S = 2.0  # for one search
MIN_S = 0.03


@dataclass(frozen=True, slots=True)
class GoalDistance:
    """Where someone stands with regard to one goal.

    ``way`` is a cheapest way, if it is known. ``estimate`` is the cost of a relaxed plan, None if
    there is none. ``distance`` is what is believed: proven, or carried on with the changes of the
    estimate. ``is_proven`` says whether the distance from the start was proven.
    """

    estimate: float | None
    distance: float | None
    way: Way | None = None
    is_proven: bool = False


class Clock:
    """Gives out time: a share at the start, the rest bit by bit."""

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
        ops: What can be done.
        goals: The alternatives of each goal.
        timeout_s: Seconds for proofs, all in all.
    """

    def __init__(
        self, ops: Sequence[Operator], goals: Sequence[Sequence[Test]], timeout_s: float
    ) -> None:
        self.ops, self.goals = ops, goals
        self.clock = Clock(timeout_s)
        began = time.monotonic()
        self.relaxation = Relaxation(ops, goals)
        self.clock.spent_s += time.monotonic() - began
        self._simple = all(op.is_simple for op in ops)
        self._searchers: dict[int, Searcher] = {}
        self._known: dict[tuple[int, int], Way | None] = {}

    def estimates(self, states: Sequence[int]) -> list[list[float | None]]:
        """Return for each state and goal the cost of a relaxed plan; None if there is none."""
        began = time.monotonic()
        found = self.relaxation.costs(states)
        self.clock.spent_s += time.monotonic() - began
        return found

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
        self, places: Sequence[GoalDistance], after: int, done: Sequence[int],
        estimates: Sequence[float | None], order: Sequence[int], n_observed: int,
    ) -> tuple[GoalDistance, ...]:  # fmt: skip
        """Return the places in a later state.

        Args:
            places: The places before.
            after: The later state.
            done: The ops that led to it.
            estimates: The relaxed distances from it.
            order: Goals, the most important first, in case time runs short.
            n_observed: How many observations there were.
        """
        ways: dict[int, Way | None] = {}
        for goal, place in enumerate(places):
            if place.way is not None:
                ways[goal] = self._shortened(goal, place.way, done, after)
        wanted = [
            g for g in order
            if places[g].is_proven and ways.get(g) is None and estimates[g] is not None
        ]  # fmt: skip
        ways.update(self._ways(after, wanted, n_observed))
        return tuple(
            _moved(place, estimates[goal], ways.get(goal)) for goal, place in enumerate(places)
        )

    def _shortened(self, goal: int, way: Way, done: Sequence[int], after: int) -> Way | None:
        """Return the rest of a cheapest way if what was done can stand at its beginning."""
        rest = list(way.ops)
        for op in done:
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
        return Way(way.cost - sum(self.ops[op].cost for op in done), tuple(rest))

    def _searcher(self, goal: int) -> Searcher:
        if goal not in self._searchers:
            self._searchers[goal] = Searcher(self.ops, self.goals[goal][0])
        return self._searchers[goal]

    def _ways(self, state: int, goals: Sequence[int], n_observed: int) -> dict[int, Way | None]:
        """Return cheapest ways to goals, where they are found in time."""
        if not self._simple or self.clock.left_s(n_observed) <= MIN_S:
            return {}
        began = time.monotonic()
        goals = [goal for goal in goals if len(self.goals[goal]) == 1]
        keys = {goal: (goal, self._searcher(goal).key(state)) for goal in goals}
        new = [goal for goal in goals if keys[goal] not in self._known]
        left_s = self.clock.left_s(n_observed)
        if new and left_s > MIN_S:
            limit_s = max(MIN_S, min(MAX_S, 2 * left_s / len(new)))
            texts = [self._searcher(goal).text(state) for goal in new]
            for goal, way in zip(new, search(texts, limit_s, left_s), strict=True):
                self._known[keys[goal]] = way
        self.clock.spent_s += time.monotonic() - began
        return {goal: self._known.get(keys[goal]) for goal in goals}

    def bridge(self, state: int, tests: Sequence[Test], limit_s: float = 1.0) -> Way | None:
        """Return a cheapest way to where one of several tests holds; None if none is found."""
        if not self._simple:
            return None
        texts = [Searcher(self.ops, test).text(state) for test in tests]
        found = [way for way in search(texts, limit_s, 2 * limit_s) if way is not None]
        return min(found, key=lambda way: way.cost, default=None)


def _moved(place: GoalDistance, estimate: float | None, way: Way | None) -> GoalDistance:
    if estimate is None:
        return GoalDistance(None, None, None, place.is_proven)
    if place.is_proven and way is not None:
        return GoalDistance(estimate, way.cost, way, True)
    if place.distance is None or place.estimate is None:
        return GoalDistance(estimate, estimate, None, place.is_proven)
    distance = max(0.0, place.distance + estimate - place.estimate)
    return GoalDistance(estimate, distance, None, place.is_proven)
