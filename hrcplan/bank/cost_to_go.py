"""What a team still needs to a goal, from every state that it can get to, in every turn.

It is (timesteps, actions) in one number, least of all team plans: see `hrcplan.bank.team`. One
search forward finds the states, and one search backward for each goal the numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.bank import Bank
from hrcplan.bank.reachable_states import MAX_STATES, reachable_states
from hrcplan.bank.state_tables import group_rows
from hrcplan.bank.team import ANY_AGENT, step_owners
from hrcplan.core.arrays import Floats, Ids, Words
from hrcplan.errors import UsageError
from hrcplan.pddl.conventions import people
from hrcplan.search.packed_states import FactPacking, PackedRules
from hrcplan.task.conditions import Test

TIMESTEP = 1 << 12  # actions are counted below it
NEVER = np.iinfo(np.int32).max - 2 * TIMESTEP  # the goal is out of reach

Costs = NDArray[np.int32]
AnyCosts = Costs | Floats


@dataclass(frozen=True, slots=True)
class _Backward:
    """Actions of one agent by the state they lead to: those of state ``s`` begin at ``first[s]``.

    ``sources`` are the states in which they are done, ``ops`` the ways to do the steps.
    """

    first: Ids
    sources: Ids
    ops: Ids

    def into(self, states: Ids) -> tuple[Ids, Ids, Ids]:
        """Return sources and ways of the actions into states, and the state each leads to."""
        lengths = self.first[states + 1] - self.first[states]
        begins = np.repeat(self.first[states] - (lengths.cumsum() - lengths), lengths)
        places = begins + np.arange(len(begins))
        return self.sources[places], self.ops[places], np.repeat(states, lengths)


MAX_PRICED_BYTES = 1 << 28  # of tables of prices that are remembered


@dataclass(eq=False)
class CostToGo:
    """The costs to go of all goals of a bank of team plans.

    ``of(...)`` has one row per goal. They are those of the whole team, or of a team in which the
    robots, or all humans but one, only wait.

    Raises:
        LimitError: if the team can get to more than ``max_states`` states.
    """

    bank: Bank
    max_states: int = MAX_STATES
    _places: dict[int, int] = field(default_factory=dict)
    _priced: dict[tuple[int, bytes, float], Floats] = field(default_factory=dict)
    _costs: dict[frozenset[int], tuple[Costs, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Find the states, and the actions between them."""
        table = self.bank.table
        self._packing = FactPacking(tuple(range(len(table.task.facts))))
        rules = PackedRules(table.ops, self._packing)
        self._rows = group_rows(reachable_states(table, self._packing, rules, self.max_states))[0]
        rows = self._rows
        self._keys = _keys(rows)
        owners = np.array(step_owners(table, self.bank.team), dtype=np.int64)
        steps = np.array([op.step for op in table.ops], dtype=np.int64)
        changes = [(s, ops, self._keys.searchsorted(_keys(after)))
                 for s, ops, after in rules.expand(rows)]  # fmt: skip
        sources, ops, targets = (
            np.concatenate([np.zeros(0, np.int64), *(part[i] for part in changes)])
            for i in range(3)
        )
        order = np.lexsort((steps[ops], sources))
        self._sources, self._ops, self._targets = sources[order], ops[order], targets[order]
        self._steps = steps[self._ops]
        self._owners = owners[self._steps]
        self._first = self._sources.searchsorted(np.arange(len(rows) + 1))
        self._is_goal = [rules.meets(rows, tests) for tests in self.bank.goals.tests]

    def with_goals_of(self, bank: Bank) -> CostToGo:
        """Return the costs of a bank of the same task that has further goals after its own."""
        other, n_goals = copy(self), len(self._is_goal)
        rules = PackedRules(bank.table.ops, self._packing)
        other.bank, other._costs, other._priced = bank, {}, dict(self._priced)
        new = [rules.meets(self._rows, tests) for tests in bank.goals.tests[n_goals:]]
        other._is_goal = [*self._is_goal, *new]
        for acting, costs in self._costs.items():
            other._costs[acting] = (*costs, other._costs_from(n_goals, acting))
        return other

    @property
    def n_actions(self) -> int:
        """How many actions there are between the states: what is looked at for each goal."""
        return len(self._ops)

    def can_hold(self, tests: tuple[Test, ...]) -> bool:
        """Return whether the team can get to a state that meets one of several tests."""
        rules = PackedRules(self.bank.table.ops, self._packing)
        return bool(rules.meets(self._rows, tests).any())

    def _costs_from(self, first: int, acting: frozenset[int]) -> Costs:
        """Return the costs to go to the goals from one on."""
        ways = np.full(len(self.bank.table.ops), TIMESTEP + 1, dtype=np.int32)
        shape = len(self._is_goal) - first, len(self.bank.team), len(self._keys)
        costs = np.full(shape, NEVER, dtype=np.int32)
        for goal, table in enumerate(costs, first):
            self._lower(table, goal, acting, ways, TIMESTEP)
        return costs

    def place(self, state: int) -> int:
        """Return the index of a state of the task.

        Raises:
            UsageError: if the team cannot get to it.
        """
        place = self._places.get(state)
        if place is None:
            key = _keys(self._packing.row(state).reshape(1, -1))
            place = int(self._keys.searchsorted(key)[0])
            if place == len(self._keys) or self._keys[place] != key[0]:
                raise UsageError("the agents cannot get to this state")
            self._places[state] = place
        return place

    def actions(self, place: int, turn: int) -> tuple[Ids, Ids]:
        """Return the steps that an agent can do in its turn, and the states they lead to."""
        part = slice(self._first[place], self._first[place + 1])
        mine = (self._owners[part] == turn) | (self._owners[part] == ANY_AGENT)
        return self._steps[part][mine], self._targets[part][mine]

    def actions_of(self, places: Ids, turn: int) -> tuple[Ids, Ids, Ids]:
        """Return the actions of an agent in states: which of them, the steps, where they lead."""
        lengths = self._first[places + 1] - self._first[places]
        begins = np.repeat(self._first[places] - (lengths.cumsum() - lengths), lengths)
        edges, which = begins + np.arange(len(begins)), np.arange(len(places)).repeat(lengths)
        mine = (self._owners[edges] == turn) | (self._owners[edges] == ANY_AGENT)
        edges = edges[mine]
        return which[mine], self._steps[edges], self._targets[edges]

    def facts(self, places: Ids) -> NDArray[np.uint8]:
        """Return which facts hold in states, one row each."""
        keys = np.ascontiguousarray(self._keys[places])
        rows = keys.view(">u8").reshape(len(places), -1).astype("<u8")
        bits = np.unpackbits(rows.view(np.uint8), axis=1, bitorder="little")
        return bits[:, : len(self._packing.positions)]

    def prices(self, place: int, turn: int, prices: Floats) -> Floats:
        """Return what the actions of an agent in its turn cost, by the price of each way."""
        part = slice(self._first[place], self._first[place + 1])
        mine = (self._owners[part] == turn) | (self._owners[part] == ANY_AGENT)
        own: Floats = prices[self._ops[part][mine]]
        return own

    def of(
        self, places: Ids | int, turn: int, *, with_robots: bool = True, human: str | None = None
    ) -> Costs:
        """Return the cost to go: one row per goal, one column per place; `NEVER` if there is none.

        Args:
            places: Indices of states.
            turn: Whose turn it is, as an index of the team's agents.
            with_robots: Whether the robots act; if not, they wait in all their turns.
            human: The only human who acts; by default all do.
        """
        acting = self._acting(with_robots, human)
        costs = self._costs.get(acting)
        if costs is None:
            costs = self._costs[acting] = (self._costs_from(0, acting),)
        parts = [part[:, turn, places] for part in costs]  # large tables are never copied
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def _acting(self, with_robots: bool, human: str | None) -> frozenset[int]:
        """Return the agents that do not only wait, as indices of the team."""
        humans = people(self.bank.goals.problem)
        is_acting = {a: (a == human or human is None) if a in humans else with_robots
                     for a in self.bank.team}  # fmt: skip
        return frozenset(i for i, agent in enumerate(self.bank.team) if is_acting[agent])

    def is_goal(self, goal: int, place: int) -> bool:
        """Return whether a goal holds in a state, given by its index."""
        return bool(self._is_goal[goal][place])

    def priced(self, goal: int, prices: Floats, timestep: float) -> Floats:
        """Return the least price to a goal, by turn and state; infinite if it is out of reach.

        Args:
            goal: The goal.
            prices: The price of each way to do a step, in the order of the table.
            timestep: The price of every timestep, also of a wait; positive.
        """
        key = goal, prices.tobytes(), timestep
        table = self._priced.pop(key, None)
        if table is None:
            table = np.full((len(self.bank.team), len(self._keys)), np.inf)
            everybody = frozenset(range(len(table)))
            self._lower(table, goal, everybody, prices + timestep, timestep)
        self._priced[key] = table
        while len(self._priced) > max(1, MAX_PRICED_BYTES // table.nbytes):
            self._priced.pop(next(iter(self._priced)))
        return table

    def _mine(self, turn: int) -> Ids:
        """Return which actions an agent can do in its turn."""
        return np.flatnonzero((self._owners == turn) | (self._owners == ANY_AGENT))

    @cached_property
    def _into(self) -> list[_Backward]:
        """The actions of each agent, by the state they lead to."""
        return list(self._actions_into())

    def _actions_into(self) -> Iterator[_Backward]:
        for turn in range(len(self.bank.team)):
            mine = self._mine(turn)
            order = mine[np.argsort(self._targets[mine], kind="stable")]
            first = self._targets[order].searchsorted(np.arange(len(self._keys) + 1))
            yield _Backward(first, self._sources[order], self._ops[order])

    def _lower(
        self, costs: AnyCosts, goal: int, acting: frozenset[int], ways: AnyCosts, wait: float
    ) -> None:
        """Lower the costs to one goal, by turn and state, until no action lowers one further.

        Args:
            costs: What no cost is above; changed in place.
            goal: The goal.
            acting: The agents that do not only wait.
            ways: What each way to do a step costs.
            wait: What a wait costs.
        """
        costs[:, self._is_goal[goal]] = 0
        is_new = np.tile(self._is_goal[goal], (len(costs), 1))
        while is_new.any():
            for turn in reversed(range(len(costs))):
                following = (turn + 1) % len(costs)
                states, after = np.flatnonzero(is_new[following]), costs[following]
                is_new[following] = False
                sources, sums = states, after[states] + wait
                if turn in acting:
                    before, ops, targets = self._into[turn].into(states)
                    sources = np.concatenate([sources, before])
                    sums = np.concatenate([sums, after[targets] + ways[ops]])
                is_less = sums < costs[turn][sources]
                sources, sums = sources[is_less], sums[is_less].astype(costs.dtype)
                np.minimum.at(costs[turn], sources, sums)
                is_new[turn, sources] = True


def _keys(rows: Words) -> NDArray[np.bytes_]:
    """Return rows as byte strings that sort as `group_rows` sorts the rows."""
    wide = np.ascontiguousarray(rows.astype(">u8"))
    return wide.view(f"S{8 * rows.shape[1]}").ravel()


_SHARED: WeakValueDictionary[tuple[int, int], CostToGo] = WeakValueDictionary()


def cost_to_go_of(bank: Bank, like: Bank | None = None) -> CostToGo:
    """Return the costs to go of a bank of team plans; all who ask for one bank share them.

    Args:
        bank: The bank.
        like: A bank of the same task, whose goals are the first ones of this bank.

    Raises:
        LimitError: if the team can get to too many states.
    """
    key = id(bank.table), id(bank.graphs)  # the same for all humans of a bank
    costs = _SHARED.get(key)
    if costs is None:
        costs = CostToGo(bank) if like is None else cost_to_go_of(like).with_goals_of(bank)
        _SHARED[key] = costs
    return costs
