"""Small pictures for notebooks, as SVG text: bars in lanes, and lines over steps.

Charts for files and papers are drawn with matplotlib; these need nothing and appear at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from hrcplan.core.records import record
from hrcplan.core.text import cut

# Okabe and Ito's colors: color-blind readers can tell them apart.
COLORS = ("#56B4E9", "#E69F00", "#009E73", "#F0E442", "#CC79A7", "#0072B2", "#D55E00", "#BBBBBB")
WIDTH, MARGIN = 760, 110  # pixels; the margin holds the lanes' names
MAX_BARS = 2000  # a larger picture cannot be read, and browsers become slow
_ROW, _AXIS = 40, 24
_CHARACTER = 6.2  # width of a character of size 11, about


@record
class LaneBar:
    """One bar: its lane, its text, from when to when, and whether it is marked as failed."""

    lane: str
    label: str
    start: float
    end: float
    failed: bool = False


def gantt(bars: Sequence[LaneBar], unit: str = "s") -> str:
    """Return bars in lanes over time; lanes are in order of appearance, colors by first word.

    >>> gantt([LaneBar("robot", "move <a>", 0, 2)]).count("&lt;a&gt;")
    2
    """
    bars = bars[:MAX_BARS]
    lanes = list(dict.fromkeys(bar.lane for bar in bars))
    kinds = list(dict.fromkeys(bar.label.split(" ", 1)[0] for bar in bars))
    span = max((bar.end for bar in bars), default=0) or 1
    body = [_text(MARGIN - 8, _ROW * row + 24, lane, MARGIN - 12, anchor="end")
            for row, lane in enumerate(lanes)]  # fmt: skip
    for bar in bars:
        x = MARGIN + (WIDTH - MARGIN - 10) * bar.start / span
        width = max(1.0, (WIDTH - MARGIN - 10) * (bar.end - bar.start) / span)
        color = COLORS[kinds.index(bar.label.split(" ", 1)[0]) % len(COLORS)]
        body += _bar(bar, x, _ROW * lanes.index(bar.lane) + 4, width, color, unit)
    bottom = _ROW * len(lanes)
    body.append(_text(MARGIN, bottom + 16, f"0 {unit}", 100))
    body.append(_text(WIDTH - 10, bottom + 16, f"{span:g} {unit}", 200, anchor="end"))
    return _document(bottom + _AXIS, body)


def lines(series: Sequence[tuple[str, Sequence[float]]], marks: Sequence[float] = ()) -> str:
    """Return probabilities over steps: a line per series with its name, and vertical marks.

    >>> lines([("tea & cake", [0.5, 1.0])]).count("tea &amp; cake")
    1
    """
    height, right = 200, 190
    n = max((len(values) for _, values in series), default=0)
    step = (WIDTH - MARGIN - right) / max(1, n - 1)
    body = [_text(MARGIN - 8, 190 - 180 * p + 4, f"{p:g}", 60, anchor="end") for p in (0, 0.5, 1)]
    for at in marks:
        x = MARGIN + step * at
        body.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="10" y2="190" stroke="currentColor" '
                    'stroke-dasharray="4 3"/>')  # fmt: skip
    for i, (name, values) in enumerate(series):
        color = COLORS[i % len(COLORS)]
        points = " ".join(f"{MARGIN + step * at:.1f},{190 - 180 * p:.1f}"
                          for at, p in enumerate(values))  # fmt: skip
        body.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="2"/>')
        y = 16 + 16 * i
        body.append(f'<rect x="{WIDTH - right + 12}" y="{y - 9}" width="10" height="10" '
                    f'fill="{color}"/>')  # fmt: skip
        body.append(_text(WIDTH - right + 28, y, name, right - 30))
    return _document(max(height, 16 * len(series) + 16), body)


def _bar(bar: LaneBar, x: float, y: float, width: float, color: str, unit: str) -> Iterator[str]:
    dashes = ' stroke="#B00020" stroke-width="2" stroke-dasharray="4 3"' if bar.failed else ""
    title = f"{bar.label}, {bar.start:g} to {bar.end:g} {unit}{', failed' if bar.failed else ''}"
    yield (
        f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{_ROW - 8}" rx="2" '
        f'fill="{color}"{dashes}><title>{escape(title)}</title></rect>'
    )
    yield _text(x + 4, y + 20, bar.label, width - 6, fill="#111")


def _text(
    x: float, y: float, text: str, width: float, *, anchor: str = "start", fill: str = ""
) -> str:
    """Return a text, cut to a width; nothing if not even one character fits."""
    room = int(width / _CHARACTER)
    if room < 2:
        return ""
    color = f' style="fill:{fill}"' if fill else ""
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{color}'
    return f"<text {place}>{escape(cut(text, room))}</text>"


def _document(height: float, body: Sequence[str]) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}" '
        f'width="100%" style="max-width:{WIDTH}px" font-family="sans-serif" font-size="11" '
        f'fill="currentColor" role="img">{"".join(body)}</svg>'
    )
