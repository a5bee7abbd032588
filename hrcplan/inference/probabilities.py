"""From scores to probabilities: rounded, so that equal evidence gives equal numbers."""

from __future__ import annotations

import math

import numpy as np

from hrcplan.core.arrays import Floats

ROUNDED = 9  # decimals of log scores


def normalized(log_scores: Floats) -> Floats:
    """Return probabilities in proportion to scores that are given as logarithms.

    >>> normalized(np.log([0.2, 0.2, 0.4])).round(6).tolist()
    [0.25, 0.25, 0.5]
    """
    highest = log_scores.max()
    if highest == -math.inf:
        return np.full(len(log_scores), 1 / len(log_scores))
    weights = np.exp((log_scores - highest).round(ROUNDED))
    probabilities: Floats = weights / math.fsum(weights.tolist())
    return probabilities


def weights_to_posterior(weights: Floats) -> Floats:
    """Return weights as probabilities, rounded like scores."""
    with np.errstate(divide="ignore"):
        return normalized(np.log(weights))


def weights_to_posteriors(weights: Floats) -> Floats:
    """Return rows of weights, each as ``weights_to_posterior`` does it.

    >>> weights_to_posteriors(np.array([[1.0, 3.0], [0.0, 0.0]])).round(6).tolist()
    [[0.25, 0.75], [0.5, 0.5]]
    """
    with np.errstate(divide="ignore"):
        logs = np.log(np.where(weights.any(axis=1, keepdims=True), weights, 1))
    shares = np.exp((logs - logs.max(axis=1, keepdims=True)).round(ROUNDED))
    totals = [math.fsum(row) for row in shares.tolist()]
    posteriors: Floats = shares / np.array(totals)[:, None]
    return posteriors
