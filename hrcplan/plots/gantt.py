"""A plan as a picture: one lane per agent, one bar per action."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction, lane, occupied

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colors: told apart by color-blind readers too.
COLORS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#0072B2", "#D55E00", "#BBBBBB")
_BAR = 0.62
_CHARACTER_INCH = 0.075


def draw(problem: Problem, plan: Plan, form: str) -> bytes:
    """Return a Gantt chart as ``png`` or ``svg``; colors are by action name.

    Args:
        problem: Whose agents are the lanes, in the order in which they are declared.
        plan: A schedule; an action without a duration lasts one unit.
        form: ``png`` or ``svg``.
    """
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams.update({"svg.hashsalt": "hrcplan", "font.size": 9})
    from matplotlib.figure import Figure

    lanes = _lanes(problem, plan)
    span = float(plan.makespan_s or 1)
    figure = Figure(figsize=(_width(plan, span), 1.1 + 0.62 * len(lanes)), layout="constrained")
    axes = figure.add_subplot()
    names = sorted({a.name for a in plan.actions})
    colors = {name: COLORS[i % len(COLORS)] for i, name in enumerate(names)}
    for action in plan.actions:
        _bar(axes, action, lanes.index(lane(action.args, problem) or ""), colors, _label(action))
        for other in occupied(action, problem) & set(lanes) - {lane(action.args, problem)}:
            _bar(axes, action, lanes.index(other), colors, f"({action.name})", alpha=0.45)
    axes.set_yticks(range(len(lanes)), labels=[name or "no agent" for name in lanes])
    axes.set_ylim(len(lanes) - 0.5, -0.5)
    axes.set_xlim(0, span)
    axes.set_xlabel("time (s)" if problem.domain.is_temporal else "steps")
    axes.set_title(f"{problem.domain.name}/{problem.name}", loc="left", fontsize=10)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    buffer = io.BytesIO()
    metadata = {"Date": None} if form == "svg" else {"Software": None}
    figure.savefig(buffer, format=form, dpi=150, metadata=metadata)
    return buffer.getvalue()


def _bar(
    axes: Axes, action: PlannedAction, row: int, colors: dict[str, str], text: str, alpha: float = 1
) -> None:
    start, length = float(action.start_s or 0), float(action.duration_s or 1)
    axes.broken_barh(
        [(start, length)], (row - _BAR / 2, _BAR), facecolor=colors[action.name], alpha=alpha,
        edgecolor="white", linewidth=1.5,
    )  # fmt: skip
    axes.text(start + length / 2, row, text, ha="center", va="center", clip_on=True)


def _width(plan: Plan, span: float) -> float:
    """Return a width in inches at which every label fits into its bar."""
    needed = (
        max(map(len, _label(action).split("\n"))) * span / float(action.duration_s or 1)
        for action in plan.actions
    )
    return min(40.0, max(7.0, 1.2 + max(needed, default=0) * _CHARACTER_INCH))


def _lanes(problem: Problem, plan: Plan) -> list[str]:
    used = {lane(action.args, problem) or "" for action in plan.actions}
    return [agent for agent in problem.agents if agent in used] + ([""] if "" in used else [])


def _label(action: PlannedAction) -> str:
    return "\n".join([action.name, " ".join(action.args[1:])]).strip()
