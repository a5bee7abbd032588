"""``hrcplan new-problem``: a problem file made from another one, with its own goal and values."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import click

from hrcplan.cli import options, output
from hrcplan.core.files import check_target
from hrcplan.errors import UsageError
from hrcplan.pddl.model import Problem


@click.command(
    "new-problem",
    cls=options.SettingsCommand,
    epilog=options.notes("DOMAIN, PROBLEM: paths, or the names of shipped files.", options.SETTING),
)
@click.argument("domain", metavar="DOMAIN")
@click.option(
    "--from", "origin", required=True, metavar="PROBLEM", help="The problem to start from."
)
@click.option("--goal", metavar="'(and …)'", help="The new goal: a PDDL condition, in quotes.")
@click.option(
    "--vary", is_flag=True, help="Draw the goal at random: the goal of PROBLEM with other objects."
)
@click.option(
    "--new-objects",
    type=click.IntRange(0, 200),
    default=0,
    metavar="N",
    help="With --vary: first add copies of N objects, for a larger problem.",
)
@options.seed("With --vary: random seed.")
@click.option("--name", required=True, metavar="NAME", help="The name of the new problem.")
@options.settings
@click.option(
    "-o",
    "--output",
    "target",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the problem to this file; by default to stdout.",
)
@output.common_options
def command(
    domain: str,
    origin: str,
    goal: str | None,
    vary: bool,
    new_objects: int,
    seed: int,
    name: str,
    settings: tuple[str, ...],
    target: Path | None,
) -> None:
    """Write a copy of PROBLEM with another goal and other values.

    The new problem is checked before it is written.
    """
    from hrcplan.pddl.generate import with_goal
    from hrcplan.pddl.inputs import read
    from hrcplan.pddl.settings import parse_setting
    from hrcplan.pddl.write import problem_text

    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name):
        raise UsageError(f"'{name}' cannot be a problem's name", hint="letters, digits, - and _")
    if vary == (goal is not None):
        raise UsageError("either --goal or --vary is needed", hint="--goal '(and …)'")
    base = read(domain, origin)
    check_target(target, base.path, base.domain.path)
    base_now = base.with_values(dict(parse_setting(text, base) for text in settings))
    if vary:
        problem = _variant(base_now, seed, new_objects)
    else:
        problem = with_goal(base_now, goal or "", name.lower())
    text = problem_text(replace(problem, name=name.lower()))
    if target is not None:
        output.write_atomically(target, text)
    if output.JSON:
        output.document(
            {"name": name.lower(), "path": str(target) if target else None, "text": text}
        )
    elif target is None:
        output.result(text.rstrip("\n"))
    else:
        output.result(f"wrote {target}")


def _variant(problem: Problem, seed: int, n_objects: int) -> Problem:
    from hrcplan.bank import from_problems
    from hrcplan.bank.variants import vary

    return vary(from_problems([problem]), 1, seed, n_objects=n_objects).problem
