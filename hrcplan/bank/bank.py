"""The policy bank: one plan graph per goal, over shared steps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from hrcplan.bank import solo, walk
from hrcplan.bank.construct import NO_LIMITS, optimal_graph
from hrcplan.bank.goals import Goals
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits
from hrcplan.bank.team import humans_in, team_graph, turn_order
from hrcplan.core.text import nearest, plural
from hrcplan.errors import UsageError
from hrcplan.pddl.conventions import interactions, robots
from hrcplan.plans import Plan, PlannedAction
from hrcplan.search.relevance import overwritten_facts, relevant
from hrcplan.task.steps import STEPS, Operator, StepTable

OPTIMAL = Fraction(1)
AUTO, EXACT, SOLO = TURNS = ("auto", "exact", "solo")
MAX_VARIANTS = 8  # states that are looked up for one that is off the graph
MAX_REROOTED = 500_000  # nodes of graphs from other states that are remembered


@dataclass(frozen=True)
class BuildOptions:
    """How a bank is made.

    ``quality`` above 1 takes all sequences up to that multiple of the optimal cost;
    ``alternatives`` the plans up to that multiple of which no step can be dropped; ``sample``
    that many plans listed by a planner. ``cost`` is ``steps`` or ``task``. ``turns`` says how a
    team's turns are looked at: ``exact``, ``solo`` (plans of each agent alone: an approximation),
    or ``auto``: exact unless the team can get to too many states.
    """

    cost: str = STEPS
    quality: Fraction = OPTIMAL
    alternatives: Fraction | None = None
    sample: int | None = None
    turns: str = AUTO

    def __post_init__(self) -> None:
        """Refuse what contradicts itself.

        Raises:
            UsageError: if more than one way of building is asked for, or a factor is below 1.
        """
        if self.turns not in TURNS:
            raise UsageError(f"turns are {', '.join(TURNS)}, not '{self.turns}'")
        ways = [self.quality != OPTIMAL, self.alternatives is not None, self.sample is not None]
        if self.turns != AUTO and (any(ways) or self.cost != STEPS):
            raise UsageError("--turns is for optimal plans that are counted in steps")
        if sum(ways) > 1:
            raise UsageError("--quality, --alternatives and --sample exclude each other")
        if self.quality < 1 or (self.alternatives or OPTIMAL) < 1:
            raise UsageError("a multiple of the optimal cost is at least 1")
        if self.sample is not None and self.sample < 1:
            raise UsageError("a sample has at least one plan")


OPTIMAL_PLANS = BuildOptions()


@dataclass(frozen=True, eq=False, repr=False)
class Bank:
    """Plan graphs of goals, in order; ``graphs[g]`` belongs to goal ``g``.

    ``table`` numbers the steps, alike for all goals. ``build_s`` is how long building took.
    ``human`` is the only human who has these goals; None if all humans share one. The last
    ``n_composed`` goals are composed of goal facts of the others; ``shared_costs`` are their costs
    to go in a team, which live as long as the bank.
    """

    goals: Goals
    table: StepTable
    graphs: tuple[PlanGraph, ...]
    recipe: BuildOptions = OPTIMAL_PLANS
    build_s: float = 0.0
    human: str | None = None
    n_composed: int = 0
    shared_costs: object = None
    _graphs: dict[tuple[int, int, int | None], PlanGraph] = field(default_factory=dict)
    _solo_facts_of: dict[tuple[int, int], int] = field(default_factory=dict)

    def __repr__(self) -> str:
        nodes = sum(graph.n_nodes for graph in self.graphs)
        return f"<Bank {self.goals.title}, {plural(nodes, 'node')}, agents {self.agents}>"

    @property
    def names(self) -> tuple[str, ...]:
        """The goals' names, in order."""
        return self.goals.names

    @property
    def agents(self) -> str:
        """``dropped`` if plans are sequences of steps, ``kept`` if of ground actions."""
        return self.table.agents

    @property
    def initial(self) -> int:
        """The initial state that all goals share, as bits of the task."""
        return self.goals.task.initial

    @cached_property
    def humans(self) -> tuple[str, ...]:
        """The humans, in the order of their turns."""
        return humans_in(self.goals.problem)

    def for_human(self, human: str) -> Bank:
        """Return the same plans for a human who has a goal of its own, which no other human helps.

        Raises:
            UsageError: if there is no such human.
        """
        if human not in self.humans:
            hint = nearest(human, self.humans) or f"humans: {', '.join(self.humans)}"
            raise UsageError(f"there is no human '{human}'", code="unknown-human", hint=hint)
        return self if len(self.humans) == 1 else replace(self, human=human)

    def goal_index(self, name: str) -> int:
        """Return the index of a goal.

        Raises:
            UsageError: if there is no such goal; the hint names the nearest.
        """
        if name not in self.names:
            hint = nearest(name, self.names) or f"goals: {', '.join(self.names[:40])}"
            raise UsageError(f"the bank has no goal '{name}'", code="unknown-goal", hint=hint)
        return self.names.index(name)

    @cached_property
    def team(self) -> tuple[str, ...]:
        """The agents in the order of their turns, if plans are team plans; else empty."""
        if self.is_solo:
            return turn_order(self.goals.problem)
        team = self.graphs[0].team if self.graphs else None
        return team.agents if team is not None else ()

    @property
    def is_solo(self) -> bool:
        """Whether plans are the solo plans of each agent of a team."""
        return self.recipe.turns == SOLO

    @property
    def turns(self) -> str | None:
        """How turns are looked at, ``exact`` or ``solo``; None where agents take none."""
        return (SOLO if self.is_solo else EXACT) if self.team else None

    @property
    def note(self) -> str | None:
        """What the plans leave out; None if they are what they are asked to be."""
        notes = [solo.NOTE] if self.is_solo else []
        if (names := sorted(interactions(self.goals.problem.domain))) and self.table.cost == STEPS:
            notes.append(
                f"interactions ({', '.join(names)}) save no steps, so plans counted in steps have "
                "none; `bank show --allocation` prices them, --bank-cost task plans with them"
            )
        return "; ".join(notes) or None

    def graph_from(
        self, goal: int, state: int, limits: BuildLimits = NO_LIMITS, *, turn: int | None = None
    ) -> PlanGraph:
        """Return the graph of all optimal plans of a goal from another state; the bank caches it.

        Args:
            goal: The goal.
            state: The state.
            limits: Time and memory.
            turn: Whose turn it is there, as an index of ``team``; by default that of the first
                agent. Where plans are solo plans, they are those of this agent, or of all if it has
                none.

        Raises:
            LimitError: if time or memory runs out.
        """
        turn = (turn or 0) if self.team else None
        plan_graph = self._graph_from(goal, state, turn, limits)
        if self.is_solo and not plan_graph.n_nodes:
            return self._graph_from(goal, state, None, limits)
        return plan_graph

    def _graph_from(
        self, goal: int, state: int, turn: int | None, limits: BuildLimits
    ) -> PlanGraph:
        is_solo = self.is_solo and turn is not None
        facts = self._solo_facts(goal, turn or 0) if is_solo else self.relevant_facts(goal)
        key = (goal, state & facts, turn)
        plan_graph = self._graphs.get(key)
        if plan_graph is None:
            tests, name = self.goals.tests[goal], self.names[goal]
            if is_solo:
                ops = self._solo_ops[turn or 0]
                plan_graph = optimal_graph(
                    self.table, tests, state, name=name, limits=limits, ops=ops
                )
            elif turn is not None:
                plan_graph = team_graph(self.table, tests, state, turn, name=name, limits=limits)
            else:
                plan_graph = optimal_graph(self.table, tests, state, name=name, limits=limits)
            self._graphs[key] = plan_graph
            while sum(graph.n_nodes + 1 for graph in self._graphs.values()) > MAX_REROOTED:
                self._graphs.pop(next(iter(self._graphs)))
        return plan_graph

    @cached_property
    def _solo_ops(self) -> list[tuple[Operator, ...]]:
        return [solo.solo_ops(self.table, self.team, turn) for turn in range(len(self.team))]

    def _solo_facts(self, goal: int, turn: int) -> int:
        """Return the facts that matter to a plan of one agent, as bits."""
        key = (goal, turn)
        if key not in self._solo_facts_of:
            tests = self.goals.tests[goal]
            self._solo_facts_of[key] = relevant(self._solo_ops[turn], tests)[1].facts
        return self._solo_facts_of[key]

    def locate(
        self, goal: int, state: int, limits: BuildLimits = NO_LIMITS, *, turn: int | None = None
    ) -> tuple[PlanGraph, int | None]:
        """Return a graph of a goal and the node in it that a state is at, whatever led there.

        It is the goal's own graph where that holds the state, else one that begins at the state.
        The node is None if the goal can no longer be reached.

        Args:
            goal: The goal.
            state: The state.
            limits: Time and memory for a graph that begins at the state.
            turn: Whose turn it is, as an index of ``team``; any turn by default.

        Raises:
            LimitError: if time or memory runs out.
        """
        node = self.node(goal, state, turn)
        if node is not None:
            return self.graphs[goal], node
        other = self.graph_from(goal, state, limits, turn=turn)
        return other, 0 if other.n_nodes else None

    def node(self, goal: int, state: int, turn: int | None = None) -> int | None:
        """Return the node of a goal's own graph that a state is at; None if it is off the graph."""
        graph = self.graphs[goal]
        if self.is_solo:
            return None  # whose plans the graph holds depends on the goal
        if self.team:
            return graph.node_of(state, turn)
        node = graph.node_of(state)
        if node is None and self._overwritten[goal] and not self.goals.is_reached(goal, state):
            candidates = map(graph.node_of, _variants(state, self._overwritten[goal]))
            node = next((n for n in candidates if n is not None and not graph.is_goal[n]), None)
        return node

    def relevant_facts(self, goal: int) -> int:
        """Return the facts that matter to any plan of a goal, from any state, as bits."""
        return self._relevant[goal][1]

    @cached_property
    def _relevant(self) -> list[tuple[tuple[Operator, ...], int]]:
        """For each goal the steps and facts that matter to any plan of it, from any state."""
        by_goal = (relevant(self.table.ops, tests) for tests in self.goals.tests)
        return [(ops, literals.facts) for ops, literals in by_goal]

    @cached_property
    def _overwritten(self) -> list[int]:
        return [overwritten_facts(ops) & facts for ops, facts in self._relevant]

    # Plans.

    @cached_property
    def _samplers(self) -> dict[int, walk.Sampler]:
        return {}

    def sampler(self, goal: int) -> walk.Sampler:
        """Return what draws plans of a goal."""
        if goal not in self._samplers:
            self._samplers[goal] = walk.Sampler(self.graphs[goal])
        return self._samplers[goal]

    def sample(
        self, goal: int, n: int, rng: np.random.Generator, keep: walk.PlanFilter | None = None
    ) -> list[tuple[int, ...]]:
        """Return ``n`` plans of a goal, drawn uniformly, as step ids.

        Raises:
            UsageError: if the goal has no plan.
            LimitError: if a filter keeps hardly any plan.
        """
        if not self.graphs[goal].n_nodes:
            raise UsageError(f"goal '{self.names[goal]}' has no plan", code="no-plan")
        if keep is not None:
            return self.sampler(goal).draw_kept(n, rng, keep)
        rows = self.sampler(goal).draw(n, rng).tolist()
        return [tuple(step for step in row if step >= 0) for row in rows]

    def plans(self, goal: int, keep: walk.PlanFilter | None = None) -> Iterator[tuple[int, ...]]:
        """Yield the plans of a goal as step ids, the cheapest first."""
        return walk.plans(self.graphs[goal], keep)

    def loop_free(self, steps: Sequence[int]) -> bool:
        """Return whether a plan meets no state twice."""
        states = [self.initial]
        for step in steps:
            after = self.table.successor(states[-1], step)
            if after is None or after in states:
                return False
            states.append(after)
        return True

    def irredundant(self, goal: int) -> walk.PlanFilter:
        """Return the filter of plans of a goal of which no single step can be dropped."""

        def keep(steps: Sequence[int]) -> bool:
            return not any(
                self._reaches(goal, (*steps[:i], *steps[i + 1 :])) for i in range(len(steps))
            )

        return keep

    def _reaches(self, goal: int, steps: Sequence[int]) -> bool:
        state: int | None = self.initial
        for step in steps:
            state = None if state is None else self.table.successor(state, step)
        return state is not None and self.goals.is_reached(goal, state)

    def as_plan(self, steps: Sequence[int]) -> Plan:
        """Return a plan with ground actions, where agents are dropped those of the cheapest agent.

        Among equals it is a human, for the sake of ``infer``: the robot's own steps
        are no evidence. Then ground-action order decides.

        Raises:
            UsageError: if the steps cannot be done one after the other.
        """
        task, state = self.goals.task, self.initial
        own = robots(task.problem)
        actions: list[PlannedAction] = []
        for step in steps:
            can = [i for i in self.table[step].actions if task.is_applicable(state, i)]
            if not can:
                raise UsageError(f"{self.table[step]} cannot be done here")
            action = min(can, key=lambda i: (task.costs[i], task.actions[i].agent in own, i))
            actions.append(PlannedAction(task.actions[action].name, task.actions[action].args))
            state = task.successor(state, action)
        return Plan(tuple(actions))


def _variants(state: int, facts: int) -> Iterator[int]:
    """Yield a state with a few facts set in all possible ways."""
    subset = facts
    for _ in range(MAX_VARIANTS):
        yield state & ~facts | subset
        if not subset:
            return
        subset = (subset - 1) & facts
