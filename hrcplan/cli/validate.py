"""``hrcplan validate``: replay a plan and say whether, or where and why not, it is valid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output
from hrcplan.core.text import quote
from hrcplan.errors import UsageError

if TYPE_CHECKING:
    from hrcplan.core.numbers import Number
    from hrcplan.pddl.model import Problem
    from hrcplan.validation import Report


@click.command(
    "validate",
    epilog=options.notes(
        options.NAMES,
        "PLAN: a file in IPC format, with or without start times, or the output of a planner.",
    ),
)
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM PLAN")
@click.option(
    "--epsilon",
    default="0.001",
    show_default=True,
    metavar="SECONDS",
    help="The smallest gap between two happenings that interfere.",
)
@output.common_options
def command(names: tuple[str, ...], epsilon: str) -> int:
    """Replay PLAN step by step, and print whether it is valid or where it fails.

    The exit code is 1 if the plan is invalid.
    """
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.pddl.source import read_text
    from hrcplan.plans import read_plan
    from hrcplan.validation import validate

    domain, name, (path,) = split_names(names, 1)
    problem = problem_of(domain, name, ())
    gap = _seconds(epsilon)
    plan, n_plans = read_plan(read_text(path), problem, path)
    if n_plans > 1:
        output.note(f"{path} holds {n_plans} plans; this is about the last one")
    report = validate(problem, plan, epsilon_s=gap)
    if output.JSON:
        output.document({
            "valid": report.valid,
            "cost": output.number(report.cost),
            "makespan_s": output.number(report.makespan_s),
            "metric": output.number(report.metric),
            "failed_step": report.failed_step,
            "reason": report.reason,
            **({} if report.gap_s is None else {"hint": _hint(report)}),
        })  # fmt: skip
    elif report.valid:
        output.result(f"valid: {len(plan.actions)} actions{_figures(report)}")
    else:
        step = "" if report.failed_step is None else f"step {report.failed_step + 1}: "
        output.result(f"invalid: {step}{report.reason}")
        if (hint := _hint(report)) is not None:
            output.result(f"  hint: {hint}")
        output.result(output.fold(f"state there: {_fluents(report, problem)}"))
    return 0 if report.valid else 1


def _hint(report: Report) -> str | None:
    """Return which option accepts a gap that is too small."""
    if report.gap_s is None:
        return None
    from hrcplan.core.numbers import number_text

    gap = number_text(report.gap_s)
    return f"the gap is {gap} s; --epsilon {gap} accepts it"


def _seconds(text: str) -> Number:
    """Return a gap in seconds.

    Raises:
        UsageError: if it is no number above zero.
    """
    from hrcplan.core.numbers import to_number

    value = to_number(text)
    if value is None or value <= 0:
        raise UsageError(f"--epsilon takes seconds above zero, not {quote(text)}")
    return value


def _fluents(report: Report, problem: Problem) -> str:
    """Return the facts of the state that actions can change, in order."""
    from hrcplan.pddl.model import fact_text

    changing = {e.target.name for action in problem.domain.actions for e in action.effects}
    facts = (fact_text(fact) for fact in sorted(report.state) if fact[0] in changing)
    return " ".join(fact.replace(" ", output.NO_BREAK) for fact in facts)


def _figures(report: Report) -> str:
    from hrcplan.core.numbers import number_text

    figures = {"cost": report.cost, "makespan": report.makespan_s, "metric": report.metric}
    return "".join(f", {name} {number_text(n)}" for name, n in figures.items() if n is not None)
