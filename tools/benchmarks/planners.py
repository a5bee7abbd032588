"""What our call of a planner adds to the planner itself: files, guard, check of the answer."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rows import Row, interleaved, milliseconds, worked

from hrcplan.pddl.inputs import read
from hrcplan.planners import registry
from hrcplan.planners.solve import solve

N_ROUNDS = 7
SHARE, EXTRA_S = 0.1, 0.05
CASES = [  # planner, its module, domain, problem, whether any plan will do
    ("fast-downward", "fast_downward", "kitchen", "smoothie-oat", False),
    ("fast-downward", "fast_downward", "kitchen", "stew-lentil", True),
    ("enhsp", "enhsp", "kitchen", "stew-lentil", True),
]


def rows() -> Iterator[Row]:
    """Yield a checked answer's time against that of the same program on the same files."""
    for planner, module, domain, name, any_plan in CASES:
        if planner not in registry.names():
            continue
        ask = partial(solve, read(domain, name), planner, any_plan=any_plan)
        with TemporaryDirectory() as folder:
            calls = _calls(module, Path(folder), ask)
            runs = {"ours": partial(worked, ask), "raw": partial(worked, partial(_run, calls))}
            found = interleaved(runs, N_ROUNDS, min)
        kind = "any plan" if any_plan else "proof"
        yield _row(f"{planner}, {kind}, {domain}/{name}", found["ours"], found["raw"])
    yield from _kairos()


def _calls(module: str, folder: Path, call: Any) -> list[tuple[list[str], Path]]:
    """Return the programs that a call runs, with copies of the folders it runs them in."""
    adapter = importlib.import_module(f"hrcplan.planners.{module}")
    real, found = adapter.run, list[tuple[list[str], Path]]()

    def recording(argv: Any, *, cwd: Path, **rest: Any) -> Any:
        place = folder / str(len(found))
        shutil.copytree(cwd, place)
        found.append((list(argv), place))
        return real(argv, cwd=cwd, **rest)

    adapter.run = recording
    try:
        call()
    finally:
        adapter.run = real
    return found


def _run(calls: list[tuple[list[str], Path]]) -> None:
    for argv, place in calls:
        subprocess.run(argv, cwd=place, capture_output=True, check=False)


def _kairos() -> Iterator[Row]:
    """Yield the same for kairos, which runs in process: our time around its own."""
    from hrcplan.planners.kairos import _Portfolio

    real, spent = _Portfolio._search, [0.0]

    def measured(*args: Any) -> Any:
        start = time.process_time()
        try:
            return real(*args)
        finally:
            spent[0] += time.process_time() - start

    problem, found = read("transport", "two-boxes"), list[tuple[float, float]]()
    _Portfolio._search = measured  # type: ignore[method-assign]
    try:
        for _ in range(N_ROUNDS):
            spent[0] = 0
            found.append((worked(lambda: solve(problem, "kairos", any_plan=True)), spent[0]))
    finally:
        _Portfolio._search = real  # type: ignore[method-assign]
    ours, raw = min(found)
    yield _row("kairos, any plan, transport/two-boxes", ours, raw)


def _row(what: str, ours: float, raw: float) -> Row:
    most = raw * (1 + SHARE) + EXTRA_S
    compared = f"the planner alone: {milliseconds(raw)}, added {milliseconds(ours - raw)}"
    return Row(what, milliseconds(ours), compared, "<= 10 % + 50 ms", ours > most)
