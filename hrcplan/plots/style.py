"""Plots as text: matplotlib figures in one style, turned into SVG that can stand in a page."""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable
from typing import Any, ParamSpec

P = ParamSpec("P")

BLUE, ORANGE, GREEN, RED, PINK, GRAY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#8A97A5",
)  # fmt: skip
INK, SOFT, LINE = "#1c2733", "#5b6b7b", "#dde3ea"
_STYLE = {
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "text.color": INK,
    "axes.edgecolor": LINE,
    "axes.labelcolor": SOFT,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "grid.color": LINE,
    "legend.frameon": False,
}
_ID = re.compile(r' id="([^"]+)"')


def styled(draw: Callable[P, str]) -> Callable[P, str]:
    """Return a function that draws in the style of all our plots."""

    @functools.wraps(draw)
    def drawn(*args: P.args, **options: P.kwargs) -> str:
        import matplotlib as mpl

        mpl.use("Agg")
        with mpl.rc_context(_STYLE):  # type: ignore[arg-type]
            return draw(*args, **options)

    return drawn


def figure(columns: int, rows: int, width: float, height: float, **options: Any) -> tuple[Any, Any]:
    """Return a figure of ``width`` by ``height`` inches, and its axes as a 2-d array."""
    from matplotlib.figure import Figure

    made = Figure(figsize=(width, height), layout="constrained")
    return made, made.subplots(rows, columns, squeeze=False, **options)


def svg(made: Any, name: str, label: str) -> str:
    """Return a figure as an ``svg`` element; equal figures give equal text.

    ``name`` keeps the inner names of several figures in one page apart; ``label`` is read out.
    """
    import matplotlib as mpl

    buffer = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": name}):
        made.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    text = _without_idle_names(text).replace("'DejaVu Sans'", "DejaVu Sans, Verdana, sans-serif")
    return text.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1).strip()


def _without_idle_names(text: str) -> str:
    """Drop the names that nothing refers to: a page may not hold one name twice."""
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', text))
    return _ID.sub(lambda match: match[0] if match[1] in used else "", text)


def bare(axes: Any, grid: str = "x") -> None:
    """Take frame and ticks off axes, and put a light grid behind what is drawn."""
    axes.spines[["left" if grid == "x" else "bottom"]].set_visible(False)
    axes.tick_params(length=0)
    axes.grid(axis=grid, linewidth=0.8)
