"""A plan as a Gantt chart: one lane per agent, one bar per action."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from hrcplan.core.numbers import number_text
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction, lane, occupied
from hrcplan.plots import style
from hrcplan.plots.lanes import (
    FONT_PT,
    LANE_PT,
    GanttBar,
    colors,
    draw_bars,
    fits,
    name_lanes,
    width_pt,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MIN_WIDTH, MAX_WIDTH = 7.0, 16.0  # inches: at most 2400 pixels
BY_ITSELF = "by itself"
"""The lane of timed initial literals."""
_TOP_PT, _AXIS_PT, _SIDE_PT = 34.0, 44.0, 16.0
_KEY_PT = 1.45 * FONT_PT  # height of a line of the legend


@style.styled
def draw(problem: Problem, plan: Plan, form: str, failed: Collection[int] = frozenset()) -> bytes:
    """Return a Gantt chart as a ``png`` or ``svg`` file, at most 2400 pixels wide.

    All agents of the problem have a lane, also idle ones. A label that does not fit into its bar is
    turned, or replaced by a number that a legend below explains.

    Args:
        problem: Its agents are the lanes, in the order of their declaration.
        plan: A schedule; an action without a duration lasts one unit.
        form: ``png`` or ``svg``.
        failed: The places of actions that have failed, if the plan is what was done in a run.
    """
    from matplotlib.figure import Figure

    names = _lanes(problem, plan)
    bars = [
        bar
        for place, action in enumerate(plan.actions)
        for bar in _bars(problem, action, names, place in failed)
    ]
    end = max([float(plan.makespan_s or 0), *(bar.start + bar.length for bar in bars)]) or 1.0
    moments = _moments(problem, end)
    if moments:
        names.append(BY_ITSELF)
    left = max(width_pt(name or "no agent", 9) for name in names) + _SIDE_PT
    width = 72 * _width(bars, end, left)
    bars += [GanttBar(len(names) - 1, t, end / 100, text) for t, text in moments]
    unit = (width - left - _SIDE_PT) / end
    labels = {bar.text for bar in bars if not bar.faint and not fits(bar, unit)}
    columns, n_lines = _key_shape(labels, width - left)
    height = _TOP_PT + LANE_PT * len(names) + _AXIS_PT + _KEY_PT * n_lines
    figure = Figure(figsize=(width / 72, height / 72))
    bottom = _AXIS_PT + _KEY_PT * n_lines
    axes = figure.add_axes((left / width, bottom / height, unit * end / width,
                            LANE_PT * len(names) / height))  # fmt: skip
    color_of = {
        **colors([a.name for a in plan.actions]),
        **{text: style.LINE for _, text in moments},
    }
    numbers = draw_bars(axes, bars, color_of, unit)
    for t, _ in moments:
        axes.axvline(t, color=style.GRAY, linewidth=0.9, linestyle="--", zorder=0)
    name_lanes(axes, names, end)
    axes.set_xlabel("time (s)" if problem.domain.is_temporal else "time (steps)")
    axes.set_title(f"{problem.domain.name}/{problem.name}, {_makespan(problem, plan)}")
    _key(figure, numbers, columns, n_lines, left / width)
    return style.file_bytes(figure, form)


def _lanes(problem: Problem, plan: Plan) -> list[str]:
    """Return the names of the lanes; an empty name is that of actions without an agent."""
    is_without = any(lane(action.args, problem) is None for action in plan.actions)
    return [*problem.agents, *([""] if is_without or not problem.agents else [])]


def _moments(problem: Problem, end: float) -> list[tuple[float, str]]:
    """Return the timed initial literals until ``end``: those of one moment as one text."""
    texts: dict[float, list[str]] = {}
    for change in problem.timed:
        if change.time <= end:
            texts.setdefault(float(change.time), []).append(change.literal)
    return [(t, " ".join(literals)) for t, literals in texts.items()]


def _bars(
    problem: Problem, action: PlannedAction, names: Sequence[str], failed: bool = False
) -> list[GanttBar]:
    """Return the bar of an action, and a faint one for each other agent that it keeps busy."""
    agent = lane(action.args, problem) or ""
    start, length = float(action.start_s or 0), float(action.duration_s or 1)
    rest = list(action.args)
    if agent:
        rest.remove(agent)
    others = sorted(occupied(action, problem) & set(names) - {agent})
    return [
        GanttBar(names.index(agent), start, length, action.name, " ".join(rest), failed),
        *(GanttBar(names.index(other), start, length, action.name, faint=True) for other in others),
    ]


def _makespan(problem: Problem, plan: Plan) -> str:
    if plan.makespan_s is None:
        return f"{len(plan.actions)} actions"
    unit = "s" if problem.domain.is_temporal else "steps"
    return f"makespan {number_text(plan.makespan_s)} {unit}"


def _width(bars: Sequence[GanttBar], end: float, left: float) -> float:
    """Return a width in inches at which texts in two lines fit, as far as that is allowed."""
    widths = (
        (max(width_pt(bar.name), width_pt(bar.words)) + 6) * end / bar.length
        for bar in bars
        if bar.length and not bar.faint
    )
    width = (left + _SIDE_PT + max(widths, default=0.0)) / 72
    return min(MAX_WIDTH, max(MIN_WIDTH, width))


def _key_shape(texts: Collection[str], width: float) -> tuple[int, int]:
    """Return the numbers of columns and lines of a legend for these texts."""
    if not texts:
        return 0, 0
    widest = max(width_pt(f"00  {text}") for text in texts) + 14
    columns = max(1, int(width // widest))
    return columns, math.ceil(len(texts) / columns)


def _key(
    figure: Figure, numbers: Mapping[str, int], columns: int, n_lines: int, left: float
) -> None:
    """Write the texts of the numbers below the chart, column by column."""
    height = figure.get_figheight() * 72
    for text, number in numbers.items():
        column, line = divmod(number - 1, n_lines)
        x = left + column * (1 - left) / columns
        y = (n_lines - line - 0.5) * _KEY_PT / height
        figure.text(x, y, f"{number}  {text}", fontsize=FONT_PT, va="center")
