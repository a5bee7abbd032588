"""``hrcplan replay``: derive every decision of a journal again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import output
from hrcplan.core.files import check_targets

if TYPE_CHECKING:
    from hrcplan.collaboration.outcome import CollaborationOutcome
    from hrcplan.execution.journal import Journal
    from hrcplan.execution.outcome import Outcome
    from hrcplan.execution.replay import Replayed
    from hrcplan.inference.traces import ActionTrace


@click.command("replay")
@click.argument("journal", type=click.Path(path_type=Path))
@click.option("--trace", type=click.Path(path_type=Path), metavar="FILE",
              help="Also write what was done, for hrcplan infer.")  # fmt: skip
@click.option("--html", "page", type=click.Path(path_type=Path), metavar="FILE",
              help="Also write a page that shows the run, with a slider over time.")  # fmt: skip
@output.common_options
def command(journal: Path, trace: Path | None, page: Path | None) -> int:
    """Check that every decision in JOURNAL follows from what was written before it.

    JOURNAL was written by 'hrcplan execute' or 'hrcplan collaborate'.
    """
    from hrcplan.execution.journal import read_journal

    check_targets((trace, page), journal)
    content = read_journal(journal)
    check = _replay(content)
    if trace is not None:
        output.write_atomically(trace, _trace(content).text())
    if page is not None:
        from hrcplan.web.replay_page import replay_page

        output.write_atomically(page, replay_page(content))
    difference = check.difference
    if output.JSON:
        place = difference and {
            "line": difference.line, "expected": difference.expected, "found": difference.recorded,
        }  # fmt: skip
        output.document({
            "ok": difference is None, "events": check.n_events, "decisions": check.n_decisions,
            "row": check.row.to_json(), "difference": place,
        })  # fmt: skip
    elif difference is None:
        counts = f"{check.n_events} events, {check.n_decisions} decisions"
        output.result(f"{journal}: {counts}, all of them follow; {check.row.ending}")
    else:
        output.result(f"{journal}:{difference.line}: this does not follow")
        output.result(f"  expected  {difference.expected}\n  found     {difference.recorded}")
    return 0 if difference is None else 1


def _trace(journal: Journal) -> ActionTrace:
    from hrcplan.collaboration.journal import is_collaboration, setup_of
    from hrcplan.execution.traces import trace_of

    setup = setup_of(journal) if is_collaboration(journal) else journal.setup()
    return trace_of(journal.lines, setup.problem)


def _replay(journal: Journal) -> Replayed[Outcome] | Replayed[CollaborationOutcome]:
    from hrcplan.collaboration.journal import is_collaboration, replay_collaboration
    from hrcplan.execution.replay import replay

    if is_collaboration(journal):
        return replay_collaboration(journal)
    return replay(journal)
