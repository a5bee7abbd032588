"""How robots do in the team domains of tests/data/teams, beside the targets that are written there.

    .venv/bin/python tools/bench_teams.py [N_COURSES [CHOOSER,... [ROBOT,... [DOMAIN,...]]]]

Courses are those of the seeds in targets.toml, so the first N are the same in every run. The
forest of `rhp`, `cdp` and `infogain` is trained once for each domain, in minutes.
"""

from __future__ import annotations

import random
import resource
import sys
import time
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from hrcplan.assistance import ASSISTANTS
from hrcplan.bank import Bank, build_bank
from hrcplan.bank.cost_to_go import cost_to_go_of
from hrcplan.episodes.episode import REACHED, STUCK, EpisodeRecord, play
from hrcplan.episodes.humans import HUMANS, Course

FOLDER = Path(__file__).parent.parent / "tests" / "data" / "teams"
ORACLE = "oracle"
ROBOTS = (ORACLE, "hrcplan", "recursive", "recursive-best", "rhp", "cdp", "infogain")


def course(bank: Bank, kind: str, seed: int, mistake_rate: float) -> Course:
    """Return the goals of a human, and the turn at which it changes the first one."""
    chance = random.Random(f"{seed}/{kind}")
    first, second = chance.sample(range(len(bank.names)), 2)
    rounds = int(bank.graphs[first].optimal_cost or 1) // len(bank.team)
    turn = chance.randint(1, max(1, rounds - 1))
    rate = mistake_rate if kind == "suboptimal" else 0.0
    if kind == "fixed":
        return Course((first,), (), rate, 0.0, str(seed))
    return Course((first, second), (turn,), rate, 0.0, str(seed))


def row(records: list[EpisodeRecord], oracle: list[EpisodeRecord]) -> str:
    """Return a line of figures of one robot."""
    can = [r.is_reachable and o.is_reachable for r, o in zip(records, oracle, strict=True)]
    gap = [r.cost - o.cost for r, o, ok in zip(records, oracle, can, strict=True) if ok]
    open_ = [r for r in records if r.is_reachable]
    reached = 100 * np.mean([r.ending == REACHED for r in open_])
    stuck = 100 * np.mean([r.ending == STUCK for r in open_])
    lost = 100 * np.mean([not r.is_reachable for r in records])
    decisions = [ms for r in records for ms in r.decisions_ms]
    return (
        f"{reached:.1f} | {stuck:.1f} | {lost:.1f} | {np.mean([r.cost for r in open_]):.2f} | "
        f"{np.mean(gap):+.2f} | {np.median(decisions):.2f}"
    )


def main(
    n: int | None, choosers: list[str] | None, names: list[str], domains: list[str] | None
) -> None:
    """Print a table for every domain."""
    spec: dict[str, Any] = tomllib.loads((FOLDER / "targets.toml").read_text("utf-8"))
    first, last = spec["seeds"]
    seeds = range(first, last + 1)[:n]
    for name in domains or spec["domains"]:
        began = time.monotonic()
        bank = build_bank(str(FOLDER / name / "domain.pddl"), str(FOLDER / name))
        costs = cost_to_go_of(bank)  # kept while it is in use
        robots = {robot: ASSISTANTS.make(robot, bank) for robot in dict.fromkeys((ORACLE, *names))}
        costs.of(0, 0), costs.of(0, 0, with_robots=False)
        mib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        print(f"{name}: {time.monotonic() - began:.0f} s, {mib} MiB so far", flush=True)
        for chooser in choosers or spec["choosers"]:
            for human in spec["humans"]:
                courses = [course(bank, human, seed, spec["mistake_rate"]) for seed in seeds]
                oracle: list[EpisodeRecord] = []
                for robot, assistant in robots.items():
                    follow = HUMANS.find(chooser)
                    records = [play(bank, follow(bank, c), assistant, c) for c in courses]
                    oracle = oracle or records
                    cells = f"{name} | {chooser} | {human} | {robot}"
                    print(f"| {cells} | {row(records, oracle)} |", flush=True)


if __name__ == "__main__":
    words = sys.argv[1:]
    main(
        int(words[0]) if words else None,
        words[1].split(",") if len(words) > 1 else None,
        words[2].split(",") if len(words) > 2 else list(ROBOTS),
        words[3].split(",") if len(words) > 3 else None,
    )
