"""What an agent of a team does next for each goal, where only its solo plans are looked at.

It does what its own plan has next, as if no other agent acted. Where it has none, it does its part
of the shortest sequence of all agents, and waits where that has no part for it now. All mistakes
are alike, and a step that is not next loses a round.
"""

from __future__ import annotations

import numpy as np

from hrcplan.bank.bank import Bank
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment, TeamChoices, TeamMoves
from hrcplan.core.arrays import Floats


class SoloMoves(TeamMoves):
    """The same as `TeamMoves` from the solo plans of each agent; any number of states will do."""

    def __init__(self, bank: Bank) -> None:
        self.take_turns(bank)
        self._by_state: dict[tuple[int, int], TeamChoices] = {}

    def knows(self, world: int) -> bool:
        """Return True: any state will do."""
        return True

    def locate(self, goal: int, world: int, turn: int) -> tuple[PlanGraph, int | None]:
        """Return a graph of a goal and the node that a state is at; see `Bank.locate`."""
        return self.bank.locate(goal, world, turn=turn)

    def can_reach(self, goal: int, world: int) -> bool:
        """Return whether a plan of any agents leads to a goal."""
        return any(
            self.bank.goals.is_reached(goal, world)
            or self.bank.graph_from(goal, world, turn=turn).n_nodes
            for turn in range(self.n_turns)
        )

    def choices(self, world: int, moment: Moment) -> TeamChoices:
        """Return what the agent whose turn it is can do."""
        key = (world, moment.turn)
        choices = self._by_state.get(key)
        if choices is None:
            self._by_state = self.not_too_many(self._by_state)
            choices = self._by_state[key] = self._solo_choices(world, moment.turn)
        return choices

    def _solo_choices(self, world: int, turn: int) -> TeamChoices:
        table, doer = self.bank.table, frozenset({self.bank.team[turn]})
        steps = np.array(list(table.able(world, table.applicable(world), doer)), dtype=np.int64)
        shape = (len(self.bank.names), len(steps) + 1)
        is_next, costs = np.zeros(shape, dtype=np.bool_), np.zeros(shape)
        for goal in range(shape[0]):
            if not self.bank.goals.is_reached(goal, world):
                is_next[goal], costs[goal] = self._for_goal(goal, world, turn, steps.tolist())
            elif self.bank.human is not None:
                is_next[goal, -1] = True  # others go on, with goals of their own
        odd = ~is_next / np.maximum(1, (~is_next).sum(axis=1, keepdims=True))
        with np.errstate(divide="ignore"):
            log_odds = np.log(odd)
        shares = is_next / np.maximum(1, is_next.sum(axis=1, keepdims=True))
        return TeamChoices(steps, is_next[:, :-1], is_next[:, -1], log_odds, shares, costs)

    def _for_goal(
        self, goal: int, world: int, turn: int, steps: list[int]
    ) -> tuple[list[bool], Floats]:
        """Return for each step, and then for waiting, whether it is next, and what it costs."""
        graph = self.bank.graph_from(goal, world, turn=turn)
        following = graph.next(0) if graph.n_nodes else {}
        is_next = [step in following for step in steps]
        is_next.append(not any(is_next))
        if not graph.n_nodes:
            return is_next, np.full(len(is_next), OUT_OF_REACH)
        rest = float(graph.steps_left[0]) * self.n_turns
        return is_next, np.where(is_next, rest, rest + self.n_turns)
