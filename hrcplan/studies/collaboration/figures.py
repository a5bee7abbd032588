"""The plots of the study, as SVG text; a robot has one color on the whole page."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.plots import style as plots
from hrcplan.studies.cells import PairedCells
from hrcplan.studies.collaboration.measures import MEASURES
from hrcplan.studies.page import keys

COLORS = (plots.ORANGE, plots.GREEN, plots.BLUE, plots.PINK, plots.GRAY, plots.RED, plots.MINT)


def color(method: str, methods: Sequence[str]) -> str:
    """Return the color of a robot."""
    return COLORS[methods.index(method) % len(COLORS)]


def legend(methods: Sequence[str]) -> str:
    """Return what the colors stand for, as HTML."""
    return keys([(name, color(name, methods), "") for name in methods])


@plots.styled
def dots(cells: PairedCells, measure: str) -> str:
    """Return a measure: a panel per task, a dot with its 95 % interval per robot."""
    figure, grid = plots.figure(len(cells.cases), 1, 2.6 * len(cells.cases) + 0.6, 2.4)
    for axes, task in zip(grid[0], cells.cases, strict=True):
        for x, method in enumerate(cells.methods):
            if (e := cells.mean(task, method, measure)) is not None:
                tone = color(method, cells.methods)
                axes.plot([x, x], MEASURES[measure].span(e), color=tone, linewidth=2.2,
                          alpha=0.45, solid_capstyle="round")  # fmt: skip
                axes.plot([x], [e.mean], "o", color=tone, markersize=5.5)
        axes.set_xticks([])
        axes.set_xlim(-0.6, len(cells.methods) - 0.4)
        axes.margins(y=0.15)
        axes.set_title(task)
        plots.bare(axes, "y")
    grid[0][0].set_ylabel(f"{MEASURES[measure].name} ({MEASURES[measure].unit})")
    title = MEASURES[measure].name
    return plots.svg(figure, f"dots {measure}", f"{title}, by task and robot")
