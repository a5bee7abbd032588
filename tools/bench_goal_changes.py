#!/usr/bin/env python3
"""Changes of goal that are reported, on runs with and without one.

    tools/bench_goal_changes.py FOLDER [--method cost]

FOLDER is what tools/make_recognition.py --changes writes. A change is detected if one is reported,
and within one step if the most probable place is at most one observed action off.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hrcplan.inference import infer


@dataclass(frozen=True)
class Row:
    """What came out of one run; the last four only of changes that were detected."""

    domain: str
    is_changed: bool
    is_reported: bool
    is_within_one: bool = False
    is_in_interval: bool = False
    width: int = 0
    is_first_right: bool = False
    is_second_right: bool = False


def judged(place: Path, method: str) -> Row:
    """Return what came out of a run; of several reported changes the nearest counts."""
    truth = json.loads(place.read_text())
    inference = infer(str(place.parent), method=method)
    domain = place.parent.parent.name
    if truth["at"] is None or not inference.changes:
        return Row(domain, truth["at"] is not None, bool(inference.changes))
    change = min(inference.changes, key=lambda change: abs(change.at - truth["at"]))
    first = change.at if change.first is None else change.first
    last = change.at if change.last is None else change.last
    return Row(
        domain, True, True, abs(change.at - truth["at"]) <= 1, first <= truth["at"] <= last,
        last - first + 1, change.before == truth["from"], change.after == truth["to"],
    )  # fmt: skip


def _line(domain: str, rows: Sequence[Row]) -> str:
    changed = [row for row in rows if row.is_changed]
    others = [row for row in rows if not row.is_changed]
    seen = [row for row in changed if row.is_reported]
    shares = [
        len(seen) / max(1, len(changed)),
        sum(row.is_reported for row in others) / max(1, len(others)),
        *(sum(values) / max(1, len(seen)) for values in zip(*(
            (row.is_within_one, row.is_in_interval, row.is_first_right, row.is_second_right)
            for row in seen), strict=True)),
    ]  # fmt: skip
    width = sum(row.width for row in seen) / max(1, len(seen))
    return f"{domain:<12}{len(rows):>5}" + "".join(f"{x:>10.2f}" for x in shares) + f"{width:>8.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--method", default="cost")
    args = parser.parse_args()
    rows = [judged(place, args.method) for place in sorted(args.folder.glob("*/*/change.json"))]
    heads = ("detected", "false", "within 1", "interval", "from", "to")
    print(f"{'domain':<12}{'runs':>5}" + "".join(f"{head:>10}" for head in heads) + "   width")
    for domain in sorted({row.domain for row in rows}):
        print(_line(domain, [row for row in rows if row.domain == domain]))
    print(_line("all", rows))


if __name__ == "__main__":
    main()
