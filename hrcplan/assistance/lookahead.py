"""A small tree of what may come: a robot step, the human's response, and so on (IV-B.1, IV-C.2).

Of all that could come next, only the few likeliest steps are looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hrcplan.agents.human import humans
from hrcplan.assistance.assistant import TIES, Watched
from hrcplan.assistance.outlook import Outlook, Wanted
from hrcplan.bank.construct import empty_graph
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Belief, Floats
from hrcplan.inference.track import Off, Track

WIDTH = 5  # steps that are looked at from each place; the paper's b

Branch = tuple[int, ...]
"""Steps in turn, the robot's first."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place in the tree: where all goals stand, what they want, and the step that led there.

    ``known`` is shared by the whole tree: steps in another order lead to the same states.
    """

    track: Track
    wanted: Wanted
    last: int | None
    known: dict[int, tuple[Track, Wanted]] = field(default_factory=dict)


Likely = Callable[[Place, Floats], Sequence[int]]
"""Returns the steps wanted at a place, the likeliest first, given the probability of each goal."""


def shares(place: Place, belief: Floats) -> Floats:
    """Return for each step the probability that the human's goal has it next, up to the last."""
    wanted = place.wanted
    found: Floats = np.bincount(wanted.steps, belief.take(wanted.goals)).astype(np.float64)
    return found


def by_help(place: Place, belief: Floats) -> list[int]:
    """Return the wanted steps by the probability that the human's goal has them next."""
    steps = np.bincount(place.wanted.steps).nonzero()[0]
    helps = shares(place, belief)[steps].round(TIES)
    order: list[int] = steps[np.argsort(-helps, kind="stable")].tolist()
    return order


class Lookahead:
    """Expands the tree.

    Args:
        outlook: Looks for what the robot could do.
        width: How many steps are looked at from each place, at most.
        likely: Which of the wanted steps are likeliest.

    Raises:
        UsageError: if ``width`` is less than 1.
    """

    def __init__(self, outlook: Outlook, width: int = WIDTH, likely: Likely = by_help) -> None:
        if width < 1:
            raise UsageError(f"a tree {width} steps wide has no branches")
        self._outlook, self.width, self.likely = outlook, width, likely
        self._tracker, self._doer = outlook.tracker, outlook.bank.table.doer
        self._humans = humans(outlook.bank)

    def root(self, state: Watched[Any]) -> Place:
        """Return the place where an assistant is."""
        return Place(state.track, self._outlook.wanted(state.track), state.last)

    def after(self, place: Place, step: int) -> Place:
        """Return the place after a step that can be done.

        A goal whose plans have no such step wants nothing more on this branch: to plan for it
        anew from a place that may never be reached would take far longer than all the rest.
        """
        world = self._tracker.successor(place.track.world, step)
        key = place.track.world if world is None else world
        if key not in place.known:
            track = self._follow(place.track, step)
            place.known[key] = track, self._outlook.wanted(track)
        return Place(*place.known[key], step, place.known)

    def _follow(self, track: Track, step: int) -> Track:
        found = self._tracker.follow(track, step)
        track = track if found is None else found[0]
        if any(gone.graph is None for gone in track.off.values()):
            off = {goal: self._lost(goal, gone) for goal, gone in track.off.items()}
            track = replace(track, off=off)
        return track

    def _lost(self, goal: int, gone: Off) -> Off:
        if gone.graph is not None:
            return gone
        packing = self._outlook.bank.graphs[goal].packing
        return Off(gone.state, empty_graph(self._outlook.bank.names[goal], packing))

    def steps(self, place: Place, belief: Floats) -> list[int]:
        """Return the likeliest steps that the robot can do at a place; likeliest first."""
        return self._able(place, belief, self._outlook.agents)

    def responses(self, place: Place, belief: Floats) -> list[tuple[int, float]]:
        """Return the human's likeliest steps at a place, with probabilities that sum to one.

        A goal's plans are followed by any of their next steps alike.
        """
        steps = self._able(place, belief, self._humans)
        wanted = place.wanted
        n_next = np.bincount(wanted.goals, minlength=len(belief))
        weights = (belief / np.maximum(1, n_next)).take(wanted.goals)
        chances = np.bincount(wanted.steps, weights).take(steps) if steps else np.zeros(0)
        total = chances.sum()
        if total <= 0:  # what is believed in has nothing to do
            chances, total = np.ones(len(steps)), len(steps)
        return list(zip(steps, (chances / total).tolist(), strict=True))

    def _able(self, place: Place, belief: Floats, agents: frozenset[str] | Any) -> list[int]:
        world, found = place.track.world, list[int]()
        for step in self.likely(place, belief):
            if len(found) == self.width:
                break
            if self._doer(world, step, agents) is not None:
                found.append(step)
        return found


def futures(belief: Belief[Any], state: Any, branches: Sequence[Branch]) -> Floats:
    """Return what will be believed after each of several branches, a row for each.

    Args:
        belief: The belief. One that does not look at the order of steps can have a method
            ``extended``, which answers for all branches at once; see `Forest`.
        state: Its state at the root.
        branches: The branches.
    """
    extended = getattr(belief, "extended", None)
    if extended is not None:
        rows: Floats = extended(state.row, branches)
        return rows
    states: dict[Branch, Any] = {(): state}
    for branch in branches:
        for i, step in enumerate(branch):
            if branch[: i + 1] not in states:
                before = states[branch[:i]]
                states[branch[: i + 1]] = belief.observe(before, step, robot=i % 2 == 0)
    return np.array([belief.posterior(states[branch]) for branch in branches])


def entropy(beliefs: Floats) -> NDArray[np.float64]:
    """Return the entropy of each row, in bits.

    >>> entropy(np.array([[0.5, 0.5, 0.0], [0.0, 1.0, 0.0]])).tolist()
    [1.0, 0.0]
    """
    logs = np.log2(np.where(beliefs > 0, beliefs, 1.0))
    found: NDArray[np.float64] = 0.0 - (beliefs * logs).sum(axis=-1)
    return found
