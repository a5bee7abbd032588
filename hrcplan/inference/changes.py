"""A goal that may change: a filter over goals, kinds of humans, and whether it may still change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import GoalChange
from hrcplan.inference.change_points import ChangePoints

# Tuned on randomly generated kitchens, not on the shipped one (docs/papers/changed-mind.md).
HAZARD = 0.1
NEVER = 0.3
SETTLES = 0.9
DECLARED = 0.5

_TINY = 1e-300


@dataclass(frozen=True, slots=True)
class FilterState:
    """The filter after some human steps.

    ``weights[m, k, g]`` is the probability of a human of kind m with goal g, which may still change
    (k = 0) or will not any more (k = 1). ``no_change`` is the part of it in which nothing has
    changed since the last declared change. ``likelihood[m, g]`` is that of the last human step;
    None before any; ``marginal`` is its probability, as it was predicted.
    """

    weights: Floats
    no_change: Floats
    likelihood: Floats | None = None
    n_declared: int = 0
    marginal: float = 1.0


@dataclass(frozen=True)
class ChangeFilter:
    """A hidden Markov model of goals that change at random.

    With probability ``hazard`` the goal changes before a human step (not before the first) to one
    of the others, all alike; ``never`` is the prior probability that it never changes, and
    ``settles`` the probability that a goal that was changed to is kept to the end. Humans of
    several kinds, such as mistake rates, have the prior ``kinds``; all alike by default.
    """

    n_goals: int
    n_kinds: int
    hazard: float = HAZARD
    never: float = NEVER
    settles: float = SETTLES
    kinds: tuple[float, ...] | None = None

    def start(self) -> FilterState:
        """Return the prior: goals uniform, no change yet."""
        kinds = np.full(self.n_kinds, 1 / self.n_kinds) if self.kinds is None else self.kinds
        never = self.never if self.n_goals > 1 else 1.0
        weights = np.empty((self.n_kinds, 2, self.n_goals))
        weights[:] = np.array([1 - never, never])[:, None] / self.n_goals
        weights *= np.array(kinds)[:, None, None]
        return FilterState(weights, weights)

    def step(self, before: FilterState, likelihood: Floats) -> FilterState:
        """Return the filter after a human step with this likelihood, by kind of human and goal."""
        weights, no_change = before.weights, before.no_change
        if before.likelihood is not None:
            weights, no_change = self._after_hazard(weights), self._without_change(no_change)
        weights = weights * likelihood[:, None, :]
        total = max(float(weights.sum()), _TINY)
        weights /= total
        no_change = no_change * likelihood[:, None, :] / total
        is_declared = 1 - float(no_change.sum()) > DECLARED
        return FilterState(
            weights,
            weights if is_declared else no_change,
            likelihood,
            before.n_declared + is_declared,
            total,
        )

    def weigh(self, before: FilterState, goals: Floats) -> FilterState:
        """Return the filter after evidence that is no step, by its likelihood for each goal."""
        weights, no_change = before.weights * goals, before.no_change * goals
        total = max(float(weights.sum()), _TINY)
        return replace(before, weights=weights / total, no_change=no_change / total)

    def _without_change(self, weights: Floats) -> Floats:
        weights_after = weights.copy()
        weights_after[:, 0] *= 1 - self.hazard
        return weights_after

    def _after_hazard(self, weights: Floats) -> Floats:
        """Return the weights once the goal has, or has not, changed."""
        weights_after = self._without_change(weights)
        if self.n_goals > 1:
            moving = weights[:, 0] * (self.hazard / (self.n_goals - 1))
            moving = moving.sum(axis=1, keepdims=True) - moving
            weights_after[:, 1] += self.settles * moving
            weights_after[:, 0] += (1 - self.settles) * moving
        return weights_after

    def goals(self, state: FilterState) -> Floats:
        """Return the probability of each goal."""
        probabilities: Floats = state.weights.sum(axis=(0, 1))
        return probabilities


class _HasLikelihood(Protocol):
    """The state of a filter that knows the likelihood of the last human step."""

    @property
    def likelihood(self) -> Floats | None: ...


class _HumanStep(Protocol):
    """The state of a belief that filters changes of goal."""

    @property
    def is_human(self) -> bool: ...

    @property
    def filter_state(self) -> _HasLikelihood: ...


def change_points(states: Sequence[_HumanStep]) -> tuple[list[int], ChangePoints]:
    """Return the places of the human steps, and the posterior of the changes before them.

    It looks back from the last step with a prior of its own (`ChangePoints`), for reports; the
    filter is for acting, and for declaring changes as they happen.

    Args:
        states: The belief after each observation, in order.
    """
    likelihoods = {
        at: likelihood
        for at, state in enumerate(states)
        if state.is_human and (likelihood := state.filter_state.likelihood) is not None
    }
    return list(likelihoods), ChangePoints(
        np.array(list(likelihoods.values()) or [np.ones((1, 1))])
    )


def changes_before(states: Sequence[_HumanStep]) -> tuple[GoalChange, ...]:
    """Return the probable changes, with the places of observations instead of human steps."""
    places, points = change_points(states)
    return tuple(change.moved(places) for change in points.changes())
