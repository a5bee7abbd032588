"""``hrcplan check``: every fault of PDDL files, each with its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from hrcplan.cli import output

if TYPE_CHECKING:
    from hrcplan.pddl.check import CheckReport


@click.command("check")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option(
    "--strict",
    is_flag=True,
    help="Exit with code 3 for warnings too, except for missing initial values.",
)
@click.option(
    "--sarif", is_flag=True, help="Print the faults as a SARIF document, as code hosts read it."
)
@output.common_options
def command(files: tuple[str, ...], strict: bool, sarif: bool) -> int:
    """Report every fault of domain and problem FILEs, with line and column.

    A FILE may also be a name: DOMAIN or DOMAIN/PROBLEM. The exit code is 3 if any fault
    is an error.
    """
    from hrcplan.pddl.check import check

    report = check(files)
    if sarif:
        from hrcplan.cli.sarif import sarif_document

        output.document(sarif_document(report.diagnostics))
    elif output.JSON:
        output.document(report.to_json())
    else:
        for line in report.lines():
            output.result(line)
        output.result(_summary(report))
    return 3 if report.has_errors or (strict and report.is_sloppy) else 0


def _summary(report: CheckReport) -> str:
    n_errors = sum(d.severity == "error" for d in report.diagnostics)
    counts = [
        (report.n_files, "file"),
        (n_errors, "error"),
        (len(report.diagnostics) - n_errors, "warning"),
    ]
    files, errors, warnings = (f"{n} {word}{'' if n == 1 else 's'}" for n, word in counts)
    return f"{files}: {f'{errors}, {warnings}' if report.diagnostics else 'no faults'}"
