"""Two filters of goals that change, on the same observations, at the price of one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hrcplan.core.arrays import Floats
from hrcplan.inference.changes import DECLARED, ChangeFilter

_TINY = 1e-300
_ACTING, _DECLARING, _NO_CHANGE = slice(0, 2), slice(2, 4), slice(4, 6)  # layers


@dataclass(frozen=True, slots=True)
class PairedState:
    """Both filters after some human steps.

    ``layers[i, m, g]`` belongs to a human of kind m with goal g. The layers are for acting: the
    goal may still change, or will not; then the same for declaring; then the part of these two in
    which nothing has changed since the last declared change. ``likelihood[m, g]`` is that of the
    last human step; None before any. ``marginal`` is its probability, as predicted for acting.
    """

    layers: Floats
    likelihood: Floats | None = None
    n_declared: int = 0
    marginal: float = 1.0


@dataclass(frozen=True)
class PairedFilters:
    """Steps a filter for acting and one for declaring changes; both have the same kinds of humans.

    A change takes a goal to any other one alike. So a step of both filters is a matrix product over
    layers, one over the layers' sums, and the product with the likelihood.
    """

    acting: ChangeFilter
    declaring: ChangeFilter

    def start(self) -> PairedState:
        """Return the prior."""
        parts = [one.start() for one in (self.acting, self.declaring)]
        weights = [part.weights for part in parts] + [parts[1].no_change]
        return PairedState(np.concatenate([w.transpose(1, 0, 2) for w in weights]))

    def step(self, before: PairedState, likelihood: Floats) -> PairedState:
        """Return both filters after a human step with this likelihood, by kind and goal."""
        layers = before.layers
        if before.likelihood is not None:
            same, others = self._transitions
            moving = others.dot(layers.dot(self._ones[: layers.shape[2]]))
            layers = same.dot(layers.reshape(len(same), -1)).reshape(layers.shape)
            layers += moving[:, :, None]
            layers *= likelihood
        else:
            layers = layers * likelihood
        sums = layers.reshape(len(layers), -1).dot(self._ones).tolist()
        acting, declaring = max(sums[0] + sums[1], _TINY), max(sums[2] + sums[3], _TINY)
        layers[_ACTING] *= 1 / acting
        layers[_DECLARING.start :] *= 1 / declaring
        is_declared = 1 - (sums[4] + sums[5]) / declaring > DECLARED
        if is_declared:
            layers[_NO_CHANGE] = layers[_DECLARING]
        return PairedState(layers, likelihood, before.n_declared + is_declared, acting)

    def weigh(self, before: PairedState, goals: Floats) -> PairedState:
        """Return both filters after evidence that is no step, by its likelihood for each goal."""
        layers = before.layers * goals
        sums = layers.sum(axis=(1, 2)).tolist()
        acting, declaring = max(sums[0] + sums[1], _TINY), max(sums[2] + sums[3], _TINY)
        layers[_ACTING] *= 1 / acting
        layers[_DECLARING.start :] *= 1 / declaring
        return replace(before, layers=layers)

    @cached_property
    def _ones(self) -> Floats:
        return np.ones(self.acting.n_kinds * self.acting.n_goals)

    @cached_property
    def _transitions(self) -> tuple[Floats, Floats]:
        """Return what stays of each layer at its goal, and what of its sum goes to every goal."""
        same, others = np.zeros((6, 6)), np.zeros((6, 6))
        for at, one in ((0, self.acting), (2, self.declaring)):
            moves = one.hazard / (one.n_goals - 1) if one.n_goals > 1 else 0.0
            stays = 1 - one.hazard
            leaves = np.array([1 - one.settles, one.settles]) * moves
            same[at : at + 2, at] = [stays - leaves[0], -leaves[1]]
            others[at : at + 2, at] = leaves
            same[at + 1, at + 1] = 1.0
        same[4, 4], same[5, 5] = 1 - self.declaring.hazard, 1.0
        return same, others

    def goals(self, state: PairedState) -> Floats:
        """Return the probability of each goal, for acting."""
        probabilities: Floats = state.layers[:2].sum(axis=(0, 1))
        return probabilities
