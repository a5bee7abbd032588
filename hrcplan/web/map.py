"""Where places stand on a map: near to each other what few steps are between."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from hrcplan.core.arrays import Floats
from hrcplan.pddl.model import Problem

MAX_PLACES = 40  # a map of more is no longer readable
ROUNDS = 60
TINY = 1e-6


def map_of(problem: Problem, places: Sequence[str]) -> dict[str, Any] | None:
    """Return positions in a unit square and the ways between places; None if there is no map.

    Ways are facts of two places; where all places are neighbors, or none are, they stand in a ring.

    Args:
        problem: Its facts hold the ways.
        places: Where agents can be.
    """
    if not 2 <= len(places) <= MAX_PLACES:
        return None
    number = {name: i for i, name in enumerate(places)}
    ways = sorted({
        (min(a, b), max(a, b))
        for fact in problem.facts
        if len(fact) == 3 and fact[1] in number and fact[2] in number
        for a, b in [(number[fact[1]], number[fact[2]])]
        if a != b
    })  # fmt: skip
    n_all = len(places) * (len(places) - 1) // 2
    is_ring = not ways or len(ways) >= 0.8 * n_all
    positions = _ring(len(places)) if is_ring else _spread(len(places), ways)
    return {
        "places": {p: [round(float(x), 3) for x in positions[i]] for p, i in number.items()},
        "ways": [] if is_ring else [[places[a], places[b]] for a, b in ways],
    }


def _ring(n: int) -> Floats:
    angles = -math.pi / 2 + 2 * math.pi * np.arange(n) / n
    return np.stack([0.5 + 0.5 * np.cos(angles), 0.5 + 0.5 * np.sin(angles)], axis=1)


def _spread(n: int, ways: Sequence[tuple[int, int]]) -> Floats:
    """Return positions whose distances fit the numbers of steps between places.

    Classical scaling gives a beginning, from which the stress is reduced (majorization).
    """
    steps = np.full((n, n), float(n))
    np.fill_diagonal(steps, 0)
    for a, b in ways:
        steps[a, b] = steps[b, a] = 1
    for k in range(n):
        steps = np.minimum(steps, steps[:, k : k + 1] + steps[k : k + 1, :])
    center = np.eye(n) - 1 / n
    values, vectors = np.linalg.eigh(-center @ (steps**2) @ center / 2)
    positions: Floats = vectors[:, -2:] * np.sqrt(np.maximum(values[-2:], 0))
    positions *= np.where(positions[0] < 0, -1, 1)  # the sign of an axis is arbitrary
    positions = positions[:, ::-1] + 0.1 * _ring(n)  # places that coincide are parted
    for _ in range(ROUNDS):
        apart = np.linalg.norm(positions[:, None] - positions[None], axis=2)
        pull = np.divide(-steps, apart, out=np.zeros((n, n)), where=apart > TINY)
        np.fill_diagonal(pull, -pull.sum(axis=1))
        positions = pull @ positions / n
    low, span = positions.min(axis=0), np.ptp(positions, axis=0)
    flat = span < TINY
    return np.where(flat, 0.5, (positions - low) / np.where(flat, 1, span))
