"""Medians of interleaved rounds, and tables of them."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Row:
    """One line of the table; ``missed`` says that a goal of the project was not reached."""

    what: str
    measured: str
    compared: str = ""
    goal: str = ""
    missed: bool = False

    @property
    def cells(self) -> tuple[str, str, str, str]:
        verdict = f"{self.goal} {'MISSED' if self.missed else 'ok'}" if self.goal else ""
        return self.what, self.measured, self.compared, verdict


HEADS = ("what", "measured", "compared", "goal")


def interleaved(
    runs: Mapping[str, Callable[[], float]],
    n_rounds: int,
    typical: Callable[[Sequence[float]], float] = median,
) -> dict[str, float]:
    """Return the median of what each run returned over rounds in which all take their turn.

    ``typical=min`` where a busy machine would drown a small difference of two long runs.
    """
    found: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(n_rounds):
        for name, run in runs.items():
            found[name].append(run())
    return {name: typical(values) for name, values in found.items()}


def timed(run: Callable[[], object]) -> float:
    """Return the seconds that a call takes by the clock on the wall."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def worked(run: Callable[[], object]) -> float:
    """Return the seconds of processor time that a call takes, with the programs that it runs.

    What waits for nothing is measured by it: a busy machine matters less.
    """
    start = _processor_s()
    run()
    return _processor_s() - start


def _processor_s() -> float:
    programs = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + programs.ru_utime + programs.ru_stime


def milliseconds(seconds: float) -> str:
    return f"{seconds * 1e3:,.1f} ms" if seconds < 1 else f"{seconds:,.2f} s"


def plain(sections: Mapping[str, Sequence[Row]], titles: Mapping[str, str]) -> str:
    """Return all tables as aligned text."""
    cells = [HEADS, *(row.cells for rows in sections.values() for row in rows)]
    widths = [max(len(line[i]) for line in cells) for i in range(len(HEADS))]

    def line(cells: Sequence[str]) -> str:
        padded = (text.ljust(width) for text, width in zip(cells, widths, strict=True))
        return "  ".join(padded).rstrip()

    parts = [
        "\n".join([titles[name], line(HEADS), *(line(row.cells) for row in rows)])
        for name, rows in sections.items()
    ]
    return "\n\n".join(parts)


def markdown(sections: Mapping[str, Sequence[Row]], titles: Mapping[str, str], machine: str) -> str:
    """Return the document ``docs/benchmarks.md``."""
    head = [
        "# Benchmarks",
        "",
        "Written by `tools/bench --markdown`; one part alone: `tools/bench simulator`. What is",
        "compared was measured in turn in the same rounds. Only the commands under *startup* are",
        "measured by the clock; all else is processor time, that of planner programs included.",
        "Figures are medians; planners, lists of plans, beliefs, and rates not compared show the",
        "best of the rounds.",
        "Ratios travel, times are of this machine:",
        f"{machine}.",
    ]
    for name, rows in sections.items():
        head += ["", f"## {titles[name].capitalize()}", ""]
        head += [f"| {' | '.join(HEADS)} |", "|---|---|---|---|"]
        head += [f"| {' | '.join(row.cells)} |" for row in rows]
    return "\n".join(head)
