"""Fast Downward (Helmert, JAIR 2006) in a child process, fed with the lowered task.

Its wheel is under the GPL, so it is looked up and run, never imported.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.errors import MissingPlannerError, PlannerError, UnsupportedError
from hrcplan.pddl.constructs import AXIOMS
from hrcplan.pddl.dialect import without_numbers
from hrcplan.pddl.inlining import remaining
from hrcplan.pddl.model import TOTAL_COST, Function
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.lowering import NO_SEQUENCE, Lowered, lower
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run
from hrcplan.plans import parse_plan

# One supervised program instead of two: translate, then search.
_SCRIPT = """
"$0" -P -m fast_downward.translate --invariant-generation-max-time 5 domain.pddl problem.pddl \
  || exit $?
exec "$1" --internal-plan-file plan --search "$2" < output.sas
"""
_BINARY = "downward/builds/release/bin/downward"
# The first iteration of LAMA 2011 (Richter, Westphal, Helmert), as the alias "lama-first" has it.
_FIRST = (
    "let(hlm, eval_modify_costs(landmark_sum(lm_factory=lm_reasonable_orders_hps(lm_rhw()),"
    "pref=false),cost_type=one),let(hff, eval_modify_costs(ff(),cost_type=one),"
    "lazy_greedy([hff,hlm],preferred=[hff,hlm],cost_type=one,reopen_closed=false)))"
)
_MAX_INT = 2**31


class FastDownward:
    """A* with LM-cut, which proves cost optima; the first plan of LAMA if any plan will do.

    On a temporal problem it plans the sequential reading: one action after the other.
    """

    def __init__(self) -> None:
        self.card = Capabilities(
            "fast-downward",
            "A* with LM-cut: proven cheapest sequential plans",
            metric="cost",
            constructs=frozenset([AXIOMS]),
            proves=True,
            needs="pip install up-fast-downward",
            licence="GPL-3.0 (run as a child process)",
        )

    def missing(self) -> str | None:
        """Return what is not installed; None if all is."""
        if find_binary() is None:
            return "the program 'downward' is not installed; pip install up-fast-downward"
        if find_spec("fast_downward") is None:
            return "its translator is not installed; pip install fast-downward.translate"
        return None

    def solve(self, request: Request) -> Answer:
        """Return a cheapest plan with its proof, or any plan if that is asked for.

        Raises:
            UnsupportedError: if the task cannot be lowered, or its costs exceed 32 bits.
            MissingPlannerError: if the wheel is not installed.
            PlannerError: if it crashes.
        """
        missing, binary = self.missing(), find_binary()
        if missing is not None or binary is None:
            raise MissingPlannerError(f"fast-downward cannot run here: {missing}")
        if remaining(request.problem) == {AXIOMS}:
            return _solve_lifted(request, binary)
        lowered = lower(request.task)
        if not lowered.fits_32_bits:
            message = f"costs in whole numbers (times {lowered.scale}) exceed 32-bit integers"
            raise UnsupportedError(message, hint="round the function values, or use enhsp, kairos")
        if request.task.is_goal(request.task.initial):  # an empty goal becomes an axiom in there
            return _solved(request, lowered, "; cost = 0")
        search = _FIRST if request.any_plan else _proof(lowered, len(request.task.goal))
        texts = lowered.domain_text, lowered.problem_text
        return _searched(request, texts, search, binary, partial(_solved, request, lowered))


def _solve_lifted(request: Request, binary: Path) -> Answer:
    """Return the answer for a task with derived predicates, which is handed over as it is."""
    problem, counts = request.problem, TOTAL_COST in request.problem.domain.functions
    priced = problem.metric == Function(TOTAL_COST) and not problem.maximize
    whole = all(isinstance(value, int) and value >= 0 for value in problem.values.values())
    exact_for_metric = whole and (priced if counts else problem.metric is None)
    if not exact_for_metric:
        problem = without_numbers(problem)
    search = _FIRST if request.any_plan else "astar(blind())"  # no other is admissible with axioms
    texts = domain_text(problem.domain), problem_text(problem)

    def solved(text: str) -> Answer:
        proven = exact_for_metric and not request.any_plan
        cost = _cost(text) if exact_for_metric else None
        status = Status.OPTIMAL if proven else Status.SOLVED
        return Answer(status, parse_plan(text), cost)

    return _searched(request, texts, search, binary, solved)


def _searched(
    request: Request,
    texts: tuple[str, str],
    search: str,
    binary: Path,
    solved: Callable[[str], Answer],
) -> Answer:
    """Return what the translator and one search say; ``solved`` reads a plan's text."""
    with TemporaryDirectory(prefix="hrcplan-") as folder:
        cwd = Path(folder)
        (cwd / "domain.pddl").write_text(texts[0])
        (cwd / "problem.pddl").write_text(texts[1])
        limits = ProcessLimits(request.time_left_s, request.memory_bytes)
        argv = ["/bin/sh", "-c", _SCRIPT, sys.executable, str(binary), search]
        finished = run(argv, cwd=cwd, limits=limits)
        plan = cwd / "plan"
        text = plan.read_text() if plan.exists() else None
    return _answer(request, solved, finished, text)


def find_binary() -> Path | None:
    """Return Fast Downward's search program in its wheel; None if there is none."""
    spec = find_spec("up_fast_downward")  # finds it without importing it
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        if (binary := Path(folder) / _BINARY).is_file():
            return binary
    return None


def _proof(lowered: Lowered, n_goals: int) -> str:
    """Return the strongest admissible search for what the task contains."""
    if n_goals > 1:  # becomes an axiom, with which no heuristic here is admissible
        return "astar(blind())"
    return "astar(hmax())" if lowered.conditional else "astar(lmcut())"


def _answer(
    request: Request,
    solved: Callable[[str], Answer],
    finished: FinishedProcess,
    text: str | None,
) -> Answer:
    """Return what the exit code means (fast-downward.org, "Exit codes")."""
    if finished.ended is not ProcessEnd.EXITED:
        return Answer(Status.UNSOLVED, note=f"stopped: {finished.ended.value}")
    code = finished.code
    if code in (0, 1, 2, 3) and text is not None:
        return solved(text)
    if code in (10, 11):
        if request.problem.domain.is_temporal:
            return Answer(Status.UNSOLVED, note=NO_SEQUENCE)
        return Answer(Status.UNSOLVABLE)
    if code in (12, 13):
        return Answer(Status.UNSOLVED, note="the search was incomplete and found no plan")
    if code in (20, 21, 22, 23, 24):
        return Answer(Status.UNSOLVED, note=f"out of time or memory (exit code {code})")
    lines = [line for line in (finished.stdout + finished.stderr).splitlines() if line.strip()]
    raise PlannerError(f"fast-downward ended with exit code {code}: {' / '.join(lines[-3:])}")


def _solved(request: Request, lowered: Lowered, text: str) -> Answer:
    cost = _cost(text)
    # No expanded node has a larger g, and no generated one is more than an action above it.
    safe = cost is not None and cost + max(lowered.costs, default=0) < _MAX_INT
    temporal = request.problem.domain.is_temporal
    proven = not request.any_plan and lowered.exact_for_metric and not temporal and safe
    return Answer(
        Status.OPTIMAL if proven else Status.SOLVED,
        lowered.plan(text),
        None if cost is None else lowered.objective(cost),
        "" if lowered.exact_for_metric else "cheapest sequence of actions, time not weighed",
    )


def _cost(text: str) -> int | None:
    """Return the cost that stands below a plan."""
    found = re.search(r"; cost = (\d+)", text)
    return int(found[1]) if found else None
