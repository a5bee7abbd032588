"""The plots of the study, as SVG text; a method has one color on the whole page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hrcplan.plots import style as plots
from hrcplan.studies.changed_mind.cells import Cells
from hrcplan.studies.changed_mind.episodes import ORACLE
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.page import keys

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = {
    "rhp": plots.ORANGE, "recursive": plots.MINT, "recursive-best": plots.GREEN,
    "cdp": plots.RED, "infogain": plots.PINK, "hrcplan": plots.BLUE, "oracle": plots.GRAY,
}  # fmt: skip
_OTHERS = ("#6a4c93", "#8A6D3B", "#3d5a5a", "#B8A500")
BOUNDS = {"cdp": "line", "infogain": "dashed", "oracle": "dotted"}
"""Methods that are drawn as lines behind the others, as the paper draws its two bounds."""
_LINES = {"line": "-", "dashed": (0, (4, 2)), "dotted": (0, (1, 1.5))}


def color(method: str, methods: Sequence[str]) -> str:
    """Return the color of a method; a user's own method gets the next free one."""
    others = [name for name in methods if name not in COLORS]
    if method in COLORS:
        return COLORS[method]
    return _OTHERS[others.index(method) % len(_OTHERS)]


def have_colors(methods: Sequence[str]) -> bool:
    """Whether each method has a color of its own: there are few for users' methods."""
    return sum(name not in COLORS for name in methods) <= len(_OTHERS)


def without_oracle(methods: Sequence[str]) -> list[str]:
    """Return methods but the oracle, whose guesses would only stretch the scale."""
    return [method for method in methods if method != ORACLE]


def legend(methods: Sequence[str], lines: bool = False) -> str:
    """Return what the colors stand for, as HTML; with ``lines``, bounds as lines."""
    kinds = BOUNDS if lines else {}
    return keys([(name, color(name, methods), kinds.get(name, "")) for name in methods])


@plots.styled
def bars(cells: Cells, humans: Sequence[str], measure: str, title: str) -> str:
    """Return a measure by human: bars with standard errors, and bounds as lines."""
    figure, grid = plots.figure(1, 1, 4.0, 2.8)
    axes = grid[0][0]
    solid = [method for method in cells.methods if method not in BOUNDS]
    width = 0.82 / max(1, len(solid))
    for x, human in enumerate(humans):
        for i, method in enumerate(solid):
            if (e := cells.mean(human, method, measure)) is not None:
                at = x + (i - (len(solid) - 1) / 2) * width
                axes.bar(at, e.mean, width * 0.9, color=color(method, cells.methods))
                axes.errorbar(at, e.mean, e.se, color=plots.INK, elinewidth=1, capsize=1.5)
        for method, kind in BOUNDS.items():
            if (e := cells.mean(human, method, measure)) is not None:
                axes.plot([x - 0.45, x + 0.45], [e.mean] * 2, linestyle=_LINES[kind],
                          color=color(method, cells.methods), linewidth=2)  # fmt: skip
    _humans(axes, humans, measure, title)
    return plots.svg(figure, f"bars {title}", f"{title}, by human and method")


@plots.styled
def dots(cells: Cells, measure: str, title: str, name: str) -> str:
    """Return a measure by human: dots with 95 % intervals, without the oracle's."""
    figure, grid = plots.figure(1, 1, 6.0, 2.7)
    axes = grid[0][0]
    methods = without_oracle(cells.methods)
    n = len(methods)
    for x, human in enumerate(cells.humans):
        for i, method in enumerate(methods):
            if (e := cells.mean(human, method, measure)) is not None:
                at, tone = x + (i - (n - 1) / 2) * 0.6 / n, color(method, cells.methods)
                axes.plot([at, at], MEASURES[measure].span(e), color=tone, linewidth=2.2,
                          alpha=0.45, solid_capstyle="round")  # fmt: skip
                axes.plot([at], [e.mean], "o", color=tone, markersize=5.5)
    _humans(axes, cells.humans, measure, title)
    return plots.svg(figure, f"{name} {title}", f"{title}, by human and method")


def _humans(axes: Axes, humans: Sequence[str], measure: str, title: str) -> None:
    axes.set_xticks(range(len(humans)), labels=[human.replace(", ", ",\n") for human in humans])
    axes.set_xlim(-0.55, len(humans) - 0.45)
    axes.set_ylabel(MEASURES[measure].unit)
    axes.set_title(title)
    plots.bare(axes, "y")


@plots.styled
def variants(cells: Cells, measures: Sequence[str]) -> str:
    """Return a line per method and a panel per measure; full and hollow dots are humans."""
    figure, grid = plots.figure(
        len(measures), 1, 9.5, 0.9 + 0.27 * len(cells.methods), sharey=True
    )  # fmt: skip
    for axes, measure in zip(grid[0], measures, strict=True):
        for i, human in enumerate(cells.humans):
            fill = plots.INK if i == 0 else "white"
            for y, method in enumerate(cells.methods):
                if (e := cells.mean(human, method, measure)) is not None:
                    axes.plot(MEASURES[measure].span(e), [y, y], color=plots.SOFT,
                              linewidth=1.6, alpha=0.6)  # fmt: skip
                    axes.plot([e.mean], [y], "o", markersize=5.5, markerfacecolor=fill,
                              markeredgecolor=plots.INK)  # fmt: skip
        axes.set_title(MEASURES[measure].name)
        axes.set_xlabel(MEASURES[measure].unit)
        axes.margins(x=0.12)
        plots.bare(axes)
    grid[0][0].set_yticks(range(len(cells.methods)), labels=cells.methods)
    grid[0][0].set_ylim(len(cells.methods) - 0.4, -0.6)
    return plots.svg(figure, "variants", "Measures of each variant")
