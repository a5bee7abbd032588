"""``hrcplan score``: what traces reach in the benchmark hrcplan-switch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hrcplan.cli import options, output

if TYPE_CHECKING:
    from hrcplan.studies.estimate import MeanEstimate
    from hrcplan.studies.switch.score import ScoredTraces
    from hrcplan.studies.switch.standings import Standing

N_SHOWN = 20  # faults
REFUSED = 3


@click.command(
    "score",
    epilog=options.notes(
        "TRACES: a folder with traces of the benchmark hrcplan-switch, at any depth; "
        "'hrcplan study run switch -o DIR --traces FOLDER' writes them.",
    ),
)
@click.argument("traces", metavar="TRACES", type=click.Path(path_type=Path))
@output.common_options
def command(traces: Path) -> int:
    """Check the traces of a method, play each of them again, and print what it reaches.

    Traces that were changed, are of something else, or are incomplete are refused (exit code 3).
    """
    from hrcplan.studies.switch.score import score

    result = score(traces)
    if output.JSON:
        output.document(result.as_json())
    elif result.faults:
        for line in _faults(result):
            output.result(line)
    else:
        output.result("\n".join(_lines(result)))
    return REFUSED if result.faults else 0


def _faults(result: ScoredTraces) -> Iterator[str]:
    for fault in result.faults[:N_SHOWN]:
        place = fault.path if fault.line is None else f"{fault.path}:{fault.line}"
        yield f"{place}: error[{fault.code}]: {fault.message}"
    if len(result.faults) > N_SHOWN:
        yield f"... and {len(result.faults) - N_SHOWN} more"
    yield "nothing is scored"


def _lines(result: ScoredTraces) -> Iterator[str]:
    """Yield a table for each track: measures as columns, in blocks that fit the terminal."""
    from hrcplan.studies.switch.standings import standings

    for name, rows in result.rows.items():
        entries = standings(name, rows)
        n = max(one.n for one in entries)
        yield output.fold(f"{name}: {n} episodes, means ± half of the 95 % interval")
        yield ""
        for block in _blocks(entries, output.table_width()):
            yield from output.columns(block, right=range(1, len(block[0])))
            yield ""
    yield f"{result.n_traces} traces, each played again"


def _blocks(entries: Sequence[Standing], width: int) -> Iterator[list[list[str]]]:
    """Yield the cells of a table, with as many measures side by side as fit."""
    methods = ["", "", *(one.method for one in entries)]
    columns = [_column(name, entries) for name in entries[0].means]
    widths = [max(map(len, column)) + 2 for column in columns]
    block, room = [methods], 0
    for column, needs in zip(columns, widths, strict=True):
        if len(block) > 1 and max(map(len, methods)) + room + needs > width:
            yield [list(row) for row in zip(*block, strict=True)]
            block, room = [methods], 0
        block.append(column)
        room += needs
    yield [list(row) for row in zip(*block, strict=True)]


def _column(name: str, entries: Sequence[Standing]) -> list[str]:
    from hrcplan.studies.switch.standings import MEASURES

    label = MEASURES[name].label.split("|")
    head = [label[0], label[1] if len(label) > 1 else ""]
    return [*head, *(_mean(one.means[name]) for one in entries)]


def _mean(mean: MeanEstimate | None) -> str:
    if mean is None:
        return "-"
    return f"{mean.mean:.2f}" + (f" ± {mean.half:.2f}" if mean.is_known else "")
