"""``hrcplan bank``: build, show, sample and verify policy banks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hrcplan.cli import options, output
from hrcplan.cli.help import Group
from hrcplan.core.files import check_target
from hrcplan.core.numbers import fraction_of, int_text
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.bank import Bank, PlanGraph
    from hrcplan.bank.allocation import Allocation


class _Factor(click.ParamType):  # type: ignore[type-arg]
    """A number of at least 1, exactly as written."""

    name = "factor"

    def convert(
        self, value: str | Fraction, param: click.Parameter | None, ctx: click.Context | None
    ) -> Fraction:
        """Return the number."""
        factor = value if isinstance(value, Fraction) else fraction_of(value)
        if factor is None:
            self.fail(f"'{value}' is not a number", param, ctx)
        if factor < 1:
            self.fail("a multiple of the optimal cost is at least 1", param, ctx)
        return factor


@click.group("bank", cls=Group)
def command() -> None:
    """Policy banks: every valid plan of every goal, counted exactly."""


@command.command(
    "build",
    epilog=options.notes(
        "DOMAIN: a path, or the name of a shipped domain.",
        options.GOALS,
        "Q: a factor of at least 1, as in 1.2.",
    ),
)
@click.argument("domain", metavar="DOMAIN")
@click.argument("goals", required=False, metavar="[GOALS]")
@click.option(
    "--goal",
    "only",
    multiple=True,
    metavar="NAME",
    help="Build only this goal; repeatable. By default all goals.",
)
@click.option(
    "--quality",
    type=_Factor(),
    metavar="Q",
    help="Include all plans that cost up to Q times the optimum; by default 1.",
)
@click.option(
    "--alternatives",
    type=_Factor(),
    metavar="Q",
    help="Include plans that cost up to Q times the optimum and need each of their steps.",
)
@click.option(
    "--sample",
    type=click.IntRange(1, 1_000_000),
    metavar="N",
    help="Include N optimal plans that the planner K* lists, if the whole does not fit.",
)
@click.option(
    "--bank-cost",
    type=click.Choice(["steps", "task"]),
    default="steps",
    show_default=True,
    help="The cost of a plan: its number of steps, or the cost of the task.",
)
@click.option(
    "--turns",
    type=click.Choice(["auto", "exact", "solo"]),
    default="auto",
    show_default=True,
    help="How agents that move or carry take turns: exactly, or by solo plans of each agent (an "
    "approximation). auto: exactly, if they can get to at most 1,000,000 states.",
)
@click.option(
    "--memory",
    type=click.IntRange(min=1),
    default=2048,
    show_default=True,
    metavar="MIB",
    help="Memory limit for the arrays of one goal, in MiB.",
)
@options.timeout("Seconds for all goals together; by default no limit.", None)
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="BANK",
    type=click.Path(path_type=Path),
    help="Write the bank to this file.",
)
@output.common_options
def build(
    domain: str,
    goals: str | None,
    only: tuple[str, ...],
    quality: Fraction | None,
    alternatives: Fraction | None,
    sample: int | None,
    bank_cost: str,
    turns: str,
    memory: int,
    timeout: float | None,
    target: Path,
) -> int:
    """Build the policy bank of all GOALS: their valid plans as graphs of states."""
    from hrcplan.bank import BuildOptions, build_bank, save

    check_target(target)
    recipe = BuildOptions(bank_cost, quality or Fraction(1), alternatives, sample, turns)
    bank = build_bank(
        domain,
        goals,
        recipe,
        only=only or None,
        mib=memory,
        timeout_s=float("inf") if timeout is None else timeout,
        report=_say,
    )
    check_target(target, *(file.path for file in bank.goals.files))
    save(bank, target)
    _print(bank)
    return 0


def _say(graph: PlanGraph) -> None:
    output.say(f"{graph.goal}: {graph.n_nodes} nodes")


@command.command(
    "show", cls=options.SettingsCommand, epilog=options.notes(options.SETTING, options.PROFILE)
)
@click.argument("bank", metavar="BANK")
@click.option(
    "--htn",
    "goal",
    metavar="GOAL",
    help="Show the plans of this goal as a tree of chains and cliques.",
)
@click.option(
    "--allocation",
    is_flag=True,
    help="Show who does what in a cheapest plan of each goal, by what actions cost each agent.",
)
@options.settings
@click.option(
    "--profile",
    metavar="PROFILE",
    help="With --allocation: how agent state becomes costs, as in `execute`; by default as it is.",
)
@output.common_options
def show(
    bank: str, goal: str | None, allocation: bool, settings: tuple[str, ...], profile: str | None
) -> int:
    """Show the goals of a BANK: steps, cost, exact number of plans, size of the graph.

    Prices (agent state given by --set, and the profile) act on top of graphs that are built in
    steps, without a new build. Graphs of --bank-cost task are built again when prices change.
    """
    from hrcplan.bank import load

    if (settings or profile is not None) and not allocation:
        raise UsageError("--set and --profile change prices: use them with --allocation")
    goal_bank = load(bank)
    if allocation:
        _print_allocation(goal_bank, settings, profile)
    elif goal is None:
        _print(goal_bank)
    else:
        _print_htn(goal_bank, goal)
    return 0


def _print_allocation(bank: Bank, settings: tuple[str, ...], profile: str | None) -> None:
    from hrcplan.agents.profile import agent_values
    from hrcplan.bank.allocation import allocations

    problem = bank.goals.problem
    rows = allocations(bank, agent_values(problem, settings, profile))
    if output.JSON:
        entries = [asdict(row) for row in rows]
        output.document({"domain": problem.domain.name, "note": bank.note, "goals": entries})
    else:
        if bank.note is not None:
            output.warn(bank.note)
        output.result(_allocation_table(rows, problem.agents))


def _allocation_table(rows: list[Allocation], agents: Sequence[str]) -> str:
    head = ["goal", "cost", "timesteps", *agents, "either", "interactions"]
    lines = [
        [
            row.goal,
            f"{row.cost:.6g}",
            "-" if row.timesteps is None else str(row.timesteps),
            *(str(row.actions[agent]) for agent in agents),
            str(row.either),
            str(row.interactions),
        ]
        for row in rows
    ]
    title = "actions of each agent in a cheapest plan"
    return "\n".join([title, "", *output.columns([head, *lines], right=range(1, len(head)))])


def _print_htn(bank: Bank, goal: str) -> None:
    from hrcplan.bank import htn_view as view
    from hrcplan.bank.htn import decompose

    graph = bank.graphs[bank.goal_index(goal)]
    htn = decompose(graph)
    if not htn.kinds:
        output.warn(f"goal '{goal}' has no plan")
    if output.JSON:
        output.document(view.as_json(graph, htn, bank.table))
    else:
        output.result(view.as_text(graph, htn, bank.table))


@command.command("sample")
@click.argument("bank", metavar="BANK")
@click.argument("goal", metavar="GOAL")
@click.option(
    "-n",
    "n",
    type=click.IntRange(min=0),
    default=1,
    show_default=True,
    metavar="N",
    help="Number of plans.",
)
@options.seed()
@click.option("--loop-free", is_flag=True, help="Only plans that visit no state twice.")
@click.option("--irredundant", is_flag=True, help="Only plans that need each of their steps.")
@output.common_options
def sample(bank: str, goal: str, n: int, seed: int, loop_free: bool, irredundant: bool) -> int:
    """Draw plans of a GOAL from a BANK, each with equal probability; print them in IPC format."""
    import numpy as np

    from hrcplan.bank import load

    goal_bank = load(bank)
    index = goal_bank.goal_index(goal)
    choices = ((loop_free, goal_bank.loop_free), (irredundant, goal_bank.irredundant(index)))
    filters = [test for is_on, test in choices if is_on]
    keep = (lambda steps: all(test(steps) for test in filters)) if filters else None
    rows = goal_bank.sample(index, n, np.random.default_rng(seed), keep)
    plans = [
        {
            "steps": [str(goal_bank.table[step]) for step in steps],
            "actions": [str(action) for action in goal_bank.as_plan(steps).actions],
        }
        for steps in rows
    ]
    if output.JSON:
        output.document({"goal": goal, "agents": goal_bank.agents, "plans": plans})
    for number, plan in enumerate(plans, start=1):
        if not output.JSON:
            output.result("\n".join([f"; plan {number}", *plan["actions"], ""]))
    return 0


@command.command("verify")
@click.argument("bank", metavar="BANK")
@output.common_options
def verify(bank: str) -> int:
    """Check the checksum, the PDDL, every node and every edge of a BANK.

    The exit code is 1 if the bank is corrupt.
    """
    from hrcplan.bank import find_fault

    fault = find_fault(bank)
    if output.JSON:
        output.document({"valid": fault is None, "reason": fault})
    else:
        output.result("sound" if fault is None else f"not sound: {fault}")
    return 0 if fault is None else 1


def _print(bank: Bank) -> None:
    for graph in bank.graphs:
        if not graph.n_nodes:
            output.warn(f"goal '{graph.goal}' has no plan")
    if output.JSON:
        output.document(as_json(bank))
    else:
        if bank.note is not None:
            output.warn(bank.note)
        output.result(_table(bank))


def as_json(bank: Bank) -> dict[str, Any]:
    """Return the document of ``bank build`` and ``bank show``."""
    return {
        "domain": bank.goals.problem.domain.name,
        "agents": bank.agents,
        "goals": [
            {
                "name": graph.goal,
                "steps": graph.n_steps,
                "optimal_cost": output.number(graph.optimal_cost),
                "plans": int_text(graph.plans),
                "nodes": graph.n_nodes,
                "edges": graph.n_edges,
                "complete": graph.complete,
            }
            for graph in bank.graphs
        ],
        "turns": bank.turns,
        "note": bank.note,
        "build_s": round(bank.build_s, 6),
    }


def _table(bank: Bank) -> str:
    head = ["goal", "steps", "cost", "plans", "nodes", "edges"]
    rows = [
        [
            g.goal,
            str(g.n_steps),
            str(output.number(g.optimal_cost)),
            f"{'' if g.complete else '>= '}{int_text(g.plans, ',')}",
            f"{g.n_nodes:,}",
            f"{g.n_edges:,}",
        ]
        for g in bank.graphs
    ]
    lines = output.columns([head, *rows], right=range(1, len(head)))
    agents = "dropped: plans are sequences of steps" if bank.agents == "dropped" else "kept"
    if bank.turns is not None:
        agents += ", solo plans of each" if bank.is_solo else ", team plans in turns"
    total = sum(graph.n_nodes for graph in bank.graphs)
    title = f"{bank.goals.problem.domain.name}: {len(bank.graphs)} goals, agents {agents}"
    return "\n".join([title, "", *lines, "", f"{total:,} nodes, built in {bank.build_s:.2f} s"])
