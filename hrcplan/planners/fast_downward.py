"""Fast Downward (Helmert, JAIR 2006) in a child process, fed with the lowered task.

Its wheel is under the GPL, so it is looked up and run, never imported.
"""

from __future__ import annotations

import re
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.core.extras import install_command
from hrcplan.core.extras import missing as missing_package
from hrcplan.errors import MissingPlannerError, PlannerError
from hrcplan.pddl.constructs import AXIOMS
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.fast_downward_input import DownwardInput, downward_input
from hrcplan.planners.lowering import NO_SEQUENCE
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run, text_of

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
_LANDMARKS = (
    "eval_modify_costs(landmark_sum(lm_factory=lm_reasonable_orders_hps(lm_rhw()),pref=false)"
)
# LAMA 2011: plans that get better, by searches that are less and less greedy.
_ANYTIME = (
    f"let(hlm1, {_LANDMARKS},cost_type=one),let(hff1, eval_modify_costs(ff(),cost_type=one),"
    f"let(hlm2, {_LANDMARKS},cost_type=plusone),"
    "let(hff2, eval_modify_costs(ff(),cost_type=plusone),"
    "iterated([lazy_greedy([hff1,hlm1],preferred=[hff1,hlm1],cost_type=one,reopen_closed=false),"
    "lazy_greedy([hff2,hlm2],preferred=[hff2,hlm2],reopen_closed=false),"
    + ",".join(f"lazy_wastar([hff2,hlm2],preferred=[hff2,hlm2],w={w})" for w in (5, 3, 2, 1))
    + "])))))"
)
_MOST = 200  # plans of one search


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
            needs="pip install 'hrcplan[planners]'",
            licence="GPL-3.0 (run as a child process)",
        )

    def missing(self) -> str | None:
        """Return what is not installed; None if all is."""
        if find_binary() is None:
            return f"the program 'downward' is not installed; {install_command('up_fast_downward')}"
        return missing_package("fast_downward")

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
        texts = downward_input(request)
        if texts.is_solved:
            return _solution(request, texts, "; cost = 0")
        return _DownwardSearch(request, texts).run(binary)


def find_binary() -> Path | None:
    """Return Fast Downward's search program in its wheel; None if there is none."""
    spec = find_spec("up_fast_downward")  # finds it without importing it
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        if (binary := Path(folder) / _BINARY).is_file():
            return binary
    return None


class _DownwardSearch:
    """One run of the translator and a search, and the plans that it has written so far."""

    def __init__(self, request: Request, texts: DownwardInput) -> None:
        self.request, self.texts = request, texts
        self._folder = Path()
        self._n_plans = 0

    def run(self, binary: Path) -> Answer:
        """Return the answer; plans that are improved later are reported at once."""
        request, texts = self.request, self.texts
        quick = _ANYTIME if request.improves else _FIRST
        search = quick if request.any_plan else texts.proof
        with TemporaryDirectory(prefix="hrcplan-") as folder:
            self._folder = Path(folder)
            (self._folder / "domain.pddl").write_text(texts.domain, encoding="utf-8")
            (self._folder / "problem.pddl").write_text(texts.problem, encoding="utf-8")
            limits = ProcessLimits(request.time_left_s, request.memory_bytes)
            argv = ["/bin/sh", "-c", _SCRIPT, sys.executable, str(binary), search]
            process = run(argv, cwd=self._folder, limits=limits, on_tick=self._look)
            plans = self._plans()
            text = plans[-1] if plans else None
        return _answer(request, texts, process, text)

    def _plans(self) -> list[str]:
        """Return the texts of complete plans, the best one last: a plan ends with its cost."""
        names = ["plan", *(f"plan.{i}" for i in range(1, _MOST))]
        texts = (text_of(self._folder / name) for name in names)
        return [text for text in texts if text is not None and "; cost" in text]

    def _look(self) -> None:
        plans = self._plans()
        for text in plans[self._n_plans :]:
            self.request.on_plan(self.texts.plan(text))
        self._n_plans = len(plans)


def _answer(
    request: Request, texts: DownwardInput, process: FinishedProcess, text: str | None
) -> Answer:
    """Return what the exit code means (fast-downward.org, "Exit codes")."""
    if process.end is not ProcessEnd.EXITED:
        note = f"stopped: {process.end.value}"
        return (
            Answer(Status.UNSOLVED, note=note) if text is None else _solution(request, texts, text)
        )
    code = process.code
    if text is not None and (code in (0, 1, 2, 3) or request.any_plan):
        return _solution(request, texts, text)
    if code in (10, 11):
        if request.problem.domain.is_temporal:
            return Answer(Status.UNSOLVED, note=NO_SEQUENCE)
        return Answer(Status.UNSOLVABLE)
    if code in (12, 13):
        return Answer(Status.UNSOLVED, note="the search was incomplete and found no plan")
    if code in (20, 21, 22, 23, 24):
        return Answer(Status.UNSOLVED, note=f"out of time or memory (exit code {code})")
    lines = [line for line in (process.stdout + process.stderr).splitlines() if line.strip()]
    raise PlannerError(f"fast-downward ended with exit code {code}: {' / '.join(lines[-3:])}")


def _solution(request: Request, texts: DownwardInput, text: str) -> Answer:
    match = re.search(r"; cost = (\d+)", text)
    cost = int(match[1]) if match else None
    is_optimal = not request.any_plan and texts.exact and cost is not None and texts.is_safe(cost)
    has_time = texts.exact or not request.weighs_time
    return Answer(
        Status.OPTIMAL if is_optimal else Status.SOLVED,
        texts.plan(text),
        None if cost is None else texts.objective(cost, request.problem),
        "" if has_time else "cheapest sequence of actions, time not weighed",
    )
