"""What a robot link adds to an action: the time of a message there and back, and memory."""

from __future__ import annotations

import resource
import shlex
import sys
import time
from collections.abc import Iterator

from rows import Row, milliseconds

from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.process import ProcessLink

N_ACTIONS = 10_000
MOST_MEDIAN_S, MOST_P99_S = 0.002, 0.010
MOST_GROWTH_MB = 5

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
