"""``hrcplan plan --any`` beside planners that are called directly on the same files."""

from __future__ import annotations

import random
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TOTAL_COST, Problem
from hrcplan.planners.enhsp import _FIRST as ENHSP_SEARCH
from hrcplan.planners.enhsp import _JAR, _inside, find_java
from hrcplan.planners.fast_downward import _FIRST as DOWNWARD_SEARCH
from hrcplan.planners.fast_downward import _SCRIPT, find_binary
from public_pddl.archive import Pair

OVERRUN_S = 1
LATE_S = 15
"""How long after its limit a call is ended."""
REPEATS = 2
"""Rounds of all calls of a task, one after the other; the quickest of each counts."""
OURS = "hrcplan"
KINDS = ("STRIPS", "ADL", "numeric", "temporal", "derived", "timed")


@dataclass(frozen=True)
class Run:
    """Seconds of one call by the clock and of processor time, and whether it came with a plan."""

    solved: bool
    elapsed_s: float
    cpu_s: float


def language(problem: Problem) -> str:
    """Return the part of PDDL that decides which planners can be called."""
    domain = problem.domain
    if problem.timed:
        return "timed"
    if domain.is_temporal:
        return "temporal"
    if domain.axioms:
        return "derived"
    if domain.changed_functions - {TOTAL_COST}:
        return "numeric"
    text = Path(domain.path).read_text(errors="replace").lower()
    return (
        "ADL" if any(word in text for word in ("(forall", "(exists", "(when", "(or")) else "STRIPS"
    )


def commands(pair: Pair, kind: str, limit_s: float) -> dict[str, list[str]]:
    """Return the calls of the planners that take a task of this kind."""
    files = [str(pair.domain), str(pair.problem)]
    python = Path(sys.executable)
    limit = ["--timeout", f"{limit_s:g}"]
    calls = {
        OURS: [str(python.with_name("hrcplan")), "plan", "--any", *limit, *files],
        "kairos": [str(python.with_name("kairos")), "solve", *files, "--no-anytime", *limit],
    }
    if kind in ("ADL", "STRIPS", "derived"):
        script = _SCRIPT.replace("domain.pddl problem.pddl", '"$3" "$4"')
        program = ["/bin/sh", "-c", script, str(python), str(find_binary()), DOWNWARD_SEARCH]
        calls["fast-downward"] = [*program, *files]
    if kind == "numeric":
        jar = ["-jar", str(_inside("up_enhsp", _JAR)), "-o", files[0], "-f", files[1]]
        calls["enhsp"] = [str(find_java()), *jar, *ENHSP_SEARCH]
    return calls


def call(argv: Sequence[str], folder: Path, limit_s: float) -> Run:
    """Return what one call did; a planner without a limit of its own is ended some time later."""
    start, worked = time.perf_counter(), _processor_s()
    try:
        done = subprocess.run(argv, cwd=folder, capture_output=True, timeout=limit_s + LATE_S)
        solved = done.returncode == 0
        solved &= b"Problem unsolvable" not in done.stdout
        solved &= b"SEVERE" not in done.stdout + done.stderr  # ENHSP failed on the way
    except subprocess.TimeoutExpired:
        solved = False
    return Run(solved, time.perf_counter() - start, _processor_s() - worked)


def _processor_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def tasks(readable: Sequence[Pair], n: int, seed: int) -> list[tuple[str, Pair]]:
    """Return ``n`` tasks, as many of each kind as there are."""
    kinds: dict[str, list[Pair]] = {kind: [] for kind in KINDS}
    for pair in random.Random(seed).sample(readable, len(readable)):
        part = kinds[language(read(pair.domain, pair.problem))]
        if len(part) <= n // len(kinds):
            part.append(pair)
    rows = [(kind, part[i]) for i in range(n) for kind, part in kinds.items() if i < len(part)]
    return rows[:n]


def report(readable: Sequence[Pair], n: int, seed: int, limit_s: float) -> None:
    """Print each task's seconds, then who solves how many, and what hrcplan adds."""
    print("\n| task | kind | hrcplan | best planner alone |\n|---|---|---|---|")
    results = list[tuple[Run, Run]]()
    for kind, pair in tasks(readable, n, seed):
        with TemporaryDirectory() as folder:
            calls = commands(pair, kind, limit_s)
            rounds = [
                {name: call(argv, Path(folder), limit_s) for name, argv in calls.items()}
                for _ in range(REPEATS)
            ]
        runs = {name: _quickest([runs[name] for runs in rounds]) for name in calls}
        ours = runs.pop(OURS)
        name = min(runs, key=lambda name: (not runs[name].solved, runs[name].elapsed_s))
        results.append((ours, runs[name]))
        print(f"| {pair.domain.parent.name}/{pair.problem.stem} | {kind} | {_cell(ours)} ", end="")
        print(f"| {name} {_cell(runs[name])} |", flush=True)
    _summary(results, limit_s)


def _quickest(runs: Sequence[Run]) -> Run:
    """Return the least of both times over several calls that solve the task, if any does."""
    best = [run for run in runs if run.solved] or runs
    return Run(best[0].solved, min(r.elapsed_s for r in best), min(r.cpu_s for r in best))


def _cell(run: Run) -> str:
    times = f"{run.elapsed_s:.2f} s ({run.cpu_s:.2f} s of processor time)"
    return times if run.solved else f"none in {times}"


def _summary(results: Sequence[tuple[Run, Run]], limit_s: float) -> None:
    ours, best = (sum(runs[i].solved for runs in results) for i in range(2))
    both = [(a, b) for a, b in results if a.solved and b.solved]
    late = [a.elapsed_s for a, _ in results if a.elapsed_s > limit_s + OVERRUN_S]
    print(
        f"\nsolved: hrcplan {ours}, the best planner of each task {best}, both {len(both)} ", end=""
    )
    print(f"of {len(results)}; limit overrun by more than {OVERRUN_S} s: {len(late)}")
    if both:
        _added("by the clock", [(a.elapsed_s, b.elapsed_s) for a, b in both])
        _added("of processor time", [(a.cpu_s, b.cpu_s) for a, b in both])


def _added(kind: str, times: Sequence[tuple[float, float]]) -> None:
    added = [ours - best for ours, best in times]
    near = median(ours - 1.2 * best for ours, best in times)
    within = sum(ours <= 2 * best + 1 for ours, best in times)
    print(f"added {kind}: median {median(added):.2f} s, at most {max(added):.2f} s; ", end="")
    print(f"median beyond 1.2 times the best {near:.2f} s; ", end="")
    print(f"within twice + 1 s: {within} of {len(times)}", flush=True)
