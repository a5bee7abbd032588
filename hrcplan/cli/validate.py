"""``hrcplan validate``: replay a plan and say whether, or where and why not, it is valid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rich_click as click

from hrcplan.cli import output

if TYPE_CHECKING:
    from hrcplan.pddl.model import Problem
    from hrcplan.validation import Report


@click.command("validate")
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM PLAN")
@output.common_options
def command(names: tuple[str, ...]) -> int:
    """Replay PLAN (IPC format, with or without times) for DOMAIN PROBLEM."""
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.pddl.source import read_text
    from hrcplan.plans import parse_plan
    from hrcplan.validation import validate

    domain, name, (path,) = split_names(names, 1)
    problem = problem_of(domain, name, ())
    plan = parse_plan(read_text(path), path)
    report = validate(problem, plan)
    if output.JSON:
        output.document({
            "valid": report.valid,
            "cost": output.number(report.cost),
            "makespan_s": output.number(report.makespan_s),
            "metric": output.number(report.metric),
            "failed_step": report.failed_step,
            "reason": report.reason,
        })  # fmt: skip
    elif report.valid:
        output.result(f"valid: {len(plan.actions)} actions{_figures(report)}")
    else:
        step = "" if report.failed_step is None else f"step {report.failed_step + 1}: "
        output.result(f"invalid: {step}{report.reason}")
        output.result(f"state there: {_fluents(report, problem)}")
    return 0 if report.valid else 1


def _fluents(report: Report, problem: Problem) -> str:
    """Return the facts of the state that actions can change, in order."""
    from hrcplan.pddl.model import fact_text

    changing = {e.target.name for action in problem.domain.actions for e in action.effects}
    return " ".join(fact_text(fact) for fact in sorted(report.state) if fact[0] in changing)


def _figures(report: Report) -> str:
    from hrcplan.core.numbers import number_text

    figures = {"cost": report.cost, "makespan": report.makespan_s, "metric": report.metric}
    return "".join(f", {name} {number_text(n)}" for name, n in figures.items() if n is not None)
