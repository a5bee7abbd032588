"""What could usefully be done next: which goals want each step, and how much it brings them on."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

from hrcplan.bank import PlanGraph
from hrcplan.bank.progress import OffGraph, Progress, ProgressTracker
from hrcplan.bank.walk import shortest
from hrcplan.core.arrays import Floats, Ids
from hrcplan.pddl.conventions import robots

DEAD_END = 100.0  # steps lost where a goal can no longer be reached


@dataclass(frozen=True, slots=True)
class NextSteps:
    """Which goals want which steps: pairs of a step and a goal, one for each edge that follows."""

    steps: Ids
    goals: Ids


class StepValues:
    """Looks from where all goals stand to what would help them.

    Args:
        tracker: Follows the goals.
        agents: Who is to act; by default the robots of the problem.
    """

    def __init__(self, tracker: ProgressTracker, agents: Set[str] | None = None) -> None:
        self.tracker, self.bank = tracker, tracker.bank
        self.agents = robots(self.bank.goals.problem) if agents is None else agents
        self._all_goals = np.arange(len(self.bank.names))
        self._matters = [self.bank.matters(g) | graph.relevant
                         for g, graph in enumerate(self.bank.graphs)]  # fmt: skip
        self._known: dict[tuple[int, int], float] = {}

    def wanted(self, track: Progress) -> NextSteps:
        """Return the steps that could come next in the plans of each goal, whoever does them."""
        joint = self.tracker.joint
        begins = joint.first.take(track.nodes)
        lengths = joint.first.take(track.nodes + 1) - begins
        goals = self._all_goals.repeat(lengths)
        ends = lengths.cumsum()
        places = np.arange(len(goals)) + (begins - ends + lengths).take(goals)
        steps = joint.step_of.take(places)
        for goal, place in track.off.items():
            graph, node = self.tracker.resolve(goal, place)
            more = list(graph.next(node)) if graph.n_nodes else []
            steps, goals = np.append(steps, more), np.append(goals, [goal] * len(more))
        return NextSteps(steps.astype(np.int64), goals.astype(np.int64, copy=False))

    def candidates(self, track: Progress, wanted: NextSteps) -> list[int]:
        """Return the wanted steps that one of the agents can do, in order."""
        steps = np.flatnonzero(np.bincount(wanted.steps, minlength=self.tracker.joint.n_steps))
        return list(self.bank.table.able(track.world, steps.tolist(), self.agents))

    def help(
        self, track: Progress, wanted: NextSteps, steps: Sequence[int], weights: Floats
    ) -> tuple[Floats, Floats]:
        """Return what steps bring: expected steps saved, and the weight of goals that want them.

        A step that a goal has next saves it one step, an idle one none; a step that leads a goal
        away costs it as many as its plan grows by.

        Args:
            track: Where the goals stand.
            wanted: What ``wanted`` returns for it.
            steps: Steps that can be done.
            weights: A weight for each goal, such as its probability.
        """
        n_steps = self.tracker.joint.n_steps
        weighted = np.bincount(wanted.steps, weights.take(wanted.goals), n_steps)
        shares: Floats = weighted.astype(np.float64).take(steps)
        n_goals = np.bincount(wanted.steps, minlength=n_steps).take(steps)
        saved = shares.copy()
        for place, (step, n) in enumerate(zip(steps, n_goals.tolist(), strict=True)):
            touched = self._touched(track, step)
            if len(touched) > n:
                wants = wanted.goals[wanted.steps == step]
                for goal in np.setdiff1d(touched, wants).tolist():
                    if weights[goal] > 0:
                        saved[place] += weights[goal] * self._change(track, goal, step)
        return saved, shares

    def _touched(self, track: Progress, step: int) -> Ids:
        """Return the goals that a step may move."""
        world = self.tracker.bank.table.successor(track.world, step)
        return self.tracker.joint.concerned(step, track.world ^ (world or 0))

    def _change(self, track: Progress, goal: int, step: int) -> float:
        """Return by how many steps a step that is not next in any plan brings a goal nearer."""
        world = self.tracker.bank.table.successor(track.world, step)
        if world is None or not (track.world ^ world) & self.bank.graphs[goal].relevant:
            return 0.0
        key = goal, world & self._matters[goal]
        if key not in self._known and self._still_works(goal, track, world):
            return 0.0
        return max(-DEAD_END, self.to_go(goal, track) - self._to_go_from(key, world))

    def _still_works(self, goal: int, track: Progress, world: int) -> bool:
        """Return whether a plan of a goal can be carried out in another state, too.

        Then nothing is lost, and nobody has to plan anew for a state that may never be reached.
        Nothing is won either: a step that wins something is next in a plan.
        """
        if self.bank.node(goal, world) is not None:
            return False  # where it is on its graph the number of steps is known
        state: int | None = world
        for step, _ in shortest(*self._place(goal, track)):
            state = None if state is None else self.tracker.bank.table.successor(state, step)
        return state is not None and self.bank.goals.is_reached(goal, state)

    def to_go(self, goal: int, track: Progress) -> float:
        """Return how few steps are left of a goal's plans."""
        return _left(*self._place(goal, track))

    def _place(self, goal: int, track: Progress) -> tuple[PlanGraph, int]:
        """Return the graph and the node where a goal stands."""
        joint, node = self.tracker.joint, int(track.nodes[goal])
        if node != joint.off:
            return self.bank.graphs[goal], node - int(joint.offsets[goal])
        return self.tracker.resolve(goal, track.off.get(goal) or OffGraph(track.world))

    def _to_go_from(self, key: tuple[int, int], world: int) -> float:
        """Return how few steps are left of a goal in a state, however it came about."""
        known = self._known.get(key)
        if known is None:
            graph, node = self.bank.locate(key[0], world)
            known = self._known[key] = DEAD_END if node is None else _left(graph, node)
        return known


def _left(graph: PlanGraph, node: int) -> float:
    """Return the number of steps from a node to the nearest goal node."""
    return float(graph.steps_left[node]) if graph.n_nodes else DEAD_END
