"""What a robot's steps are worth at the present prices, and what is still to be paid.

One class for plans in which any agent can do a step, one for teams that take turns. With all prices
1 they are the values of `ExpectedHelp`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from hrcplan.assistance.bounded_roots import unrooted
from hrcplan.assistance.explanation import StepChoice
from hrcplan.assistance.priced_moves import PricedMoves
from hrcplan.assistance.step_prices import StepPrices
from hrcplan.assistance.step_values import NextSteps, StepValues
from hrcplan.assistance.team_help import TeamHelp
from hrcplan.assistance.turn_costs import costs_to_go
from hrcplan.bank import PlanGraph
from hrcplan.bank.progress import OffGraph, Progress
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment, TeamMoves
from hrcplan.core.arrays import Floats

NEGLIGIBLE = 1e-3  # the probability of a goal whose costs are not priced
MOST_ASKED = 4  # the likeliest goals, which a question names
MOST_TEAM, MOST_STEPS = 3, 12  # the likeliest goals whose costs are priced: a table takes a while


class PricedHelp(Protocol):
    """Values steps by what they save the team, for weights of the goals that sum to 1.

    ``options`` and ``to_go`` price the goals that are likeliest by their weights, once for all; the
    others take them at the prices that there are, so that what they compare is priced alike.
    """

    def options(self, progress: Progress, weights: Floats) -> StepChoice:
        """Return the steps that a robot could do now, and what each is expected to save."""

    def least_cost(self, progress: Progress, weights: Floats) -> float:
        """Return what the best step or wait is expected to cost, up to a constant of ``progress``.

        The constant is the same for all weights, in the mean over them.
        """

    def least_costs(self, progress: Progress, weights: Floats) -> Floats:
        """Return ``least_cost`` for each goal if it were certain."""

    def to_go(self, progress: Progress, weights: Floats) -> float:
        """Return what is expected to be paid until the goal is reached, from here on."""

    def n_helped(self, progress: Progress, step: int, weights: Floats) -> int:
        """Return how many goals that are not out of the question have a step next."""

    def surely_nearer(self, choice: StepChoice, progress: Progress, weights: Floats) -> StepChoice:
        """Return a choice without steps that pay only because people will show what they want.

        Those could be done and undone for ever while people stand still.
        """


def priced_help(
    values: StepValues, moves: TeamMoves | None, prices: StepPrices, waste_price: float
) -> PricedHelp:
    """Return what values the steps of a robot at the present prices.

    Args:
        values: What steps are worth in steps.
        moves: What the agents of a team do in their turns; None where any agent can do any step.
        prices: The prices.
        waste_price: What a step that is not needed costs; a team has no such price.
    """
    if moves is not None:
        return PricedTeam(values, moves, prices)
    return PricedSteps(values, prices, waste_price)


class PricedSteps:
    """The help of steps that any agent can do.

    Args:
        values: What steps are worth in steps.
        prices: The prices.
        waste_price: What a step that is not needed costs.
    """

    def __init__(self, values: StepValues, prices: StepPrices, waste_price: float) -> None:
        self.values, self.prices, self.waste_price = values, prices, waste_price
        self.graph = values.tracker.combined_graph
        self._costs = np.zeros(self.graph.off + 1)
        self._is_priced = np.zeros(len(values.bank.names), dtype=np.bool_)
        self._off_costs: dict[int, tuple[PlanGraph, Floats]] = {}
        self._last: tuple[Progress, bytes, StepChoice] | None = None

    def options(self, progress: Progress, weights: Floats) -> StepChoice:
        """Return the steps that some goal has next, and what each is expected to save."""
        if (
            self._last is None
            or self._last[0] is not progress
            or self._last[1] != weights.tobytes()
        ):
            self._last = progress, weights.tobytes(), self._options(progress, weights)
        return self._last[2]

    def _options(self, progress: Progress, weights: Floats) -> StepChoice:
        missing = unrooted(progress)
        if missing:
            weights = weights.copy()
            weights[missing] = 0.0  # nothing is known of what they need
        next_steps = self.values.next_steps(progress)
        steps = self.values.candidates(progress, next_steps)
        savings, needs = self.values.expected_saving(progress, next_steps, steps, weights)
        if self.prices.changes and steps:
            self._price_goals(_likeliest(weights, MOST_STEPS))
            savings = savings + self._more(progress, next_steps, weights).take(steps)
        worth = savings - self.waste_price * (1 - needs)
        return StepChoice(tuple(steps), tuple(worth.tolist()))

    def _more(self, progress: Progress, next_steps: NextSteps, weights: Floats) -> Floats:
        """Return how much more than one step each step is expected to save."""
        more = self._more_by_pair(progress, next_steps)
        by_goal = more * weights.take(next_steps.goals)
        sums = np.bincount(next_steps.steps, by_goal, len(self.prices.robot))
        return sums.astype(np.float64)

    def _more_by_pair(self, progress: Progress, next_steps: NextSteps) -> Floats:
        """Return how much more than one step each next step saves the goal that it belongs to."""
        goals, steps = next_steps.goals, next_steps.steps
        nodes = progress.nodes.take(goals)
        hit, places = self.graph.edges(nodes, steps)  # type: ignore[arg-type]  # one step for each
        targets = np.where(hit, self.graph.targets.take(places, mode="clip"), self.graph.off)
        more = self._costs[nodes] - self._costs[targets] - self.prices.robot[steps]
        more = np.where(hit & self._is_priced[goals], more, 0.0)
        for goal, place in progress.off.items():
            if self._is_priced[goal]:
                graph, node = self.values.tracker.graph_of(goal, place)
                following = graph.next(node) if graph.n_nodes else {}
                costs = self._costs_off(graph)
                for i in np.flatnonzero(goals == goal).tolist():
                    after = costs[following[int(steps[i])]]
                    more[i] = costs[node] - after - self.prices.robot[steps[i]]
        return more

    def _price_goals(self, goals: Sequence[int]) -> None:
        for goal in goals:
            if not self._is_priced[goal]:
                first, graph = int(self.graph.offsets[goal]), self.values.bank.graphs[goal]
                costs = costs_to_go(graph, self.prices)
                self._costs[first : first + graph.n_nodes] = costs
                self._is_priced[goal] = True

    def _costs_off(self, graph: PlanGraph) -> Floats:
        costs = self._off_costs.get(id(graph))
        if costs is None:  # the graph is held, so that no other one gets its id
            costs = self._off_costs[id(graph)] = graph, costs_to_go(graph, self.prices)
        return costs[1]

    def least_cost(self, progress: Progress, weights: Floats) -> float:
        """Return what the best step costs compared with waiting."""
        return -max(0.0, 0.0, *self.options(progress, weights).values)

    def least_costs(self, progress: Progress, weights: Floats) -> Floats:
        """Return for each goal what the best step costs if it is certain, compared with waiting."""
        next_steps = self.values.next_steps(progress)
        steps = self.values.candidates(progress, next_steps)
        worth = np.where(np.isin(next_steps.steps, steps), 1.0, 0.0)
        if self.prices.changes:
            worth *= 1 + self._more_by_pair(progress, next_steps)
        costs = np.zeros(len(self.values.bank.names))
        np.minimum.at(costs, next_steps.goals, -worth)
        return costs

    def to_go(self, progress: Progress, weights: Floats) -> float:
        """Return what is expected to be paid until the goal is reached, after a wait."""
        total = 0.0
        goals = _likeliest(weights, MOST_STEPS)
        self._price_goals(goals)
        for goal in goals:
            if int(progress.nodes[goal]) != self.graph.off:
                total += weights[goal] * self._costs[progress.nodes[goal]]
                continue
            place = progress.off.get(goal) or OffGraph(progress.world)
            graph, node = self.values.tracker.graph_of(goal, place)
            cost = self._costs_off(graph)[node] if graph.n_nodes else OUT_OF_REACH
            total += weights[goal] * float(cost)
        return float(total)

    def n_helped(self, progress: Progress, step: int, weights: Floats) -> int:
        """Return how many goals that are not out of the question have a step next."""
        next_steps = self.values.next_steps(progress)
        goals = np.unique(next_steps.goals[next_steps.steps == step])
        return int((weights[goals] > NEGLIGIBLE).sum())

    def surely_nearer(self, choice: StepChoice, progress: Progress, weights: Floats) -> StepChoice:
        """Return the choice: its values do not look ahead."""
        return choice


class PricedTeam:
    """The help of a robot in a team that takes turns.

    Args:
        values: Knows whose turn it is.
        moves: What the agents do for each goal.
        prices: The prices.
    """

    def __init__(self, values: StepValues, moves: TeamMoves, prices: StepPrices) -> None:
        self.values, self.prices = values, prices
        self._priced = PricedMoves(moves, prices) if prices.changes else None
        self.moves = moves if self._priced is None else self._priced
        self.help = _RemembersCosts(self.moves, prices.extra)

    def options(self, progress: Progress, weights: Floats) -> StepChoice:
        """Return how much time each step of the next robot is expected to save."""
        self._price_goals(weights)
        return self.help.options(progress.world, self.values.next_robot(progress), weights)

    def _price_goals(self, weights: Floats) -> None:
        if self._priced is not None:
            self._priced.price_goals(_likeliest(weights, MOST_TEAM))

    def least_cost(self, progress: Progress, weights: Floats) -> float:
        """Return what the best step or wait is expected to cost."""
        costs = self.help.costs(progress.world, self.values.next_robot(progress), weights)
        return float(costs.min())

    def least_costs(self, progress: Progress, weights: Floats) -> Floats:
        """Return what the best step or wait costs for each goal if that is certain."""
        moment = self.values.next_robot(progress)
        costs: Floats = self.moves.choices(progress.world, moment).costs.min(axis=1)
        if self._priced is not None:  # people do not choose by price, so they may do worse
            for goal in _likeliest(weights, MOST_ASKED):
                certain = np.zeros(len(weights))
                certain[goal] = 1.0
                costs[goal] = self.help.costs(progress.world, moment, certain).min()
        return costs

    def to_go(self, progress: Progress, weights: Floats) -> float:
        """Return what is expected to be paid until the goal is reached, after a wait."""
        self._price_goals(weights)
        moment = self.moves.after(self.values.next_robot(progress), None)
        costs = self.moves.choices(progress.world, moment).costs.min(axis=1)
        return float(weights @ costs)

    def n_helped(self, progress: Progress, step: int, weights: Floats) -> int:
        """Return how many goals that are not out of the question have a step next."""
        choices = self.moves.choices(progress.world, self.values.next_robot(progress))
        is_next = choices.is_next[:, choices.place(step)]
        return int((is_next & (weights > NEGLIGIBLE)).sum())

    def surely_nearer(self, choice: StepChoice, progress: Progress, weights: Floats) -> StepChoice:
        """Return the steps that lower the expected cost of a team that knows the goal."""
        choices = self.moves.choices(progress.world, self.values.next_robot(progress))
        costs = weights @ choices.costs
        pairs = [
            (step, value) for step, value in zip(choice.steps, choice.values, strict=True)
            if costs[choices.place(step)] < costs[-1]
        ]  # fmt: skip
        return StepChoice(tuple(s for s, _ in pairs), tuple(v for _, v in pairs), choice.wait)


class _RemembersCosts(TeamHelp):
    """The same, which does not look ahead twice for one decision."""

    _last: tuple[int, Moment, bytes] | None = None
    _last_costs: Floats

    def costs(self, world: int, moment: Moment, weights: Floats) -> Floats:
        """Return the expected cost of each step that a robot can do, and then of waiting."""
        key = world, moment, weights.tobytes()
        if key != self._last:
            self._last_costs, self._last = super().costs(world, moment, weights), key
        return self._last_costs


def _likeliest(weights: Floats, most: int) -> list[int]:
    """Return the likeliest goals, at most so many, without those that are out of the question."""
    order = np.argsort(-weights, kind="stable")[:most]
    return [int(goal) for goal in order if weights[goal] > NEGLIGIBLE]
