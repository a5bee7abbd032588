"""The clock of the machine jumps to and fro while people and a robot collaborate."""

import json
import random
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from hrcplan.bank import Bank, build
from hrcplan.cli.terminal import IdleAlarm
from hrcplan.collaboration.collaborate import collaborate
from hrcplan.collaboration.journal import replay_collaboration
from hrcplan.execution.journal import read_journal
from hrcplan.execution.links.world import LinkWorld
from tests.collaboration.test_collaborate_command import Session, written
from tests.worlds import PACKED, PARCELS, WORKSHOP, world

HOUR_S = 3600.0
JUMPS = """
import itertools, time

def jumping(real, calls=itertools.count()):
    return lambda: real() + (0, 86_400, -86_400)[next(calls) // 5 % 3]

time.time, time.monotonic = jumping(time.time), jumping(time.monotonic)
"""


@pytest.fixture(scope="module")
def workshop() -> Bank:
    return build(world(WORKSHOP, PACKED, PARCELS))


def jumping_clock(seed: int) -> Callable[[], float]:
    """Return a clock that ticks with its calls, and now and then jumps by hours."""
    chance, now_s = random.Random(seed), 0.0

    def clock() -> float:
        nonlocal now_s
        now_s += 0.001
        if chance.random() < 0.02:
            now_s += chance.choice((-5 * HOUR_S, -60.0, -HOUR_S))
        return now_s

    return clock


@pytest.mark.parametrize("pace", ["free", "turns"])
def test_a_collaboration_with_a_robot_outlives_jumps_of_its_clock(
    workshop: Bank, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pace: str
) -> None:
    assert LinkWorld.__init__.__kwdefaults__
    monkeypatch.setitem(LinkWorld.__init__.__kwdefaults__, "clock", jumping_clock(3))
    path = tmp_path / "run.jsonl"
    done = collaborate(workshop, robot="simulated", speed=1000, pace=pace, journal=path)
    assert done.outcome.success
    journal = read_journal(path)
    assert replay_collaboration(journal).difference is None
    times = [line["event"]["t"] for line in journal.lines if "event" in line]
    assert times == sorted(times)
    assert 0 <= times[0] <= done.outcome.duration_s <= times[-1]
    assert times[-1] < HOUR_S  # no jump back was waited for


def test_a_wait_for_words_is_as_long_as_it_is_with_jumps() -> None:
    now_s, jumps = 0.0, {3: 9 * HOUR_S, 5: -20 * HOUR_S, 8: 2 * HOUR_S}
    n_looks = 0

    def clock() -> float:
        nonlocal now_s
        now_s += 0.05 + jumps.get(n_looks, 0.0)
        return now_s

    alarm = IdleAlarm(30.0, lambda seconds: False, clock)
    while not alarm(0.05):
        n_looks += 1
    assert 30 / 0.05 - 2 / 0.05 - 2 <= n_looks <= 30 / 0.05  # two jumps count as a second each


def test_a_session_at_a_terminal_outlives_jumps_of_all_clocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(JUMPS)
    folder = tmp_path / "shop"
    folder.mkdir()
    written(folder, PACKED)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "site"))
    path = tmp_path / "run.jsonl"
    session = Session(folder, "--pace", "free", "--journal", str(path))
    session.expect("> $")
    session.type("cut pipe\n")
    session.expect(r"cut pipe[^>]*> $")
    session.type("state\n")
    session.expect(r"whole rope[^>]*> $")
    session.type("quit\n")
    assert session.wait() == 1
    assert re.search(r"stopped \(quit\)", session.text)
    events = [json.loads(line)["event"] for line in path.read_text().splitlines()[1:]
              if '"event"' in line]  # fmt: skip
    assert [e["t"] for e in events] == sorted(e["t"] for e in events)
    assert "idle" not in {e["kind"] for e in events}  # nobody has waited for half a minute
    assert replay_collaboration(read_journal(path)).difference is None
