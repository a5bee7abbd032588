"""Looking ahead: where the goals would stand after steps that nobody has done yet."""

from __future__ import annotations

from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.bank.progress import OffGraph, Progress


class ImaginedSteps:
    """Follows imagined steps, quickly: no graph is ever made for them.

    A goal that an imagined step takes off its graph is given up until a later one brings it back.

    Args:
        outlook: Knows what goals have next.
    """

    def __init__(self, outlook: StepValues) -> None:
        self.outlook, self.tracker, self.bank = outlook, outlook.tracker, outlook.bank
        self._offsets: list[int] = self.tracker.joint.offsets.tolist()
        self._relevant = [graph.relevant for graph in self.bank.graphs]

    def begin(self, track: Progress) -> Progress:
        """Return where goals really stand, with a graph for each that has left its own."""
        if not track.off:
            return track
        off: dict[int, OffGraph] = {}
        for goal, place in track.off.items():
            graph, node = place.graph, place.node
            if graph is None:
                graph, found = self.bank.locate(goal, place.state)
                if found is None:
                    continue
                node = found
            off[goal] = OffGraph(place.state, graph, node)
        return Progress(track.world, track.nodes, track.doable, off)

    def wanted(self, track: Progress) -> NextSteps:
        """Return the steps that could come next in the plans of each goal."""
        return self.outlook.wanted(track)

    def after(self, track: Progress, step: int) -> Progress:
        """Return where goals would stand after a step that somebody can do."""
        joint, before = self.tracker.joint, track.world
        world = self.tracker.bank.table.successor(before, step)
        if world is None or world == before:
            return track
        goals = joint.concerned(step, before ^ world)
        hit, places = joint.edges(track.nodes.take(goals), step)
        nodes = track.nodes.copy()
        nodes[goals[hit]] = joint.targets.take(places[hit])
        if not hit.all():
            for goal in goals[~hit].tolist():
                if (before ^ world) & self._relevant[goal]:
                    node = self.bank.graphs[goal].node_of(world)
                    nodes[goal] = joint.off if node is None else self._offsets[goal] + node
        return Progress(world, nodes, track.doable, self._off(track, step, world))

    def _off(self, track: Progress, step: int, world: int) -> dict[int, OffGraph]:
        """Return where the goals stand that were off their graphs already."""
        found: dict[int, OffGraph] = {}
        for goal, place in track.off.items():
            graph = place.graph
            if graph is None:
                continue
            node = graph.next(place.node).get(step)
            if node is None:
                node = graph.node_of(world)
            if node is not None:
                found[goal] = OffGraph(world, graph, node)
        return found
