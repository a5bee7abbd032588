"""The page of an allocation diagram: who does how much, for every value of one function.

It shows what `hrcplan allocation --json` writes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from pathlib import Path

from hrcplan.core.files import read_bytes
from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.svg import COLORS
from hrcplan.errors import InputError
from hrcplan.web.pages import card, document, save_data

MAX_BYTES = 4 << 20
_WIDTH, _HEIGHT, _SIDE, _TOP = 640, 200, 44, 24  # pixels
_NO_AGENT = "no agent"


@dataclass(frozen=True, slots=True)
class DiagramPiece:
    """From ``least`` to ``most`` one allocation is best; its metric is a line over the value."""

    least: float
    most: float
    intercept: float
    slope: float
    n_actions: Mapping[str, int]
    plan: Sequence[str]


@dataclass(frozen=True, slots=True)
class DiagramDocument:
    """An allocation diagram as its JSON document says it; ``value`` is that of the problem."""

    element: str
    value: float
    is_proven: bool
    pieces: Sequence[DiagramPiece]

    @property
    def agents(self) -> list[str]:
        """The agents of all pieces, in the order of their names."""
        return sorted({agent for piece in self.pieces for agent in piece.n_actions})


def is_diagram(data: bytes) -> bool:
    """Return whether the bytes of a file are an allocation diagram."""
    if data.lstrip()[:1] != b"{" or len(data) > MAX_BYTES:
        return False
    try:
        value = json.loads(data)
    except (ValueError, RecursionError):
        return False
    return isinstance(value, dict) and "element" in value and "pieces" in value


def read_diagram(path: Path) -> DiagramDocument:
    """Return the allocation diagram in a file.

    Raises:
        InputError: if the file cannot be read, or is no allocation diagram.
    """
    try:
        return _diagram(json.loads(read_bytes(path, MAX_BYTES)))
    except DOCUMENT_FAULTS:
        message = f"{path.name} is no allocation diagram"
        hint = "write it again: hrcplan allocation ... --json > FILE"
        raise InputError(message, code="bad-diagram", path=str(path), hint=hint) from None


def _diagram(value: Mapping[str, JsonValue]) -> DiagramDocument:
    pieces = [_piece(piece) for piece in _list(value["pieces"])]
    if not pieces or any(not piece.least < piece.most for piece in pieces):
        raise ValueError("a piece is empty")
    if any(one.most != other.least for one, other in pairwise(pieces)):
        raise ValueError("there is a gap between pieces")
    return DiagramDocument(
        str(value["element"]), _number(value["value"]), value["proven"] is True, pieces
    )


def _piece(value: JsonValue) -> DiagramPiece:
    if not isinstance(value, Mapping) or not isinstance(counts := value["n_actions"], Mapping):
        raise TypeError
    n_actions = {agent: int(_number(n)) for agent, n in counts.items()}
    if any(n < 0 for n in n_actions.values()):
        raise ValueError("a number of actions is negative")
    return DiagramPiece(
        _number(value["from"]), _number(value["to"]), _number(value["intercept"]),
        _number(value["slope"]), n_actions, [str(action) for action in _list(value["plan"])],
    )  # fmt: skip


def _list(value: JsonValue) -> Sequence[JsonValue]:
    if not isinstance(value, list):
        raise TypeError
    return value


def _number(value: JsonValue) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise TypeError
    return float(value)


def diagram_page(title: str, diagram: DiagramDocument) -> str:
    """Return the page of an allocation diagram: picture, table, and the plan of each piece."""
    words = "" if diagram.is_proven else " (approximate: not all plans are proven to be the best)"
    flips = ", ".join(f"{piece.most:g}" for piece in diagram.pieces[:-1])
    now = f"now {diagram.value:g}; " + (f"flips at {flips}" if flips else "it never flips here")
    picture = f'<p>{now}{words}</p><div class="scroll">{_picture(diagram)}</div>'
    plans = "".join(
        f"<details><summary>plan from {piece.least:g} to {piece.most:g}</summary>"
        f"<pre>{escape(chr(10).join(piece.plan))}</pre></details>"
        for piece in diagram.pieces
    )
    cards = card(f"Who does how much, by {diagram.element}", picture)
    cards += card("Allocations", _table(diagram) + plans)
    body = f'<nav><a href="/">← all</a></nav><main><div class="cards">{cards}</div></main>'
    return document(title, body, pictures=True)


def _rows(diagram: DiagramDocument) -> list[list[str]]:
    """Return the table of the pieces, with its head."""
    names = [agent or _NO_AGENT for agent in diagram.agents]
    lines = (
        [f"{p.least:g}", f"{p.most:g}", *(str(p.n_actions.get(a, 0)) for a in diagram.agents),
         f"{p.intercept:g}", f"{p.slope:g}"]
        for p in diagram.pieces
    )  # fmt: skip
    return [["from", "to", *names, "metric at 0", "per unit"], *lines]


def _table(diagram: DiagramDocument) -> str:
    head, *rows = _rows(diagram)
    lines = ["".join(f'<th class="n">{escape(name)}</th>' for name in head)]
    lines += ["".join(f'<td class="n">{text}</td>' for text in row) for row in rows]
    table = "".join(f"<tr>{line}</tr>" for line in lines)
    return f'<div class="scroll"><table>{table}</table></div>'


def _picture(diagram: DiagramDocument) -> str:
    """Return bars as wide as the pieces, divided by what share each agent does."""
    first, last = diagram.pieces[0].least, diagram.pieces[-1].most
    unit = (_WIDTH - 2 * _SIDE) / (last - first)
    bottom = _TOP + _HEIGHT
    body = [part for piece in diagram.pieces for part in _bars(piece, diagram, first, unit)]
    ends = sorted({first, last, *(piece.most for piece in diagram.pieces)})
    body += [_label(_SIDE + unit * (end - first), bottom + 16, f"{end:g}") for end in ends]
    body.append(_label(_WIDTH / 2, bottom + 34, diagram.element))
    if first <= diagram.value <= last:
        x = _SIDE + unit * (diagram.value - first)
        body.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{_TOP - 6}" y2="{bottom}" '
                    'stroke="#d55e00" stroke-width="2" stroke-dasharray="5 3"/>')  # fmt: skip
        body.append(_label(x, _TOP - 10, f"now {diagram.value:g}"))
    for row, agent in enumerate(diagram.agents):
        y = bottom + 46 + 18 * row
        body.append(f'<rect x="{_SIDE}" y="{y}" width="12" height="12" fill="{_color(row)}"/>')
        body.append(_label(_SIDE + 18, y + 10, agent or _NO_AGENT, "start"))
    height = bottom + 52 + 18 * len(diagram.agents)
    return (
        f'<svg width="{_WIDTH}" height="{height}" viewBox="0 0 {_WIDTH} {height}" role="img" '
        f'aria-label="who does how much" {save_data("allocation", _rows(diagram))}>'
        f"{''.join(body)}</svg>"
    )


def _bars(
    piece: DiagramPiece, diagram: DiagramDocument, first: float, unit: float
) -> list[str]:  # fmt: skip
    total = sum(piece.n_actions.values()) or 1
    x, width = _SIDE + unit * (piece.least - first), unit * (piece.most - piece.least)
    y, parts = float(_TOP), list[str]()
    for row, agent in enumerate(diagram.agents):
        n = piece.n_actions.get(agent, 0)
        height = _HEIGHT * n / total
        title = f"{agent or _NO_AGENT}: {n} actions from {piece.least:g} to {piece.most:g}"
        parts.append(
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{max(1.0, width - 1):.1f}" '
            f'height="{height:.1f}" fill="{_color(row)}"><title>{escape(title)}</title></rect>'
        )
        if height >= 16 and width >= 24:
            parts.append(_label(x + width / 2, y + height / 2 + 4, str(n), "middle", "on"))
        y += height
    return parts


def _label(x: float, y: float, text: str, anchor: str = "middle", kind: str = "") -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{kind}">{escape(text)}</text>'
    )


def _color(row: int) -> str:
    return COLORS[row % len(COLORS)]
