"""Where the plans of every goal stand after what has been done: on its graph, or off it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from hrcplan.bank import Bank, BuildLimits, PlanGraph
from hrcplan.bank.combined_graph import ApplicableSteps, combined_graph_of
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.bank.turn_moves import team_moves
from hrcplan.core.arrays import Floats, Ids
from hrcplan.errors import LimitError
from hrcplan.search.relevance import relevant

REROOT_MIB = 256  # for one graph from a state off the graph
_NOWHERE: Mapping[int, OffGraph] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class OffGraph:
    """A goal that has left its graph: where it stands on the graph from ``state`` on.

    The graph is only made when the next step asks for it; None until then. ``turn`` is whose turn
    it is, where agents take turns.
    """

    state: int
    graph: PlanGraph | None = None
    node: int = 0
    turn: int | None = None


@dataclass(frozen=True, slots=True)
class Progress:
    """The state of the world, where each goal stands, and which labels can be done, as bits.

    ``moment`` says whose turn it is, where agents take turns.
    """

    world: int
    nodes: Ids
    doable: int
    off: Mapping[int, OffGraph] = field(default_factory=lambda: _NOWHERE)
    moment: Moment | None = None


@dataclass(frozen=True, slots=True)
class Evidence:
    """What one step says.

    Attributes:
        goals: The goals that explain it: it is a next step of one of their plans.
        log_shares: For each of these the logarithm of the share of its plans that go on so.
        n_next: For every goal, how many labels could come next in its plans.
        n_doable: How many labels some agent could do.
        log_odds: For every goal the logarithm of the share of the step among the mistakes; None
            if all mistakes are alike.
    """

    goals: Ids
    log_shares: Floats
    n_next: Ids
    n_doable: int
    log_odds: Floats | None = None


class ProgressTracker:
    """Follows observed steps through the graphs of a bank.

    See docs/concepts/plan-graphs.md, "States off the graph".
    """

    def __init__(self, bank: Bank) -> None:
        self.bank = bank
        self.combined_graph = combined_graph_of(bank)
        self._doable = ApplicableSteps(self.combined_graph)
        self._relevant = [graph.relevant_facts for graph in bank.graphs]
        self._roots: dict[tuple[int, int], int] = {}
        self._matters: dict[int, int] = {}
        world = bank.initial
        self.moves = team_moves(bank)
        moment = None if self.moves is None else Moment()
        doable = self._doable.of(world)
        self.start = Progress(world, self.combined_graph.roots, doable, moment=moment)

    def follow(self, progress: Progress, step: int) -> tuple[Progress, Evidence] | None:
        """Return the progress and the evidence after a step; None if no agent can do it.

        What it says, it says about the moment before. A step that changes nothing is progress on no
        plan, so no goal explains it, also where another agent's step of the same name would be.
        """
        graph = self.combined_graph
        before, world = progress.world, self.bank.table.successor(progress.world, step)
        if world is None:
            return None
        if self.moves is not None and progress.moment is not None:
            return self._follow_turn(self.moves, progress, progress.moment, step)
        goals = graph.goals_of(step, before ^ world)
        old = progress.nodes.take(goals)
        hit, places = graph.edges(old, step)
        movers = goals[hit], places[hit]
        if graph.one_label_each:
            says = movers
        else:
            same, pairs = graph.edges_of_label(old, graph.label[step])
            says = goals[same], pairs[same]
        n_next, shares = graph.n_next.take(progress.nodes), graph.log_shares.take(says[1])
        evidence = Evidence(says[0], shares, n_next, progress.doable.bit_count())
        if progress.off:
            evidence = self._look_off(progress, step, evidence)
        if before == world:
            return progress, replace(
                evidence, goals=evidence.goals[:0], log_shares=evidence.log_shares[:0]
            )
        nodes = progress.nodes.copy()
        nodes[movers[0]] = graph.targets.take(movers[1])
        misses = [] if len(movers[0]) == len(goals) else goals[~hit].tolist()
        off = self._jumps(progress, step, world, misses, nodes)
        doable = self._doable.after(progress.doable, before, world)
        return Progress(world, nodes, doable, off), evidence

    def is_intervention(self, progress: Progress) -> bool:
        """Return whether it is the turn of a robot, or of a human with goals of its own.

        What they do is no evidence. It is False where agents do not take turns.
        """
        if self.moves is None or progress.moment is None:
            return False
        turn = progress.moment.turn
        return self.moves.is_robot[turn] or self.moves.is_other[turn]

    def at_turn(self, progress: Progress, agent: str) -> Progress:
        """Return the progress as it is if it is an agent's turn, where agents take turns."""
        moment = progress.moment
        if self.moves is None or moment is None or agent not in self.bank.team:
            return progress
        turn = self.bank.team.index(agent)
        if turn == moment.turn:
            return progress
        return self._in_turn(progress, progress.world, replace(moment, turn=turn))

    def in_world(self, progress: Progress, world: int) -> Progress:
        """Return the progress in another state, which was observed.

        A state that a team cannot get to leaves it as it is.
        """
        if world == progress.world:
            return progress
        if self.moves is not None and progress.moment is not None:
            if not self.moves.knows(world):
                return progress
            return self._in_turn(progress, world, progress.moment)
        nodes = np.array([self._find(g, world) for g in range(len(self.bank.names))])
        is_off = np.flatnonzero(nodes == self.combined_graph.off).tolist()
        off = {goal: OffGraph(world) for goal in is_off}
        doable = self._doable.after(progress.doable, progress.world, world)
        return Progress(world, nodes, doable, off or _NOWHERE)

    def attempt(self, progress: Progress, step: int) -> Progress:
        """Return the progress after a step that failed: where agents take turns, a turn is over."""
        if self.moves is None or progress.moment is None:
            return progress
        return self._in_turn(progress, progress.world, self.moves.after(progress.moment, step))

    def wait(self, progress: Progress) -> tuple[Progress, Evidence] | None:
        """Return the progress and the evidence after a wait of the agent whose turn it is.

        None if agents do not take turns: then a wait says nothing.
        """
        if self.moves is None or progress.moment is None:
            return None
        return self._follow_turn(self.moves, progress, progress.moment, None)

    def _follow_turn(
        self, moves: TeamMoves, progress: Progress, moment: Moment, step: int | None
    ) -> tuple[Progress, Evidence]:
        world = progress.world
        after = moves.after(moment, step)
        if step is not None:
            moment = moves.turn_of(moment, step)
        choices = moves.choices(world, moment)
        place = choices.place(step)
        n_next = np.maximum(1, choices.is_next.sum(axis=1)).astype(np.int64)
        is_right = choices.waits if step is None else choices.is_next[:, place]
        if place < 0:  # it changes nothing, so it is progress for no goal
            return progress, Evidence(
                np.zeros(0, np.int64), np.zeros(0), n_next, len(choices.steps)
            )
        goals = np.flatnonzero(is_right)
        evidence = Evidence(goals, -np.log(n_next[goals]), n_next, len(choices.steps) + 1,
                        choices.log_odds[:, place])  # fmt: skip
        if step is not None:
            world = self.bank.table.successor(world, step) or 0
        return self._in_turn(progress, world, after), evidence

    def after_turn(self, moves: TeamMoves, progress: Progress, step: int) -> Progress:
        """Return the progress after an applicable step, where agents take turns."""
        world = self.bank.table.successor(progress.world, step) or 0
        return self._in_turn(progress, world, moves.after(progress.moment or Moment(), step))

    def _in_turn(self, progress: Progress, world: int, moment: Moment) -> Progress:
        """Return the progress in a state, in a turn."""
        places = [self.bank.node(goal, world, moment.turn) for goal in range(len(self.bank.names))]
        graph = self.combined_graph
        nodes = np.array(
            [graph.off if node is None else int(offset) + node
             for offset, node in zip(graph.offsets[:-1], places, strict=True)], dtype=np.int64,
        )  # fmt: skip
        off = {
            g: OffGraph(world, turn=moment.turn) for g, node in enumerate(places) if node is None
        }
        doable = self._doable.after(progress.doable, progress.world, world)
        return Progress(world, nodes, doable, off or _NOWHERE, moment)

    def _look_off(self, progress: Progress, step: int, evidence: Evidence) -> Evidence:
        label, n_next = self.combined_graph.label, evidence.n_next
        more: list[tuple[int, float]] = []
        for goal, place in progress.off.items():
            graph, node = self.graph_of(goal, place)
            following = graph.next(node) if graph.n_nodes else {}
            n_next[goal] = len({label[s] for s in following})
            ways = sum(graph.plans_from(t) for s, t in following.items() if label[s] == label[step])
            if ways:
                more.append((goal, math.log(ways) - math.log(graph.plans_from(node))))
        if not more:
            return evidence
        goals = np.append(evidence.goals, [goal for goal, _ in more])
        shares = np.append(evidence.log_shares, [share for _, share in more])
        return replace(evidence, goals=goals, log_shares=shares)

    def graph_of(self, goal: int, place: OffGraph) -> tuple[PlanGraph, int]:
        """Return graph and node of a goal that has left its graph."""
        if place.graph is not None:
            return place.graph, place.node
        if goal not in self._matters:
            bank = self.bank
            self._matters[goal] = relevant(bank.table.ops, bank.goals.tests[goal])[1].facts
        state = place.state & self._matters[goal]
        try:
            limits = BuildLimits(REROOT_MIB)
            graph = self.bank.graph_from(goal, state, limits, turn=place.turn)
        except LimitError:  # nothing is known about how this goal goes on
            from hrcplan.bank.construct import empty_graph

            graph = empty_graph(self.bank.names[goal], self.bank.graphs[goal].packing)
        return graph, 0

    def _jumps(
        self, progress: Progress, step: int, world: int, goals: list[int], nodes: Ids
    ) -> Mapping[int, OffGraph]:
        """Put goals for which a step is no edge where they stand; return those off the graph."""
        if not goals and not progress.off:
            return _NOWHERE
        off = dict(progress.off)
        for goal in {*goals, *off}:
            nodes[goal] = self._jump(goal, int(nodes[goal]), step, progress, world, off)
        return off or _NOWHERE

    def _jump(
        self,
        goal: int,
        node: int,
        step: int,
        progress: Progress,
        world: int,
        off: dict[int, OffGraph],
    ) -> int:
        """Return the node of a goal after a step that is no edge; ``off`` notes it has none."""
        if node != self.combined_graph.off:
            change = (progress.world ^ world) & self._relevant[goal]
            if not change:
                return node
            root = self._roots.get((node, change))
            if root is None:
                root = self._roots[node, change] = self._find(goal, world)
            if root == self.combined_graph.off:
                off[goal] = OffGraph(world)
            return root
        node_after = self._find(goal, world)
        if node_after != self.combined_graph.off:
            off.pop(goal, None)
            return node_after
        off[goal] = self._follow_off(goal, off.get(goal) or OffGraph(progress.world), step, world)
        return node_after

    def _find(self, goal: int, world: int) -> int:
        node = self.bank.node(goal, world)
        return (
            self.combined_graph.off
            if node is None
            else int(self.combined_graph.offsets[goal]) + node
        )

    def _follow_off(self, goal: int, place: OffGraph, step: int, world: int) -> OffGraph:
        graph = place.graph
        if graph is None:
            graph, _ = self.graph_of(goal, place)
        if not graph.n_nodes:
            return OffGraph(world)
        node = graph.next(place.node).get(step)
        if node is None:
            node = graph.node_of(world)
        return OffGraph(world) if node is None else OffGraph(world, graph, node)
