"""The program between hrcplan and ROS 2; runs on the Python of ROS and needs nothing of hrcplan.

It reads the lines of ``hrcplan.execution.links.messages`` from standard input and writes them to
standard output. Before ``begin`` a line ``configure`` says what is used: samples of actions, which
are checked, and topics. A dispatch names its action server and holds the whole goal, or names only
the PDDL action if performers of PlanSys2 carry it out.

An action that was accepted ends with the result of its server. If the server goes away, or another
one takes its name, the outcome is unknown.
"""

from __future__ import annotations

import glob
import json
import os
import signal
import sys
import threading
import time
import traceback
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from typing import Any

sys.path.pop(0)  # the folder of this file: its modules are no business of ROS
for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
    sys.path += glob.glob(f"{prefix}/**/python3*/*-packages", recursive=True) if prefix else []
if os.environ.get("ROS_DISTRO") in ("foxy", "galactic", "humble"):
    is_local = os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE") == "LOCALHOST"
    os.environ.setdefault("ROS_LOCALHOST_ONLY", "1" if is_local else "0")
os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")  # a wrong type is found when it is set
try:
    import rclpy
    from rclpy.action import ActionClient
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
except ImportError as error:
    print(json.dumps({"event": "fault", "key": "python", "why": str(error)}), flush=True)
    sys.exit(1)

SERVERS_S = 8.0  # how long action servers may take to appear
TICK_S = 0.1
FRESH_S = 2.0  # a message of this age still says what is true
CANCEL_S = 2.0
LAST_S = 0.2  # how long the last cancels may take
SUCCEEDED, CANCELED = 4, 5  # of action_msgs/msg/GoalStatus
HUB, PERFORMERS = "actions_hub", "performers_status"  # of PlanSys2
PERFORMER_RUNS = 2  # the state of a performer that carries an action out
PERFORMER_S = 5.0  # a performer says once a second that it is there


def say(event: str, **values: Any) -> None:
    """Write one event."""
    sys.stdout.write(json.dumps({"event": event, **values}) + "\n")
    sys.stdout.flush()


class ConfigurationError(Exception):
    """What is wrong with the configuration, and with which part of it."""

    def __init__(self, key: str, why: str) -> None:
        super().__init__(why)
        self.key, self.why = key, why


class FieldError(ValueError):
    """A field that a message does not have, or cannot hold this value."""

    def __init__(self, path: str, why: str) -> None:
        super().__init__(why)
        self.path = path


def interface(name: str) -> Any:
    """Return the class of a message or action type such as ``std_msgs/msg/String``."""
    package, kind, member = name.split("/")
    return getattr(import_module(f"{package}.{kind}"), member)


def fill(message: Any, values: Mapping[str, Any], path: str = "") -> None:
    """Set fields of a message, also nested ones.

    Raises:
        FieldError: naming the field that does not fit.
    """
    kinds = message.get_fields_and_field_types()
    for key, value in values.items():
        here = f"{path}{key}"
        if key not in kinds:
            raise FieldError(here, f"there is no field '{here}'; fields: {', '.join(kinds)}")
        try:
            setattr(message, key, _value(getattr(message, key), kinds[key], value, here))
        except (AssertionError, TypeError, OverflowError) as error:
            raise FieldError(here, f"field '{here}' is a {kinds[key]}, not {value!r}") from error


def _value(old: Any, kind: str, value: Any, path: str) -> Any:
    if isinstance(value, dict):
        if not hasattr(old, "get_fields_and_field_types"):
            raise TypeError
        fill(old, value, f"{path}.")
        return old
    if isinstance(value, list) and any(isinstance(one, dict) for one in value):
        package, name = kind.removeprefix("sequence<").rstrip(">").split("[")[0].split("/")
        items = [interface(f"{package}/msg/{name}")() for _ in value]
        for n, (item, one) in enumerate(zip(items, value)):  # noqa: B905  Python 3.8 has no strict
            fill(item, one, f"{path}[{n}].")
        return items
    if isinstance(old, float) and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(old, str) and isinstance(value, (int, float)):
        return str(value)
    return value


def field(message: Any, path: str) -> Any:
    """Return a field of a message as JSON; ``path`` has dots between names."""
    for name in path.split("."):
        message = getattr(message, name)
    return plain(message)


def configured_interface(key: str, name: str) -> Any:
    """Return a type that the configuration names.

    Raises:
        ConfigurationError: if there is none.
    """
    try:
        return interface(name)
    except (ImportError, AttributeError) as error:
        raise ConfigurationError(key, f"there is no {name}: {error}") from error


def check_fields(key: str, message: Any, paths: Iterable[str]) -> None:
    """Check that a message has fields.

    Raises:
        ConfigurationError: naming the first that is missing.
    """
    for path in paths:
        try:
            field(message, path)
        except AttributeError as error:
            raise ConfigurationError(key, f"there is no field '{path}' in it") from error


def plain(value: Any) -> Any:
    """Return a value of a message as JSON."""
    if hasattr(value, "get_fields_and_field_types"):
        return {key: plain(getattr(value, key)) for key in value.get_fields_and_field_types()}
    if isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, (bytes, bytearray)):
        return list(value)
    return [plain(one) for one in value]


class RobotAction:
    """One action under way: ``limit_s`` is the time at which it is given up."""

    def __init__(self, order: Mapping[str, Any]) -> None:
        self.order, self.n = order, order["n"]
        self.limit_s = time.monotonic() + order["limit_s"]
        self.is_accepted = self.is_cancelled = False
        self.n_tries = 0
        self.cancel_until_s = float("inf")
        self.why = ""


class Executive(ABC):
    """What all ways to carry actions out have in common."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.actions: dict[int, RobotAction] = {}
        self.outcomes: dict[int, tuple[str, str]] = {}

    def check(self, samples: Sequence[Mapping[str, Any]]) -> None:  # noqa: B027 - not all check
        """Check what can be checked before the first action.

        Raises:
            ConfigurationError: naming the action.
        """

    def dispatch(self, order: Mapping[str, Any]) -> None:
        """Begin an action; a number that was dispatched before is the same action."""
        n = order["n"]
        if n in self.outcomes:
            say("ended", n=n, outcome=self.outcomes[n][0], why=self.outcomes[n][1])
            return
        action = self.actions.get(n)
        if action is not None and action.is_accepted:
            say("accepted", n=n)
            return
        action = self.actions.setdefault(n, RobotAction(order))
        action.n_tries += 1
        try:
            self.request(action)
        except Exception as error:  # noqa: BLE001  whatever ROS raises
            self.reject(action, str(error))

    def accept(self, action: RobotAction) -> None:
        """Note that an action is carried out, unless it was given up meanwhile."""
        if action.is_accepted:
            return
        action.is_accepted = True
        if action.is_cancelled:
            self.break_off(action)
        else:
            say("accepted", n=action.n)

    def reject(self, action: RobotAction, why: str) -> None:
        """Note that an action is not carried out."""
        if self.actions.pop(action.n, None) is not None:
            self.outcomes[action.n] = "failed", why
            say("rejected", n=action.n, why=why)

    def end(self, action: RobotAction, outcome: str, why: str = "") -> None:
        """Note the outcome of an action, once."""
        if self.actions.pop(action.n, None) is not None:
            self.outcomes[action.n] = outcome, action.why or why
            say("ended", n=action.n, outcome=outcome, why=action.why or why)

    def cancel(self, n: int) -> None:
        """Break an action off; if nothing is heard of it, its outcome is unknown."""
        action = self.actions.get(n)
        if action is None:
            if n in self.outcomes:
                say("ended", n=n, outcome=self.outcomes[n][0], why=self.outcomes[n][1])
            return
        action.is_cancelled = True
        action.cancel_until_s = time.monotonic() + CANCEL_S
        if action.is_accepted:
            self.break_off(action)

    def tick(self) -> None:
        """Give up what is too late, or whose server has gone."""
        now = time.monotonic()
        for action in list(self.actions.values()):
            if action.is_accepted and self.is_gone(action):
                self.end(action, "unknown", "who carried it out has gone")
            elif now > action.cancel_until_s:
                self.end(action, "unknown", "it was cancelled without an answer")
            elif now > action.limit_s:
                action.limit_s = float("inf")
                action.why = f"it did not end within {action.order['limit_s']:g} s"
                self.cancel(action.n)

    @abstractmethod
    def request(self, action: RobotAction) -> None:
        """Ask for an action."""

    @abstractmethod
    def break_off(self, action: RobotAction) -> None:
        """Ask to break an action off that was accepted."""

    @abstractmethod
    def is_gone(self, action: RobotAction) -> bool:
        """Whether who carries an action out is there no more."""


class ActionServers(Executive):
    """Actions that action servers carry out."""

    def __init__(self, node: Any) -> None:
        super().__init__(node)
        self.clients: dict[tuple[str, str], Any] = {}
        self.handles: dict[int, Any] = {}
        self.servers: dict[int, frozenset[bytes]] = {}
        self.ids: dict[int, Any] = {}

    def check(self, samples: Sequence[Mapping[str, Any]]) -> None:
        """Check types, goals and results of samples, and wait until their servers are there."""
        for sample in samples:
            key = f"actions.{sample['action']}"
            kind = configured_interface(f"{key}.type", sample["type"])
            try:
                fill(kind.Goal(), sample["goal"])
            except FieldError as error:
                raise ConfigurationError(f"{key}.goal.{error.path}", str(error)) from error
            check_fields(f"{key}.done", kind.Result(), sample["done"])
            self.client(sample)
        until = time.monotonic() + SERVERS_S
        for (_, name), client in self.clients.items():
            while not client.server_is_ready():
                if time.monotonic() > until:
                    raise ConfigurationError("server", name)
                time.sleep(0.02)

    def client(self, order: Mapping[str, Any]) -> Any:
        """Return the client of an action server."""
        key = order["type"], order["name"]
        if key not in self.clients:
            self.clients[key] = ActionClient(self.node, interface(key[0]), key[1])
        return self.clients[key]

    def request(self, action: RobotAction) -> None:
        """Send the goal; the same number has the same goal, however often it is sent."""
        client = self.client(action.order)
        if not client.server_is_ready():
            return  # it is asked for again
        goal = interface(action.order["type"]).Goal()
        fill(goal, action.order["goal"])
        n = action.n
        if n not in self.ids:
            self.ids[n] = client._generate_random_uuid()
        client.send_goal_async(
            goal, lambda message: self._feedback(action, message.feedback), self.ids[n]
        ).add_done_callback(lambda future: self._answered(action, future))

    def _answered(self, action: RobotAction, future: Any) -> None:
        handle = future.result()
        if handle is None or action.is_accepted:
            return
        if not handle.accepted and action.n_tries > 1:
            # The first request may have arrived, and a server takes a goal only once.
            self.end(action, "unknown", "whether the goal was accepted is unknown")
        elif not handle.accepted:
            self.reject(action, "the action server has rejected the goal")
        else:
            self.handles[action.n] = handle
            self.servers[action.n] = self._servers(action)
            self.accept(action)
            result = handle.get_result_async()
            result.add_done_callback(lambda future: self._finished(action, future))

    def _feedback(self, action: RobotAction, message: Any) -> None:
        if action.n in self.actions:
            values = {key: getattr(message, key) for key in message.get_fields_and_field_types()}
            words = [
                f"{k} {v:g}" if isinstance(v, float) else f"{k} {v}"
                for k, v in values.items()
                if isinstance(v, (str, int, float)) and v != ""
            ]
            say("feedback", n=action.n, text=", ".join(words)[:120])

    def _finished(self, action: RobotAction, future: Any) -> None:
        response = future.result()
        self.forget(action)
        if response.status == CANCELED:
            self.end(action, "cancelled")
            return
        if response.status != SUCCEEDED:
            self.end(action, "failed", f"the result has status {response.status}")
            return
        for path, value in action.order["done"].items():
            if field(response.result, path) != value:
                self.end(action, "failed", f"{path} is {field(response.result, path)}")
                return
        self.end(action, "done")

    def forget(self, action: RobotAction) -> None:
        """Free what is remembered of an action."""
        for table in (self.handles, self.servers, self.ids):
            table.pop(action.n, None)

    def break_off(self, action: RobotAction) -> None:
        """Cancel a goal."""
        self.handles[action.n].cancel_goal_async()

    def _servers(self, action: RobotAction) -> frozenset[bytes]:
        topic = f"{action.order['name']}/_action/status"
        ends = self.node.get_publishers_info_by_topic(topic)
        return frozenset(bytes(end.endpoint_gid) for end in ends)

    def is_gone(self, action: RobotAction) -> bool:
        """Whether the servers of an action's name are others than those that accepted it."""
        before = self.servers.get(action.n)
        if before is None or self._servers(action) == before:
            return False
        self.forget(action)
        return True


class Performers(Executive):
    """Actions that performers of PlanSys2 carry out; they are asked on a topic."""

    def __init__(self, node: Any) -> None:
        super().__init__(node)
        self.kind = interface("plansys2_msgs/msg/ActionExecution")
        status = interface("plansys2_msgs/msg/ActionPerformerStatus")
        qos = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
        self.hub = node.create_publisher(self.kind, HUB, qos)
        self.subscription = node.create_subscription(self.kind, HUB, self._heard, qos)
        self.status = node.create_subscription(status, PERFORMERS, self._alive, qos)
        self.seen_s: dict[str, float] = {}
        self.performers: dict[int, str] = {}

    def check(self, samples: Sequence[Mapping[str, Any]]) -> None:
        """Wait until a performer listens."""
        until = time.monotonic() + SERVERS_S
        while self.node.count_subscribers(HUB) < 2:
            if time.monotonic() > until:
                raise ConfigurationError("server", HUB)
            time.sleep(0.02)

    def request(self, action: RobotAction) -> None:
        """Ask which performer takes an action."""
        self._publish(self.kind.REQUEST, action, self.node.get_name())

    def break_off(self, action: RobotAction) -> None:
        """Cancel an action. A performer does not say that it has stopped: the tick ends it."""
        self._publish(self.kind.CANCEL, action, self.performers[action.n])

    def is_gone(self, action: RobotAction) -> bool:
        """Whether the performer has not been heard for some time; it says every second it is."""
        seen_s = self.seen_s.get(self.performers[action.n])
        return seen_s is not None and time.monotonic() - seen_s > PERFORMER_S

    def _publish(self, kind: int, action: RobotAction, node: str) -> None:
        self.hub.publish(self.kind(
            type=kind, node_id=node, action=action.order["action"],
            arguments=list(action.order["args"]),
        ))  # fmt: skip

    def _alive(self, message: Any) -> None:
        """Note a heartbeat: a performer that was cancelled says by it that it has stopped."""
        now = self.seen_s[message.node_name] = time.monotonic()
        for action in list(self.actions.values()):
            sent_s = action.cancel_until_s - CANCEL_S
            is_its = self.performers.get(action.n) == message.node_name
            if is_its and now > sent_s + TICK_S and message.state != PERFORMER_RUNS:
                self.end(action, "cancelled")

    def _heard(self, message: Any) -> None:
        action = next((a for a in self.actions.values() if _is_about(message, a.order)), None)
        if action is None:
            return
        if message.type == self.kind.RESPONSE:
            self._responded(action, message.node_id)
        elif message.node_id != self.performers.get(action.n):
            return
        elif message.type == self.kind.FEEDBACK:
            say("feedback", n=action.n, text=f"{message.completion:.0%} {message.status}".strip())
        elif message.type == self.kind.FINISH:
            self.end(action, "done" if message.success else "failed", message.status)

    def _responded(self, action: RobotAction, performer: str) -> None:
        if action.is_accepted or action.is_cancelled:
            self._publish(self.kind.REJECT, action, performer)
            return
        self.performers[action.n] = performer
        self.seen_s.setdefault(performer, time.monotonic())
        self._publish(self.kind.CONFIRM, action, performer)
        self.accept(action)


def _is_about(message: Any, order: Mapping[str, Any]) -> bool:
    return message.action == order["action"] and list(message.arguments) == list(order["args"])


class Topics:
    """What topics say: a message is passed on if what is looked at has changed."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.last: dict[int, tuple[float, dict[str, Any]]] = {}
        self.latched: set[int] = set()
        self.subscriptions: list[Any] = []

    def add(self, n: int, topic: Mapping[str, Any]) -> None:
        """Listen to a topic.

        Raises:
            ConfigurationError: if its type, or a field, does not exist.
        """
        kind = configured_interface(f"topics.{n}.type", topic["type"])
        check_fields(f"topics.{n}", kind(), topic["fields"])
        qos = QoSProfile(depth=10)
        if topic["latched"]:
            self.latched.add(n)
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
        self.subscriptions.append(self.node.create_subscription(
            kind, topic["name"], lambda message: self._take(n, topic, message), qos
        ))  # fmt: skip

    def _take(self, n: int, topic: Mapping[str, Any], message: Any) -> None:
        values = {path: field(message, path) for path in topic["fields"]}
        last = self.last.get(n)
        self.last[n] = time.monotonic(), values
        if topic["every"] or last is None or last[1] != values:
            say("topic", n=n, fields=values)

    def now(self) -> dict[int, dict[str, Any]]:
        """Return what the topics have said lately."""
        since = time.monotonic() - FRESH_S
        return {n: v for n, (t, v) in self.last.items() if t >= since or n in self.latched}


class Bridge:
    """Takes commands, and spins a node."""

    def __init__(self) -> None:
        rclpy.init(args=[])
        self.node = rclpy.create_node(f"hrcplan_{os.getpid()}")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.lines: deque[str] = deque()
        self.wake = self.node.create_guard_condition(self._take_lines)
        self.topics = Topics(self.node)
        self.executive: Executive = ActionServers(self.node)
        self.agents: list[str] = []
        self.is_over = False

    def run(self) -> None:
        """Serve until standard input ends, or the end is commanded."""
        signal.signal(signal.SIGTERM, self.stop)
        threading.Thread(target=self._read, daemon=True).start()
        self.node.create_timer(TICK_S, lambda: self.executive.tick())
        while not self.is_over:
            self.executor.spin_once(timeout_sec=1.0)
        until = time.monotonic() + LAST_S
        while self.executive.actions and time.monotonic() < until:
            self.executor.spin_once(timeout_sec=TICK_S)

    def _read(self) -> None:
        for line in sys.stdin:
            self.lines.append(line)
            self.wake.trigger()
        self.lines.append('{"do": "end"}')
        self.wake.trigger()

    def _take_lines(self) -> None:
        while self.lines:
            self.take(json.loads(self.lines.popleft()))

    def take(self, message: Mapping[str, Any]) -> None:
        """Take one message of hrcplan."""
        takes: dict[str, Callable[[Mapping[str, Any]], None]] = {
            "configure": self._configure,
            "begin": lambda m: say("ready", agents=self.agents),
            "dispatch": lambda m: self.executive.dispatch(m),
            "cancel": lambda m: self.executive.cancel(m["n"]),
            "observe": lambda m: say("now", topics=self.topics.now()),
            "end": self._end,
        }
        take = takes.get(message["do"])
        if take is not None:
            take(message)

    def _configure(self, message: Mapping[str, Any]) -> None:
        self.agents = message["agents"]
        try:
            for n, topic in enumerate(message["topics"]):
                self.topics.add(n, topic)
            if message["performers"]:
                try:
                    self.executive = Performers(self.node)
                except ImportError as error:
                    raise ConfigurationError("performers", str(error)) from error
            self.executive.check(message["samples"])
        except ConfigurationError as fault:
            say("fault", key=fault.key, why=fault.why)
            self.is_over = True
            return
        say("configured")

    def _end(self, message: Mapping[str, Any]) -> None:
        for n in list(self.executive.actions):
            self.executive.cancel(n)
        self.is_over = True

    def stop(self, *_: Any) -> None:
        """End soon: everything is cancelled first."""
        self.lines.append('{"do": "end"}')
        self.wake.trigger()


def main() -> int:
    """Run the bridge; return the exit code."""
    try:
        Bridge().run()
    except KeyboardInterrupt:
        return 130
    except Exception:  # noqa: BLE001  the last words are quoted by hrcplan
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)  # ROS may hang in its own clean-up
