"""What a robot link adds to an action: the time of a message there and back, and memory."""

from __future__ import annotations

import json
import os
import resource
import shlex
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from rows import Row, milliseconds

from hrcplan.execution.links import make_link
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.process import ProcessLink
from hrcplan.execution.links.ros.link import PYTHON, ros_python
from hrcplan.execution.links.ros.mapping import read_mapping
from hrcplan.execution.links.ros.simulated import ROBOT as ROS_ROBOT
from hrcplan.execution.links.ros.simulated import robot_options
from hrcplan.pddl.inputs import read

N_ACTIONS = 10_000
MOST_MEDIAN_S, MOST_P99_S = 0.002, 0.010
MOST_GROWTH_MB = 5
N_GOALS = 300
MOST_ROS_MEDIAN_S, MOST_ROS_P99_S = 0.010, 0.050
ROOT = Path(__file__).resolve().parents[2]

ROBOT = """
import json, sys
for line in sys.stdin:
    sys.stdout.write(json.dumps({"event": "ended", "n": json.loads(line)["n"], "outcome": "done"}))
    sys.stdout.write("\\n")
    sys.stdout.flush()
"""


def rows() -> Iterator[Row]:
    """Yield median and 99th percentile of the way there and back, and how memory grows."""
    link = ProcessLink(shlex.join([sys.executable, "-S", "-c", ROBOT]))
    link.start()
    try:
        half = N_ACTIONS // 2
        times = [_action(link, number) for number in range(half)]
        before = _peak_mb()
        times += [_action(link, number) for number in range(half, N_ACTIONS)]
        growth = _peak_mb() - before
    finally:
        link.close()
    times.sort()
    middle, late = times[len(times) // 2], times[len(times) * 99 // 100]
    yield Row("a message there and back, median", milliseconds(middle), "", "<= 2 ms",
              middle > MOST_MEDIAN_S)  # fmt: skip
    yield Row("the same, 99 of 100", milliseconds(late), "", "<= 10 ms", late > MOST_P99_S)
    yield Row(f"memory that {half} further actions take", f"{growth:.1f} MB", "",
              f"<= {MOST_GROWTH_MB} MB", growth > MOST_GROWTH_MB)  # fmt: skip
    if PYTHON in os.environ:
        yield from ros_rows()


def ros_rows() -> Iterator[Row]:
    """Yield how long a goal takes to be accepted by an action server of ROS 2, and to end."""
    problem, path = read("transport/two-boxes"), ROOT / "tests/execution/robots/shop.toml"
    link = make_link(f"ros:{path}", problem)
    assert isinstance(link, ProcessLink)
    options = {**robot_options(problem, read_mapping(path)), "seconds": 0.0}
    environment = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
                   "ROS_DOMAIN_ID": "77"}  # fmt: skip
    argv = [ros_python(), str(ROS_ROBOT), json.dumps(options)]
    with subprocess.Popen(argv, env=environment, stdout=subprocess.DEVNULL) as robot:
        try:
            link.start()
            accepted, ended = zip(*(_goal(link, n) for n in range(N_GOALS)), strict=True)
        finally:
            link.close()
            robot.kill()
    middle, late = sorted(accepted)[N_GOALS // 2], sorted(accepted)[N_GOALS * 99 // 100]
    yield Row("ROS 2: a goal is accepted, median", milliseconds(middle), "", "<= 10 ms",
              middle > MOST_ROS_MEDIAN_S)  # fmt: skip
    yield Row("the same, 99 of 100", milliseconds(late), "", "<= 50 ms", late > MOST_ROS_P99_S)
    middle, late = sorted(ended)[N_GOALS // 2], sorted(ended)[N_GOALS * 99 // 100]
    yield Row("ROS 2: a goal that takes no time has ended, median", milliseconds(middle))
    yield Row("the same, 99 of 100", milliseconds(late))


def _goal(link: ProcessLink, number: int) -> tuple[float, float]:
    """Return when a goal was accepted and when it ended, in seconds after its dispatch."""
    begun, accepted = time.perf_counter(), 0.0
    link.send({
        "do": "dispatch", "n": number, "agent": "robot", "action": "move",
        "args": ["robot", "wp0", "wp3"], "duration_s": 0.1, "limit_s": 60.0,
    })  # fmt: skip
    while True:
        for message in link.receive(10.0):
            if isinstance(message, msg.Accepted):
                accepted = time.perf_counter() - begun
            elif isinstance(message, msg.ActionEnded):
                return accepted, time.perf_counter() - begun


def _action(link: ProcessLink, number: int) -> float:
    """Return how long one action takes that the robot does at once."""
    begun = time.perf_counter()
    link.send({
        "do": "dispatch", "n": number, "agent": "robot", "action": "move",
        "args": ["robot", "wp0", "wp3"], "duration_s": 50.0, "limit_s": 150.0,
    })  # fmt: skip
    messages = link.receive(10.0)
    assert messages == [msg.ActionEnded(number, "done")], messages
    return time.perf_counter() - begun


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
