"""``hrcplan check``: every fault of PDDL files, each with its place."""

from __future__ import annotations

from dataclasses import asdict

import rich_click as click

from hrcplan.cli import output


@click.command("check")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@output.common_options
def command(files: tuple[str, ...]) -> int:
    """Report every fault of domain and problem FILEs; exit 3 if any is an error."""
    from hrcplan.pddl.check import check_files

    found = check_files(files)
    n_errors = sum(d.severity == "error" for d in found)
    if output.JSON:
        output.document({"files": len(files), "diagnostics": [asdict(d) for d in found]})
    else:
        for diagnostic in found:
            output.result(str(diagnostic))
        output.result(_summary(len(files), n_errors, len(found) - n_errors))
    return 3 if n_errors else 0


def _summary(n_files: int, n_errors: int, n_warnings: int) -> str:
    def count(n: int, word: str) -> str:
        return f"{n} {word}{'' if n == 1 else 's'}"

    faults = f"{count(n_errors, 'error')}, {count(n_warnings, 'warning')}"
    return f"{count(n_files, 'file')}: {'no faults' if not n_errors + n_warnings else faults}"
