"""Builds policy banks: reads goals, and makes the plan graph of each."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from hrcplan.bank.alternatives import alternatives_graph
from hrcplan.bank.bank import AUTO, EXACT, OPTIMAL_PLANS, SOLO, Bank, BuildOptions
from hrcplan.bank.construct import bounded_graph, optimal_graph
from hrcplan.bank.enumerated import sampled_graph
from hrcplan.bank.goals import Goals
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.reachable_states import check_states, has_few_states
from hrcplan.bank.search import MAX_MIB, BuildLimits
from hrcplan.bank.solo import solo_graph
from hrcplan.bank.sources import read_goals
from hrcplan.bank.team import team_graph
from hrcplan.task.steps import StepTable


def build_bank(
    domain: str, goals: str | None = None, recipe: BuildOptions = OPTIMAL_PLANS, *,
    only: Sequence[str] | None = None, mib: int = MAX_MIB, timeout_s: float = float("inf"),
    report: Callable[[PlanGraph], None] | None = None,
) -> Bank:  # fmt: skip
    """Return the policy bank of the goals of a folder, or of a domain's shipped problems.

    Args:
        domain: A path or a shipped name.
        goals: A folder of problem files, or one with ``template.pddl`` and ``hyps.dat``.
        recipe: What goes into the graphs.
        only: Names of goals, if not all are wanted.
        mib: MiB of arrays that one graph may need.
        timeout_s: Seconds for all graphs together.
        report: Is called with every graph that is done.

    Raises:
        InputError: if a file is missing or has faults, or the goals are not in one world.
        UnsupportedError: if bits cannot hold the task.
        LimitError: if time or memory runs out.
        UsageError: if ``only`` names no goal.
    """
    goal_set = read_goals(domain, goals)
    if only is not None:
        goal_set = goal_set.only(only)
    return build(goal_set, recipe, mib=mib, timeout_s=timeout_s, report=report)


def build(
    goals: Goals, recipe: BuildOptions = OPTIMAL_PLANS, *, mib: int = MAX_MIB,
    timeout_s: float = float("inf"), report: Callable[[PlanGraph], None] | None = None,
) -> Bank:  # fmt: skip
    """Return the policy bank of goals that are in memory; see ``build_bank``."""
    started_s = time.monotonic()
    table = StepTable(goals.task, recipe.cost)
    limits = BuildLimits(mib, started_s + timeout_s)
    recipe = replace(recipe, turns=_turns(goals, table, recipe))
    bank = Bank(goals, table, (), recipe)
    graphs: list[PlanGraph] = []
    for goal in range(len(goals)):
        graphs.append(_graph(bank, goal, limits))
        if report is not None:
            report(graphs[-1])
    return replace(bank, graphs=tuple(graphs), build_s=time.monotonic() - started_s)


def _turns(goals: Goals, table: StepTable, recipe: BuildOptions) -> str:
    """Return how turns are looked at; `AUTO` where agents take none.

    Raises:
        LimitError: if they are asked for exactly, and the team can get to too many states.
    """
    is_plain = recipe == BuildOptions(turns=recipe.turns)
    if table.agents == "dropped" or not goals.problem.agents or not is_plain:
        return AUTO
    if recipe.turns == AUTO:
        return EXACT if has_few_states(table) else SOLO
    if recipe.turns == EXACT:
        check_states(table)
    return recipe.turns


def _graph(bank: Bank, goal: int, limits: BuildLimits) -> PlanGraph:
    recipe, name = bank.recipe, bank.names[goal]
    tests = bank.goals.tests[goal]
    if recipe.alternatives is not None:
        return alternatives_graph(
            bank.table, tests, bank.initial, recipe.alternatives, name=name, limits=limits
        )
    if recipe.sample is not None:
        return sampled_graph(bank.table, bank.goals, goal, recipe.sample, limits=limits)
    if recipe.quality > 1:
        return bounded_graph(
            bank.table, tests, bank.initial, recipe.quality, name=name, limits=limits
        )
    if bank.is_solo:
        return solo_graph(bank.table, bank.team, tests, name=name, limits=limits)
    build_graph = team_graph if recipe.turns == EXACT else optimal_graph
    return build_graph(bank.table, tests, bank.initial, name=name, limits=limits)
