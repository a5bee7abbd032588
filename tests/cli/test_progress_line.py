"""Progress of long work: one line of a terminal, after a while, gone at the end."""

import io
import os
import time

import pytest
from joblib.externals.loky import get_reusable_executor

from hrcplan.cli.progress_line import COLUMNS, DELAY_S, ProgressLine, ProgressLog, show_progress
from hrcplan.core.progress import counting, listen
from hrcplan.errors import LimitError
from hrcplan.pddl.inputs import read
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.solve import solve
from hrcplan.plans import parse_plan
from hrcplan.task import Task
from hrcplan.task.reachable import reachable
from tests.planners.actors import Actor, only, walk


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
def test_a_line_is_rewritten_on_a_terminal_only(
    stream: io.StringIO, shown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ProgressLine, "delay_s", 0)
    show_progress(stream)
    try:
        with counting("steps") as tell:
            tell(1)
            tell(5)
    finally:
        listen(None)
    assert bool(stream.getvalue()) == bool(shown)
    assert stream.getvalue().startswith(shown)


def test_a_log_has_a_line_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    stream, clock = io.StringIO(), Clock()
    log = ProgressLog(stream, clock)
    for clock.now in range(30):
        log("steps", int(clock.now))
        log("steps", None)
    assert stream.getvalue() == "5 steps …\n15 steps …\n25 steps …\n"
    monkeypatch.setattr(os, "getpid", lambda: -1)
    clock.now = 99
    log("steps", 99)
    assert "99" not in stream.getvalue()


def test_a_line_is_not_wider_than_the_terminal() -> None:
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(stream, clock)
    line("x" * 200, 1)
    clock.now = DELAY_S
    line("x" * 200, 2)
    assert len(stream.getvalue()) == COLUMNS  # with the carriage return


def test_planners_at_work_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def thinks(request: Request) -> Answer:
        request.on_plan(parse_plan("(go a b) (go b c)"))
        time.sleep(0.5)
        return Answer(Status.UNSOLVED)

    heard: list[str] = []
    only(monkeypatch, {"thinker": Actor("thinker", thinks)})
    get_reusable_executor().shutdown(wait=True)  # its threads would move the race elsewhere
    listen(lambda what, count: heard.append(what))
    try:
        solve(walk(), timeout_s=30)
    finally:
        listen(None)
    assert any(what.startswith("s; at work: thinker") for what in heard)
    assert any(what.endswith("best so far: 2") for what in heard)


@pytest.mark.parametrize("kind", [ProgressLine, ProgressLog])
def test_a_stream_that_was_closed_is_left_alone(kind: type[ProgressLine | ProgressLog]) -> None:
    seconds, stream = iter(range(0, 1000, 100)), io.StringIO()
    show = kind(stream, lambda: next(seconds))
    show("states", 1)
    stream.close()
    for count in (2, 3):
        show("states", count)
