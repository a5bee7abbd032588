"""A robot that carries out every action by waiting: what a link can be tried with.

It follows the protocol of ``messages.py``, and on request misbehaves as real robots do.
"""

from __future__ import annotations

import json
import os
import random
import select
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue, json_of
from hrcplan.core.text import quote
from hrcplan.errors import InputError

MAX_LINE = 1 << 20  # bytes
LONGEST_S = 1e9  # more than a clock can wait for
_CHUNK = 1 << 16
STDIN = 0


@dataclass(frozen=True, slots=True)
class RobotFaults:
    """How a simulated robot misbehaves.

    Attributes:
        slow: Actions last this many times their duration.
        deaf_after: From this number of actions on nothing is answered; None for never.
        lost: The probability that a message of the robot is lost.
        die_after: It dies in the middle of the action of this number; None for never.
        fail: The probability that an action fails.
        seed: Chance follows from it.
    """

    slow: float = 1.0
    deaf_after: int | None = None
    lost: float = 0.0
    die_after: int | None = None
    fail: float = 0.0
    seed: int = 1


@dataclass
class SimulatedRobotProgram:
    """Reads commands and writes events; ``speed`` simulated seconds take one second."""

    speed: float = 1.0
    faults: RobotFaults = field(default_factory=RobotFaults)
    agents: tuple[str, ...] = ()

    def run(self) -> None:
        """Serve until standard input ends or the end is commanded.

        Raises:
            InputError: if a line is no command.
        """
        self._ends_s: dict[int, float] = {}
        self._outcomes: dict[int, str] = {}
        self._n_actions = 0
        self._actions: list[str] = []
        self._chance = random.Random(self.faults.seed)
        part = bytearray()
        while True:
            self._finish_due()
            wait_s = min(self._ends_s.values(), default=None)
            timeout_s = None if wait_s is None else max(0.0, wait_s - time.monotonic())
            if not select.select([STDIN], [], [], timeout_s)[0]:
                continue
            piece = os.read(STDIN, _CHUNK)
            if not piece:
                return
            *lines, rest = piece.split(b"\n")
            for line in lines:
                if not self._obey(part + line):
                    return
                part.clear()
            part += rest
            if len(part) > MAX_LINE:
                raise InputError("a line of the master is too long", code="bad-line")

    def _obey(self, line: bytes | bytearray) -> bool:
        """Carry a command out; return whether others may follow.

        Raises:
            InputError: if the line is no command.
        """
        try:
            command = json_of(bytes(line))
            if command["do"] == "end":
                return False
            self._take(command)
        except DOCUMENT_FAULTS as error:
            shown = quote(line.decode("utf-8", "replace"))
            message = f"this line is no command of a robot link: {shown} ({error!r})"
            raise InputError(message, code="bad-line") from None
        return True

    def _say(self, event: str, **values: JsonValue) -> None:
        if event != "ready" and self._chance.random() < self.faults.lost:
            return
        sys.stdout.write(json.dumps({"event": event, **values}) + "\n")
        sys.stdout.flush()

    def _is_deaf(self) -> bool:
        after = self.faults.deaf_after
        return after is not None and self._n_actions > after

    def _take(self, command: Mapping[str, Any]) -> None:
        match command["do"]:
            case "begin":
                self._actions = command["actions"]
                self._say("ready", **({"agents": list(self.agents)} if self.agents else {}))
            case "dispatch":
                self._dispatch(command)
            case "cancel":
                self._cancel(command["n"])

    def _dispatch(self, command: Mapping[str, Any]) -> None:
        number = command["n"]
        if command["action"] not in self._actions:
            self._say("rejected", n=number, why="no such action")
            return
        if number in self._outcomes:  # the answer was lost: it is given again
            self._say("ended", n=number, outcome=self._outcomes[number])
            return
        if number not in self._ends_s:
            self._n_actions += 1
            if self._is_deaf():
                return
            lasts_s = min(LONGEST_S, command["duration_s"] * self.faults.slow / self.speed)
            if self._n_actions == self.faults.die_after:
                time.sleep(lasts_s / 2)
                os._exit(1)
            self._ends_s[number] = time.monotonic() + lasts_s
        self._say("accepted", n=number)

    def _cancel(self, number: int) -> None:
        if self._is_deaf():
            return
        if self._ends_s.pop(number, None) is not None:
            self._outcomes[number] = "cancelled"
        if number in self._outcomes:
            self._say("ended", n=number, outcome=self._outcomes[number])

    def _finish_due(self) -> None:
        now = time.monotonic()
        for number in [n for n, end_s in self._ends_s.items() if end_s <= now]:
            del self._ends_s[number]
            failed = self._chance.random() < self.faults.fail
            self._outcomes[number] = "failed" if failed else "done"
            self._say("ended", n=number, outcome=self._outcomes[number])
