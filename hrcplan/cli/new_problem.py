"""``hrcplan new-problem``: a problem file made from another one, with its own goal and values."""

from __future__ import annotations

import re
from pathlib import Path

import rich_click as click

from hrcplan.cli import output
from hrcplan.errors import UsageError


@click.command("new-problem")
@click.argument("domain", metavar="DOMAIN")
@click.option("--from", "origin", required=True, metavar="PROBLEM", help="Problem to start from.")
@click.option("--goal", required=True, metavar="'(and …)'", help="The new goal, in PDDL.")
@click.option("--name", required=True, metavar="N", help="The new problem's name.")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="'F OBJ…=N'",
    help="Change a value of the initial state.",
)
@click.option(
    "-o",
    "--output",
    "target",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Where to write it; on stdout if not given.",
)
@output.common_options
def command(
    domain: str, origin: str, goal: str, name: str, settings: tuple[str, ...], target: Path | None
) -> None:
    """Write a problem like PROBLEM with another goal, checked before it is written."""
    from hrcplan.cli.arguments import setting
    from hrcplan.facade import load_problem
    from hrcplan.pddl.generate import with_goal
    from hrcplan.pddl.write import problem_text

    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name):
        raise UsageError(f"'{name}' cannot be a problem's name", hint="letters, digits, - and _")
    base = load_problem(domain, origin)
    changed = base.with_values(dict(setting(text, base) for text in settings))
    text = problem_text(with_goal(changed, goal, name.lower()))
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
