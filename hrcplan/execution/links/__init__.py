"""Robots: what carries actions out beyond a simulation, and how it is spoken to.

A link is a program that speaks lines of JSON (``messages.py``), below the guard that planners have
(``process.py``). `LinkWorld` (``world.py``) makes an `EventWorld` of it: the monitor, its journal
and its plans do not know whether a robot is real.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from hrcplan.core.json_values import JsonValue
from hrcplan.core.registry import Registry
from hrcplan.errors import PlannerError
from hrcplan.execution.links.messages import LinkMessage


@runtime_checkable
class RobotLink(Protocol):
    """Speaks to one robot or several; never blocks for longer than its time limit."""

    def start(self) -> None:
        """Start, or start again after the link has ended."""

    def send(self, message: Mapping[str, JsonValue]) -> bool:
        """Send a message; return whether it could be sent."""

    def receive(self, timeout_s: float) -> Sequence[LinkMessage]:
        """Return the messages that arrive next, none after a time; the last is `LinkEnded`."""

    def close(self) -> None:
        """End the link and all that belongs to it."""


LINKS: Registry[[], RobotLink] = Registry(
    "link",
    {"simulated": "hrcplan.execution.links.process:SimulatedRobot"},
    "hrcplan.links",
    RobotLink,
    prefixes={"cmd": "hrcplan.execution.links.process:ProcessLink"},
    program_prefixes=frozenset({"cmd"}),
    load_error=PlannerError,
)
