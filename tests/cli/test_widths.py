"""What commands print at terminals of 60, 80 and 120 columns: no word is cut, no column lost."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from hrcplan.bank import build_bank
from hrcplan.cli import output
from hrcplan.cli.infer import as_text
from hrcplan.cli.live import Live
from hrcplan.cli.planners import command as planners
from hrcplan.cli.play import _n_columns, _side_by_side
from hrcplan.execution.execute import carry_out, prepare_run
from hrcplan.inference import infer
from hrcplan.pddl.inputs import read
from hrcplan.studies.changed_mind.script import NarratedEpisode, NarratedTurn

PROBLEMS = Path(__file__).parents[2] / "problems"
WIDTHS = (60, 80, 120)


@pytest.fixture(params=WIDTHS)
def width(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    columns: int = request.param
    monkeypatch.setenv("COLUMNS", str(columns))
    return columns


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def printed(write: Callable[[], object]) -> list[str]:
    """Return the lines that are written to a terminal."""
    terminal = Terminal()
    with redirect_stdout(terminal):
        write()
    return terminal.getvalue().splitlines()


def episode(method: str) -> NarratedEpisode:
    top = (("smoothie-chocolate", 0.6), ("parfait-fruit", 0.4))
    turns = [
        NarratedTurn(t, agent, "(pour oats glass)", "parfait-fruit", False, top, 0)
        for t, agent in enumerate(("human", "robot"))
    ]
    return NarratedEpisode(method, tuple(turns), "")


def words(lines: list[str]) -> list[str]:
    return [word for line in lines for word in line.split()]


def test_planners_and_their_licences_fit(width: int) -> None:
    command = planners.callback
    assert command is not None
    whole = CliRunner().invoke(planners).output  # a pipe: lines as they are
    lines = printed(command)
    assert max(map(len, lines)) <= width
    assert words(lines) == whole.split()


def test_folded_lines_keep_numbers_and_units_together(width: int) -> None:
    lines = printed(lambda: output.result(output.fold("plant-care 67 %, " * 40, indent=11)))
    assert max(map(len, lines)) <= width
    assert not any(line.lstrip().startswith("%") for line in lines)
    assert all(line.startswith(" " * 11) for line in lines[1:])


def test_a_run_with_two_humans_has_straight_lanes(width: int) -> None:
    problem = read("household", str(PROBLEMS / "household-family" / "plant-care.pddl"))
    live = Live(problem)
    head, *lines = printed(lambda: carry_out(prepare_run(problem), watch=live.watch))
    lanes = [match.start() for match in re.finditer(r"\S+", head)]
    assert len(lanes) == 4
    assert max(map(len, lines)) <= width
    for line in lines:
        marks = [match.start() for match in re.finditer("[▶✓]", line)]
        marks += [match.start() for match in re.finditer(r"[█░]+ \d+/\d+$", line)]
        assert set(marks) <= set(lanes), line


def test_methods_side_by_side_are_never_cut(width: int) -> None:
    episodes = [episode(name) for name in ("hrcplan", "rhp, exact belief", "recursive")]
    lines = [click.unstyle(line) for line in printed(lambda: side_by_side(episodes))]
    assert max(map(len, lines)) <= width
    assert words(lines).count("smoothie-chocolate") == len(episodes)
    assert words(lines).count("✓") == len(episodes)


def test_no_color_takes_the_color(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    lines = printed(lambda: side_by_side([episode("hrcplan")]))
    assert not re.search(r"\x1b\[([0-9;]*;)?3[0-7]\b", "\n".join(lines))


def test_a_posterior_is_folded_between_its_goals(width: int) -> None:
    answer = infer(build_bank("transport", "transport-goals"), ["(move human wp1 wp4)"])
    text = as_text(answer)  # no terminal
    lines = printed(lambda: output.result(as_text(answer)))
    assert max(map(len, lines)) <= width
    assert words(lines) == text.split()
    assert not any(re.search(r" \d\.\d\d$", line) for line in lines[:-1])


def side_by_side(episodes: list[NarratedEpisode]) -> None:
    n = _n_columns(episodes, output.table_width())
    for first in range(0, len(episodes), n):
        output.table(_side_by_side(episodes[first : first + n]))
