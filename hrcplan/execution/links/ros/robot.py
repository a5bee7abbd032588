"""A simulated robot for ROS 2; runs on the Python of ROS and needs nothing of hrcplan.

It has the action servers of a mapping file, or performers of PlanSys2, accepts every goal, and
carries it out by waiting. On request it fails, refuses, or does not hear, as real robots do. Its
argument is a JSON object. It says "ready" when its servers are there, and serves until it is ended.
"""

from __future__ import annotations

import glob
import json
import os
import random
import sys
import threading
import time
from importlib import import_module
from typing import Any

sys.path.pop(0)  # the folder of this file: its modules are no business of ROS
for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
    sys.path += glob.glob(f"{prefix}/**/python3*/*-packages", recursive=True) if prefix else []
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy

FEEDBACK_S = 0.5
RATE_S = 0.02


def interface(name: str) -> Any:
    """Return the class of a message or action type."""
    package, kind, member = name.split("/")
    return getattr(import_module(f"{package}.{kind}"), member)


class Behaviour:
    """How long goals take, and how they end."""

    def __init__(self, options: dict[str, Any]) -> None:
        self.options, self.n = options, 0
        self.chance = random.Random(options.get("seed") or 1)
        self.seconds = float(options.get("seconds", 1.0))

    def takes(self) -> bool:
        """Whether the robot takes the next goal."""
        self.n += 1
        if self.n == self.options.get("die_after"):
            threading.Timer(self.seconds / 2, os._exit, [1]).start()
        return self.n not in self.options.get("reject", ())

    def is_deaf(self) -> bool:
        """Whether the robot does not hear any more."""
        after = self.options.get("deaf_after")
        return after is not None and self.n >= after

    def succeeds(self) -> bool:
        """Whether the goal that has come last succeeds."""
        fails = self.chance.random() < (self.options.get("fail") or 0)
        return self.n not in self.options.get("fail_at", ()) and not fails


class Servers:
    """Action servers; a goal that is cancelled ends at once."""

    def __init__(self, node: Any, behaviour: Behaviour, servers: list[list[str]]) -> None:
        self.behaviour = behaviour
        self.servers = [
            ActionServer(
                node, interface(kind), name, self._execute(interface(kind)),
                goal_callback=self._goal, cancel_callback=lambda _: CancelResponse.ACCEPT,
                callback_group=ReentrantCallbackGroup(),
            )
            for kind, name in servers
        ]  # fmt: skip

    def _goal(self, goal: Any) -> Any:
        while self.behaviour.is_deaf():
            time.sleep(1.0)
        return GoalResponse.ACCEPT if self.behaviour.takes() else GoalResponse.REJECT

    def _execute(self, kind: Any) -> Any:
        def execute(handle: Any) -> Any:
            succeeds = self.behaviour.succeeds()
            begun = shown = time.monotonic()
            while time.monotonic() - begun < self.behaviour.seconds:
                if handle.is_cancel_requested:
                    handle.canceled()
                    return kind.Result()
                if time.monotonic() - shown > FEEDBACK_S:
                    shown = time.monotonic()
                    handle.publish_feedback(kind.Feedback())
                time.sleep(RATE_S)
            (handle.succeed if succeeds else handle.abort)()
            return kind.Result()

        return execute


class Performer:
    """A performer of PlanSys2 for one action, as its protocol on ``actions_hub`` says."""

    def __init__(self, node: Any, behaviour: Behaviour, action: str) -> None:
        self.node, self.behaviour, self.action = node, behaviour, action
        self.name = f"{action}_performer_{os.getpid()}"
        self.kind = interface("plansys2_msgs/msg/ActionExecution")
        self.status = interface("plansys2_msgs/msg/ActionPerformerStatus")
        qos = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
        self.hub = node.create_publisher(self.kind, "actions_hub", qos)
        self.heartbeat = node.create_publisher(self.status, "performers_status", qos)
        self.subscription = node.create_subscription(self.kind, "actions_hub", self._heard, qos)
        self.request: Any = None
        self.begun_s: float | None = None
        self.shown_s = 0.0
        node.create_timer(1.0, self._beat)
        node.create_timer(RATE_S, self._work)

    def _beat(self) -> None:
        runs = self.begun_s is not None
        state = self.status.RUNNING if runs else self.status.READY
        self.heartbeat.publish(self.status(state=state, action=self.action, node_name=self.name))

    def _say(self, kind: int, **values: Any) -> None:
        self.hub.publish(self.kind(
            type=kind, node_id=self.name, action=self.request.action,
            arguments=self.request.arguments, **values,
        ))  # fmt: skip

    def _heard(self, message: Any) -> None:
        kind = self.kind
        if message.type == kind.REQUEST and message.action == self.action:
            hears = self.request is None and not self.behaviour.is_deaf()
            if hears and self.behaviour.takes():
                self.request = message
                self._say(kind.RESPONSE)
        elif message.node_id != self.name:
            return
        elif message.type == kind.CONFIRM and self.request is not None:
            self.begun_s = self.shown_s = time.monotonic()
        elif message.type in (kind.REJECT, kind.CANCEL):
            self.request = self.begun_s = None

    def _work(self) -> None:
        if self.begun_s is None:
            return
        now = time.monotonic()
        part = min(1.0, (now - self.begun_s) / max(self.behaviour.seconds, 1e-9))
        if part >= 1.0:
            self._say(self.kind.FINISH, success=self.behaviour.succeeds(), completion=1.0)
            self.request = self.begun_s = None
        elif now - self.shown_s > FEEDBACK_S:
            self.shown_s = now
            self._say(self.kind.FEEDBACK, completion=part)


def main() -> None:
    """Serve until the program is ended."""
    options = json.loads(sys.argv[1])
    rclpy.init(args=[])
    node = rclpy.create_node(f"simulated_robot_{os.getpid()}")
    behaviour = Behaviour(options)
    servers = Servers(node, behaviour, options.get("servers", []))
    performers = [Performer(node, behaviour, name) for name in options.get("performers", ())]
    executor = MultiThreadedExecutor(8)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    names = [name for _, name in options.get("servers", [])] or [p.action for p in performers]
    assert servers
    print(f"ready: {', '.join(names)}", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    finally:
        sys.stdout.flush()
        os._exit(0)
