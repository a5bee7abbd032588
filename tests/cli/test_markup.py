"""Square brackets in names are text, not markup of the terminal library."""

from __future__ import annotations

import pytest

from hrcplan.cli import output
from hrcplan.cli.play import _side_by_side
from hrcplan.studies.changed_mind.script import NarratedEpisode, NarratedTurn


def test_names_with_brackets_are_shown_as_they_are(capsys: pytest.CaptureFixture[str]) -> None:
    turns = tuple(
        NarratedTurn(0, agent, f"(get [/{agent}])", "[/goal]", False, (("[/goal]", 1.0),), 0)
        for agent in ("human", "robot")
    )
    output.table(_side_by_side([NarratedEpisode("[/method]", turns, "")]))
    shown = capsys.readouterr().out
    assert all(f"[/{word}]" in shown for word in ("human", "robot", "goal", "method"))
