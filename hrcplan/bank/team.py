"""Team plan graphs: all plans of agents that take turns, as few timesteps as possible.

In every timestep the agent whose turn it is does a ground action or waits. A plan is optimal if it
takes fewest timesteps and, among these, fewest actions. Whose turn it is becomes a fact of its own,
so that the general search finds these plans. Afterwards waits are left out of the graph: from a
node and the next action it follows who has waited, because no optimal plan waits a whole round.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from hrcplan.bank.construct import (
    NO_LIMITS,
    assemble,
    by_source,
    empty_graph,
    merge_equivalent_nodes,
)
from hrcplan.bank.graph import PlanGraph, Team
from hrcplan.bank.search import BuildLimits, Explorer, StateSpaceLayers
from hrcplan.core.arrays import Ids, SmallIds
from hrcplan.core.numbers import Number
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Problem
from hrcplan.search.lm_cut import landmarks
from hrcplan.search.packed_states import FactPacking, PackedRules
from hrcplan.search.relevance import relevant
from hrcplan.task import BitEffect
from hrcplan.task.conditions import ALWAYS, Tests
from hrcplan.task.steps import TIE_BITS, Operator, StepTable

TIMESTEP = 1 << TIE_BITS  # actions are counted below it
HINT = (
    "use fewer goals with --goal, or fewer objects; "
    "--sample N and --bank-cost task build sequences of actions without turns"
)


def turn_order(problem: Problem) -> tuple[str, ...]:
    """Return the agents as they take turns: humans first, then robots, each in object order."""
    controllable = robots(problem)
    return tuple(sorted(problem.agents, key=lambda agent: agent in controllable))


def humans_in(problem: Problem) -> tuple[str, ...]:
    """Return the humans, in the order of their turns."""
    controllable = robots(problem)
    return tuple(agent for agent in turn_order(problem) if agent not in controllable)


def team_graph(
    table: StepTable, goal: Tests, state: int, turn: int = 0, *, name: str = "goal",
    limits: BuildLimits = NO_LIMITS,
) -> PlanGraph:  # fmt: skip
    """Return the graph of all optimal team plans from a state to a goal.

    Args:
        table: The steps; agents are kept.
        goal: The goal's alternatives.
        state: Where plans begin.
        turn: Whose turn it is there, as an index of the turn order.
        name: The goal's name.
        limits: Time and memory.

    Raises:
        LimitError: if time or memory runs out.
    """
    actions = TeamActions(table, turn_order(table.task.problem))
    ops, literals = relevant(actions.ops, goal)
    packing = FactPacking.of_facts(literals.facts)
    space = _explore(ops, packing, goal, state | actions.facts[turn], name,
                     replace(limits, hint=HINT))  # fmt: skip
    return graph_without_waits(actions, space, packing, goal, turn, name)


def graph_without_waits(
    actions: TeamActions, space: StateSpaceLayers | None, packing: FactPacking, goal: Tests,
    turn: int, name: str,
) -> PlanGraph:  # fmt: skip
    """Return the graph of team plans out of all optimal sequences of actions and waits.

    Args:
        actions: What the agents do in their turns.
        space: The sequences; None if there is none.
        packing: The facts of its states.
        goal: The goal's alternatives.
        turn: Whose turn it is where plans begin.
        name: The goal's name.
    """
    team = Team(tuple(actions.agents), turn)
    if space is None:
        n_facts = len(actions.table.task.facts)
        plain = FactPacking(tuple(place for place in packing.positions if place < n_facts))
        return replace(empty_graph(name, plain), team=team)
    whole = assemble(_Units(), space, packing, name)
    graph = replace(_without_waits(whole, actions), team=team)
    return merge_equivalent_nodes(graph, actions.table, goal)


class _Units:
    """Prices as they are, for `assemble`."""

    def in_units(self, price: int) -> Number:
        return price


def _explore(
    ops: Sequence[Operator], packing: FactPacking, goal: Tests, state: int, name: str,
    limits: BuildLimits,
) -> StateSpaceLayers | None:  # fmt: skip
    """Return what a search finds that holds all optimal plans; None if there is no plan."""
    marks = landmarks(ops, state, goal)
    if marks is None:
        return None
    bound = sum(mark.cost for mark in marks)
    rules, start = PackedRules(ops, packing), packing.row(state)
    while True:
        search = Explorer(rules, goal, marks, bound, optimal=True, limits=limits, name=name)
        space = search.run(start)
        if space.cost is not None:
            return space
        if space.next_bound is None:
            return None
        bound = max(space.next_bound, bound + TIMESTEP)


@dataclass(frozen=True)
class TeamActions:
    """The steps of a table with turns: a fact for each agent's turn, and a wait for each.

    The step ids of waits follow those of the table.
    """

    table: StepTable
    agents: tuple[str, ...]

    @property
    def facts(self) -> list[int]:
        """For each agent the fact that it is its turn, as a bit; none if there is only one."""
        n, n_facts = len(self.agents), len(self.table.task.facts)
        return [1 << n_facts + i for i in range(n)] if n > 1 else [0]

    @property
    def ops(self) -> tuple[Operator, ...]:
        """The ways to do the steps and to wait, each in the turns in which it is possible."""
        return tuple(sorted(self._ops(), key=lambda op: op.step))

    def _ops(self) -> Iterator[Operator]:
        owners = self.owners
        for turn in range(len(self.agents)):
            for op in self.table.ops:
                if owners[op.step] in (turn, ANY_AGENT):
                    yield self._in_turn(op, turn, TIMESTEP + 1)
            wait = Operator(ALWAYS, (), (), step=len(self.table) + turn, cost=0)
            yield self._in_turn(wait, turn, TIMESTEP)

    def _in_turn(self, op: Operator, turn: int, cost: int) -> Operator:
        mine, following = self.facts[turn], self.facts[(turn + 1) % len(self.agents)]
        turn_change = BitEffect(adds=following, deletes=mine)
        return Operator(
            tuple((mask | mine, value | mine) for mask, value in op.tests),
            (*op.at_start, turn_change), op.at_end, step=op.step, cost=cost,
        )  # fmt: skip

    @property
    def owners(self) -> list[int]:
        """The agent of each step; see `step_owners`."""
        return step_owners(self.table, self.agents)


ANY_AGENT = -1


def step_owners(table: StepTable, agents: Sequence[str]) -> list[int]:
    """Return the index of the agent that does each step, or ANY_AGENT if it names no agent."""
    place: dict[str | None, int] = {agent: i for i, agent in enumerate(agents)}
    actions = table.task.actions
    return [place.get(actions[table[i].actions[0]].agent, ANY_AGENT) for i in range(len(table))]


def _without_waits(graph: PlanGraph, actions: TeamActions) -> PlanGraph:
    """Return a graph whose edges lead over waits: each is an action and the waits before it.

    What names no agent is done at once, without a wait before it. Nodes that only a wait leads to
    stay, because a team may be there.
    """
    n, sources = graph.n_nodes, np.repeat(np.arange(graph.n_nodes), np.diff(graph.first))
    is_wait = graph.steps >= len(actions.table)
    after_wait = np.full(n, -1, dtype=np.int64)
    after_wait[sources[is_wait]] = graph.targets[is_wait]
    owner = np.array([*actions.owners, *range(len(actions.agents))])
    anybody = owner[graph.steps] == ANY_AGENT
    owners, places = np.arange(n), np.arange(n)
    parts: list[tuple[Ids, SmallIds, Ids]] = []
    for n_waits in range(len(actions.agents)):
        is_allowed = ~is_wait & ~anybody if n_waits else ~is_wait
        edges, which = _edges_of(graph.first, places)
        fits = is_allowed[edges]
        edges, which = edges[fits], which[fits]
        parts.append((owners[which], graph.steps[edges], graph.targets[edges].astype(np.int64)))
        owners, places = owners[after_wait[places] >= 0], after_wait[places]
        places = places[places >= 0]
    sources, steps, targets = (np.concatenate([part[i] for part in parts]) for i in range(3))
    layers = tuple(
        (timesteps, next(group)[1])
        for timesteps, group in groupby(graph.layers, lambda layer: int(layer[0]) // TIMESTEP)
    )
    first, steps, targets = by_source(sources, steps, targets, n)
    return replace(graph, layers=layers, first=first, steps=steps, targets=targets)


def _edges_of(first: Ids, nodes: Ids) -> tuple[Ids, Ids]:
    """Return the edges of nodes, and for each the place of its node among them."""
    lengths = first[nodes + 1] - first[nodes]
    which = np.repeat(np.arange(len(nodes)), lengths)
    begins = np.repeat(first[nodes] - (np.cumsum(lengths) - lengths), lengths)
    return begins + np.arange(len(which)), which
