"""Changes of goal, looking back: how many there were, where, and from which goal to which.

This is the read-out for reports. It uses the likelihoods of the observed steps only, with a prior
of its own, so that a filter can act on another prior (`hrcplan.inference.changes`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import GoalChange

PRIOR = 0.5
"""The prior probability that the goal changes at all: ``changed`` is then a Bayes factor."""
MORE = 0.1
"""How probable one more change is, after each."""
MOST = 4
"""Changes that are considered."""
COVERED = 0.9
"""The probability that the interval of places holds the change, if there is one."""
REPORTED = 0.5
_SAME = 1e-9  # places whose probabilities differ by less are equally probable


@dataclass(frozen=True)
class ChangePoints:
    """The posterior of the changes of goal in a sequence of human steps.

    A change lies before a step that is not the first. The number of changes k has the prior
    ``1 - prior`` for none, and each further one is ``MORE`` times as probable as the one before;
    all places of k changes are equally probable, and so are all goals but the present one.

    Attributes:
        likelihoods: (steps, rates, goals): how likely each human step is under a goal that is
            pursued with a rate of mistakes.
        prior: The prior probability that the goal changes.
        reported: The probability above which `changes` reports a change.
    """

    likelihoods: Floats
    prior: float = PRIOR
    reported: float = REPORTED

    @property
    def n_steps(self) -> int:
        """The number of human steps."""
        return len(self.likelihoods)

    @cached_property
    def counts(self) -> Floats:
        """The posterior probability of k changes, for k from 0 to at most `MOST`."""
        most = min(MOST, self.n_steps - 1) if self.likelihoods.shape[2:] != (1,) else 0
        if most <= 0:
            return np.ones(1)
        priors = np.array([MORE**k for k in range(most)])
        priors = np.array([1 - self.prior, *(self.prior * priors / priors.sum())])
        places = [math.comb(self.n_steps - 1, k) for k in range(most + 1)]
        shares: Floats = priors * self._forward[-1].sum(axis=(1, 2))[: most + 1] / places
        shares /= shares.sum() or 1.0
        return shares

    @property
    def changed(self) -> float:
        """The posterior probability that the goal has changed at all."""
        return min(1.0, float(self.counts[1:].sum()))

    def changes(self) -> tuple[GoalChange, ...]:
        """Return the changes that are more probable than ``reported``, in order of time.

        The i-th change has the probability that there were at least i. Its place, its interval and
        its goals are those of the posterior in which there are as many changes as are returned.
        ``at``, ``first`` and ``last`` count human steps; ``before`` and ``after`` are indices.
        """
        at_least = np.cumsum(self.counts[::-1])[::-1]
        n = int((at_least[1:] > self.reported).sum())
        changes: list[GoalChange] = []
        following = self._following(n)
        for i in range(n):
            places, goals = self._change(i, following)
            if changes:  # there is one goal between two changes
                goals[np.arange(len(goals)) != changes[-1].after] = 0
            before, after = np.unravel_index(int(goals.argmax()), goals.shape)
            at, sure = _middle_mode(places), min(1.0, float(at_least[i + 1]))
            changes.append(GoalChange(at, sure, *_interval(places, at), int(before), int(after)))
        return tuple(changes)

    @cached_property
    def _forward(self) -> Floats:
        """The weights (steps, changes, rates, goals) after each step, scaled step by step."""
        n_steps, n_rates, n_goals = self.likelihoods.shape
        weights = np.zeros((n_steps, MOST + 1, n_rates, n_goals))
        weights[0, 0] = self.likelihoods[0]
        for t in range(1, n_steps):
            weights[t] = weights[t - 1]
            weights[t, 1:] += _after_change(weights[t - 1, :-1])
            weights[t] *= self.likelihoods[t]
            weights[t] /= weights[t].max() or 1.0
        return weights

    def _following(self, n: int) -> Floats:
        """Return how likely each step and what follows it are, if there are n changes in all.

        It is scaled so that its sum with the weights before the step, over all ways to make the
        step, is one: entries of different steps can be compared.
        """
        following = np.zeros_like(self._forward)
        ahead = np.zeros_like(following[0])
        ahead[n] = self.likelihoods[-1]
        for t in range(self.n_steps - 1, 0, -1):
            behind = ahead.copy()
            behind[:-1] += _after_change(ahead[1:])
            following[t] = ahead / (float((self._forward[t - 1] * behind).sum()) or 1.0)
            ahead = behind / (behind.max() or 1.0) * self.likelihoods[t - 1]
        return following

    def _change(self, i: int, following: Floats) -> tuple[Floats, Floats]:
        """Return the probability of each place of the i-th change, and of each pair of goals."""
        n_steps, _, n_goals = self.likelihoods.shape
        places, goals = np.zeros(n_steps), np.zeros((n_goals, n_goals))
        for t in range(1, n_steps):
            pairs = self._forward[t - 1, i].T @ following[t, i + 1] / max(1, n_goals - 1)
            np.fill_diagonal(pairs, 0.0)
            places[t] = pairs.sum()
            goals += pairs
        return places / (places.sum() or 1.0), goals


def _after_change(weights: Floats) -> Floats:
    """Return weights after a change of goal to one of the others, which are the last axis."""
    others = weights.sum(axis=-1, keepdims=True) - weights
    after: Floats = np.maximum(others, 0.0) / max(1, weights.shape[-1] - 1)
    return after


def _middle_mode(places: Floats) -> int:
    """Return the most probable place; of equally probable ones the middle one."""
    best = np.flatnonzero(places >= places.max() * (1 - _SAME))
    return int(best[(len(best) - 1) // 2])


def _interval(places: Floats, at: int) -> tuple[int, int]:
    """Return the shortest interval with ``at`` in it that holds a change with `COVERED`."""
    sums = np.concatenate([[0.0], np.cumsum(places)])
    ends = (
        (last - first, first, last)
        for first in range(at + 1)
        for last in range(at, len(places))
        if sums[last + 1] - sums[first] >= COVERED - _SAME
    )
    _, first, last = min(ends, default=(0, 0, len(places) - 1))
    return first, last
