"""Plans of one agent of a team alone: the approximation where a team can get to too many states.

An agent is taken to do the whole rest by itself while the others stand still. Where it cannot, the
plans are the shortest sequences of all agents' actions, without turns.
"""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.bank.construct import NO_LIMITS, optimal_graph
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits
from hrcplan.bank.team import ANY_AGENT, step_owners
from hrcplan.task.conditions import Tests
from hrcplan.task.steps import Operator, StepTable

NOTE = (
    "approximation by solo plans of each agent (--turns solo, or too many states for exact turns): "
    "how agents help each other is left out"
)


def solo_ops(table: StepTable, agents: Sequence[str], turn: int) -> tuple[Operator, ...]:
    """Return the ways to do the steps of one agent, and those that any agent can do.

    Args:
        table: The steps.
        agents: The agents in the order of their turns.
        turn: The agent, as an index of them.
    """
    owners = step_owners(table, agents)
    return tuple(op for op in table.ops if owners[op.step] in (turn, ANY_AGENT))


def solo_graph(
    table: StepTable, agents: Sequence[str], goal: Tests, *, name: str,
    limits: BuildLimits = NO_LIMITS,
) -> PlanGraph:  # fmt: skip
    """Return the graph of the shortest solo plans of a goal, of the first agent that has them.

    Where no agent reaches the goal alone, it holds the shortest sequences of all agents' actions.

    Raises:
        LimitError: if time or memory runs out.
    """
    state = table.task.initial
    graphs = [
        optimal_graph(table, goal, state, name=name, limits=limits, ops=solo_ops(table, agents, i))
        for i in range(len(agents))
    ]
    solo = [graph for graph in graphs if graph.n_nodes]
    if solo:
        return min(solo, key=lambda graph: graph.n_steps)
    return optimal_graph(table, goal, state, name=name, limits=limits)
