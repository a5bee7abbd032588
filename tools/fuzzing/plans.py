"""Targets that take plans: in IPC format and as planners log them."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import cache
from pathlib import Path

from fuzzing import mutate
from fuzzing.files import PAIRS
from hrcplan.inference.observations import observed_words
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction, find_plans, format_plan
from hrcplan.plans.logs import read_plan
from hrcplan.validation import validate


def plan(rng: random.Random, folder: Path) -> None:
    """Read and replay a mutated plan; what was read is read again from how it is written."""
    problem, result = planned(rng.choice(PAIRS[:2]))
    _read_again(mutate.text(rng, format_plan(result)), problem)


def log(rng: random.Random, folder: Path) -> None:
    """Do the same with the log of a planner, and take it as observations."""
    problem, result = planned(rng.choice(PAIRS[:2]))
    text = mutate.text(rng, rng.choice(LOGS)(result))
    for found in find_plans(text, problem):
        validate(problem, found)
    path = folder / "x.log"
    path.write_bytes(text.encode("utf-8", "replace"))
    observed_words(path)
    _read_again(text, problem)


def _read_again(text: str, problem: Problem) -> None:
    found, _ = read_plan(text, problem)
    validate(problem, found)
    if found.is_schedule:
        return
    again, _ = read_plan(format_plan(found), problem)
    assert [str(a) for a in again.actions] == [str(a) for a in found.actions]


@cache
def planned(pair: tuple[str, str]) -> tuple[Problem, Plan]:
    """Return a shipped problem and its best plan."""
    import hrcplan

    result = hrcplan.plan(*pair, planner="exact")
    assert result.plan is not None
    return read(*pair), result.plan


def _words(action: PlannedAction) -> str:
    return " ".join((action.name, *action.args))


def _ff(found: Plan) -> str:
    steps = [f"{i:9}: {_words(a).upper()}" for i, a in enumerate(found.actions)]
    return (
        "\nff: found legal plan as follows\n\nstep" + "\n".join(steps)[4:] + "\n\ntime spent: 0.00"
    )


def _fast_downward(found: Plan) -> str:
    steps = [f"{_words(a)} (1)" for a in found.actions]
    head = "[t=0.01s, 9 KB] Solution found!\n"
    return head + "\n".join(steps) + f"\n[t=0.01s, 9 KB] Plan length: {len(steps)} step(s).\n"


def _functions(found: Plan) -> str:
    steps = [f"STEP {i}: {a.name}({','.join(a.args)})" for i, a in enumerate(found.actions)]
    return f"PLAN FOUND: {len(steps)} steps\n" + "\n".join(steps) + "\n"


def _enhsp(found: Plan) -> str:
    steps = [f"{i}.0: ({_words(a)})" for i, a in enumerate(found.actions)]
    return "Problem Solved\n\nFound Plan:\n" + "\n".join(steps) + "\n\nPlan-Length:9\n"


def _times(action: PlannedAction) -> tuple[float, float]:
    return float(action.start_s or 0), float(action.duration_s or 1)


def _popf(found: Plan) -> str:
    steps = [
        f"{start:.3f}: ({_words(a)})  [{length:.3f}]"
        for a in found.actions
        for start, length in [_times(a)]
    ]
    return "b (1.000 | 5.000);;;; Solution Found\n; Cost: 10.001\n" + "\n".join(steps) + "\n"


def _lpg(found: Plan) -> str:
    steps = [
        f" {start:.4f}:   ({_words(a).upper()}) [D:{length:.4f}; C:0.1000]"
        for a in found.actions
        for start, length in [_times(a)]
    ]
    head = "   Time: (ACTION) [action Duration; action Cost]\n"
    return head + "\n".join(steps) + "\n\nSolution number: 1\n"


def _numbers(found: Plan) -> str:
    return "\n".join(f"{i}. ({_words(a)})" for i, a in enumerate(found.actions, 1))


def _names(found: Plan) -> str:
    rows = [f'{{"action": "{a.name}", "args": {list(a.args)}}}' for a in found.actions]
    return ('{"plan": [' + ", ".join(rows) + "]}").replace("'", '"')


LOGS: tuple[Callable[[Plan], str], ...] = (
    _ff, _fast_downward, _functions, _enhsp, _popf, _lpg, _numbers, _names,
)  # fmt: skip
