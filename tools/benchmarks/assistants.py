"""How long robots think, also of many goals, and what the sweep of the changed-mind study takes.

The forest is used if the user's cache folder has it, or if the environment variable
``HRCPLAN_BENCH_FOREST`` is set (then it is trained, in minutes); else the exact belief about sets
of steps stands for it, and the sweep is left out.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from statistics import median
from typing import Any

import numpy as np
from beliefs import many_goals
from growth import exponent
from rows import Row

from hrcplan.assistance import ASSISTANTS
from hrcplan.assistance.assistant import needs_training
from hrcplan.bank import Bank
from hrcplan.core.files import cache_folder
from hrcplan.episodes.episode import play
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.inference.classifier.cache import key_of, path_of
from hrcplan.inference.classifier.training import N_SAMPLES, N_TREES
from hrcplan.inference.exact import ExactBelief
from hrcplan.studies.changed_mind import STUDY, scenario
from hrcplan.studies.study import Seed

OURS, PAPERS = "hrcplan", "rhp"
PUBLISHED = (PAPERS, "recursive", "cdp", "infogain")
HUMANS = ("fixed", "optimal", "suboptimal")
PROMISED_MS = {PAPERS: (2, 10), OURS: (0.3, None)}  # median, 99th percentile
N_WARM, N_RUNS = 30, 100  # goals and turns of their change; the first are thrown away
N_WARM_SWEPT, N_SWEPT, N_JOBS = 8, 56, 2
SWEEP_S, SWEEP_MB = 600, 1000
MANY, N_ITEMS, N_WANTED, SLOPE = (30, 300, 3_000), 60, 6, 1.1
N_MANY_WARM, N_MANY_RUNS, N_MANY_PLANS = 2, 6, 200

# As `study run --jobs 2` does it: a parent, which has made the forest, and two workers. Resident
# sets are looked at while they work and added up; a page that they share counts for each.
SWEEP = """
import json, os, sys, threading, time
from pathlib import Path
from joblib import Parallel, delayed
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.studies.changed_mind import STUDY, scenario
from hrcplan.studies.study import Seed

def work(run, humans, methods):
    table, options, spent = STUDY.tables[0], STUDY.with_defaults({}), {}
    for human in humans:
        for method in methods:
            began = time.process_time()
            table.episode(options, (human, method), Seed(0, run))
            spent[method] = spent.get(method, 0) + time.process_time() - began
    return os.getpid(), time.process_time(), spent

def megabytes(folder):
    try:
        said = dict(line.split(":", 1) for line in (folder / "status").open())
    except OSError:
        return 0  # it has just ended
    if os.getpid() not in (int(said["Pid"]), int(said["PPid"])):
        return 0
    return int(said.get("VmRSS", "0 kB").split()[0]) * 1024 / 1e6

def watch():
    while True:
        sums.append(sum(map(megabytes, Path("/proc").glob("[0-9]*"))))
        time.sleep(0.2)

sums, (humans, methods, n_runs, n_jobs) = [], json.loads(sys.argv[1])
ForestBelief(scenario.bank_of(**{key: STUDY.options[key] for key in ("domain", "goals")}))
threading.Thread(target=watch, daemon=True).start()
calls = (delayed(work)(run, humans, methods) for run in range(n_runs))
found = Parallel(n_jobs=n_jobs, batch_size=1)(calls)
print(json.dumps([max(sums), found]))
"""


@dataclass
class Timed:
    """A robot whose work is noted, in seconds of processor time.

    ``turns`` is what each decision took with all since the one before: what the robot and then the
    human did was taken in, and the goal guessed.
    """

    robot: Any
    decisions: list[float] = field(default_factory=list)
    turns: list[float] = field(default_factory=list)
    _spent: float = 0.0

    def start(self) -> Any:
        return self.robot.start()

    def observe(self, state: Any, step: int, *, robot: bool = False) -> Any:
        return self._noted(partial(self.robot.observe, state, step, robot=robot))

    def posterior(self, state: Any) -> Any:
        return self._noted(partial(self.robot.posterior, state))

    def choose(self, state: Any) -> Any:
        before = self._spent
        found = self._noted(partial(self.robot.choose, state))
        self.decisions.append(self._spent - before)
        self.turns.append(self._spent)
        self._spent = 0.0
        return found

    def _noted(self, call: Callable[[], Any]) -> Any:
        began = time.process_time()
        found = call()
        self._spent += time.process_time() - began
        return found


def rows() -> Iterator[Row]:
    """Yield times of decisions, of whole turns, of the sweep, and their growth."""
    task = STUDY.options["domain"], STUDY.options["goals"]
    bank = scenario.bank_of(*task)
    has_forest = bool(os.environ.get("HRCPLAN_BENCH_FOREST")) or _is_kept(bank)
    whole = []
    for method in (PAPERS, OURS, *PUBLISHED[1:]):
        robot = _robot(method, bank, has_forest)
        name = _name(method, has_forest)
        timed, clock = _watched(bank, robot)
        yield _decisions(f"{name}, {len(bank.names)} goals", method, timed, clock)
        if method in PROMISED_MS:
            whole.append(_turns(name, timed))
    yield from whole
    if has_forest:
        yield from _sweep(bank)
    else:
        yield Row("the changed-mind study's sweep", "not measured", "there is no forest")
    yield from _growth()


def _is_kept(bank: Bank) -> bool:
    folder = cache_folder()
    key = key_of(bank, 0, N_SAMPLES, N_TREES)
    return folder is not None and path_of(folder, key).exists()


def _robot(method: str, bank: Bank, has_forest: bool, **changes: Any) -> Any:
    kind = ASSISTANTS.find(method)
    if getattr(kind, "learns", False) and not has_forest:
        changes["belief"] = "presence" if method == PAPERS else ExactBelief(bank)
    return kind(bank, **changes)


def _name(method: str, has_forest: bool) -> str:
    if not needs_training(ASSISTANTS.find(method)):
        return method
    return f"{method}, {'forest' if has_forest else 'exact belief'}"


def _watched(bank: Bank, robot: Any) -> tuple[Timed, list[float]]:
    """Return what a robot did on real episodes, and its decisions by the clock, in ms."""
    timed, clock = Timed(robot), list[float]()
    for run in range(N_WARM + N_RUNS):
        if run == N_WARM:
            timed, clock = Timed(robot), []
        for human in HUMANS[1:]:
            course = scenario.course(human, bank, Seed(1, run))
            clock += play(bank, Frontier(bank, course), timed, course).decisions_ms
    return timed, clock


def _decisions(what: str, method: str, timed: Timed, clock: Sequence[float]) -> Row:
    middle, late = _spread(timed.decisions)
    limits = zip(PROMISED_MS.get(method, ()), ("median", "p99"), (middle, late), strict=False)
    promised = [(limit, name, found) for limit, name, found in limits if limit is not None]
    return Row(
        f"{what}, {len(clock):,} decisions",
        f"median {middle:.3f} ms, p99 {late:.3f} ms",
        f"by the clock: median {median(clock):.3f} ms, p99 {np.percentile(clock, 99):.3f} ms",
        ", ".join(f"{name} <= {limit:g} ms" for limit, name, _ in promised),
        any(found > limit for limit, _, found in promised),
    )


def _turns(name: str, timed: Timed) -> Row:
    middle, late = _spread(timed.turns)
    measured = f"median {middle:.3f} ms, p99 {late:.3f} ms"
    return Row(f"{name}, two steps taken in, a guess, a decision", measured)


def _spread(seconds: Sequence[float]) -> tuple[float, float]:
    """Return median and 99th percentile, in ms."""
    ms = np.array(seconds) * 1e3
    return float(np.median(ms)), float(np.percentile(ms, 99))


def _sweep(bank: Bank) -> Iterator[Row]:
    """Yield what all episodes of the published methods take, and the memory of some of them."""
    said = json.dumps([HUMANS, PUBLISHED, N_SWEPT, N_JOBS])
    argv = [sys.executable, "-c", SWEEP, said]
    done = subprocess.run(argv, capture_output=True, text=True, check=True)
    mb, found = json.loads(done.stdout)
    each = {
        method: sum(spent[method] for _, _, spent in found[N_WARM_SWEPT:])
        / (len(found) - N_WARM_SWEPT) / len(HUMANS)
        for method in PUBLISHED
    }  # fmt: skip
    n = scenario.runs(STUDY.with_defaults({})) * len(HUMANS) * len(PUBLISHED)
    episodes_s = sum(each.values()) / len(PUBLISHED)
    ends = {pid: used for pid, used, _ in found}  # the last one that each worker said
    n_played = len(found) * len(HUMANS) * len(PUBLISHED)
    start_s = (sum(ends.values()) - episodes_s * n_played) / len(ends)
    total = n * episodes_s / N_JOBS + max(0.0, start_s)
    parts = ", ".join(f"{method} {seconds * 1e3:.0f}" for method, seconds in each.items())
    yield Row(
        f"the changed-mind study's sweep, {n:,} episodes on {N_JOBS} processes",
        f"{total:,.0f} s",
        f"from {episodes_s * 1e3:.1f} ms each ({parts}), and {start_s:.1f} s to start",
        f"<= {SWEEP_S} s",
        total > SWEEP_S,
    )
    compared = f"while {n_played} episodes were played"
    what = f"its largest resident sets, of {N_JOBS} workers and their parent"
    yield Row(what, f"{mb:,.0f} MB", compared, f"<= {SWEEP_MB:,} MB", mb > SWEEP_MB)


def _growth() -> Iterator[Row]:
    """Yield times of decisions by the number of goals, with the exponent since the size before."""
    last: dict[str, tuple[int, float]] = {}
    for n in MANY:
        bank = many_goals(n, N_ITEMS, N_WANTED)
        for method in (OURS, PAPERS):
            changes = {"n_sampled": N_MANY_PLANS} if method == PAPERS else {}
            timed = _among_many(bank, _robot(method, bank, has_forest=False, **changes))
            seconds = median(timed.decisions)
            power = exponent(last[method], n, seconds) if method in last else None
            guesses = f"{_spread(timed.turns)[0]:.2f} ms with two steps taken in and a guess"
            yield Row(
                f"{_name(method, has_forest=False)}, {n:,} generated goals",
                f"{seconds * 1e3:.3f} ms",
                guesses if power is None else f"{guesses}; decisions grow as n^{power:.2f}",
                "" if power is None else f"<= n^{SLOPE}",
                power is not None and power > SLOPE,
            )
            last[method] = n, seconds


def _among_many(bank: Bank, robot: Any) -> Timed:
    """Return what a robot did on episodes in which the goal changes once."""
    timed = Timed(robot)
    for run in range(N_MANY_WARM + N_MANY_RUNS):
        if run == N_MANY_WARM:
            timed = Timed(robot)
        chance = random.Random(run)
        goals = tuple(chance.sample(range(len(bank.names)), 2))
        turns = (chance.randint(1, N_WANTED),)
        for mistake_rate in (0.0, 0.1):
            course = Course(goals, turns, mistake_rate, seed=str(run))
            play(bank, Frontier(bank, course), timed, course)
    return timed
