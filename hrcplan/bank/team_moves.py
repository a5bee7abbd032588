"""What an agent of a team does next for each goal, in its turn, and how odd anything else would be.

A human does a step that loses the team nothing. If only waiting loses nothing, it waits; but if no
robot has acted since its last turn, it counts on the robots no longer, and does the best step
towards the goal without them. A human with a goal of its own does not count on the other humans:
for its goal they only wait.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from hrcplan.bank.bank import Bank
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP, Costs, cost_to_go_of
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.team import ANY_AGENT, step_owners
from hrcplan.bank.team_graphs import TeamGraphs
from hrcplan.core.arrays import Bools, Floats, Ids
from hrcplan.errors import UsageError
from hrcplan.pddl.conventions import robots

K = TypeVar("K")

DECAY = 0.5  # a step that loses one timestep more is less likely as a mistake by exp(-DECAY)
LOST = 1e-6  # the weight of a mistake that loses the goal
OUT_OF_REACH = 1000.0  # timesteps that count for a goal that is lost
MAX_KNOWN = 50_000  # choices that are remembered


@dataclass(frozen=True, slots=True)
class Moment:
    """Whose turn it is, and for how many turns no robot, and no human, has acted."""

    turn: int = 0
    without_robot: int = 0
    without_human: int = 0


@dataclass(frozen=True, slots=True)
class TeamChoices:
    """What an agent can do in its turn.

    Attributes:
        steps: The steps, in order.
        is_next: For each goal and step, whether the agent does it for the goal.
        waits: For each goal, whether the agent waits for it.
        log_odds: For each goal and step, and then for waiting, the log of its share among the
            mistakes.
        shares: For each goal and step, and then for waiting, how likely the agent does it if it
            makes no mistake; all 0 once the goal is reached.
        costs: For each goal and step, and then for waiting, the timesteps to the goal with this
            one, and a little for each action; `OUT_OF_REACH` if it is lost, 0 if it is reached.
    """

    steps: Ids
    is_next: Bools
    waits: Bools
    log_odds: Floats
    shares: Floats
    costs: Floats

    def next_steps(self, goal: int) -> list[int]:
        """Return the steps that the agent does for a goal, in order."""
        next_steps: list[int] = self.steps[self.is_next[goal]].tolist()
        return next_steps

    @property
    def savings(self) -> Floats:
        """For each goal and step, the timesteps that it saves compared with waiting."""
        timesteps = np.floor(self.costs)
        return timesteps[:, -1:] - timesteps[:, :-1]

    @property
    def options(self) -> tuple[int | None, ...]:
        """The steps and then waiting, in the order of the columns."""
        return (*self.steps.tolist(), None)

    def place(self, step: int | None) -> int:
        """Return the column of a step, or of waiting; -1 if the agent cannot do the step."""
        if step is None:
            return len(self.steps)
        return next(iter(np.flatnonzero(self.steps == step).tolist()), -1)


class TeamMoves:
    """Knows for every state and turn what the agents of a team do for each goal.

    Args:
        bank: A bank of team plans.

    Raises:
        LimitError: if the team can get to too many states.
    """

    def __init__(self, bank: Bank) -> None:
        self.costs = cost_to_go_of(bank)
        self._graphs = TeamGraphs(bank, self.costs)
        self._choices_by_key: dict[tuple[int, int, bool], TeamChoices] = {}
        self.take_turns(bank)

    def take_turns(self, bank: Bank) -> None:
        """Take in who the agents of a bank are, and the order of their turns."""
        self.bank = bank
        self.n_turns = len(bank.team)
        controllable = robots(bank.goals.problem)
        self.is_robot = [agent in controllable for agent in bank.team]
        self.has_humans = not all(self.is_robot)
        others = {*bank.humans} - {bank.human} if bank.human is not None else set()
        self.is_other = [agent in others for agent in bank.team]
        self._owners = step_owners(bank.table, bank.team)

    def after(self, moment: Moment, step: int | None) -> Moment:
        """Return the moment after a step, or after a wait of the agent whose turn it is.

        If the step is another agent's, those between have waited.
        """
        n_waits = 0 if step is None else self._n_waits(moment, step)
        turn = (moment.turn + n_waits) % self.n_turns
        acts, n_turns = step is not None, n_waits + 1
        return Moment(
            (turn + 1) % self.n_turns,
            0 if acts and self.is_robot[turn] else moment.without_robot + n_turns,
            0 if acts and not self.is_robot[turn] else moment.without_human + n_turns,
        )

    def _n_waits(self, moment: Moment, step: int) -> int:
        owner = self._owners[step]
        return 0 if owner == ANY_AGENT else (owner - moment.turn) % self.n_turns

    def state_after(self, world: int, step: int | None) -> int:
        """Return the state after a step that can be done, or after a wait."""
        return world if step is None else self.bank.table.successor(world, step) or 0

    def turn_of(self, moment: Moment, step: int) -> Moment:
        """Return the moment at which a step is done, once the agents before its agent waited."""
        for _ in range(self._n_waits(moment, step)):
            moment = self.after(moment, None)
        return moment

    def knows(self, world: int) -> bool:
        """Return whether a state is one that the team can get to."""
        try:
            self.costs.place(world)
        except UsageError:
            return False
        return True

    def locate(self, goal: int, world: int, turn: int) -> tuple[PlanGraph, int | None]:
        """Return a graph of a goal and the node that a state is at; see `Bank.locate`."""
        return self._graphs.locate(goal, world, turn)

    def can_reach(self, goal: int, world: int) -> bool:
        """Return whether the team can still reach a goal."""
        costs = self.costs.of(self.costs.place(world), 0, human=self.bank.human)
        return bool(costs[goal] < NEVER)

    def next_steps(self, world: int, moment: Moment) -> tuple[Ids, Ids]:
        """Return which steps come next for which goals: two arrays, one pair for each.

        They are those of the agent whose turn it is, and of others if the goal lets all between
        wait. A human with other goals has none.
        """
        pairs: list[tuple[Ids, Ids]] = []
        can_wait = np.ones(len(self.bank.names), dtype=np.bool_)
        for _ in range(self.n_turns):
            choices = self.choices(world, moment)
            goals, places = np.nonzero(choices.is_next & can_wait[:, None])
            pairs.append((choices.steps[places], goals))
            if not self.is_other[moment.turn]:
                can_wait &= choices.costs[:, -1] <= choices.costs.min(axis=1)
            moment = self.after(moment, None)
        steps, goals = (np.concatenate([pair[i] for pair in pairs]) for i in range(2))
        return steps, goals

    def choices(self, world: int, moment: Moment) -> TeamChoices:
        """Return what the agent whose turn it is can do."""
        alone = moment.without_robot >= self.n_turns and not self.is_robot[moment.turn]
        key = (self.costs.place(world), moment.turn, alone)
        choices = self._choices_by_key.get(key)
        if choices is None:
            self._choices_by_key = self.not_too_many(self._choices_by_key)
            choices = self._choices_by_key[key] = self._choices(*key)
        return choices

    @staticmethod
    def not_too_many(choices: dict[K, TeamChoices]) -> dict[K, TeamChoices]:
        """Return the choices that are remembered; none if they are too many."""
        return {} if len(choices) >= MAX_KNOWN else choices

    def _choices(self, place: int, turn: int, alone: bool) -> TeamChoices:
        human, steps, targets = self.bank.human, *self.costs.actions(place, turn)
        following = (turn + 1) % self.n_turns
        now = self.costs.of(np.array([place]), turn, human=human)
        wait = self.costs.of(np.array([place]), following, human=human) + TIMESTEP
        after = self.costs.of(targets, following, human=human) + TIMESTEP + 1
        is_next = (after == now) & (now < NEVER) & (not self.is_other[turn])
        if alone and len(steps) and not self.is_other[turn]:
            own = self.costs.of(targets, following, with_robots=False, human=human)
            best = own.min(axis=1, keepdims=True)
            is_stuck = ~is_next.any(axis=1, keepdims=True) & (best < NEVER) & (now > 0)
            is_next |= is_stuck & (own == best)
        # Who has reached its goal is not waiting; but others may go on, with goals of their own.
        waits = ~is_next.any(axis=1) & ((now[:, 0] > 0) | (human is not None))
        odd = _weights(np.concatenate([after, wait], axis=1), now)
        odd[np.concatenate([is_next, waits[:, None]], axis=1)] = 0
        totals = np.maximum(odd.sum(axis=1, keepdims=True), LOST)
        with np.errstate(divide="ignore"):
            log_odds = np.log(odd / totals)
        right = np.concatenate([is_next, waits[:, None]], axis=1).astype(np.float64)
        shares = right / np.maximum(1, right.sum(axis=1, keepdims=True))
        costs = _timesteps(np.concatenate([after, wait], axis=1), now)
        return TeamChoices(steps, is_next, waits, log_odds, shares, costs)


def _weights(costs: Costs, now: Costs) -> Floats:
    """Return how likely mistakes are, from what they cost; the scale does not matter."""
    loss = np.maximum(0, costs // TIMESTEP - now // TIMESTEP)  # other humans may save some
    return np.where(costs < NEVER, np.maximum(np.exp(-DECAY * loss), LOST), LOST)


def _timesteps(costs: Costs, now: Costs) -> Floats:
    """Return costs to go in timesteps; actions count a little, and a lost goal for many."""
    timesteps: Floats = np.where(costs < NEVER, costs / TIMESTEP, OUT_OF_REACH)
    return np.where(now == 0, 0.0, timesteps)
