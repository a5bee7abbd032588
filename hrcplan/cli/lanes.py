"""A result of planning as JSON and as a table with a lane per agent."""

from __future__ import annotations

from typing import Any

from hrcplan.cli import output
from hrcplan.cli.output import number
from hrcplan.core.numbers import Number, number_text
from hrcplan.pddl.model import Problem
from hrcplan.planners.contract import Status
from hrcplan.planners.result import Result
from hrcplan.plans import Plan, PlannedAction, lane, occupied, seconds_text

BY_ITSELF = "by itself"
"""The column of timed initial literals."""
VERDICT = {
    Status.OPTIMAL: "proven optimal",
    Status.SOLVED: "not proven optimal",
    Status.UNSOLVABLE: "unsolvable",
    Status.UNSOLVED: "no plan within the limits",
}


def as_json(problem: Problem, result: Result) -> dict[str, Any]:
    """Return the document of ``plan --json``."""
    report = result.report
    return {
        "status": result.status.value,
        "planner": result.planner,
        "cost": number(report.cost) if report else None,
        "makespan_s": number(report.makespan_s) if report else None,
        "metric": number(report.metric) if report else None,
        "sense": _sense(problem),
        "bound": number(result.bound),
        "gap": result.gap,
        "gap_reason": result.gap_reason,
        "valid": report.valid if report else None,
        "steps": _steps(problem, result),
        "wall_s": round(result.wall_s, 6),
        "why": result.why,
        "tried": [
            {"planner": a.planner, "outcome": a.outcome, "wall_s": round(a.wall_s, 6)}
            for a in result.attempts
        ],
        "shortest": result.shortest,
    }


def _sense(problem: Problem) -> str | None:
    """Return what is to be done with the problem's metric; None if it has none."""
    if problem.metric is None:
        return None
    return "maximize" if problem.maximize else "minimize"


def _steps(problem: Problem, result: Result) -> list[dict[str, Any]]:
    if result.plan is None:
        return []
    costs = result.report.step_costs if result.report else (None,) * len(result.plan.actions)
    return [
        {
            "start_s": number(action.start_s),
            "duration_s": number(action.duration_s),
            "agent": lane(action.args, problem),
            "action": action.name,
            "args": list(action.args),
            "cost": number(cost),
        }
        for action, cost in zip(result.plan.actions, costs, strict=True)
    ]


def as_text(problem: Problem, result: Result) -> str:
    """Return a headline, the plan with one column per lane, and what it costs."""
    head = f"{problem.domain.name}/{problem.name}: {VERDICT[result.status]}"
    by = f" ({result.planner}, {result.wall_s:.2f} s)" if result.planner != "auto" else ""
    attempts = _attempts_text(result)
    if result.plan is None:
        return f"{head}{by}{attempts}"
    plan = "\n".join(_table(problem, result.plan))
    return f"{head}{by}{attempts}\n\n{plan}\n\n{_figures(problem, result)}"


def _attempts_text(result: Result) -> str:
    others = [a for a in result.attempts if a.planner != result.planner or result.plan is None]
    lines = [f"\n  {a.planner}: {a.outcome}" for a in others if not a.outcome.startswith("solved")]
    mismatch = [] if result.mismatch is None else [f"\n  {result.mismatch}"]
    return "".join(dict.fromkeys([*lines, *mismatch]))


def _figures(problem: Problem, result: Result) -> str:
    report = result.report
    assert result.plan is not None
    if report is None:
        return "valid     not judged"
    lines: list[str] = []
    if report.metric is not None:
        lines.append(f"metric    {_short(report.metric)}   {_sense(problem)} {problem.metric}")
    if report.cost is not None:
        lines.append(f"cost      {_short(report.cost)}")
    if report.makespan_s is not None:
        unit = " s" if problem.domain.is_temporal else " steps"
        proof = {None: "", True: "   (shortest for this partial order)", False: ""}[result.shortest]
        lines.append(f"makespan  {_short(report.makespan_s)}{unit}{proof}")
    if (bound := _bound(problem, result)) is not None:
        lines.append(bound)
    lines.append(f"valid     yes, replayed: {len(result.plan.actions)} actions, goal reached")
    return "\n".join(lines)


def _bound(problem: Problem, result: Result) -> str | None:
    """Return what is proven about a plan that is not proven to be the best."""
    if result.status is Status.OPTIMAL:
        return None
    if result.bound is None:
        return f"bound     none: {result.bound_note}" if result.bound_note else None
    if result.gap is None:
        return f"bound     {_short(result.bound)}"
    side = "below" if problem.metric is not None and problem.maximize else "above"
    percent = 100 * result.gap
    words = f"{percent:.2g}" if percent < 99.5 else f"{percent:,.0f}"
    return f"bound     {_short(result.bound)}   (at most {words} % {side} the optimum)"


def _short(value: Number) -> str:
    return number_text(value)


def _table(problem: Problem, plan: Plan) -> list[str]:
    """Return lines: time or position, then one column per agent that does anything."""
    lanes = [a for a in problem.agents if any(lane(p.args, problem) == a for p in plan.actions)]
    if any(lane(p.args, problem) is None for p in plan.actions) or not lanes:
        lanes.append("")
    rows: list[tuple[str, dict[str, str]]] = []
    for position, action in enumerate(plan.actions):
        when = str(position + 1) if action.start_s is None else _clock(action.start_s, problem)
        cells = _cells(action, problem)
        # Actions of one instant share a row as long as each finds its cells empty.
        row = next((c for at, c in rows if at == when and c.keys().isdisjoint(cells)), None)
        if row is None:
            rows.append((when, cells))
        else:
            row.update(cells)
    coming = _literals(problem, plan)
    if coming:
        lanes.append(BY_ITSELF)
        rows = [(when, cells) for _, when, cells in sorted(
            [*coming, *((float(when), when, cells) for when, cells in rows)], key=lambda r: r[0]
        )]  # fmt: skip
    head = "step" if not plan.is_schedule else "time (s)" if problem.domain.is_temporal else "time"
    width = max(len(text) for text in (head, *(when for when, _ in rows)))
    table = [[head, *lanes]] + [
        [when.rjust(width), *(row.get(a, "") for a in lanes)] for when, row in rows
    ]
    return [f"  {line}" for line in output.columns([table[0], output.rule(table), *table[1:]])]


def _literals(problem: Problem, plan: Plan) -> list[tuple[float, str, dict[str, str]]]:
    """Return rows of the timed initial literals that come before the end of a schedule."""
    if not plan.is_schedule:
        return []
    return [
        (float(change.time), _clock(change.time, problem), {BY_ITSELF: change.literal})
        for change in problem.timed
        if change.time <= (plan.makespan_s or 0)
    ]


def _cells(action: PlannedAction, problem: Problem) -> dict[str, str]:
    """Return the cells of an action in the table: its lane's, and those of agents it occupies."""
    agent = lane(action.args, problem) or ""
    others = occupied(action, problem) - {agent}
    return {agent: _cell(action, agent), **dict.fromkeys(others, f"({action.name} by {agent})")}


def _clock(start: Number, problem: Problem) -> str:
    return seconds_text(start) if problem.domain.is_temporal else number_text(start)


def _cell(action: PlannedAction, agent: str) -> str:
    rest = list(action.args)
    if agent:
        rest.remove(agent)
    return " ".join([action.name, *rest])
