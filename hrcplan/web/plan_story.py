"""A plan as the story of a run in which everything goes well."""

from __future__ import annotations

from typing import Any

from hrcplan.execution.action_model import ActionModel
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction, lane
from hrcplan.web.run_head import execution_head


def plan_run(problem: Problem, plan: Plan) -> dict[str, Any]:
    """Return head and entries of a plan, for the page of a run.

    Actions without times come one after the other; the world is drawn as far as actions can be
    done.
    """
    entries = []
    model = ActionModel(problem)
    state = model.initial()
    for number, action in enumerate(plan.actions):
        start = float(action.start_s) if action.start_s is not None else float(number)
        end = start + (float(action.duration_s) if action.duration_s is not None else 1.0)
        before = model.changing(state)
        step = model.step(action)
        if step is not None and model.obstacle(state, step) is None:
            state = model.finish(model.begin(state, step)[0], step)
        after = model.changing(state)
        entries.append({
            "n": number + 1, "t": end, "bars": [_bar(problem, action, number, start, end)],
            "notes": [{"kind": "note", "text": str(action).strip("()")}],
            "plus": sorted(" ".join(fact) for fact in after - before),
            "minus": sorted(" ".join(fact) for fact in before - after),
        })  # fmt: skip
    head = execution_head(problem)
    if not plan.is_schedule:
        head["unit"] = "steps"
    return {"head": head, "entries": entries}


def _bar(
    problem: Problem, action: PlannedAction, number: int, start: float, end: float
) -> dict[str, Any]:
    agent = lane(action.args, problem) or ""
    rest = list(action.args)
    if agent:
        rest.remove(agent)
    return {
        "number": number, "agent": agent, "action": action.name, "args": rest, "start": start,
        "end": end, "outcome": "done",
    }  # fmt: skip
