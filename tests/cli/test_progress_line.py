"""Progress of long work: one line of a terminal, after a while, gone at the end."""

import io
import os

import pytest

from hrcplan.cli.progress_line import DELAY_S, ProgressLine, show_progress
from hrcplan.core.progress import counting, listen
from hrcplan.errors import LimitError
from hrcplan.pddl.inputs import read
from hrcplan.task import Task
from hrcplan.task.reachable import reachable


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_the_line_is_rewritten_and_cleared() -> None:
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(stream, clock)
    line("steps", 256)
    clock.now = DELAY_S - 0.1
    line("steps", 512)
    assert stream.getvalue() == ""
    clock.now = DELAY_S
    line("steps", 12800)
    line("steps", 12900)  # too soon
    clock.now += 1
    line("steps", 7)
    line("steps", None)
    assert stream.getvalue() == f"\r12,800 steps …\r{'7 steps …':14}\r{'':9}\r"


def test_short_work_and_copies_of_the_process_write_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(stream, clock)
    line("steps", 1)
    line("steps", None)
    line("steps", 1)
    clock.now = 9
    monkeypatch.setattr(os, "getpid", lambda: -1)
    line("steps", 1)
    assert stream.getvalue() == ""


def test_grounding_tells_how_far_it_is_and_always_ends() -> None:
    heard: list[tuple[str, int | None]] = []
    listen(lambda what, count: heard.append((what, count)))
    try:
        Task(read("transport", "boxes-6"))
        assert ("reachable ground actions", None) in heard
        assert heard[-1] == ("ground actions", None)
        assert any(count for _, count in heard)
        heard.clear()
        with pytest.raises(LimitError):
            reachable(read("transport", "boxes-6"), deadline=-1.0)
        assert heard[-1] == ("reachable ground actions", None)
    finally:
        listen(None)


@pytest.mark.parametrize(("stream", "shown"), [(Terminal(), "\r5 steps …"), (io.StringIO(), "")])
def test_only_a_terminal_shows_progress(
    stream: io.StringIO, shown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hrcplan.cli.progress_line.DELAY_S", 0)
    show_progress(stream)
    try:
        with counting("steps") as tell:
            tell(1)
            tell(5)
    finally:
        listen(None)
    assert bool(stream.getvalue()) == bool(shown)
    assert stream.getvalue().startswith(shown)
