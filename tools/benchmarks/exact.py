"""How long ``exact`` needs to prove larger tasks."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from rows import Row, milliseconds, worked

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.solve import Result, solve


def rows() -> Iterator[Row]:
    """Yield the time to a checked proof, loading not counted."""
    for name, most in (("two-boxes", 2), ("handover", 2), ("boxes-3", 2), ("boxes-4", 10)):
        found: list[Result] = []
        seconds = worked(partial(_prove, read("transport", name), found))
        goal = f"proven within {most} s"
        proven = found[0].status.value == "solved-optimally"
        yield Row(
            f"transport/{name}",
            milliseconds(seconds),
            f"{found[0].status.value}, metric {float(found[0].objective or 0):g}",
            goal,
            seconds > most or not proven,
        )


def _prove(problem: Problem, found: list[Result]) -> None:
    found.append(solve(problem, "exact"))
