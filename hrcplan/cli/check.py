"""``hrcplan check``: every fault of PDDL files, each with its place."""

from __future__ import annotations

import rich_click as click

from hrcplan.cli import output


@click.command("check")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@output.common_options
def command(files: tuple[str, ...]) -> int:
    """Report every fault of domain and problem FILEs; exit 3 if any is an error."""
    from hrcplan.pddl.check import check

    report = check(files)
    if output.JSON:
        output.document(report.to_json())
    else:
        output.result("\n".join(report.lines()))
    return 3 if report.has_errors else 0
