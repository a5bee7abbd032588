"""Goal recognition on folders of Ramírez and Geffner's format, beside published methods.

    tools/bench_goal_recognition.py FOLDER [--method cost] [--cross-validate]

FOLDER holds one folder per domain, and these one per instance. The protocol is that of Wilken et
al. (ECAI 2024): the first floor(f T) + 1 actions are seen; accuracy is 1/n if the true goal is
among the n likeliest, else 0; spread is n; f = 1 is computed with .99. Instances of a domain weigh
the same, and so do domains. With --cross-validate the settings of method cost are chosen for each
domain by the accuracy on the others.

Published figures: their per-step scores (github.com/nilsWilken,
Fact-Observation-Probability-Based-Goal-Recognition_ECAI24, MIT), on the development instances only.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from statistics import median

from hrcplan.bank.ramirez_geffner import RecognitionInstance, read_instance
from hrcplan.inference import infer
from hrcplan.inference.observations import Resolver
from hrcplan.inference.recognition.cost import CostBelief
from hrcplan.inference.run import run
from hrcplan.search.relaxed_plans import RelaxedPlans, RelaxedPlanShares

FRACTIONS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99)
GRID = {"new_fact": (1.0, 2.0, 3.0), "in_plan": (1.0, 2.0, 3.0, 4.0), "mistakes": (0.02, 0.05, 0.1)}
Row = tuple[float, ...]

# Accuracy at .1 .2 .3 .5 .7 .9 1, then the mean spread over ten fractions.
PUBLISHED: dict[str, dict[str, Row]] = {
    "blocks-world": {
        "MS": (0.07, 0.09, 0.09, 0.33, 0.45, 0.55, 0.55, 6.7),
        "RG09": (0.06, 0.21, 0.21, 0.40, 0.56, 0.84, 0.94, 4.5),
        "LP": (0.05, 0.18, 0.18, 0.48, 0.45, 0.84, 0.91, 5.1),
        "PLR": (0.12, 0.12, 0.12, 0.12, 0.12, 0.35, 0.38, 1.8),
        "FPV": (0.12, 0.25, 0.12, 0.44, 0.62, 0.81, 0.88, 1.7),
    },
    "easy-ipc-grid": {
        "MS": (0.35, 0.28, 0.40, 0.71, 0.77, 0.88, 1.0, 2.5),
        "RG09": (0.41, 0.42, 0.50, 0.62, 0.77, 0.88, 1.0, 2.8),
        "LP": (0.13, 0.19, 0.28, 0.33, 0.45, 0.75, 0.88, 3.4),
        "PLR": (0.0, 0.0, 0.25, 0.38, 0.62, 0.62, 1.0, 1.0),
        "FPV": (0.38, 0.50, 0.50, 0.62, 0.88, 0.94, 1.0, 1.0),
    },
    "kitchen": {
        "MS": (0.86, 0.86, 0.93, 0.86, 0.86, 0.93, 0.93, 1.1),
        "RG09": (0.73, 0.81, 0.88, 0.94, 0.94, 0.81, 0.81, 1.2),
        "LP": (0.58, 0.65, 0.71, 0.94, 0.77, 0.62, 0.62, 1.5),
        "PLR": (0.38, 0.38, 0.29, 0.50, 0.50, 0.62, 0.62, 1.5),
        "FPV": (0.88, 0.88, 0.94, 1.0, 1.0, 0.88, 0.88, 1.1),
    },
    "logistics": {
        "MS": (0.32, 0.33, 0.35, 0.69, 0.81, 1.0, 1.0, 1.3),
        "RG09": (0.34, 0.49, 0.68, 0.79, 0.79, 0.94, 1.0, 1.9),
        "LP": (0.15, 0.34, 0.35, 0.43, 0.68, 0.68, 0.68, 4.0),
        "PLR": (0.06, 0.06, 0.19, 0.67, 0.92, 1.0, 1.0, 1.3),
        "FPV": (0.16, 0.39, 0.52, 0.92, 0.92, 1.0, 1.0, 1.2),
    },
}


def instances(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield (domain, instance folder) in order."""
    for place in sorted(folder.glob("*/obs.dat")) + sorted(folder.glob("*/*/obs.dat")):
        yield place.parent.parent.name, place.parent


def accuracies(posterior: Sequence[Sequence[float]], true: int | None) -> Row:
    """Return the accuracy at each fraction; the prior is the first row of ``posterior``."""
    n = len(posterior) - 1
    return tuple(_right(posterior[int(f * n) + 1], true) for f in FRACTIONS)


def scored(folder: Path, method: str) -> tuple[Row, float]:
    """Return accuracies and mean spread of an instance, and the seconds of the whole call."""
    began = time.perf_counter()
    inference = infer(str(folder), method=method)
    wall_s = time.perf_counter() - began
    n = len(inference.actions)
    tens = [int(min(f / 10, 0.99) * n) + 1 for f in range(1, 11)]
    spread = sum(_n_best(inference.posterior[k]) for k in tens) / len(tens)
    true = read_instance(folder).true_goal
    return (*accuracies(inference.posterior, true), spread), wall_s


class _Remembered(RelaxedPlans):
    """Relaxed plans that are looked up, for other settings on the same states."""

    def __init__(self, plans: RelaxedPlans) -> None:
        self.__dict__.update(plans.__dict__)
        self._memory: dict[int, RelaxedPlanShares] = {}

    def shares(self, state: int) -> RelaxedPlanShares:
        """Return the shares, which are computed once."""
        if state not in self._memory:
            self._memory[state] = super().shares(state)
        return self._memory[state]


def cross_validate(folder: Path) -> None:
    """Print for each domain the settings that are best on the others, and what they reach."""
    scores: dict[tuple[float, ...], dict[str, list[float]]] = {}
    for domain, place in instances(folder):
        instance = read_instance(place)
        plans: RelaxedPlans | None = None
        for setting in product(*GRID.values()):
            belief = CostBelief(instance.goals, **dict(zip(GRID, setting, strict=True)))
            plans = belief.plans = plans or _Remembered(belief.plans)
            row = accuracies(_posterior(belief, instance), instance.true_goal)
            by_domain = scores.setdefault(setting, {})
            by_domain.setdefault(domain, []).append(sum(row) / len(row))
    means = {s: {d: sum(v) / len(v) for d, v in rows.items()} for s, rows in scores.items()}
    domains = list(next(iter(means.values())))
    print(f"{'without':<16}{' '.join(GRID)}   there   here")
    here = []
    for held_out in domains:
        there = {s: sum(v for d, v in row.items() if d != held_out) for s, row in means.items()}
        best = max(there, key=lambda s: there[s])
        here.append(means[best][held_out])
        print(f"{held_out:<16}{best}   {there[best] / (len(domains) - 1):.3f}   {here[-1]:.3f}")
    print(f"mean of what was held out: {sum(here) / len(here):.3f}")
    for setting, row in sorted(means.items(), key=lambda item: -sum(item[1].values()))[:10]:
        print(setting, f"{sum(row.values()) / len(row):.3f}")


def _posterior(belief: CostBelief, instance: RecognitionInstance) -> Sequence[Sequence[float]]:
    resolver = Resolver(belief.steps, instance.goals)
    return run(belief, resolver, instance.observations, "cost").posterior


def _n_best(posterior: Sequence[float]) -> int:
    return posterior.count(max(posterior)) if isinstance(posterior, tuple) else 0


def _right(posterior: Sequence[float], true: int | None) -> float:
    best = [goal for goal, p in enumerate(posterior) if p == max(posterior)]
    return 1 / len(best) if true in best else 0.0


def _mean(rows: Sequence[Row]) -> Row:
    return tuple(sum(column) / len(column) for column in zip(*rows, strict=True))


def _line(domain: str, method: str, row: Row) -> str:
    return f"{domain:<16}{method:<10}" + " ".join(f"{value:5.2f}" for value in row)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--method", default="cost")
    parser.add_argument("--cross-validate", action="store_true")
    args = parser.parse_args()
    if args.cross_validate:
        cross_validate(args.folder)
        return
    ours: dict[str, list[Row]] = {}
    walls_s: list[float] = []
    for domain, folder in instances(args.folder):
        row, wall_s = scored(folder, args.method)
        ours.setdefault(domain, []).append(row)
        walls_s.append(wall_s)
        print(_line(domain, f"{wall_s:.1f} s", row), folder.name, flush=True)
    heads = " ".join(f"{f:5}" for f in (".1", ".2", ".3", ".5", ".7", ".9", "1", "S"))
    print(f"\n{'domain':<16}{'method':<10}{heads}")
    means = {domain: _mean(rows) for domain, rows in ours.items()}
    for domain, row in means.items():
        print(_line(domain, "hrcplan", row))
        for method, published in PUBLISHED.get(domain, {}).items():
            print(_line(domain, method, published))
    every = _mean(list(means.values()))
    print(_line("all", "hrcplan", every))
    if means.keys() <= PUBLISHED.keys():
        for method in next(iter(PUBLISHED.values())):
            print(_line("all", method, _mean([PUBLISHED[domain][method] for domain in means])))
    print(f"\nmean over the fractions: {sum(every[:-1]) / len(FRACTIONS):.3f}")
    print(f"seconds of an instance: median {median(walls_s):.2f}, most {max(walls_s):.2f}")


if __name__ == "__main__":
    main()
