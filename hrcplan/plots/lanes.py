"""Bars in lanes, one lane per agent: what Gantt charts of plans and of runs have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from hrcplan.plots import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAR = 0.74  # height of a bar; a lane is 1 high
LANE_PT = 54.0  # height of a lane, in points
FONT_PT = 8.0
_LINE_PT = 1.2 * FONT_PT
_PAD_PT = 4.0


@dataclass(frozen=True, slots=True)
class GanttBar:
    """One action in a lane.

    Attributes:
        lane: Number of the lane, from the top.
        start: When it begins, in the unit of the time axis.
        length: How long it lasts.
        name: Of the action; equal names have equal colors.
        words: The text after the name.
        failed: Whether it failed.
        faint: Whether the lane's agent is only kept busy by another agent's action.
    """

    lane: int
    start: float
    length: float
    name: str
    words: str = ""
    failed: bool = False
    faint: bool = False

    @property
    def text(self) -> str:
        """Everything there is to say, in one line."""
        text = f"{self.name} {self.words}".strip()
        return f"({text})" if self.faint else f"{text} (failed)" if self.failed else text


@lru_cache(maxsize=4096)
def width_pt(text: str, size: float = FONT_PT) -> float:
    """Return the width of a line of text in points."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family="DejaVu Sans")
    return float(TextPath((0, 0), text, size=size, prop=font).get_extents().width) if text else 0.0


def layouts(bar: GanttBar) -> list[tuple[str, bool]]:
    """Return the texts to try in a bar, the best first, each with whether it is rotated."""
    two_lines = "\n".join(filter(None, (bar.name, bar.words)))
    words = "\n".join([bar.name, *bar.words.split()])
    if bar.faint:
        return [(bar.text, False), (bar.text, True)]
    texts = [f"{text}\nfailed" if bar.failed else text for text in (two_lines, words)]
    return [(texts[0], False), (texts[1], False), (texts[0], True), (bar.text, True)]


def fitting(bar: GanttBar, width: float, height: float) -> tuple[str, bool] | None:
    """Return the first layout that fits into ``width`` x ``height`` points; None if none does."""
    for text, is_rotated in layouts(bar):
        lines = text.split("\n")
        along, across = max(map(width_pt, lines)), len(lines) * _LINE_PT
        size = (across, along) if is_rotated else (along, across)
        if size[0] + _PAD_PT <= width and size[1] + _PAD_PT <= height:
            return text, is_rotated
    return None


def fits(bar: GanttBar, unit_pt: float) -> bool:
    """Return whether some layout of the text fits into a bar; ``unit_pt`` as in `draw_bars`."""
    return fitting(bar, bar.length * unit_pt, BAR * LANE_PT) is not None


def colors(names: Sequence[str]) -> dict[str, str]:
    """Return a color for each name, in the order in which names first appear."""
    return {n: style.FILLS[i % len(style.FILLS)] for i, n in enumerate(dict.fromkeys(names))}


def draw_bars(
    axes: Axes, bars: Sequence[GanttBar], color_of: dict[str, str], unit_pt: float
) -> dict[str, int]:
    """Draw bars, each with its text if that fits, else with a number; equal texts share a number.

    Args:
        axes: Where to draw; lanes are 1 high, the first at 0.
        bars: The bars.
        color_of: A color for each name.
        unit_pt: The length of one unit of time in points.

    Returns:
        The number of each text that did not fit: a legend has to name them.
    """
    numbers: dict[str, int] = {}
    for bar in sorted(bars, key=lambda bar: (bar.start, bar.lane)):
        axes.broken_barh(
            [(bar.start, bar.length)], (bar.lane - BAR / 2, BAR),
            facecolor="white" if bar.failed else color_of[bar.name],
            edgecolor=style.RED if bar.failed else "white", linewidth=1.2,
            hatch="////" if bar.failed else None, alpha=0.5 if bar.faint else 1,
        )  # fmt: skip
        layout = fitting(bar, bar.length * unit_pt, BAR * LANE_PT)
        if layout is None:
            if bar.faint:
                continue
            layout = str(numbers.setdefault(bar.text, len(numbers) + 1)), False
        text, is_rotated = layout
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8} if bar.failed else None
        axes.text(bar.start + bar.length / 2, bar.lane, text, ha="center", va="center",
                  rotation=90 if is_rotated else 0, fontsize=FONT_PT, linespacing=1.1, bbox=box,
                  color=style.RED if bar.failed else style.INK, clip_on=True)  # fmt: skip
    return numbers


def name_lanes(axes: Axes, names: Sequence[str], end: float) -> None:
    """Name the lanes, and show the time from 0 to ``end``."""
    axes.set_yticks(range(len(names)), labels=[name or "no agent" for name in names])
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlim(0, end)
    for border in range(1, len(names)):
        axes.axhline(border - 0.5, color=style.LINE, linewidth=0.8, zorder=0)
    style.bare(axes)
