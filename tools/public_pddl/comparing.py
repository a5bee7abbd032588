"""Plans of ``auto`` beside those of each planner alone, asked through hrcplan."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from hrcplan.pddl.inputs import read
from hrcplan.planners import registry
from public_pddl.archive import Pair
from public_pddl.racing import tasks

AUTO = "auto"
SHARE = 0.5
"""The part of the time of ``auto`` that a planner alone has."""
LATE_S = 5


@dataclass(frozen=True)
class Found:
    """The objective of a plan (None without one), whether it is proven, and its bound."""

    value: Fraction | None
    is_proven: bool
    bound: Fraction | None


NOTHING = Found(None, False, None)


def ask(pair: Pair, planner: str, time_s: float) -> Found:
    """Return what a planner finds in time, by the figures of hrcplan."""
    program = str(Path(sys.executable).with_name("hrcplan"))
    words = [program, "plan", "--json", "--planner", planner, "--timeout", str(time_s)]
    files = [str(pair.domain), str(pair.problem)]
    try:
        done = subprocess.run([*words, *files], capture_output=True, timeout=time_s + LATE_S + 10)
        document = json.loads(done.stdout, parse_float=Fraction)
    except (subprocess.TimeoutExpired, ValueError):
        return NOTHING
    if not document.get("valid"):
        return NOTHING
    is_temporal = read(pair.domain, pair.problem).domain.is_temporal
    measure = "makespan_s" if is_temporal else "cost"
    value = document["metric"] if document["metric"] is not None else document[measure]
    value, bound = (None if x is None else Fraction(x) for x in (value, document["bound"]))
    return Found(value, document["status"] == "solved-optimally", bound)


def report(readable: Sequence[Pair], n: int, seed: int, time_s: float) -> None:
    """Print each task's values, then on how many ``auto`` is no costlier than any planner alone."""
    print(f"\n| task | kind | auto, {time_s:g} s | best alone, {SHARE * time_s:g} s | |")
    print("|---|---|---|---|---|")
    n_good = n_tasks = 0
    for kind, pair in tasks(readable, n, seed):
        problem = read(pair.domain, pair.problem)
        maximize = problem.metric is not None and problem.maximize
        ours = ask(pair, AUTO, time_s)
        others = {name: ask(pair, name, SHARE * time_s) for name in registry.BUILT_IN}
        name, best = _best(others, maximize)
        is_good = _is_no_worse(ours, best, maximize)
        n_tasks += ours.value is not None or best.value is not None
        n_good += is_good and (ours.value is not None or best.value is not None)
        verdict = "" if is_good else "costlier"
        print(f"| {pair.domain.parent.name}/{pair.problem.stem} | {kind} | {_cell(ours)} ", end="")
        print(f"| {name} {_cell(best)} | {verdict} |", flush=True)
    print(
        f"\nno costlier than the best planner alone: {n_good} of {n_tasks} that are solved at all"
    )


def _best(others: Mapping[str, Found], maximize: bool) -> tuple[str, Found]:
    sign = -1 if maximize else 1
    solved = {name: f for name, f in others.items() if f.value is not None}
    if not solved:
        return "", NOTHING
    name = min(solved, key=lambda name: sign * (solved[name].value or 0))
    return name, solved[name]


def _is_no_worse(ours: Found, best: Found, maximize: bool) -> bool:
    """Return whether our plan is no worse than the best one of planners alone."""
    if ours.value is None or best.value is None:
        return best.value is None
    return ours.value >= best.value if maximize else ours.value <= best.value


def _cell(found: Found) -> str:
    if found.value is None:
        return "none"
    bound = "" if found.bound is None else f", bound {float(found.bound):g}"
    return f"{float(found.value):g}{' proven' if found.is_proven else bound}"
