"""A belief whose steps take a bounded time, also where all goals leave their graphs at once.

A graph from a state off the graph takes milliseconds. After each step only those of the likeliest
goals are made; of the others nothing is known until they are among the likeliest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hrcplan.bank import Bank, PlanGraph
from hrcplan.bank.construct import empty_graph
from hrcplan.bank.progress import Evidence, OffGraph, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.adaptive import AdaptiveBelief
from hrcplan.inference.filter_belief import FilterBeliefState
from hrcplan.inference.paired_filters import PairedState

MAX_ROOTS = 8  # graphs that are made after one step


class BoundedTracker(ProgressTracker):
    """Follows goals off their graphs only where `rooted` has made a graph for them."""

    def graph_of(self, goal: int, place: OffGraph) -> tuple[PlanGraph, int]:
        """Return graph and node of a goal that has left its graph; an empty one if none is made."""
        if place.graph is not None:
            return place.graph, place.node
        return empty_graph(self.bank.names[goal], self.bank.graphs[goal].packing), 0

    def rooted(self, progress: Progress, goals: Sequence[int]) -> Progress:
        """Return the progress with graphs for the first of several goals that have none."""
        missing = [goal for goal in goals if goal in unrooted(progress)]
        if self.moves is not None or not missing:
            return progress
        off = dict(progress.off)
        for goal in missing[:MAX_ROOTS]:
            graph, node = super().graph_of(goal, off[goal])
            off[goal] = OffGraph(off[goal].state, graph, node)
        return replace(progress, off=off)


def unrooted(progress: Progress) -> list[int]:
    """Return the goals that have left their graph and have no other one yet."""
    if progress.moment is not None:
        return []
    return [goal for goal, place in progress.off.items() if place.graph is None]


class BoundedBelief(AdaptiveBelief):
    """The adaptive filter with a bounded number of new graphs per step.

    To goals without a graph a step says what it says to the others on average.
    """

    tracker: BoundedTracker

    def __init__(self, bank: Bank) -> None:
        super().__init__(bank)
        self.tracker = BoundedTracker(bank)

    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood of a step by kind of human and goal."""
        likelihood = super().likelihood(progress, step, evidence)
        missing = unrooted(progress)
        if missing and len(missing) < likelihood.shape[1]:
            others = np.delete(likelihood, missing, axis=1)
            likelihood[:, missing] = others.mean(axis=1, keepdims=True)
        return likelihood

    def _after(
        self, state: FilterBeliefState[PairedState], step: int | None, robot: bool,
        progress: Progress, evidence: Evidence,
    ) -> FilterBeliefState[PairedState]:  # fmt: skip
        return self._with_roots(super()._after(state, step, robot, progress, evidence))

    def observe_state(
        self, state: FilterBeliefState[PairedState], world: int
    ) -> FilterBeliefState[PairedState]:
        """Return the belief in another state of the task, given as bits."""
        return self._with_roots(super().observe_state(state, world))

    def _with_roots(self, state: FilterBeliefState[PairedState]) -> FilterBeliefState[PairedState]:
        if not state.progress.off:
            return state
        order = np.argsort(-self.posterior(state), kind="stable").tolist()
        return replace(state, progress=self.tracker.rooted(state.progress, order))
