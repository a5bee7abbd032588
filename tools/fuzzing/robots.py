"""Robots that answer anything: lines that are others, missing, late, or there twice."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from fuzzing import mutate
from hrcplan.agents import load_profile
from hrcplan.core.json_values import JsonValue
from hrcplan.errors import LimitError
from hrcplan.execution.links.messages import LinkEnded, LinkMessage, message_of
from hrcplan.execution.links.world import LinkWorld
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.simulate import Engine
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.inputs import read

MOST_CALLS = 3000
"""How often a link is asked for messages until the run counts as one without an end."""
MORE: tuple[Mapping[str, JsonValue], ...] = (
    {"event": "observed", "facts": ["at robot wp3"], "absent": ["at robot wp1"]},
    {"event": "sensed", "values": {"motivation human": 8}},
    {"event": "said", "agent": "human", "text": "I take the blue box"},
    {"event": "begun", "agent": "human", "action": "move", "args": ["human", "wp1", "wp4"]},
    {"event": "stop", "why": "button"},
    {"event": "release"},
    {"event": "feedback", "n": 0, "text": "50 %"},
)


class OddRobot:
    """A link whose clock runs only while it is waited for.

    Args:
        rng: All chances follow from it.
    """

    def __init__(self, rng: random.Random) -> None:
        self.rng, self.name = rng, "odd"
        self.now_s = 0.0
        self.n_calls = 0
        self._lines: list[str | None] = []

    def clock(self) -> float:
        """Return the time in seconds."""
        return self.now_s

    def start(self) -> None:
        """Be ready."""
        self._lines = ['{"event": "ready"}']

    def send(self, message: Mapping[str, JsonValue]) -> bool:
        """Answer a message, most of the time as a robot does."""
        for answer in self._answers(message):
            line: str | None = json.dumps(answer)
            match self.rng.randrange(12):
                case 0:
                    line = json.dumps(mutate.value(self.rng, answer))
                case 1:
                    raw = mutate.data(self.rng, json.dumps(answer).encode())
                    line = raw.decode("utf-8", "replace")
                case 2:
                    line = self.rng.choice((None, "", "[" * 9999, '{"event":' * 999))
                case 3:
                    self._lines.append(line)
                case 4:
                    continue
                case 5:
                    self._lines.append(json.dumps(mutate.value(self.rng, self.rng.choice(MORE))))
            self._lines.append(line)
        return self.rng.random() > 0.02

    def _answers(self, message: Mapping[str, JsonValue]) -> Iterator[Mapping[str, Any]]:
        number = message.get("n")
        match message["do"]:
            case "dispatch":
                yield {"event": "accepted", "n": number}
                outcome = "done" if self.rng.random() < 0.8 else "failed"
                yield {"event": "ended", "n": number, "outcome": outcome}
            case "cancel":
                yield {"event": "ended", "n": number, "outcome": "cancelled"}
            case "observe":
                yield {"event": "observed", "facts": []}

    def receive(self, timeout_s: float) -> Sequence[LinkMessage]:
        """Return the next messages, or let time go by."""
        self.n_calls += 1
        if self.n_calls > MOST_CALLS:
            raise AssertionError("the run has no end")
        self.now_s += 0.001
        if not self._lines:
            self.now_s += timeout_s
            return [LinkEnded("it went")] if self.rng.random() < 0.01 else []
        lines, self._lines = self._lines, []
        return [message_of(line) for line in lines]

    def close(self) -> None:
        """End."""
        self._lines = []


@cache
def _engine() -> Engine:
    model = ExecutionModel(read("transport", "two-boxes"))
    return Engine(Monitor(model, load_profile("hrcplan")), Replanner(model))


def links(rng: random.Random, folder: Path) -> None:
    """Carry out a plan with a robot that answers anything: the run ends, and says how."""
    robot = OddRobot(rng)
    model = _engine().monitor.model
    world = LinkWorld(model, Nature(), robot, speed=1000, clock=robot.clock)
    try:
        _engine().run(Nature(), None, lambda *_: None, world)
    except LimitError:
        raise AssertionError("the run reached a limit") from None
