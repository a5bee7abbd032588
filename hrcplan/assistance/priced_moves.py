"""What the agents of a team do next, with its cost at the present prices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hrcplan.assistance.step_prices import StepPrices
from hrcplan.assistance.team_help import ACTION
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.solo_moves import SoloMoves
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment, TeamChoices, TeamMoves
from hrcplan.core.arrays import Floats


class PricedMoves(TeamMoves):
    """What agents do as without prices; what it costs with them.

    Where plans are solo plans, only a step's own price counts, not what is still to be paid.

    Args:
        moves: What the agents do.
        prices: The prices.
    """

    def __init__(self, moves: TeamMoves, prices: StepPrices) -> None:
        self.inner, self.extra = moves, prices.extra
        self.take_turns(moves.bank)
        self._tables: dict[int, Floats] = {}
        self._by_moment: dict[tuple[int, Moment], TeamChoices] = {}

    def price_goals(self, goals: Sequence[int]) -> None:
        """Price several goals from now on: a table of each takes a while."""
        new = [goal for goal in goals if goal not in self._tables]
        if isinstance(self.inner, SoloMoves) or not new:
            return
        self._by_moment = {}
        extra = self.extra[[op.step for op in self.bank.table.ops]] + ACTION
        for goal in new:
            self._tables[goal] = self.inner.costs.priced(goal, extra, 1.0)

    def knows(self, world: int) -> bool:
        """Return whether a state is one that the team can get to."""
        return self.inner.knows(world)

    def locate(self, goal: int, world: int, turn: int) -> tuple[PlanGraph, int | None]:
        """Return a graph of a goal and the node that a state is at; see `Bank.locate`."""
        return self.inner.locate(goal, world, turn)

    def choices(self, world: int, moment: Moment) -> TeamChoices:
        """Return what the agent whose turn it is can do, with its costs at the present prices."""
        key = world, moment
        choices = self._by_moment.get(key)
        if choices is None:
            self._by_moment = self.not_too_many(self._by_moment)
            choices = self._by_moment[key] = self._with_prices(world, moment)
        return choices

    def _with_prices(self, world: int, moment: Moment) -> TeamChoices:
        choices = self.inner.choices(world, moment)
        extra = np.append(self.extra[choices.steps], 0.0)
        costs = np.where(choices.costs >= OUT_OF_REACH, OUT_OF_REACH, choices.costs + extra)
        costs = np.where(choices.costs == 0, 0.0, costs)
        if self._tables:
            place = self.inner.costs.place(world)
            _, targets = self.inner.costs.actions(place, moment.turn)
            following, places = (moment.turn + 1) % self.n_turns, np.append(targets, place)
            own = np.append(np.full(len(targets), ACTION), 0.0) + 1 + extra
            for goal, table in self._tables.items():
                after = table[following, places] + own
                reached = table[moment.turn, place] == 0
                costs[goal] = 0.0 if reached else np.minimum(after, OUT_OF_REACH)
        return replace(choices, costs=costs)
