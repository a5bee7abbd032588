"""Steps that no agent has done yet: where they lead, and which of them a tree tries (IV-C2)."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set
from dataclasses import replace
from itertools import islice

import numpy as np

from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.explanation import TIES
from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.bank.progress import OffGraph, Progress
from hrcplan.core.arrays import Floats
from hrcplan.errors import UsageError

BRANCHING = 5


class ImaginedSteps:
    """Follows imagined steps, quickly: no plan graph is built for them.

    A goal that an imagined step takes off its graph has no next steps until another imagined step
    brings it back.

    Args:
        step_values: Knows the goals' next steps.
    """

    def __init__(self, step_values: StepValues) -> None:
        self.step_values, self.tracker = step_values, step_values.tracker
        self.bank = step_values.bank
        self._offsets: list[int] = self.tracker.combined_graph.offsets.tolist()
        self._relevant = [graph.relevant_facts for graph in self.bank.graphs]

    def begin(self, progress: Progress) -> Progress:
        """Return the progress to begin from: goals off their graph get one, if there is one."""
        if not progress.off or self.tracker.moves is not None:
            return progress
        off: dict[int, OffGraph] = {}
        for goal, place in progress.off.items():
            graph, node = place.graph, place.node
            if graph is None:
                graph, place_on_graph = self.bank.locate(goal, place.state, turn=place.turn)
                if place_on_graph is None:
                    continue
                node = place_on_graph
            off[goal] = OffGraph(place.state, graph, node)
        return replace(progress, off=off)

    def next_steps(self, progress: Progress) -> NextSteps:
        """Return the steps that can come next in the plans of each goal."""
        return self.step_values.next_steps(progress)

    def after(self, progress: Progress, step: int) -> Progress:
        """Return the goals' progress after an applicable step."""
        graph, before = self.tracker.combined_graph, progress.world
        world = self.bank.table.successor(before, step)
        if world is None or world == before:
            return progress
        if self.tracker.moves is not None:
            return self.tracker.after_turn(self.tracker.moves, progress, step)
        goals = graph.goals_of(step, before ^ world)
        hit, places = graph.edges(progress.nodes.take(goals), step)
        nodes = progress.nodes.copy()
        nodes[goals[hit]] = graph.targets.take(places[hit])
        if not hit.all():
            for goal in goals[~hit].tolist():
                if (before ^ world) & self._relevant[goal]:
                    node = self.bank.graphs[goal].node_of(world)
                    nodes[goal] = graph.off if node is None else self._offsets[goal] + node
        return Progress(world, nodes, progress.doable, self._off(progress, step, world))

    def _off(self, progress: Progress, step: int, world: int) -> dict[int, OffGraph]:
        """Return the progress of the goals that were off their graphs already."""
        places: dict[int, OffGraph] = {}
        for goal, place in progress.off.items():
            graph = place.graph
            if graph is None:
                continue
            node = graph.next(place.node).get(step)
            if node is None:
                node = graph.node_of(world)
            if node is not None:
                places[goal] = OffGraph(world, graph, node)
        return places


class Branching:
    """Limits the branches of a tree: by 2-grams first, then by the belief.

    Args:
        step_values: Knows the goals' next steps.
        bigrams: How often a step follows another; without them the belief decides alone.
        branching: How many steps are tried from each position (b).

    Raises:
        UsageError: if ``branching`` is less than 1.
    """

    def __init__(
        self, step_values: StepValues, bigrams: Bigrams | None = None, branching: int = BRANCHING
    ) -> None:
        if branching < 1:
            raise UsageError(f"a tree {branching} steps wide has no branches")
        self.bigrams, self.branching = bigrams, branching
        self.label = step_values.tracker.combined_graph.label
        self._able = step_values.bank.table.able
        self._steps_by_label: dict[int, list[int]] = {}
        for step, label in enumerate(self.label):
            self._steps_by_label.setdefault(label, []).append(step)

    def expand(
        self, progress: Progress, next_steps: NextSteps, last: int | None, agents: Set[str],
        belief: Callable[[], Floats], plausible: Sequence[int] = (),
    ) -> list[int]:  # fmt: skip
        """Return the steps that are tried after a step, the likeliest first.

        They come next in a plan of some goal, and one of the agents can do them. Steps whose 2-gram
        with the last step was counted come first; the next steps of the likeliest goals follow.

        Args:
            progress: The progress of the goals.
            next_steps: The next steps of the goals there.
            last: The last step.
            agents: The agents that act.
            belief: Returns the posterior of the goals; called if 2-grams are too few.
            plausible: Goals, as bits, whose plans the 2-grams count; all by default.
        """
        is_open = np.zeros(len(self.label), dtype=np.bool_)
        is_open[next_steps.steps] = True
        steps = self._frequent(progress, is_open.tolist(), last, agents, plausible)
        room = self.branching - len(steps)
        if not room:
            return steps
        more = [s for s in np.flatnonzero(is_open).tolist() if s not in steps]
        more = list(self._able(progress.world, more, agents))
        if len(more) > room:
            weights = np.bincount(
                next_steps.steps, belief().take(next_steps.goals), len(self.label)
            )
            weights = weights.round(TIES)
            more.sort(key=lambda step: -weights[step])
        return steps + more[:room]

    def _frequent(
        self, progress: Progress, is_open: Sequence[bool], last: int | None, agents: Set[str],
        plausible: Sequence[int],
    ) -> list[int]:  # fmt: skip
        """Return the open steps with a 2-gram after a step, the most frequent first."""
        if last is None or self.bigrams is None:
            return []
        labels = self.bigrams.followers(self.label[last], plausible)
        candidates = (
            step for label in labels for step in self._steps_by_label[label] if is_open[step]
        )
        return list(islice(self._able(progress.world, candidates, agents), self.branching))
