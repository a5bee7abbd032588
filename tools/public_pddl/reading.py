"""Which pairs hrcplan and other readers accept, and how long reading takes."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from hrcplan.errors import HrcplanError
from hrcplan.pddl.inputs import read
from public_pddl.archive import Pair
from public_pddl.reader import READERS

OURS, BASE = "hrcplan", "fast-downward"


@dataclass(frozen=True)
class Verdict:
    """What one reader says of one pair: None as the reason if it accepts."""

    reason: str | None
    cpu_s: float


Verdicts = dict[str, Verdict]
"""The verdict of every reader on one pair."""


def verdicts(pairs: Sequence[Pair]) -> list[Verdicts]:
    """Return the verdicts on every pair, each reader in a process of its own."""
    lines = "".join(f"{pair.domain}\t{pair.problem}\n" for pair in pairs)
    columns = {name: _column(name, lines) for name in READERS}
    return [{name: columns[name][i] for name in READERS} for i in range(len(pairs))]


def _column(name: str, lines: str) -> list[Verdict]:
    command = [sys.executable, "-P", str(Path(__file__).with_name("reader.py")), name]
    done = subprocess.run(command, input=lines, capture_output=True, text=True, check=True)
    return [Verdict(**json.loads(line)) for line in done.stdout.splitlines()]


def is_readable(pair: Pair) -> bool:
    """Return whether hrcplan reads a pair, whatever other readers say."""
    try:
        read(pair.domain, pair.problem)
    except HrcplanError:
        return False
    return True


def accepts(verdict: Verdicts, name: str = OURS) -> bool:
    """Return whether a reader accepts the pair."""
    return verdict[name].reason is None


def refused_alone(verdict: Verdicts) -> bool:
    """Return whether hrcplan refuses what at least two others accept."""
    return not accepts(verdict) and sum(accepts(verdict, n) for n in READERS if n != OURS) >= 2


def counts(table: Sequence[Verdicts]) -> list[int]:
    """Return the numbers of pairs: all, accepted by each reader, refused by hrcplan alone."""
    each = [sum(accepts(verdict, name) for verdict in table) for name in READERS]
    return [len(table), *each, sum(map(refused_alone, table))]


def time_ratios(table: Sequence[Verdicts]) -> tuple[int, float, float]:
    """Return the pairs that both accept, and hrcplan's processor time over Fast Downward's.

    The second value is the ratio of the sums, the third one the median ratio of a pair.
    """
    times = [(v[OURS].cpu_s, v[BASE].cpu_s) for v in table if accepts(v) and accepts(v, BASE)]
    if not times:
        return 0, 0.0, 0.0
    ours, base = (sum(column) for column in zip(*times, strict=True))
    return len(times), ours / base, median(a / b for a, b in times)
