"""A run as one page that needs nothing else: the story in its journal, and the front end in it."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from html import escape
from typing import Any

from hrcplan.collaboration.companion import Companion
from hrcplan.collaboration.events import KINDS
from hrcplan.collaboration.journal import is_collaboration, setup_of
from hrcplan.execution.journal import Journal
from hrcplan.execution.journal.reader import event_in
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.web.frontend import FRONTEND
from hrcplan.web.run_head import collaboration_head, execution_head
from hrcplan.web.story import Story

MODULES = ("dom.js", "lanes.js", "belief.js", "scene.js", "story.js", "view.js", "replay.js")
_IMPORT = re.compile(r"^import .*;\n", re.MULTILINE)
_EXPORT = re.compile(r"^export ", re.MULTILINE)


def replay_page(journal: Journal) -> str:
    """Return the page of a journal: lanes, belief, what happened and why, with a slider over time.

    Raises:
        InputError: if the journal has no beginning, or an event of it makes no sense.
    """
    run = run_of(journal)
    title = f"{run['head']['domain']}: {journal.path.name}"
    return one_file(title, {**run, "title": title})


def run_of(journal: Journal) -> dict[str, Any]:
    """Return head and entries of a journal, for the page of a run.

    Raises:
        InputError: if the journal has no beginning, or an event of it makes no sense.
    """
    head, story = _head_and_story(journal)
    return {"head": head, "entries": story.entries}


def _head_and_story(journal: Journal) -> tuple[dict[str, Any], Story]:
    """Return what a page has to know of a run, and the run's story."""
    if is_collaboration(journal):
        setup = setup_of(journal)
        companion, story = Companion(setup), Story(setup.problem)
        run = companion.begin()
        for event in _events(journal):
            run, decided = companion.step(run, event)
            story.add(run.run.state, event, decided)
        return collaboration_head(setup), story
    plan_setup = journal.setup()
    model = ExecutionModel(plan_setup.problem)
    monitor = Monitor(model, plan_setup.profile, plan_setup.sensing)
    story, state = Story(plan_setup.problem), monitor.begin()
    for event in _events(journal):
        state, commands = monitor.step(state, event)
        story.add(state.state, event, commands)
    return execution_head(plan_setup.problem), story


def _events(journal: Journal) -> list[Any]:
    return [
        event_in(line, number, journal.path, KINDS)
        for number, line in enumerate(journal.lines[1:], start=2)
        if "event" in line
    ]


def one_file(title: str, run: dict[str, Any]) -> str:
    """Return a page with its style, modules and data in it; its policy allows nothing else."""
    script = "".join(_EXPORT.sub("", _IMPORT.sub("", FRONTEND[name])) for name in MODULES)
    style = FRONTEND["page.css"]
    data = json.dumps(run, ensure_ascii=False).replace("<", "\\u003c")
    policy = (
        f"default-src 'none'; script-src {_hash(script)}; style-src {_hash(style)}; "
        "img-src data: blob:"
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{escape(title)}</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<main id="page"></main>
<script type="application/json" id="run">{data}</script>
<script type="module">{script}</script>
</body>
</html>
"""


def _hash(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    return f"'sha256-{digest}'"
