"""Goal recognition on folders of Ramírez and Geffner's format, beside published methods.

    tools/bench_goal_recognition.py FOLDER [--method cost] [--timeout S]

FOLDER holds one folder per domain, and these one per instance. The protocol is that of Wilken et
al. (ECAI 2024): the first floor(f T) + 1 actions are seen; accuracy is 1/n if the true goal is
among the n likeliest, else 0; spread is n; f = 1 is computed with .99. Instances of a domain weigh
the same, and so do domains. Published figures: their per-step scores (github.com/nilsWilken,
Fact-Observation-Probability-Based-Goal-Recognition_ECAI24, MIT), on the development instances only.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference import infer

FRACTIONS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99)
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


def scored(folder: Path, method: str, timeout_s: float) -> tuple[Row, float]:
    """Return accuracies and mean spread of an instance, and the seconds of the whole call."""
    began = time.perf_counter()
    options = {"timeout_s": timeout_s} if method == "cost" else {}
    found = infer(str(folder), method=method, **options)
    wall_s = time.perf_counter() - began
    true = read_instance(folder).true_goal
    n = len(found.actions)
    rights = [_right(found.posterior[int(f * n) + 1], true) for f in FRACTIONS]
    tens = [int(min(f / 10, 0.99) * n) + 1 for f in range(1, 11)]
    spread = sum(_n_best(found.posterior[k]) for k in tens) / len(tens)
    return (*rights, spread), wall_s


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
    parser.add_argument("--timeout", type=float, default=25.0)
    args = parser.parse_args()
    ours: dict[str, list[Row]] = {}
    slowest = 0.0
    for domain, folder in instances(args.folder):
        row, wall_s = scored(folder, args.method, args.timeout)
        ours.setdefault(domain, []).append(row)
        slowest = max(slowest, wall_s)
        print(_line(domain, f"{wall_s:.1f} s", row), folder.name, flush=True)
    heads = " ".join(f"{f:5}" for f in (".1", ".2", ".3", ".5", ".7", ".9", "1", "S"))
    print(f"\n{'domain':<16}{'method':<10}{heads}")
    means = {domain: _mean(rows) for domain, rows in ours.items()}
    for domain, row in means.items():
        print(_line(domain, "hrcplan", row))
        for method, published in PUBLISHED.get(domain, {}).items():
            print(_line(domain, method, published))
    print(_line("all", "hrcplan", _mean(list(means.values()))))
    if means.keys() <= PUBLISHED.keys():
        for method in next(iter(PUBLISHED.values())):
            print(_line("all", method, _mean([PUBLISHED[domain][method] for domain in means])))
    print(f"\nslowest instance: {slowest:.1f} s")


if __name__ == "__main__":
    main()
