"""``tools/fuzz``: mutated inputs by kind, seed and number; exit 1 if anything is wrong."""

from __future__ import annotations

import argparse
import os
import resource
import tempfile
from pathlib import Path

from fuzzing import branches
from fuzzing.campaign import Outcome, campaign
from fuzzing.files import TOKENISED
from fuzzing.targets import TARGETS

MEMORY = 4 << 30
"""Bytes of address space that a run may use."""


def main() -> int:
    """Run the campaigns that are asked for and print what came out."""
    parser = argparse.ArgumentParser(prog="tools/fuzz", description=__doc__)
    parser.add_argument("--n", type=int, default=200, help="mutants per kind (default 200)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--kind", action="append", choices=list(TARGETS), help="repeatable")
    parser.add_argument("--coverage", action="store_true", help="report branches (5 times slower)")
    options = parser.parse_args()
    wrong = 0
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))  # what needs more is a fault
    memory_disk = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # faster
    with tempfile.TemporaryDirectory(prefix="hrcplan-fuzz-", dir=memory_disk) as name:
        os.environ["HRCPLAN_CACHE"] = f"{name}/cache"
        os.chdir(name)
        with branches.recorded(options.coverage) as arcs:
            for kind in options.kind or TARGETS:
                found = campaign(kind, options.n, options.seed, Path(name), options.first)
                wrong += show(found, options.seed)
    if options.coverage:
        print(branches.report(arcs))
    return 1 if wrong else 0


def show(found: Outcome, seed: int) -> int:
    """Print the outcome of one kind and return how many mutants went wrong."""
    wrong = sum(times for times, _ in found.faults.values())
    typed = sum(found.typed.values())
    print(f"{found.kind:13} {found.n} mutants: {found.n_accepted} accepted, {typed} typed errors, "
          f"{wrong} wrong; slowest {found.slowest_s:.1f} s", flush=True)  # fmt: skip
    if found.kind in ("pddl", "public", "tree"):
        print(f"{'':13} {TOKENISED['yes'] / max(1, sum(TOKENISED.values())):.0%} can be tokenised")
    codes = ", ".join(f"{code} {times}" for code, times in found.typed.most_common(5))
    print(f"{'':13} {codes}" if codes else "", end="\n" if codes else "")
    for place, (times, first) in sorted(found.faults.items()):
        again = f"tools/fuzz --kind {found.kind} --seed {seed} --first {first} --n 2"
        print(f"  {times} x {place}\n      again: {again}")
    return wrong


if __name__ == "__main__":
    raise SystemExit(main())
