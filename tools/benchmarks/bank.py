"""Policy banks: building and sampling the kitchen's, and listing plans against top-k planners."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
from rows import Row, interleaved, milliseconds, worked

from hrcplan.bank import Bank, build, build_bank, from_problems
from hrcplan.bank.enumerated import step_task
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.planners import kstar
from hrcplan.planners.lowering import Lowering, lower
from hrcplan.planners.process import ProcessLimits, run

BUILT_S, BUILT_MB, SAMPLED, OVER = 0.5, 300, 300_000, 10
N_ROUNDS, N_SAMPLED = 3, 200_000
K, SYMK_K = 10_000, 5_000  # SymK takes about 2 ms for each plan, and 2 s to start
LIMITS = ProcessLimits(120.0, memory_bytes=2 << 30, output_bytes=1 << 28)
RECIPE, SAMPLED_GOAL = "smoothie-green", "stew-lentil"
GOALS = {  # parts of the recipe, by the number of steps of their optimal plans
    12: "(and (available glass) (blended yogurt) (blended milk) (blended spinach) (served))",
    16: "(and (available glass) (available measuring-cup) (blended yogurt) (blended milk)"
    " (blended spinach) (blended apple) (served))",
}
# In a process of its own: the largest resident set is that of this one call.
BUILD = """
import time
from pathlib import Path
from hrcplan.bank import build_bank
start = time.process_time()
bank = build_bank("kitchen")
print(len(bank.names), time.process_time() - start)
print(*(line.split()[1] for line in Path("/proc/self/status").open() if line.startswith("VmHWM")))
"""


def rows() -> Iterator[Row]:
    """Yield the time and memory of the kitchen's bank, the rate of samples, and the comparison."""
    yield from _building()
    yield from _sampling()
    for n_steps, goal in GOALS.items():
        yield from _listing(n_steps, goal)


def _building() -> Iterator[Row]:
    found = []
    for _ in range(N_ROUNDS):
        argv = [sys.executable, "-c", BUILD]
        done = subprocess.run(argv, capture_output=True, text=True, check=True)
        n_goals, seconds, kib = done.stdout.split()
        found.append((float(seconds), int(kib) * 1024 / 1e6))
    seconds_, mb = (median(values) for values in zip(*found, strict=True))
    goal = f"<= {BUILT_S:g} s, <= {BUILT_MB} MB"
    missed = seconds_ > BUILT_S or mb > BUILT_MB
    compared = f"largest resident set {mb:,.0f} MB"
    yield Row(f"kitchen, {n_goals} goals built", milliseconds(seconds_), compared, goal, missed)


def _sampling() -> Iterator[Row]:
    bank = build_bank("kitchen", only=[SAMPLED_GOAL])
    rng = np.random.default_rng(0)
    sampler = bank.sampler(0)
    sampler.draw(1, rng)
    runs = {
        "rows": partial(worked, partial(sampler.draw, N_SAMPLED, rng)),
        "tuples": partial(worked, partial(bank.sample, 0, N_SAMPLED, rng)),
    }
    found = {name: N_SAMPLED / s for name, s in interleaved(runs, N_ROUNDS, min).items()}
    yield Row(
        f"kitchen/{SAMPLED_GOAL}, plans sampled from {bank.graphs[0].plans:,}",
        f"{found['rows']:,.0f} plans/s",
        f"as tuples: {found['tuples']:,.0f} plans/s",
        f">= {SAMPLED:,} plans/s",
        found["rows"] < SAMPLED,
    )


def _listing(n_steps: int, goal: str) -> Iterator[Row]:
    """Yield our rate of distinct plans, reading and building included, over each planner's."""
    make = partial(_bank, goal)
    bank = make()
    assert bank.graphs[0].optimal_cost == n_steps
    lowered = lower(step_task(bank.table, bank.goals.formulas[0])[0])
    calls: dict[str, tuple[int, Callable[[], object]]] = {"ours": (K, lambda: _ours(make()))}
    if kstar.missing() is None:
        calls["K*"] = K, partial(_kstar, lowered)
    if find_spec("up_symk") is not None:
        calls["SymK"] = SYMK_K, partial(_symk, lowered)
    runs = {name: partial(worked, call) for name, (_, call) in calls.items()}
    seconds = interleaved(runs, N_ROUNDS, min)
    rates = {name: calls[name][0] / seconds[name] for name in calls}
    what = f"{n_steps} steps, {bank.graphs[0].plans:,} plans counted, {K:,} listed"
    for name in [name for name in calls if name != "ours"]:
        ratio = rates["ours"] / rates[name]
        theirs = f"{name}, stopped at {calls[name][0]:,}: {rates[name]:,.0f} plans/s"
        compared = f"{theirs}, ratio {ratio:,.0f}"
        ours = f"{rates['ours']:,.0f} plans/s"
        yield Row(what, ours, compared, f">= {OVER} x", ratio < OVER)


def _bank(goal: str) -> Bank:
    return build(from_problems([with_goal(read("kitchen", RECIPE), goal, "part")]))


def _ours(bank: Bank) -> None:
    assert bank.graphs[0].plans >= len(set(islice(bank.plans(0), K))) == K


def _kstar(lowered: Lowering) -> None:
    assert len(kstar.list_plans(lowered, LIMITS, n=K).plans) == K


def _symk(lowered: Lowering) -> None:
    """Run SymK as its own front end does; it writes each plan to a file."""
    spec = find_spec("up_symk")
    assert spec is not None
    assert spec.origin is not None
    driver = Path(spec.origin).parent / "symk" / "fast-downward.py"
    search = f"symk_bd(simple=false,plan_selection=top_k(num_plans={SYMK_K},dump_plans=false))"
    with TemporaryDirectory() as folder:
        cwd = Path(folder)
        (cwd / "domain.pddl").write_text(lowered.domain_text)
        (cwd / "problem.pddl").write_text(lowered.problem_text)
        argv = [sys.executable, str(driver), "--plan-file", "plan", "domain.pddl", "problem.pddl",
                "--search-options", "--search", search]  # fmt: skip
        ended = run(argv, cwd=cwd, limits=LIMITS)
        assert len(list(cwd.glob("plan*"))) == SYMK_K, ended
