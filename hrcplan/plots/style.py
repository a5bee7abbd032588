"""The one look of all plots: colors, settings, and figures as SVG text or as files.

Settings hold only while a plot is drawn, and figures are made without pyplot: the caller's
matplotlib settings and backend stay as they are.
"""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Literal, ParamSpec, TypeVar

from hrcplan.core.extras import require

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

P = ParamSpec("P")
T = TypeVar("T")

# The colors of Okabe and Ito, which color-blind readers can tell apart.
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PINK, SKY, MINT, GRAY = "#CC79A7", "#56B4E9", "#86CFB8", "#8A97A5"
INK, SOFT, LINE = "#1c2733", "#5b6b7b", "#dde3ea"
LINES = (BLUE, ORANGE, GREEN, RED, PINK, SKY, "#8A6D3B", "#6A4C93")
"""Colors of lines and dots, in their order."""
FILLS = ("#8CC8EC", "#F2C46D", "#7CCBB1", "#E6B3CF", "#F3EC8B", "#A9C1E8", "#EDA583", "#C9CED4")
"""The same colors, lighter, for areas that carry dark text."""
DPI = 150
COPY_FORMS = ("pdf", "png")
FigureCopies = dict[str, dict[str, bytes]]
"""Of each figure of a page, by its ``svg`` text: the same figure as files, by their form."""
_Sharing = bool | Literal["none", "all", "row", "col"]
_STYLE = {
    "text.parse_math": False,  # names of files may hold dollars
    "svg.hashsalt": "hrcplan",
    "pdf.fonttype": 42,  # publishers refuse fonts of type 3
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
_CHANGING = {"svg": "Date", "pdf": "CreationDate"}  # what would differ each time
_COPIES: ContextVar[FigureCopies | None] = ContextVar("copies", default=None)
_ID = re.compile(r' id="([^"]+)"')


def styled(draw: Callable[P, T]) -> Callable[P, T]:
    """Return a function that draws in the style of all plots."""

    @functools.wraps(draw)
    def styled_draw(*args: P.args, **options: P.kwargs) -> T:
        require("matplotlib", "a picture")
        import matplotlib as mpl

        with mpl.rc_context(_STYLE):  # type: ignore[arg-type]
            return draw(*args, **options)

    return styled_draw


def figure(
    columns: int, rows: int, width: float, height: float, *,
    sharex: _Sharing = False, sharey: _Sharing = False,
) -> tuple[Figure, Any]:  # fmt: skip
    """Return a figure of ``width`` by ``height`` inches, and its axes as a 2-d array."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(width, height), layout="constrained")
    return drawing, drawing.subplots(rows, columns, squeeze=False, sharex=sharex, sharey=sharey)


def file_bytes(drawing: Figure, form: str) -> bytes:
    """Return a figure as a ``pdf``, ``png`` or ``svg`` file; equal figures give equal bytes."""
    buffer = io.BytesIO()
    metadata = {_CHANGING.get(form, "Software"): None}
    drawing.savefig(buffer, format=form, dpi=DPI, metadata=metadata)
    return buffer.getvalue()


@contextmanager
def copies() -> Iterator[FigureCopies]:
    """Give the figures that `svg` draws meanwhile as files, too: pages hold no PDF and no PNG."""
    of_page: FigureCopies = {}
    token = _COPIES.set(of_page)
    try:
        yield of_page
    finally:
        _COPIES.reset(token)


def svg(drawing: Figure, name: str, label: str) -> str:
    """Return a figure as an ``svg`` element of a page; equal figures give equal text.

    Args:
        drawing: The figure.
        name: Unique in the page: inner names are derived from it.
        label: A description for screen readers.
    """
    import matplotlib as mpl

    buffer = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": name, "svg.fonttype": "none"}):
        drawing.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    text = _without_idle_names(text).replace("'DejaVu Sans'", "DejaVu Sans, Verdana, sans-serif")
    text = text.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1).strip()
    if (of_page := _COPIES.get()) is not None:
        of_page[text] = {form: file_bytes(drawing, form) for form in COPY_FORMS}
    return text


def _without_idle_names(text: str) -> str:
    """Remove ids that nothing refers to: ids are unique in a page."""
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', text))
    return _ID.sub(lambda match: match[0] if match[1] in used else "", text)


def bare(axes: Axes, grid: Literal["x", "y"] = "x") -> None:
    """Remove frame and ticks from axes, and draw a light grid in the background."""
    axes.spines[["left" if grid == "x" else "bottom"]].set_visible(False)
    axes.tick_params(length=0)
    axes.grid(axis=grid, linewidth=0.8)
