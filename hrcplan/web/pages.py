"""Pages that need no script: the list of collaborations, and the frame of all others."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

ROBOTS = ("hrcplan", "recursive", "recursive-best", "cdp", "infogain", "rhp")
HUMANS = {"me": "I act for the people", "frontier": "simulated", "cc-htn": "simulated, by modules"}
PACES = {"turns": "in turns", "free": "at any time"}
SCRIPT = '<script type="module" src="/static/app.js"></script>'
_SAVE_SCRIPT = '<script type="module" src="/static/dom.js"></script>'


def document(title: str, body: str, script: str = "", *, pictures: bool = False) -> str:
    """Return a page; the body is markup already.

    Args:
        title: The title of the window.
        body: What is in it.
        script: The element that loads its script.
        pictures: Whether pictures of the body have `save_data`: they get buttons that save them.
    """
    if pictures:
        script += _SAVE_SCRIPT
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="/static/page.css">
{script}
</head>
<body>{body}</body>
</html>
"""


def save_data(name: str, rows: Sequence[Sequence[str]]) -> str:
    """Return the attributes of an ``svg`` that can be saved: file name and rows of its table."""
    return f'id="{escape(name)}" data-rows="{escape(json.dumps(rows, ensure_ascii=False))}"'


def live_page(names: Sequence[str]) -> str:
    """Return the page of collaborations side by side."""
    main = (
        f'<nav><a href="/">← all</a></nav><main id="page" data-api="/api/" '
        f'data-sessions="{escape("+".join(names))}"></main>'
    )
    return document("hrcplan", main, SCRIPT)


def card(title: str, body: str) -> str:
    """Return a part of a page; the body is markup already."""
    return f'<section class="card"><h2>{escape(title)}</h2>{body}</section>'


def select(name: str, choices: Mapping[str, str]) -> str:
    """Return a labelled choice between values, each with its text."""
    options = "".join(
        f'<option value="{escape(value)}">{escape(text)}</option>'
        for value, text in choices.items()
    )
    return f'<label>{escape(name)}<select name="{escape(name)}">{options}</select></label>'


def home_page(
    worlds: Sequence[Mapping[str, str]], sessions: Sequence[Mapping[str, Any]],
    files: Sequence[str] = (),
) -> str:  # fmt: skip
    """Return the first page: begin a collaboration, go on with one, or look at a file."""
    by_world = {f"{w['domain']} {w['goals']}": _world_text(w) for w in worlds}
    begin = (
        '<p class="soft">It does not know your goal, infers it from what you do, and helps; you '
        'may change your mind.</p><form class="begin" method="post" action="/begin">'
        + select("world", by_world)
        + select("pace", PACES)
        + select("robot", {name: name for name in ROBOTS})
        + select("human", HUMANS)
        + '<label>seed<input name="seed" type="number" min="0" value="0"></label>'
        '<div><button class="main">begin</button></div></form>'
    )
    cards = card("Work together with a robot", begin) + card("Collaborations", _rows(sessions))
    if files:
        links = (f'<li><a href="/look/{n}">{escape(f)}</a></li>' for n, f in enumerate(files))
        cards += card("Files", f"<ul>{''.join(links)}</ul>")
    return document("hrcplan", f'<main><h1>hrcplan</h1><div class="cards">{cards}</div></main>')


def _world_text(world: Mapping[str, str]) -> str:
    return f"{world['label']} (one goal: a plan is followed)" if world["single"] else world["label"]


def _rows(sessions: Sequence[Mapping[str, Any]]) -> str:
    if not sessions:
        return '<p class="soft">none yet</p>'
    rows = "".join(
        f'<tr><td><input type="checkbox" name="name" value="{escape(one["name"])}" '
        f'aria-label="show {escape(one["name"])}"></td>'
        f'<td><a href="/c/{escape(one["name"])}">{escape(one["goals"] or one["domain"])}</a></td>'
        f"<td>{escape(PACES.get(one['pace'], one['pace']))}</td>"
        f"<td>{escape(one['human'])}</td><td>{escape(one['phase'])}</td></tr>"
        for one in sessions
    )
    return (
        f'<form action="/c"><div class="scroll"><table>{rows}</table></div>'
        "<p><button>show side by side</button></p></form>"
    )
