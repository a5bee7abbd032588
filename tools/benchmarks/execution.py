"""Simulated runs of failure anticipation, and the replans inside them."""

from __future__ import annotations

import resource
from collections.abc import Iterator
from statistics import median

from rows import Row, milliseconds, worked

from hrcplan.execution import Spec, engine_for, simulate

N_RUNS = 50
CASES = [(case, model) for case in (1, 2) for model in (False, True)]
MOST_REPLAN_S = 0.02
MOST_RUN_S = 2 * 180 / 4000  # two cores, three minutes, 1000 runs of four cases
MOST_MB = 500


def rows() -> Iterator[Row]:
    """Yield seconds per run of each profile, the replans' median, and the memory used."""
    for profile in ("replan-always", "hrcplan"):
        taken = worked(lambda profile=profile: _run_all(profile)) / (N_RUNS * len(CASES))
        yield Row(
            f"a simulated run, profile {profile}, cases 1a to 2b",
            milliseconds(taken), "", f"<= {milliseconds(MOST_RUN_S)}", taken > MOST_RUN_S,
        )  # fmt: skip
    walls = engine_for(Spec()).planner.wall_s
    yield Row(
        f"replan inside the executor, median of {len(walls)}", milliseconds(median(walls)),
        f"slowest {milliseconds(max(walls))}", "<= 20 ms", median(walls) > MOST_REPLAN_S,
    )  # fmt: skip
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    yield Row("memory of the process", f"{used} MB", "", f"<= {MOST_MB} MB", used > MOST_MB)


def _run_all(profile: str) -> None:
    for case, model in CASES:
        for run in range(N_RUNS):
            simulate(Spec(case=case, model=model, profile=profile, seed=f"bench/{run}"))
