"""What every belief about a goal does: it takes in one observed step at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from hrcplan.core.arrays import Floats

ROUNDED = 9  # decimals of log scores, so that equal evidence gives equal numbers


class State(Protocol):
    """What a belief is after some observations; it never changes.

    ``world`` is the state of the task, as bits. ``ignored`` says why the last observation told
    nothing; None if it did.
    """

    @property
    def world(self) -> int: ...  # noqa: D102

    @property
    def ignored(self) -> str | None: ...  # noqa: D102


S = TypeVar("S", bound=State)


@runtime_checkable
class Belief(Protocol[S]):
    """A belief about which of several goals someone has.

    Steps are those of a `StepTable`. Nothing is remembered outside the states, so a state can be
    followed in several directions, and one observation at a time gives what all at once give.
    """

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        ...

    def start(self) -> S:
        """Return the belief before any observation."""
        ...

    def observe(self, state: S, step: int, *, robot: bool = False) -> S:
        """Return the belief after one more step, done by the human or by the robot."""
        ...

    def posterior(self, state: S) -> Floats:
        """Return the probability of each goal, in order; they sum to one."""
        ...


def normalized(log_scores: Floats) -> Floats:
    """Return probabilities in proportion to scores that are given as logarithms.

    >>> normalized(np.log([0.2, 0.2, 0.4])).round(6).tolist()
    [0.25, 0.25, 0.5]
    """
    highest = log_scores.max()
    if highest == -math.inf:
        return np.full(len(log_scores), 1 / len(log_scores))
    weights = np.exp((log_scores - highest).round(ROUNDED))
    found: Floats = weights / math.fsum(weights.tolist())
    return found


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
    found: Floats = shares / np.array(totals)[:, None]
    return found


def batch(belief: Belief[S], steps: Sequence[int], robot: Sequence[bool] = ()) -> list[Floats]:
    """Return the posterior before and after each of several steps.

    Args:
        belief: Any belief.
        steps: Step ids.
        robot: Which of them the robot did; none by default.
    """
    by = robot or [False] * len(steps)
    states = [belief.start()]
    for step, robots in zip(steps, by, strict=True):
        states.append(belief.observe(states[-1], step, robot=robots))
    return [belief.posterior(state) for state in states]
