"""Measure what is promised about speed, side by side in one run.

Figures that are compared are measured in turn in the same rounds, so that a busy machine slows
both. Absolute times are of this machine, ratios travel.
"""

from __future__ import annotations

import argparse
import importlib
import os
import platform
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

from rows import Row, markdown, plain

PARTS = {
    "simulator": "random walks: ours, unified-planning's, pddlgym's",
    "environments": "robots that learn: steps per second, human turns and resets included",
    "startup": "python -c pass, hrcplan --help, hrcplan plan transport/two-boxes",
    "planners": "our planner call over the raw planner",
    "replan": "a changed motivation, proven anew in process",
    "exact": "proofs for two agents and for three",
    "execution": "simulated runs of failure anticipation and their replans",
    "links": "a message to a robot and back",
    "growth": "grounding, walking and validating as tasks grow, to 100,000 ground actions",
    "reach": "editors, layout, unified-planning and tools of language models",
    "bank": "building, sampling, and listing plans beside top-k planners",
    "beliefs": "updates of 30 and of 10,000 goals",
    "words": "phrases of people read as steps, in states of walks",
    "cluster": "a study on two workers of Dask, and on two of joblib",
    "assistants": "decisions of robots, and how they grow with the goals",
}


def main() -> None:
    """Measure the parts that were asked for, print a table, exit 1 if a goal was missed."""
    options = _options()
    warnings.filterwarnings("ignore")
    sections: dict[str, Sequence[Row]] = {}
    for part in options.parts or PARTS:
        print(f"{part} …", file=sys.stderr, flush=True)
        sections[part] = list(importlib.import_module(part).rows())
    titles = {part: f"{part}: {PARTS[part]}" for part in sections}
    print(markdown(sections, titles, _machine()) if options.markdown else plain(sections, titles))
    sys.exit(any(row.missed for found in sections.values() for row in found))


def _options() -> argparse.Namespace:
    listed = "\n".join(f"  {name:10} {what}" for name, what in PARTS.items())
    parser = argparse.ArgumentParser(
        prog="tools/bench",
        description=f"{__doc__}\nparts:\n{listed}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("parts", nargs="*", metavar="PART", help="default: all")
    parser.add_argument("--markdown", action="store_true", help="as docs/benchmarks.md")
    options = parser.parse_args()
    unknown = set(options.parts) - PARTS.keys()
    if unknown:
        parser.error(f"there is no part {', '.join(sorted(unknown))}")
    return options


def _machine() -> str:
    """Return what ran the benchmarks, and how busy it was; no names or paths."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    model = models[0] if models else platform.machine()
    facts = [f"{model}, {len(models)} cores", platform.system()]
    facts.append(f"Python {platform.python_version()}")
    return "; ".join([*facts, f"load average {os.getloadavg()[1]:.1f} while measuring"])


main()
