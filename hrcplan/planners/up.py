"""unified-planning's engines (``up:NAME``), and our problems as its ``Problem``: the one door.

An engine runs in a child process, in which this module is imported again: unified-planning costs
more than a second to import, and some engines take their whole process with them.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from hrcplan.core.extras import missing as missing_package
from hrcplan.core.records import record
from hrcplan.errors import (
    LimitError,
    MissingPlannerError,
    PlannerError,
    UnsupportedError,
)
from hrcplan.pddl import inlining
from hrcplan.pddl.dialect import with_effects
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Function, Problem
from hrcplan.pddl.write import domain_text, problem_text
from hrcplan.planners.contract import Answer, Capabilities, Request, Status
from hrcplan.planners.handover import Handover
from hrcplan.planners.lowering import Lowering, lower
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run
from hrcplan.planners.up_table import Build, UpTable, table

if TYPE_CHECKING:
    from fractions import Fraction

    from unified_planning.environment import Environment
    from unified_planning.model import Problem as UpProblem
    from unified_planning.plans import ActionInstance, SequentialPlan, TimeTriggeredPlan

_CODE = "from hrcplan.planners.up import child; child()"
_MARGIN_S = 0.5  # so that an engine that keeps its limit can still report


class UnifiedPlanning:
    """Any installed engine of unified-planning, by the name that it has there."""

    def __init__(self, engine: str) -> None:
        self._engine = engine
        self.card = Capabilities(
            f"up:{engine}",
            "an engine of unified-planning",
            temporal=True,
            numeric=True,
            metric="none",
            needs="pip install 'hrcplan[planners]' and the engine's package",
            licence="the engine's own",
        )

    def missing(self) -> str | None:
        """Return that unified-planning is not installed; only ``solve`` looks for the engine."""
        return missing_package("unified_planning")

    def solve(self, request: Request) -> Answer:
        """Return the engine's plan, in the names of the task.

        The engine gets the first form of the task that it says it supports: lowered, lowered
        without costs, or as it is; a temporal task first as it is.

        Raises:
            UnsupportedError: if it supports none of them.
            MissingPlannerError: with the reason, if the engine cannot be loaded.
            PlannerError: if it crashes.
        """
        missing = self.missing()
        if missing is not None:
            raise MissingPlannerError(f"{self.card.name}: {missing}")
        forms = list(_forms(request))
        job: dict[str, Any] = {
            "engine": self._engine,
            "timeout_s": max(0.1, request.time_left_s - _MARGIN_S),
            "forms": [form.input for form in forms],
        }
        process, reply = _call(job, ProcessLimits(request.time_left_s, request.memory_bytes))
        return self._answer(forms, process, reply)

    def _answer(
        self, forms: list[_Form], process: FinishedProcess, reply: Mapping[str, Any] | None
    ) -> Answer:
        name = self.card.name
        if reply is None:
            if process.end is not ProcessEnd.EXITED:
                return Answer(Status.UNSOLVED, note=f"stopped: {process.end.value}")
            last = " / ".join((process.stdout + process.stderr).strip().splitlines()[-3:])
            raise PlannerError(f"{name} ended with exit code {process.code}: {last[-300:]}")
        if "missing" in reply:
            raise MissingPlannerError(f"{name} cannot be loaded: {reply['missing']}")
        if "unsupported" in reply:
            raise UnsupportedError(f"{name} does not support this task: {reply['unsupported']}")
        form = forms[reply["form"]]
        status = reply["status"]
        if reply["plan"] is not None:
            lowering = form.lowering
            source = form.handover if lowering is None else lowering
            plan = source.plan(reply["plan"])
            is_optimal = status == "SOLVED_OPTIMALLY" and form.exact
            return Answer(Status.OPTIMAL if is_optimal else Status.SOLVED, plan)
        if status == "UNSOLVABLE_PROVEN":
            return Answer(Status.UNSOLVABLE)
        if status in ("INTERNAL_ERROR", "UNSUPPORTED_PROBLEM"):
            raise PlannerError(f"{name} failed: {status.lower()}: {reply['log'][-300:]}")
        return Answer(Status.UNSOLVED, note=status.lower().replace("_", " "))


@record
class _Form:
    """One way to put the task. ``exact``: cheapest here means cheapest by the problem's metric."""

    input: list[str] | UpTable
    lowering: Lowering | None
    handover: Handover
    exact: bool


def _forms(request: Request) -> Iterator[_Form]:
    problem = request.problem
    temporal = problem.domain.is_temporal
    plain = problem.metric == Function(TOTAL_COST) and not problem.maximize
    handover = Handover.of(inlining.plain(problem))
    free = handover.problem if plain else _without_costs(handover.problem)
    texts = [domain_text(free.domain), problem_text(free)]
    lifted_form = _Form(texts, None, handover, plain and not temporal)
    if temporal:
        yield lifted_form
    try:
        lowering = lower(request.task)
    except (UnsupportedError, LimitError):
        lowering = None
    if lowering is not None:
        exact = lowering.exact_for_metric and not temporal
        yield _Form(table(request.task, lowering, costs=True), lowering, handover, exact)
        yield _Form(table(request.task, lowering, costs=False), lowering, handover, False)
    if not temporal:
        yield lifted_form


def _without_costs(problem: Problem) -> Problem:
    """Return a problem without total-cost and metric.

    A cost without a metric would be a fluent that every action changes: no two could overlap.
    """
    plain_domain = with_effects(problem.domain, lambda effect: effect.target.name != TOTAL_COST)
    return replace(problem, domain=plain_domain, metric=None, maximize=False)


def _call(
    job: Mapping[str, Any], limits: ProcessLimits
) -> tuple[FinishedProcess, Mapping[str, Any] | None]:
    """Run a child with a job; its reply is None if it did not get that far."""
    package = str(Path(__file__).resolve().parents[2])
    path = os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")]))
    with TemporaryDirectory(prefix="hrcplan-") as folder:
        cwd = Path(folder)
        (cwd / "job.json").write_text(json.dumps(job), encoding="utf-8")
        argv = [sys.executable, "-P", "-W", "ignore", "-c", _CODE]
        process = run(argv, cwd=cwd, limits=limits, env={**os.environ, "PYTHONPATH": path})
        reply = cwd / "reply.json"
        return process, json.loads(reply.read_text("utf-8")) if reply.exists() else None


def engines(timeout_s: float = 30) -> Mapping[str, str | None]:
    """Return unified-planning's engines and why each is not usable (None if it is).

    unified-planning itself drops engines silently whose packages fail to import.

    Raises:
        MissingPlannerError: if unified-planning is not installed.
        PlannerError: if it cannot be imported in time.
    """
    missing = missing_package("unified_planning")
    if missing is not None:
        raise MissingPlannerError(missing)
    process, reply = _call({"list": True}, ProcessLimits(timeout_s))
    if reply is None:
        raise PlannerError(f"unified-planning does not start: {process.stderr[-300:]}")
    return dict(reply)


def to_up(problem: Problem, *, with_time: bool = False) -> UpProblem:
    """Return a problem as unified-planning's ``Problem``, to go on with there.

    Args:
        problem: The problem.
        with_time: Hold PDDL's total-time as a fluent of that name, for a metric that weighs it
            against costs. Only hrcplan's engine knows what it means; for others it is 0.

    Raises:
        UnsupportedError: if unified-planning cannot hold the problem (a metric of cost and time,
            for one).
        MissingPlannerError: if unified-planning is not installed.
    """
    try:
        from unified_planning.exceptions import UPException
    except ImportError as error:
        raise MissingPlannerError(f"unified-planning cannot be imported: {error}") from error
    texts = domain_text(problem.domain), problem_text(problem)
    if with_time:
        texts = _declare_time(*texts)
    try:
        return _read(*texts)
    except (UPException, SyntaxError, AssertionError, NotImplementedError) as error:
        message = f"unified-planning cannot hold this problem: {error}"
        raise UnsupportedError(message) from error


def _declare_time(domain: str, problem: str) -> tuple[str, str]:
    """Return the texts with total-time as a function of their own, which is 0."""
    time = f"({TOTAL_TIME})"
    if "(:functions" in domain:
        domain = domain.replace("(:functions", f"(:functions {time}", 1)
    else:
        domain = f"{domain.rstrip()[:-1]} (:functions {time}))"
    return domain, problem.replace("(:init", f"(:init (= {time} 0)", 1)


def _read(domain: str, problem: str) -> UpProblem:
    from unified_planning.io import PDDLReader

    return PDDLReader().parse_problem_string(domain, problem)


# From here on: what happens in the child process.


def child() -> None:
    """Do the job in ``job.json`` and write ``reply.json``, both in the current folder."""
    job = json.loads(Path("job.json").read_text())
    reply = _survey() if "list" in job else _solve(job)
    Path("reply.part").write_text(json.dumps(reply), encoding="utf-8")
    Path("reply.part").rename("reply.json")


def _survey() -> dict[str, str | None]:
    from unified_planning.engines.factory import DEFAULT_ENGINES

    return {name: _fault(name) for name in DEFAULT_ENGINES if _may_plan(name)}


def _may_plan(name: str) -> bool:
    """Return whether an engine solves problems, as far as one can tell if it does not load."""
    from importlib import import_module

    from unified_planning.engines.factory import DEFAULT_ENGINES

    module, attribute = DEFAULT_ENGINES[name]
    try:
        return bool(getattr(import_module(module), attribute).is_oneshot_planner())
    except Exception:  # noqa: BLE001 - the import of an engine may raise anything
        return True


def _fault(name: str) -> str | None:
    """Return why an engine cannot be loaded; None if it can."""
    from importlib import import_module

    from unified_planning.engines.factory import DEFAULT_ENGINES

    if name not in DEFAULT_ENGINES:
        return f"unified-planning knows no engine '{name}'"
    module, attribute = DEFAULT_ENGINES[name]
    try:
        getattr(import_module(module), attribute)
    except Exception as error:  # noqa: BLE001 - the import of an engine may raise anything
        package = str(module).partition(".")[0].replace("_", "-")
        return f"{type(error).__name__}: {error}; pip install {package}"
    return None


def _solve(job: Mapping[str, Any]) -> dict[str, Any]:
    """Return status and plan of an engine, or why it cannot run."""
    from unified_planning.environment import get_environment

    environment = get_environment()
    environment.credits_stream = None
    name = job["engine"]
    if name not in environment.factory.engines:
        return {"missing": _fault(name) or "unified-planning could not register it"}
    engine = environment.factory.engine(name)
    if not engine.is_oneshot_planner():
        return {"unsupported": "it does not solve problems by itself"}
    faults: list[str] = []
    for form, form_input in enumerate(job["forms"]):
        try:
            problem = _build(form_input)
        except Exception as error:  # noqa: BLE001 - pyparsing's and UP's own kinds
            faults.append(str(error))
            continue
        if engine.supports(problem.kind):
            return {"form": form, **_run_engine(environment, name, problem, job["timeout_s"])}
        faults.append(", ".join(sorted(problem.kind.features - engine.supported_kind().features)))
    return {"unsupported": "; ".join(dict.fromkeys(faults))}


def _build(form_input: list[str] | UpTable) -> UpProblem:
    from unified_planning import model

    return _read(*form_input) if isinstance(form_input, list) else Build(model, form_input).problem


def _run_engine(
    environment: Environment, name: str, problem: UpProblem, timeout_s: float
) -> dict[str, Any]:
    with environment.factory.OneshotPlanner(name=name) as planner:
        result = planner.solve(problem, timeout=timeout_s)
    log = " ".join(message.message for message in result.log_messages or ())
    plan = None if result.plan is None else "\n".join(_plan_lines(result.plan))
    return {"status": result.status.name, "plan": plan, "log": log}


def _plan_lines(plan: SequentialPlan | TimeTriggeredPlan) -> Iterator[str]:
    from unified_planning.plans import TimeTriggeredPlan

    if isinstance(plan, TimeTriggeredPlan):
        for start, action, duration in plan.timed_actions:
            lasts = "" if duration is None else f" [{_decimal(duration)}]"
            yield f"{_decimal(start)}: {_action_text(action)}{lasts}"
    else:
        yield from map(_action_text, plan.actions)


def _action_text(action: ActionInstance) -> str:
    return f"({' '.join([action.action.name, *map(str, action.actual_parameters)])})"


def _decimal(seconds: Fraction) -> str:
    return f"{float(seconds):.6f}"
