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
from hrcplan.errors import PlannerError, UsageError
from hrcplan.execution.links.messages import LinkMessage
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Problem


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


@runtime_checkable
class PreparesForProblem(Protocol):
    """A link that has to know the problem before it starts."""

    def prepare(self, problem: Problem) -> None:
        """Take note of the problem; it may be refused."""


@runtime_checkable
class LimitsActions(Protocol):
    """A link that says how long actions may take."""

    def limit_s(self, action: str) -> float | None:
        """Return how many seconds an action may take; None for the usual limit."""


def make_link(link: str | RobotLink, problem: Problem, ros_python: str | None = None) -> RobotLink:
    """Return the link that a user has named, for a problem.

    Args:
        link: A name, or an object.
        problem: The problem.
        ros_python: The Python of ROS.

    Raises:
        InputError: if its mapping file has a fault, or does not fit the problem.
        UsageError: if there is no such link, or no agent of the problem takes commands.
    """
    if not robots(problem):
        hint = "(controllable AGENT) in the initial state says which agents take commands"
        raise UsageError("no agent of this problem takes commands", code="no-robot", hint=hint)
    robot = LINKS.make(link) if isinstance(link, str) else link
    if ros_python is not None:
        from hrcplan.execution.links.ros.link import with_python

        with_python(robot, ros_python)
    if isinstance(robot, PreparesForProblem):
        robot.prepare(problem)
    return robot


LINKS: Registry[[], RobotLink] = Registry(
    "link",
    {
        "simulated": "hrcplan.execution.links.process:SimulatedRobot",
        "plansys2": "hrcplan.execution.links.ros.link:PlanSys2Link",
    },
    "hrcplan.links",
    RobotLink,
    prefixes={
        "cmd": "hrcplan.execution.links.process:ProcessLink",
        "ros": "hrcplan.execution.links.ros.link:RosLink",
        "plansys2": "hrcplan.execution.links.ros.link:PlanSys2Link",
    },
    program_prefixes=frozenset({"cmd", "ros", "plansys2"}),
    load_error=PlannerError,
)
