"""The command ``tools/wild``."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from public_pddl import breaking, comparing, grounding, judging, racing
from public_pddl.archive import Pair, export, pairs
from public_pddl.reader import READERS
from public_pddl.reading import (
    OURS,
    Verdicts,
    accepts,
    counts,
    is_readable,
    refused_alone,
    time_ratios,
)
from public_pddl.reading import verdicts as read_all

RACE_S, QUALITY_S = 60.0, 20.0


def main() -> None:
    """Print the tables that were asked for as Markdown."""
    options = _options()
    readable = list[Pair]()
    table = list[Verdicts]()
    with TemporaryDirectory(prefix="wild-") as folder:
        if options.groundings:
            grounding.report(_middles(options, Path(folder)), options.groundings)
            return
        if not options.alone:
            print(f"| archive | pairs | {' | '.join(READERS)} | refused by {OURS} alone |")
            print(f"|{'---|' * (len(READERS) + 3)}")
        for i, source in enumerate(options.archive):
            chosen = pairs(export(source, Path(folder, str(i))), options.n, options.seed)
            if options.alone:
                readable += filter(is_readable, chosen)
                continue
            part = read_all(chosen)
            _row(_name(source), part)
            _reasons(Path(folder), chosen, part)
            readable += [pair for pair, v in zip(chosen, part, strict=True) if accepts(v)]
            table += part
        if table:
            _totals(table)
        if options.mutants:
            breaking.report(readable, options.mutants, options.seed)
        if options.plans:
            judging.report(readable, options.plans, options.rounds, options.seed)
        if options.tasks:
            racing.report(readable, options.tasks, options.seed, options.time or RACE_S)
        if options.qualities:
            comparing.report(readable, options.qualities, options.seed, options.time or QUALITY_S)


def _middles(options: argparse.Namespace, folder: Path) -> list[list[Pair]]:
    """Return domains of each archive, with the problem of each that is in the middle by size."""
    folders = (export(source, folder / str(i)) for i, source in enumerate(options.archive))
    return [pairs(f, options.n, options.seed, middle=True) for f in folders]


def _totals(table: list[Verdicts]) -> None:
    _row("all", table)
    n, total, middle = time_ratios(table)
    print(f"\nprocessor time over Fast Downward's: {total:.2f} in sum, {middle:.2f} in the")
    print(f"median of {n} pairs", flush=True)


def _name(source: Path) -> str:
    """Return the name of an archive: a bare repository may stand as OWNER+NAME/repo."""
    name = source.resolve()
    return (name.parent.name if name.name == "repo" else name.name).rpartition("+")[2]


def _row(name: str, table: list[Verdicts]) -> None:
    print(f"| {name} | {' | '.join(f'{n:,}' for n in counts(table))} |", flush=True)


def _reasons(root: Path, chosen: list[Pair], table: list[Verdicts]) -> None:
    for pair, verdict in zip(chosen, table, strict=True):
        if not accepts(verdict):
            reasons = {name: v.reason for name, v in verdict.items()}
            place = [str(path).removeprefix(f"{root}/") for path in (pair.domain, pair.problem)]
            line = json.dumps({"pair": place, "alone": refused_alone(verdict), **reasons})
            print(line, file=sys.stderr, flush=True)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/wild", description=__doc__)
    parser.add_argument(
        "--archive",
        type=Path,
        action="append",
        required=True,
        help="a folder or a bare git repository with PDDL files; repeatable",
    )
    parser.add_argument("--n", type=int, default=80, help="domains of each archive")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--alone", action="store_true", help="do not ask other readers")
    parser.add_argument("--mutants", type=int, default=0, help="broken mutants to refuse")
    parser.add_argument("--plans", type=int, default=0, help="plans to validate beside VAL")
    parser.add_argument("--rounds", type=int, default=1, help="changes of each kind of every plan")
    parser.add_argument("--tasks", type=int, default=0, help="tasks to plan beside planners")
    words = "tasks of middle size to ground beside Fast Downward's translator, and nothing else"
    parser.add_argument("--groundings", type=int, default=0, help=words)
    words = "tasks whose plans of auto are compared with those of each planner alone"
    parser.add_argument("--qualities", type=int, default=0, help=words)
    parser.add_argument("--time", type=float, help="seconds for a task: 60 to plan, 20 to compare")
    return parser.parse_args()


if __name__ == "__main__":
    main()
