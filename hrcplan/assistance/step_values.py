"""What a step is worth: which goals have it next, and how many steps it saves them."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

from hrcplan.bank import PlanGraph
from hrcplan.bank.progress import OffGraph, Progress, ProgressTracker
from hrcplan.bank.team_moves import Moment, TeamChoices
from hrcplan.bank.walk import shortest
from hrcplan.core.arrays import Floats, Ids
from hrcplan.core.deprecation import Renamed
from hrcplan.pddl.conventions import robots

DEAD_END = 100.0  # steps lost where a goal can no longer be reached


@dataclass(frozen=True, slots=True)
class NextSteps:
    """Which goals have which steps next: pairs of a step and a goal, one for each edge."""

    steps: Ids
    goals: Ids


class StepValues:
    """Values steps by how much nearer they bring the goals.

    Args:
        tracker: Follows the goals through their plan graphs.
        agents: The agents that act; by default the robots of the problem.
    """

    def __init__(self, tracker: ProgressTracker, agents: Set[str] | None = None) -> None:
        self.tracker, self.bank = tracker, tracker.bank
        self.agents = robots(self.bank.goals.problem) if agents is None else agents
        self._all_goals = np.arange(len(self.bank.names))
        self._matters = [self.bank.relevant_facts(g) | graph.relevant_facts
                         for g, graph in enumerate(self.bank.graphs)]  # fmt: skip
        self._distances: dict[tuple[int, int], float] = {}

    def next_steps(self, progress: Progress) -> NextSteps:
        """Return the steps that can come next in the plans of each goal, by any agent."""
        all_graphs, moves = self.tracker.combined_graph, self.tracker.moves
        if moves is not None:
            return NextSteps(*moves.next_steps(progress.world, progress.moment or Moment()))
        begins = all_graphs.first.take(progress.nodes)
        lengths = all_graphs.first.take(progress.nodes + 1) - begins
        goals = self._all_goals.repeat(lengths)
        ends = lengths.cumsum()
        places = np.arange(len(goals)) + (begins - ends + lengths).take(goals)
        steps = all_graphs.step_of.take(places)
        for goal, place in progress.off.items():
            graph, node = self.tracker.graph_of(goal, place)
            more = list(graph.next(node)) if graph.n_nodes else []
            steps, goals = np.append(steps, more), np.append(goals, [goal] * len(more))
        return NextSteps(steps.astype(np.int64), goals.astype(np.int64, copy=False))

    def next_robot(self, progress: Progress) -> Moment:
        """Return the moment of the next turn of a robot; the humans before it are taken to wait."""
        moves, moment = self.tracker.moves, progress.moment or Moment()
        while moves is not None and not moves.is_robot[moment.turn]:
            moment = moves.after(moment, None)
        return moment

    def in_turn(self, progress: Progress) -> TeamChoices | None:
        """Return what the next robot in turn can do; None where agents do not take turns.

        If it is not a robot's turn, the humans before it are taken to wait.
        """
        moves = self.tracker.moves
        if moves is None or not any(moves.is_robot):
            return None
        return moves.choices(progress.world, self.next_robot(progress))

    def candidates(self, progress: Progress, next_steps: NextSteps) -> list[int]:
        """Return the next steps that one of the agents can do, in order."""
        steps = np.flatnonzero(
            np.bincount(next_steps.steps, minlength=self.tracker.combined_graph.n_steps)
        )
        return list(self.bank.table.able(progress.world, steps.tolist(), self.agents))

    def expected_saving(
        self, progress: Progress, next_steps: NextSteps, steps: Sequence[int], weights: Floats
    ) -> tuple[Floats, Floats]:
        """Return two arrays: expected steps saved, and the weight of the goals that have it next.

        A step that a goal has next saves it one step, an idle one none; a step that leads a goal
        away costs it as many as its plan grows by.

        Args:
            progress: The progress of the goals.
            next_steps: The result of ``next_steps`` for it.
            steps: Applicable steps; in a team, of the robot whose turn comes next.
            weights: A weight for each goal, such as its probability.
        """
        choices = self.in_turn(progress)
        if choices is not None:
            places = [choices.place(step) for step in steps]
            return weights @ choices.savings[:, places], weights @ choices.is_next[:, places]
        n_steps = self.tracker.combined_graph.n_steps
        sums = np.bincount(next_steps.steps, weights.take(next_steps.goals), n_steps)
        shares: Floats = sums.astype(np.float64).take(steps)
        n_goals = np.bincount(next_steps.steps, minlength=n_steps).take(steps)
        savings = shares.copy()
        for place, (step, n) in enumerate(zip(steps, n_goals.tolist(), strict=True)):
            goals_of_step = self._goals_of(progress, step)
            if len(goals_of_step) > n:
                owners = next_steps.goals[next_steps.steps == step]
                for goal in np.setdiff1d(goals_of_step, owners).tolist():
                    if weights[goal] > 0:
                        savings[place] += weights[goal] * self._change(progress, goal, step)
        return savings, shares

    wanted = Renamed("next_steps")
    help = Renamed("expected_saving")
    to_go = Renamed("steps_to_go")

    def _goals_of(self, progress: Progress, step: int) -> Ids:
        """Return the goals whose progress a step may change."""
        world = self.bank.table.successor(progress.world, step)
        return self.tracker.combined_graph.goals_of(step, progress.world ^ (world or 0))

    def _change(self, progress: Progress, goal: int, step: int) -> float:
        """Return by how many steps a step that is not next in any plan brings a goal nearer."""
        world = self.bank.table.successor(progress.world, step)
        if world is None or not (progress.world ^ world) & self.bank.graphs[goal].relevant_facts:
            return 0.0
        key = goal, world & self._matters[goal]
        if key not in self._distances and self._still_works(goal, progress, world):
            return 0.0
        return max(-DEAD_END, self.steps_to_go(goal, progress) - self._to_go_from(key, world))

    def _still_works(self, goal: int, progress: Progress, world: int) -> bool:
        """Return whether a plan of a goal is also valid in another state.

        Then nothing is lost, and no graph is built for a state that may never be reached. Nothing
        is gained either: a step that gains something is next in a plan.
        """
        if self.bank.node(goal, world) is not None:
            return False  # on the graph the number of steps is exact
        state: int | None = world
        for step, _ in shortest(*self._place(goal, progress)):
            state = None if state is None else self.bank.table.successor(state, step)
        return state is not None and self.bank.goals.is_reached(goal, state)

    def steps_to_go(self, goal: int, progress: Progress) -> float:
        """Return the length of the shortest rest of a goal's plans."""
        return _distance(*self._place(goal, progress))

    def _place(self, goal: int, progress: Progress) -> tuple[PlanGraph, int]:
        """Return the graph and the node of a goal."""
        graph, node = self.tracker.combined_graph, int(progress.nodes[goal])
        if node != graph.off:
            return self.bank.graphs[goal], node - int(graph.offsets[goal])
        return self.tracker.graph_of(goal, progress.off.get(goal) or OffGraph(progress.world))

    def _to_go_from(self, key: tuple[int, int], world: int) -> float:
        """Return the length of the shortest rest of a goal's plans, from a state."""
        distance = self._distances.get(key)
        if distance is None:
            graph, node = self.bank.locate(key[0], world)
            distance = self._distances[key] = DEAD_END if node is None else _distance(graph, node)
        return distance


def _distance(graph: PlanGraph, node: int) -> float:
    """Return the number of steps from a node to the nearest goal node."""
    return float(graph.steps_left[node]) if graph.n_nodes else DEAD_END
