"""Links to ROS 2: ``ros:MAPPING.toml``, and ``plansys2`` for performers of PlanSys2."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hrcplan.core.json_values import DOCUMENT_FAULTS, JsonValue
from hrcplan.core.text import cut, harmless
from hrcplan.errors import HrcplanError, PlannerError, UsageError
from hrcplan.execution.links import RobotLink
from hrcplan.execution.links.messages import (
    BadLine,
    FactsObserved,
    LinkMessage,
    Rejected,
    message_of,
)
from hrcplan.execution.links.process import ProcessLink
from hrcplan.execution.links.ros.filling import FilledMapping
from hrcplan.execution.links.ros.mapping import RosMapping, read_mapping
from hrcplan.pddl.model import Problem

BRIDGE = Path(__file__).with_name("bridge.py")
PYTHON = "HRCPLAN_ROS_PYTHON"  # the environment variable with the Python of ROS
CONFIGURE_S = 20.0
_FAULT, _TOPIC, _NOW = (f'{{"event": "{event}"' for event in ("fault", "topic", "now"))


def ros_python() -> str:
    """Return the Python of ROS, unless the user names it."""
    return os.environ.get(PYTHON) or "python3"


def ros_environment(mapping: RosMapping) -> dict[str, str]:
    """Return the environment of a program for ROS: only this machine, unless it is set."""
    environment = dict(os.environ)
    discovery = mapping.discovery or os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost")
    environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] = discovery.upper()
    if mapping.domain_id is not None:
        environment["ROS_DOMAIN_ID"] = str(mapping.domain_id)
    return environment


class RosLink(ProcessLink):
    """Carries actions out by action servers of ROS 2, and senses by topics.

    Args:
        mapping: The path of the mapping file.

    Attributes:
        python: The Python of ROS.
    """

    performers = False

    def __init__(self, mapping: str) -> None:
        super().__init__("python3")
        self.name = f"ros:{mapping}"
        self.python = ros_python()
        self.mapping = read_mapping(Path(mapping)) if mapping else RosMapping(Path())
        self.filled: FilledMapping | None = None
        self._own_messages: list[LinkMessage] = []

    def prepare(self, problem: Problem) -> None:
        """Take note of the problem.

        Raises:
            InputError: if the mapping does not fit it.
        """
        self.filled = FilledMapping(self.mapping, problem, self.performers)

    def limit_s(self, action: str) -> float | None:
        """Return how many seconds an action may take; None if the mapping does not say."""
        entry = self.mapping.actions.get(action)
        return None if entry is None else entry.limit_s

    def start(self) -> None:
        """Start the bridge, and let it check the mapping.

        Raises:
            InputError: if ROS does not know what the mapping names.
            PlannerError: if the Python of ROS is missing, has no ROS, or no robot is there.
        """
        self.argv = [self.python, str(BRIDGE)]
        super().start()
        assert self.filled is not None
        self.send({
            "do": "configure", "performers": self.performers, "agents": list(self.filled.agents),
            "samples": [{"action": name, **order} for name, order in self.filled.samples()],
            "topics": [
                {"name": topic.name, "type": topic.type, "fields": list(topic.fields),
                 "latched": topic.latched, "every": topic.says in ("said", "begun")}
                for topic in self.mapping.topics
            ],
        })  # fmt: skip
        self._await_configured()

    def _await_configured(self) -> None:
        assert self._program is not None
        until = time.monotonic() + CONFIGURE_S
        while (left_s := until - time.monotonic()) > 0:
            for line in self._program.read_lines(left_s):
                if line == '{"event": "configured"}':
                    return
                if line is not None and line.startswith(_FAULT):
                    error = self._fault(json.loads(line))
                    self.close()
                    raise error
            if self._program.ending is not None:
                words = self._program.last_words.splitlines()
                reason = ": ".join([self._program.ending, *words[-1:]])
                self.close()
                raise PlannerError(f"the Python of ROS, {self.python}, ended: {reason}")
        self.close()
        raise PlannerError(f"the Python of ROS, {self.python}, does not answer")

    def _fault(self, fault: Mapping[str, str]) -> HrcplanError:
        """Return the error for what the bridge does not find."""
        key, why = fault["key"], cut(harmless(fault["why"]), 300)
        if key == "python":
            hint = "--ros-python PATH names one that has; sources of setup.bash come first"
            return PlannerError(f"{self.python} has no rclpy: {why}", code="no-ros", hint=hint)
        if key == "performers":
            message = f"{self.python} has no messages of PlanSys2: {why}"
            return PlannerError(message, code="no-ros", hint="source the workspace of PlanSys2")
        if key == "server":
            hint = "is the robot on, and in this ROS domain? see discovery and domain_id"
            return PlannerError(f"no robot listens at {why}", code="no-robot-there", hint=hint)
        keys = tuple(int(word) if word.isdecimal() else word for word in key.split("."))
        return self.mapping.fault(keys, why)

    def _environment(self) -> Mapping[str, str]:
        return ros_environment(self.mapping)

    def _resources(self) -> list[str]:
        """Return the names of the action servers: two mappings may share one."""
        assert self.filled is not None
        domain = self._environment().get("ROS_DOMAIN_ID", "0")
        names = {str(order["name"]) for _, order in self.filled.samples()}
        return [f"{name} of ROS domain {domain}" for name in sorted(names)]

    def send(self, message: Mapping[str, JsonValue]) -> bool:
        """Send a message; a dispatch gets its action server and goal."""
        if message.get("do") != "dispatch":
            return super().send(message)
        try:
            args = [str(arg) for arg in message["args"]]  # type: ignore[union-attr]
            order = self._order(str(message["action"]), args)
        except (KeyError, ValueError):
            why = f"the mapping has no '{message['action']}' of these objects"
            self._own_messages.append(Rejected(int(str(message["n"])), why))
            return True
        return super().send({**message, **order})

    def receive(self, timeout_s: float) -> Sequence[LinkMessage]:
        """Return the messages that arrive next, none after a time; `LinkEnded` at the end."""
        own, self._own_messages = self._own_messages, []
        return own or super().receive(timeout_s)

    def _order(self, action: str, args: Sequence[str]) -> Mapping[str, JsonValue]:
        assert self.filled is not None
        return self.filled.order(action, args)

    def _message(self, line: str | None) -> LinkMessage | None:
        if line is None or not line.startswith((_TOPIC, _NOW)):
            return message_of(line)
        assert self.filled is not None
        try:
            document = json.loads(line)
            if document["event"] == "topic":
                return self.filled.read(document["n"], document["fields"])
            return self._observed(document["topics"])
        except DOCUMENT_FAULTS as error:
            return BadLine(f"the bridge to ROS: {error}")

    def _observed(self, topics: Mapping[str, Mapping[str, JsonValue]]) -> FactsObserved:
        """Return all that topics have said lately as one observation."""
        assert self.filled is not None
        facts, absent = frozenset[Any](), frozenset[Any]()
        for n, fields in topics.items():
            message = self.filled.read(int(n), fields)
            if isinstance(message, FactsObserved):
                facts, absent = facts | message.facts, absent | message.absent
        return FactsObserved(facts, absent - facts)


class PlanSys2Link(RosLink):
    """Lets performers of PlanSys2 carry actions out; a mapping file may name topics."""

    performers = True

    def __init__(self, mapping: str = "") -> None:
        super().__init__(mapping)
        self.name = f"plansys2:{mapping}".rstrip(":")
        if self.mapping.actions:
            first = next(iter(self.mapping.actions))
            message = "performers of PlanSys2 take actions by their names"
            raise self.mapping.fault(("actions", first), message, "leave the actions out")

    def _order(self, action: str, args: Sequence[str]) -> Mapping[str, JsonValue]:
        return {}

    def _resources(self) -> list[str]:
        return [f"actions_hub of ROS domain {self._environment().get('ROS_DOMAIN_ID', '0')}"]


def with_python(link: RobotLink, python: str | None) -> None:
    """Let a link use this Python of ROS.

    Raises:
        UsageError: if it is no link to ROS.
    """
    if python is None:
        return
    if not isinstance(link, RosLink):
        hint = "--robot ros:MAPPING.toml or plansys2"
        raise UsageError("--ros-python is for robots of ROS", hint=hint)
    link.python = python
