"""How long ``exact`` needs to prove larger tasks, of two agents and of three."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from rows import Row, milliseconds, worked

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Status
from hrcplan.planners.solve import Result, solve

TWO = {"two-boxes": 2, "handover": 2, "boxes-3": 2, "boxes-4": 4, "boxes-5": 8, "boxes-6": 60}
THREE = {"two-boxes": 2, "boxes-3": 8, "boxes-4": 60, "boxes-5": 60}
NEW = "helper"


def rows() -> Iterator[Row]:
    """Yield the time to a checked proof, loading not counted."""
    for name, most_s in TWO.items():
        yield _row(f"transport/{name}", read("transport", name), most_s)
    for name, most_s in THREE.items():
        problem = with_helper(read("transport", name))
        yield _row(f"transport/{name}, three agents", problem, most_s)


def with_helper(problem: Problem) -> Problem:
    """Return a problem of transport with one more agent, which starts as the robot does."""
    copies = {
        (predicate, *[NEW if name == old else name for name in names])
        for predicate, *names in problem.facts
        for old in ("robot", "human")
        if predicate == "partner" or (old == "robot" and predicate != "controllable")
    }
    values = {
        (function, NEW, *rest): value
        for (function, *names), value in problem.values.items()
        if names
        for agent, *rest in [names]
        if agent == "robot"
    }
    return replace(
        problem,
        objects={**problem.objects, NEW: "agent"},
        facts=problem.facts | copies,
        values={**problem.values, **values},
    )


def _row(what: str, problem: Problem, most_s: float) -> Row:
    results: list[Result] = []
    seconds = worked(partial(_prove, problem, results))
    result = results[0]
    return Row(
        what,
        milliseconds(seconds),
        f"{result.status.value}, metric {float(result.objective or 0):g}",
        f"proven within {most_s} s",
        seconds > most_s or result.status is not Status.OPTIMAL,
    )


def _prove(problem: Problem, results: list[Result]) -> None:
    results.append(solve(problem, "exact", timeout_s=120))
