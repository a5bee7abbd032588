"""Goals without plan graphs: the observed steps cost more or less on the way to each goal.

The likelihood of an action under a goal falls with what it adds to the cost of reaching the goal
(Ramírez and Geffner, AAAI 2010; from the present state only: Masters and Sardina, JAIR 2019), and
with the number of actions that would have served as well. Distances are proven where time allows,
and relaxed plans stand in where it does not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hrcplan.bank import Goals, StepTable
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import IMPOSSIBLE, GoalChange
from hrcplan.inference.changes import (
    NEVER,
    ChangeFilter,
    FilterState,
    change_points,
    changes_before,
)
from hrcplan.inference.probabilities import normalized
from hrcplan.inference.recognition.optimal import FastDownwardProver
from hrcplan.search.distances import Distances, GoalDistance
from hrcplan.task.steps import STEPS, TASK

TIMEOUT_S = 25.0
BETA = 1.0  # per cost of an average step
CHOICE = 0.5  # weight of the number of actions that would have served as well
HAZARD = 0.01
MAX_DETOUR = 10.0  # no single action speaks more strongly against a goal
PROGRESS = 1e-3  # between goals that are otherwise alike, the one that is nearer to its end
MAX_SIBLINGS, FEW_SIBLINGS = 48, 8  # as long as there is time, and when it runs short
LATE = 0.1  # beyond this part of the time nothing is spent on actions that were not taken
MAX_PRICE = 10_000


@dataclass(frozen=True, slots=True)
class CostState:
    """The state of `CostBelief`: the world, its distance to each goal, and the filter."""

    world: int
    places: tuple[GoalDistance, ...]
    filter_state: FilterState
    n_observed: int = 0
    is_human: bool = False
    ignored: str | None = None
    n_bridged: int = 0
    note: str | None = None


class CostBelief:
    """A belief from cost differences, for any classical task.

    Actions that cannot be done where the world is believed to be are evidence of unobserved ones:
    a cheapest way to where they can be done is put before them.

    Args:
        goals: The goals.
        timeout_s: Seconds for proven distances, all in all.
        hazard: The probability of a change of goal before each action.
        never: The prior probability that the goal never changes.
    """

    takes_goals = True

    def __init__(
        self, goals: Goals, timeout_s: float = TIMEOUT_S, hazard: float = HAZARD,
        never: float = NEVER,
    ) -> None:  # fmt: skip
        self.goals = goals
        self.steps = StepTable(goals.task, _cost_kind(goals))
        self.ops = self.steps.ops
        self.distances = Distances(self.ops, goals.tests, timeout_s, FastDownwardProver(self.ops))
        self.unit = sum(op.cost for op in self.ops) / max(1, len(self.ops)) or 1.0
        self.filter = ChangeFilter(len(goals), 1, hazard, never)
        self._ops_of: list[list[int]] = [[] for _ in range(len(self.steps))]
        for i, op in enumerate(self.ops):
            self._ops_of[op.step].append(i)
        self._first: tuple[GoalDistance, ...] | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.goals.names

    def start(self) -> CostState:
        """Return the uniform belief in the initial state."""
        initial = self.goals.task.initial
        if self._first is None:
            self._first = self.distances.first(initial)
        return CostState(initial, self._first, self.filter.start(), note=self._note(self._first))

    def observe(self, state: CostState, step: int, *, robot: bool = False) -> CostState:
        """Return the belief after one more action; the robot's own are no evidence."""
        operators = self._operators_of(state.world, step)
        if operators is None:
            return replace(state, is_human=False, ignored=IMPOSSIBLE)
        *bridge, last = operators
        before = state.world
        for op in bridge:
            before = self.ops[op].apply(before)
        after = self.ops[last].apply(before)
        n_observed = state.n_observed + 1
        siblings = self._siblings(before, n_observed) if not robot else []
        costs = self.distances.estimates([after, *siblings])
        order = np.argsort(-self.posterior(state), kind="stable").tolist()
        places = self.distances.next(state.places, after, operators, costs[0], order, n_observed)
        note = state.note or self._note(places)
        n_bridged = state.n_bridged + len(bridge)
        next_state = CostState(
            after, places, state.filter_state, n_observed, not robot, n_bridged=n_bridged, note=note
        )
        if robot:
            return next_state
        price = sum(self.ops[op].cost for op in operators)
        log_likelihood = self._log_likelihood(state.places, places, price, costs[1:])
        likelihood = np.exp(log_likelihood - log_likelihood.max())[None, :]
        return replace(next_state, filter_state=self.filter.step(state.filter_state, likelihood))

    def _operators_of(self, world: int, step: int) -> list[int] | None:
        """Return the ops that a step stands for: itself, after unobserved ones where needed."""
        ops = self._ops_of[step]
        for op in ops:
            if self.ops[op].is_enabled(world):
                return [op]
        bridge = self.distances.bridge(world, [test for op in ops for test in self.ops[op].tests])
        if bridge is None:
            return None
        there = world
        for op in bridge.ops:
            there = self.ops[op].apply(there)
        last = next((op for op in ops if self.ops[op].is_enabled(there)), None)
        return None if last is None else [*bridge.ops, last]

    def _siblings(self, world: int, n_observed: int) -> list[int]:
        """Return the states that one action leads to; an even choice of them if there are many."""
        clock = self.distances.clock
        left_s = clock.left_s(n_observed)
        if left_s < -LATE * clock.timeout_s:
            return []
        most = MAX_SIBLINGS if left_s > 0 else FEW_SIBLINGS
        task = self.goals.task
        states = list(dict.fromkeys(task.successor(world, i) for i in task.applicable(world)))
        stride = -(-len(states) // most) or 1
        return states[::stride]

    def _log_likelihood(
        self, before: Sequence[GoalDistance], after: Sequence[GoalDistance], price: float,
        siblings: Sequence[Sequence[float | None]],
    ) -> Floats:  # fmt: skip
        beta = BETA / self.unit
        log_likelihood = np.zeros(len(before))
        for goal, (old, new) in enumerate(zip(before, after, strict=True)):
            if old.distance is None or new.distance is None:
                detour = MAX_DETOUR
            else:
                detour = min(MAX_DETOUR, beta * (price + new.distance - old.distance))
            costs = [cost for row in siblings if (cost := row[goal]) is not None]
            least = min(costs, default=0.0)
            choices = sum(math.exp(beta * (least - cost)) for cost in costs) or 1.0
            log_likelihood[goal] = -detour - CHOICE * math.log(choices)
        return log_likelihood

    def posterior(self, state: CostState) -> Floats:
        """Return the probability of each goal, in order."""
        with np.errstate(divide="ignore"):
            scores = np.log(self.filter.goals(state.filter_state))
        first = self._first or state.places
        progress = [_progress(a, b) for a, b in zip(first, state.places, strict=True)]
        return normalized(scores + PROGRESS * np.array(progress))

    def changes(self, states: Sequence[CostState]) -> tuple[GoalChange, ...]:
        """Return the changes that are probable given all observations."""
        return changes_before(states)

    def changed(self, states: Sequence[CostState]) -> float:
        """Return the probability, given all observations, that the goal has changed at all."""
        return change_points(states)[1].changed

    def _note(self, places: Sequence[GoalDistance]) -> str | None:
        n = sum(place.way is None and place.estimate is not None for place in places)
        if not n:
            return None
        return f"distances to {n} of {len(places)} goals are estimates by relaxed plans"


def _progress(first: GoalDistance, now: GoalDistance) -> float:
    if first.distance is None or now.distance is None:
        return 0.0
    return 1 - now.distance / max(1.0, first.distance)


def _cost_kind(goals: Goals) -> str:
    """Return ``task`` if all costs are positive whole numbers, and not large; else ``steps``."""
    costs = goals.task.costs
    fine = all(isinstance(cost, int) and 0 < cost <= MAX_PRICE for cost in costs)
    return TASK if fine else STEPS
