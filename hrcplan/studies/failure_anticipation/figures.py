"""The plots of the study, as SVG text."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from hrcplan.agents.state import MOST
from hrcplan.core.text import plural
from hrcplan.plots import lanes as charts
from hrcplan.plots import style as plots
from hrcplan.studies.estimate import MeanEstimate, estimate
from hrcplan.studies.failure_anticipation.claims import BASELINE
from hrcplan.studies.failure_anticipation.measures import MEASURES
from hrcplan.studies.study import Cell, StudyRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CASE_COLORS = {"1a": plots.GRAY, "1b": plots.BLUE, "2a": plots.PINK, "2b": plots.GREEN}
_REASONS = (
    ("replans_change", "a change was sensed", plots.BLUE),
    ("replans_failure", "an action failed", plots.RED),
    ("replans_deviation", "the world deviated", plots.ORANGE),
)
_WIDTH = 11.5  # inches: as wide as the page


@plots.styled
def measures(
    by_cell: Mapping[Cell, Sequence[StudyRow]],
    names: Sequence[str],
    figures: Mapping[str, Mapping[str, float]],
) -> str:
    """Return a dot per cell and measure with 95 % intervals; diamonds are printed figures."""
    cells = [cell for cell, rows in by_cell.items() if rows]
    height = 0.9 + 0.27 * len(cells)
    figure, grid = plots.figure(len(names), 1, _WIDTH, height, sharey=True)
    places = _places(cells)
    for axes, measure in zip(grid[0], names, strict=True):
        for cell, y in zip(cells, places, strict=True):
            case, method = map(str, cell)
            e = estimate(float(row[measure] or 0) for row in by_cell[cell])
            color = CASE_COLORS.get(case, plots.GRAY)
            axes.plot(MEASURES[measure].span(e), [y, y],
                      color=color, linewidth=2.2, alpha=0.45, solid_capstyle="round")  # fmt: skip
            axes.plot([e.mean], [y], "o", color=color, markersize=6)
            if method == BASELINE and measure in figures.get(case, {}):
                axes.plot([figures[case][measure]], [y], "D", markersize=5, zorder=1,
                          markerfacecolor="white", markeredgecolor=plots.INK)  # fmt: skip
        axes.set_title(MEASURES[measure].title)
        axes.margins(x=0.12)
        plots.bare(axes)
    grid[0][0].set_yticks(places, labels=[f"{case}  {method}" for case, method in cells])
    grid[0][0].set_ylim(max(places, default=0) + 0.6, -0.6)
    return plots.svg(figure, "measures", "Measures of every case and method")


def _places(cells: Sequence[Cell]) -> list[float]:
    """Return where the lines of cells stand: a little space before each new case."""
    places: list[float] = []
    for i, cell in enumerate(cells):
        gap = 0.5 if i and cells[i - 1][0] != cell[0] else 0.0
        places.append((places[-1] + 1 if places else 0.0) + gap)
    return places


@plots.styled
def reasons(by_cell: Mapping[Cell, Sequence[StudyRow]]) -> str:
    """Return bars of the mean number of replans, split by what they were for."""
    cells = [cell for cell, rows in by_cell.items() if rows]
    figure, grid = plots.figure(1, 1, _WIDTH, 1.1 + 0.25 * len(cells))
    axes, places = grid[0][0], _places(cells)
    offsets = [0.0] * len(cells)
    for name, label, color in _REASONS:
        means = [estimate(float(r[name] or 0) for r in by_cell[cell]).mean for cell in cells]
        axes.barh(places, means, left=offsets, height=0.66, color=color, label=label)
        offsets = [a + b for a, b in zip(offsets, means, strict=True)]
    for total, y in zip(offsets, places, strict=True):
        axes.text(total + 0.04, y, f"{total:.2f}", va="center", color=plots.SOFT)
    axes.set_yticks(places, labels=[f"{case}  {method}" for case, method in cells])
    axes.set_ylim(max(places, default=0) + 0.6, -0.6)
    axes.set_xlabel("replans per run")
    axes.legend(loc="lower right")
    plots.bare(axes)
    return plots.svg(figure, "reasons", "Replans per run, by reason")


@plots.styled
def allocation(rows: Sequence[StudyRow], element: str) -> str:
    """Return shares of human and robot in the new plan against the value, a panel per profile."""
    profiles = list(dict.fromkeys(str(row["profile"]) for row in rows))
    profiles.sort(key=lambda name: name != BASELINE)
    figure, grid = plots.figure(max(1, len(profiles)), 1, _WIDTH, 3.9, sharey=True)
    for axes, profile in zip(grid[0], profiles, strict=False):
        points = [row for row in rows if row["profile"] == profile]
        _shares(axes, points)
        axes.set_title(f"profile {profile}")
        axes.set_xlabel(f"{element} (value that the planner gets)")
    grid[0][0].set_ylabel("share of the plan's actions (%)")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return plots.svg(figure, "allocation", f"Shares of human and robot against {element}")


def _shares(axes: Axes, points: Sequence[StudyRow]) -> None:
    values = sorted({int(row["value"] or 0) for row in points})
    changes = sorted({int(row["action"] or 0) for row in points})
    share = {
        (row["action"], row["value"]): 100.0 * float(row["n_human"] or 0)
        / max(1.0, float(row["n_human"] or 0) + float(row["n_robot"] or 0))
        for row in points
    }  # fmt: skip
    mean = [estimate(share[at, v] for at in changes if (at, v) in share).mean for v in values]
    axes.fill_between(values, mean, 0, step="mid", color=plots.ORANGE, alpha=0.35, linewidth=0)
    axes.fill_between(values, mean, 100, step="mid", color=plots.BLUE, alpha=0.18, linewidth=0)
    for at, dashes in zip(changes, ("--", ":", "-.", (0, (1, 3)), (0, (5, 3))), strict=False):
        label = "change before its first action" if at == 0 else f"before action {at + 1}"
        own = [v for v in values if (at, v) in share]  # a limit may leave some out
        axes.step(own, [share[at, v] for v in own], where="mid", linestyle=dashes,
                  linewidth=2 if at == 0 else 1.1, color=plots.INK if at == 0 else plots.SOFT,
                  label=label)  # fmt: skip
    axes.step(values, mean, where="mid", color=plots.RED, linewidth=2.2, label="mean over these")
    axes.axvline(MOST, color=plots.INK, linewidth=0.8)
    axes.text(MOST + 0.2, 97, f"{MOST}: failure is certain", va="top", color=plots.SOFT)
    axes.text(values[-1] - 0.3, 84, "robot", ha="right", color=plots.BLUE, weight="bold")
    axes.text(0.4, 6, "human", color="#9a6a00", weight="bold")
    if values[0] < values[-1]:
        axes.set_xlim(values[0], values[-1])
    axes.set_xticks(values[:: max(1, len(values) // 10)])
    axes.set_ylim(0, 100)
    plots.bare(axes, "y")


@plots.styled
def levels(lines: Mapping[str, Sequence[StudyRow]], names: Sequence[str]) -> str:
    """Return measures against the value that was drawn; a line per name, one panel per measure."""
    colors = (plots.GRAY, plots.BLUE, plots.GREEN, plots.ORANGE)
    figure, grid = plots.figure(len(names), 1, _WIDTH, 2.9)
    for axes, measure in zip(grid[0], names, strict=True):
        for color, (name, rows) in zip(colors, lines.items(), strict=False):
            values = sorted({float(row["value"] or 0) for row in rows})
            points = [
                estimate(float(r[measure] or 0) for r in rows if r["value"] == v) for v in values
            ]
            means = [e.mean for e in points]
            low, high = zip(*map(MEASURES[measure].span, points), strict=True)
            axes.fill_between(values, low, high, color=color, alpha=0.15, linewidth=0)
            axes.plot(values, means, "o-", color=color, markersize=4, label=name)
        axes.set_title(MEASURES[measure].title)
        axes.set_xlabel("value drawn for the element")
        plots.bare(axes, "y")
    grid[0][0].legend(loc="best", fontsize=8)
    return plots.svg(figure, "levels", "Measures against the drawn value")


@plots.styled
def sweeps(by_cell: Mapping[Cell, Sequence[StudyRow]], names: Sequence[str]) -> str:
    """Return measures against each swept parameter: a column per parameter, a row per measure."""
    parameters = list(dict.fromkeys(str(parameter) for parameter, _ in by_cell))
    figure, grid = plots.figure(
        len(parameters), len(names), _WIDTH, 0.6 + 1.7 * len(names), sharex="col", sharey="row"
    )
    for column, parameter in enumerate(parameters):
        cells = sorted((float(v), rows) for (name, v), rows in by_cell.items() if name == parameter)
        for line, measure in enumerate(names):
            axes = grid[line][column]
            means = [estimate(float(row[measure] or 0) for row in rows) for _, rows in cells]
            axes.errorbar([v for v, _ in cells], [e.mean for e in means],
                          _errors(measure, means), fmt="o-", markersize=4,
                          color=plots.BLUE, elinewidth=1, linewidth=1.4)  # fmt: skip
            if column == 0:
                axes.set_ylabel(MEASURES[measure].title)
            plots.bare(axes, "y")
        grid[-1][column].set_xlabel(parameter)
    return plots.svg(figure, "sweeps", "Measures against the numbers of the interactions")


def _errors(measure: str, means: Sequence[MeanEstimate]) -> list[list[float]]:
    """Return how far the intervals of means reach below and above them."""
    spans = [(e.mean, *MEASURES[measure].span(e)) for e in means]
    return [[mean - low for mean, low, _ in spans], [high - mean for mean, _, high in spans]]


@plots.styled
def lanes(rows: Sequence[StudyRow]) -> str:
    """Return one Gantt chart per variant of the example: what was carried out, lane by lane."""
    films = [(row, json.loads(str(row["bars"])), json.loads(str(row["plans"]))) for row in rows]
    agents = list(dict.fromkeys(bar["agent"] for _, bars, _ in films for bar in bars))
    color_of = charts.colors([bar["action"] for _, bars, _ in films for bar in bars])
    end_s = max((bar["end_s"] for _, bars, _ in films for bar in bars), default=1.0)
    height = charts.LANE_PT * len(agents) / 72 + 0.55
    figure, grid = plots.figure(1, len(films), _WIDTH, 0.5 + height * len(films), sharex=True)
    for (axes,), (row, bars, plans) in zip(grid, films, strict=True):
        gantt_bars = [_bar(bar, agents) for bar in bars]
        charts.draw_bars(axes, gantt_bars, color_of, 72 * (_WIDTH - 1.0) / end_s)
        for plan in plans[1:]:
            axes.axvline(plan["t"], color=plots.INK, linewidth=1, linestyle=(0, (2, 2)))
            axes.text(plan["t"] + end_s / 400, -0.62, "replan", fontsize=7, color=plots.SOFT)
        end = f"{row['ending']}, {plural(int(row['replans'] or 0), 'replan')}"
        axes.set_title(f"{row['variant']}: {end}", pad=14)
        charts.name_lanes(axes, agents, end_s)
    grid[-1][0].set_xlabel("time (s)")
    figure.set_layout_engine("constrained", hspace=0.12)
    return plots.svg(figure, "lanes", "One change of the human's state, as carried out")


def _bar(bar: Mapping[str, Any], agents: Sequence[str]) -> charts.GanttBar:
    return charts.GanttBar(
        agents.index(bar["agent"]), bar["start_s"], bar["end_s"] - bar["start_s"], bar["action"],
        " ".join(bar["args"]), failed=bar["outcome"] == "failed",
    )  # fmt: skip
