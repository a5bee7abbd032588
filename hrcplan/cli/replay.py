"""``hrcplan replay``: derive every decision of a journal again."""

from __future__ import annotations

from pathlib import Path

import rich_click as click

from hrcplan.cli import output


@click.command("replay")
@click.argument("journal", type=click.Path(path_type=Path))
@output.common_options
def command(journal: Path) -> int:
    """Check that every decision in JOURNAL follows from what was written before it."""
    from hrcplan.execution.journal import read_journal
    from hrcplan.execution.replay import replay

    found = replay(read_journal(journal))
    difference = found.difference
    if output.JSON:
        place = difference and {
            "line": difference.line, "expected": difference.expected, "found": difference.found,
        }  # fmt: skip
        output.document({
            "ok": difference is None, "events": found.n_events, "decisions": found.n_decisions,
            "row": found.row.to_json(), "difference": place,
        })  # fmt: skip
    elif difference is None:
        counts = f"{found.n_events} events, {found.n_decisions} decisions"
        output.result(f"{journal}: {counts}, all of them follow; {found.row.ending}")
    else:
        output.result(f"{journal}:{difference.line}: this does not follow")
        output.result(f"  expected  {difference.expected}\n  found     {difference.found}")
    return 0 if difference is None else 1
