"""Goals without plan graphs: the observed actions do what relaxed plans of a goal would do.

How likely an action is under a goal grows with the facts that it makes true for the first time and
that plans of the goal need (Wilken et al., ECAI 2024), and with the share of plans from the present
state that hold it; it is compared with the actions that could have been done instead. Plans are
relaxed, so that an answer takes milliseconds, and nothing depends on time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hrcplan.bank import Goals, StepTable
from hrcplan.core.arrays import Floats
from hrcplan.core.bits import positions
from hrcplan.core.deprecation import warn_old_name
from hrcplan.core.text import plural
from hrcplan.inference.belief import IMPOSSIBLE, UNCHANGED, GoalChange
from hrcplan.inference.change_points import ChangePoints
from hrcplan.inference.changes import NEVER, ChangeFilter, FilterState, change_points
from hrcplan.inference.probabilities import normalized
from hrcplan.pddl.conventions import people
from hrcplan.search.bridge import MAX_EXPANSIONS, find_bridge
from hrcplan.search.relaxed_plans import N_PLANS, RelaxedPlans, RelaxedPlanShares
from hrcplan.task.conditions import Test

# Chosen by cross-validation over four domains (docs/papers/goal-inference.md).
NEW_FACT, IN_PLAN, MISTAKES = 2.0, 3.0, 0.05
UNOBSERVED = 0.1
HAZARD = 0.01
# The settings above make guesses right; in the read-out of changes, log likelihoods count more.
SHARPNESS = 1.5
REPORTED = 0.7
LOST = 10.0  # log odds against a goal that an action puts out of reach
PROGRESS = 1e-3  # between goals that are otherwise alike, the one that is nearer to its end


@dataclass(frozen=True, slots=True)
class CostState:
    """The state of `CostBelief`.

    ``shares`` are those of plans from the world as it is observed, and from the world in which
    every action of a name that was not observed so far has been done unseen. ``seen`` are the facts
    that were ever true, as bits.
    """

    world: int
    seen: int
    shares: tuple[RelaxedPlanShares, ...]
    filter_state: FilterState
    names_observed: frozenset[str] = frozenset()
    is_human: bool = False
    ignored: str | None = None
    n_bridged: int = 0

    @property
    def note(self) -> str | None:
        """How many actions must have happened unobserved; None if there were none."""
        if not self.n_bridged:
            return None
        return f"{plural(self.n_bridged, 'action')} must have happened unobserved"


class CostBelief:
    """A belief from relaxed plans, for any classical task.

    Actions that cannot be done where the world is believed to be are evidence of unobserved ones:
    a way to where they can be done is put before them.

    Args:
        goals: The goals.
        hazard: The probability of a change of goal before each action.
        never: The prior probability that the goal never changes.
        new_fact: Log odds of an action per needed fact that it makes true for the first time.
        in_plan: Log odds of an action that is in all plans of a goal.
        mistakes: The share of actions that have nothing to do with the goal.
        unobserved: The prior probability that actions of some names are never observed.
        n_plans: How many relaxed plans of a goal are looked at.
        max_expansions: The most states that are expanded to explain one action.
        timeout_s: Without effect; what is done is counted instead.
    """

    takes_goals = True

    def __init__(
        self, goals: Goals, timeout_s: float | None = None, hazard: float = HAZARD,
        never: float = NEVER, new_fact: float = NEW_FACT, in_plan: float = IN_PLAN,
        mistakes: float = MISTAKES, unobserved: float = UNOBSERVED, n_plans: int = N_PLANS,
        max_expansions: int = MAX_EXPANSIONS,
    ) -> None:  # fmt: skip
        if timeout_s is not None:
            warn_old_name("option of method cost", "timeout_s", "max_expansions")
        self.goals = goals
        self.steps = StepTable(goals.task)
        self.ops = self.steps.ops
        self.max_expansions = max_expansions
        self.new_fact, self.in_plan, self.mistakes = new_fact, in_plan, mistakes
        self.plans = RelaxedPlans(self.ops, goals.tests, n_plans)
        kinds = (1 - unobserved, unobserved) if unobserved else (1.0,)
        self.filter = ChangeFilter(len(goals), len(kinds), hazard, never, kinds=kinds)
        self._ops_of: list[list[int]] = [[] for _ in range(len(self.steps))]
        for i, op in enumerate(self.ops):
            self._ops_of[op.step].append(i)
        self._people = people(goals.problem)

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.goals.names

    @cached_property
    def _first(self) -> RelaxedPlanShares:
        return self.plans.shares(self.goals.task.initial)

    def start(self) -> CostState:
        """Return the uniform belief in the initial state."""
        initial = self.goals.task.initial
        return CostState(initial, initial, self._shares(initial, frozenset()), self.filter.start())

    def observe(self, state: CostState, step: int, *, robot: bool = False) -> CostState:
        """Return the belief after one more action; the robot's own are no evidence."""
        tests = [] if self.steps.successor(state.world, step) is not None else self._tests(step)
        way = find_bridge(self.steps, state.world, tests, self.max_expansions) if tests else ()
        if way is None:
            return replace(state, is_human=False, ignored=IMPOSSIBLE)
        before = self._follow(state.world, way)
        after = self._follow(before, [step])
        if robot:
            return self._moved(state, way, before, after, [step])
        choices, shares = self._policy(state, before, [step])
        place = choices.index(step)
        return self._moved(state, way, before, after, [step], shares[:, place])

    def observe_fact(self, state: CostState, test: Test) -> CostState:
        """Return the belief after a fact was seen to be true, or false.

        If one action of a human can make it so, it was the most probable one of those, and they are
        evidence together; else all actions of a short way to the fact are.
        """
        mask, value = test
        if state.world & mask == value:
            return replace(state, is_human=False, ignored=UNCHANGED)
        choices, shares = self._policy(state, state.world, [])
        places = [i for i, step in enumerate(choices)
                  if self._follow(state.world, [step]) & mask == value]  # fmt: skip
        if not places:
            way = find_bridge(self.steps, state.world, [test], self.max_expansions)
            if way is None:
                return replace(state, is_human=False, ignored=IMPOSSIBLE)
            for step in way:
                state = self.observe(state, step)
            return replace(state, n_bridged=state.n_bridged + len(way) - 1)
        weights = state.filter_state.weights.sum(axis=1)
        best = max(places, key=lambda i: float((shares[:, i] * weights).sum()))
        after = self._follow(state.world, [choices[best]])
        likelihood = shares[:, places].sum(axis=1)
        return self._moved(state, (), state.world, after, [choices[best]], likelihood)

    def _tests(self, step: int) -> list[Test]:
        return [test for op in self._ops_of[step] for test in self.ops[op].tests]

    def _follow(self, world: int, steps: Sequence[int]) -> int:
        for step in steps:
            after = self.steps.successor(world, step)
            assert after is not None
            world = after
        return world

    def _moved(
        self, state: CostState, way: Sequence[int], before: int, after: int,
        steps: Sequence[int] = (), likelihood: Floats | None = None,
    ) -> CostState:  # fmt: skip
        """Return the belief after unobserved steps and an observed one of some likelihood."""
        names = state.names_observed.union(self.steps[step].name[0] for step in steps)
        shares = self._shares(after, names)
        moved = CostState(
            after, state.seen | before | after, shares, state.filter_state, names,
            likelihood is not None, n_bridged=state.n_bridged + len(way),
        )  # fmt: skip
        if likelihood is None:
            return moved
        was, now = (np.array([kind.costs for kind in x]) for x in (state.shares, shares))
        is_lost = np.isfinite(was) & ~np.isfinite(now)
        likelihood = np.where(is_lost, likelihood * math.exp(-LOST), likelihood)
        return replace(moved, filter_state=self.filter.step(state.filter_state, likelihood))

    def _shares(self, world: int, names: frozenset[str]) -> tuple[RelaxedPlanShares, ...]:
        """Return the shares of relaxed plans for each kind of human."""
        shares = self.plans.shares(world)
        if len(self.filter.kinds or ()) < 2:
            return (shares,)
        closure = self._with_unobserved(world, names)
        return shares, shares if closure == world else self.plans.shares(closure)

    def _with_unobserved(self, world: int, names: frozenset[str]) -> int:
        """Return the world with all facts that actions of other names can make true."""
        silent = [op for op in self.ops if self.steps[op.step].name[0] not in names]
        before = -1
        while world != before:
            before = world
            for op in silent:
                if op.is_enabled(world):
                    world |= op.apply(world)
        return world

    def _policy(
        self, state: CostState, world: int, more: Sequence[int]
    ) -> tuple[list[int], Floats]:
        """Return the steps that a human can do, and the probability of each.

        Args:
            state: The belief.
            world: Where the steps are done.
            more: Steps that another agent may have done.

        Returns:
            The steps, and their probabilities by kind of human, step and goal.
        """
        steps = list(self.steps.able(world, self.steps.applicable(world), self._people))
        steps += [step for step in more if step not in steps]
        ops = [self._enabled(step, world) for step in steps]
        fresh = np.zeros((len(ops), self.plans.n_facts))
        for i, op in enumerate(ops):
            facts = self.ops[op].apply(world) & ~state.seen
            fresh[i, [fact for fact in positions(facts) if fact < self.plans.n_facts]] = 1
        gains = self.new_fact * fresh @ self._first.facts
        scores = gains + self.in_plan * np.array([shares.ops[ops] for shares in state.shares])
        weights = np.exp(scores - scores.max(axis=1, keepdims=True, initial=0))
        policy = weights / weights.sum(axis=1, keepdims=True)
        return steps, (1 - self.mistakes) * policy + self.mistakes / max(1, len(steps))

    def _enabled(self, step: int, world: int) -> int:
        ops = self._ops_of[step]
        return next((op for op in ops if self.ops[op].is_enabled(world)), ops[0])

    def posterior(self, state: CostState) -> Floats:
        """Return the probability of each goal, in order."""
        with np.errstate(divide="ignore"):
            scores = np.log(self.filter.goals(state.filter_state))
        return normalized(scores + PROGRESS * self._progress(state))

    def _progress(self, state: CostState) -> Floats:
        """Return which part of the way to each goal is done; 0 where it is out of reach."""
        first, now = self._first.costs, state.shares[0].costs
        is_near = np.isfinite(first) & np.isfinite(now)
        progress = np.zeros(len(first))
        progress[is_near] = 1 - now[is_near] / np.maximum(1.0, first[is_near])
        return progress

    def changes(self, states: Sequence[CostState]) -> tuple[GoalChange, ...]:
        """Return the changes that are probable given all observations."""
        places, points = self._change_points(states)
        return tuple(change.moved(places) for change in points.changes())

    def changed(self, states: Sequence[CostState]) -> float:
        """Return the probability, given all observations, that the goal has changed at all."""
        return self._change_points(states)[1].changed

    def _change_points(self, states: Sequence[CostState]) -> tuple[list[int], ChangePoints]:
        places, points = change_points(states)
        likelihoods = points.likelihoods**SHARPNESS
        if places:
            likelihoods[0] *= np.array(self.filter.kinds)[:, None]
        return places, ChangePoints(likelihoods, reported=REPORTED)
