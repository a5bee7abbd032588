"""Links to ROS 2 with real processes: action servers, performers of PlanSys2, and topics.

They need the Python of `tools/ros/venv.sh`, which `tools/test --all` makes.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from hrcplan.errors import InputError, PlannerError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.execute import Execution, execute
from hrcplan.execution.journal import read_journal
from hrcplan.execution.links import make_link
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links import world as link_world
from hrcplan.execution.links.ros.link import PYTHON, RosLink
from hrcplan.execution.links.ros.mapping import read_mapping
from hrcplan.execution.links.ros.simulated import ROBOT, robot_options
from hrcplan.execution.replay import replay
from hrcplan.pddl.inputs import read
from hrcplan.testing import check_link

ROS = os.environ.get(PYTHON, "")
pytestmark = pytest.mark.skipif(not ROS, reason=f"{PYTHON} names no Python with ROS 2")
HERE = Path(__file__).parent
SHOP = (HERE / "robots" / "shop.toml").read_text()
# Tests at the same time are worlds apart.
DOMAIN = 1 + os.getpid() % 100
ENVIRONMENT = {
    **os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
}  # fmt: skip
MOVE = ("move", ("robot", "wp0", "wp3"))
SPEED = 100.0
WAIT_S = 30.0


@pytest.fixture(autouse=True)
def own_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))


@pytest.fixture
def mapping(tmp_path: Path) -> Path:
    path = tmp_path / "shop.toml"
    path.write_text(SHOP.replace("domain_id = 77", ""))
    return path


@contextmanager
def robot(mapping: Path | None, **behaviour: Any) -> Iterator[subprocess.Popen[str]]:
    """Run a simulated robot; without a mapping it performs for PlanSys2."""
    file = None if mapping is None else read_mapping(mapping)
    options = {**robot_options(read("transport/two-boxes"), file), "seconds": 0.1, **behaviour}
    child = subprocess.Popen(
        [ROS, str(ROBOT), json.dumps(options)], stdout=subprocess.PIPE, text=True, env=ENVIRONMENT
    )
    try:
        assert child.stdout is not None
        assert child.stdout.readline().startswith("ready")
        yield child
    finally:
        child.kill()
        child.wait()


@contextmanager
def successor(first: subprocess.Popen[str], mapping: Path | None) -> Iterator[None]:
    """Start another robot when the first has ended."""
    over = threading.Event()

    def serve() -> None:
        first.wait()
        with robot(mapping):
            over.wait()

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        yield
    finally:
        over.set()
        first.kill()
        thread.join()


def run(mapping: Path | None, **options: Any) -> Execution:
    link = "plansys2" if mapping is None else f"ros:{mapping}"
    return execute("transport/two-boxes", robot=link, **{"speed": SPEED, **options})


def messages(done: Execution) -> str:
    return "\n".join(message.message for message in done.timeline.messages)


def outcomes(done: Execution) -> list[str]:
    return [bar.outcome for bar in done.timeline.bars.values() if bar.agent == "robot"]


@contextmanager
def started(mapping: Path | None) -> Iterator[RosLink]:
    """Start a link, as a run does."""
    link = make_link(
        "plansys2" if mapping is None else f"ros:{mapping}", read("transport/two-boxes")
    )
    assert isinstance(link, RosLink)
    try:
        link.start()
        link.send({"do": "begin", "link": 1, "agents": ["robot"], "actions": [], "speed": 1})
        assert hear(link, msg.LinkReady) == msg.LinkReady(("robot",))
        yield link
    finally:
        link.close()


def hear(link: RosLink, *kinds: type) -> Any:
    """Return the next message of some kinds."""
    until = time.monotonic() + WAIT_S
    while time.monotonic() < until:
        for message in link.receive(0.5):
            if isinstance(message, kinds):
                return message
    raise AssertionError(f"no {kinds}")


def dispatch(link: RosLink, n: int, limit_s: float = 60.0, action: Any = MOVE) -> None:
    link.send({"do": "dispatch", "n": n, "agent": "robot", "action": action[0],
               "args": list(action[1]), "duration_s": 1.0, "limit_s": limit_s})  # fmt: skip


KINDS = pytest.mark.parametrize("kind", ["actions", "plansys2"])


def of(kind: str, mapping: Path) -> Path | None:
    return mapping if kind == "actions" else None


@KINDS
def test_success_and_the_journal_replays(kind: str, mapping: Path, tmp_path: Path) -> None:
    journal = tmp_path / "run.jsonl"
    with robot(of(kind, mapping)):
        done = run(of(kind, mapping), journal=journal)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done) == ["done"] * 4
    again = replay(read_journal(journal))
    assert (again.row, again.difference) == (done.outcome, None)


@KINDS
def test_failure_is_planned_around(kind: str, mapping: Path) -> None:
    with robot(of(kind, mapping), fail_at=[1]):
        done = run(of(kind, mapping))
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "failed"
    assert done.outcome.replans_failure == 1


def test_a_rejection_is_a_failure_with_a_reason(mapping: Path) -> None:
    with robot(mapping, reject=[1]):
        done = run(mapping)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "failed"
    assert "has rejected the goal" in messages(done)


def test_a_performer_that_does_not_answer_is_asked_again(
    mapping: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """PlanSys2 knows no rejection: a performer that does not want an action says nothing."""
    monkeypatch.setattr(link_world, "ACCEPT_S", 0.5)
    with robot(None, reject=[1, 2]):
        done = run(None)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done) == ["done"] * 4


@KINDS
def test_feedback_is_shown(kind: str, mapping: Path) -> None:
    with robot(of(kind, mapping), seconds=0.8):
        done = run(of(kind, mapping), speed=40)
    assert done.outcome.ending == ev.GOAL
    assert "(move robot wp0 wp3): " in messages(done)


@KINDS
def test_an_action_is_cancelled_while_it_runs(kind: str, mapping: Path) -> None:
    with robot(of(kind, mapping), seconds=20.0), started(of(kind, mapping)) as link:
        dispatch(link, 1)
        assert hear(link, msg.Accepted) == msg.Accepted(1)
        link.send({"do": "cancel", "n": 1})
        assert hear(link, msg.ActionEnded).outcome == ev.CANCELLED
        link.send({"do": "cancel", "n": 1})  # a cancel that comes twice is answered twice
        assert hear(link, msg.ActionEnded).outcome == ev.CANCELLED


@KINDS
def test_a_number_that_is_dispatched_twice_is_one_action(kind: str, mapping: Path) -> None:
    with robot(of(kind, mapping), fail_at=[2]), started(of(kind, mapping)) as link:
        for _ in range(2):
            dispatch(link, 1)
        assert hear(link, msg.ActionEnded) == msg.ActionEnded(1, ev.DONE)
        dispatch(link, 1)
        assert hear(link, msg.ActionEnded) == msg.ActionEnded(1, ev.DONE)
        dispatch(link, 2)
        assert hear(link, msg.ActionEnded).outcome == ev.FAILED  # it is the second


@KINDS
def test_an_action_has_a_deadline(kind: str, mapping: Path) -> None:
    with robot(of(kind, mapping), seconds=20.0), started(of(kind, mapping)) as link:
        dispatch(link, 1, limit_s=0.5)
        ended = hear(link, msg.ActionEnded)
    assert ended.outcome == ev.CANCELLED
    assert "did not end within 0.5 s" in ended.why


def test_the_mapping_says_how_long_an_action_may_take(mapping: Path) -> None:
    text = mapping.read_text().replace("done = {", "limit_s = 0.3\ndone = {")
    mapping.write_text(text)
    with robot(mapping, seconds=5.0):
        done = run(mapping, replan_limit=0)
    assert done.outcome.ending == ev.REPLAN_LIMIT
    assert outcomes(done)[0] in (ev.FAILED, ev.CANCELLED)


@KINDS
def test_a_robot_that_is_killed_while_it_acts(kind: str, mapping: Path) -> None:
    """Its outcome is unknown: at once if another robot takes its place, else after a while."""
    with robot(of(kind, mapping), seconds=30.0) as first, started(of(kind, mapping)) as link:
        dispatch(link, 1)
        hear(link, msg.Accepted)
        first.kill()
        first.wait()
        with robot(of(kind, mapping)):
            ended = hear(link, msg.ActionEnded)
            assert ended.outcome == ev.UNKNOWN
            assert "gone" in ended.why
            dispatch(link, 2)
            hear(link, msg.ActionEnded)


@KINDS
def test_a_robot_that_is_killed_and_restarted_leads_to_a_replan(kind: str, mapping: Path) -> None:
    place = of(kind, mapping)
    with robot(place, die_after=1, seconds=0.5) as first, successor(first, place):
        done = run(place, speed=20)
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == ev.UNKNOWN
    assert done.outcome.replans_failure >= 1


@KINDS
def test_a_deaf_robot_is_asked_three_times(
    kind: str, mapping: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link_world, "ACCEPT_S", 0.4)
    with robot(of(kind, mapping), deaf_after=0):
        done = run(of(kind, mapping), replan_limit=0)
    assert outcomes(done)[0] == ev.UNKNOWN
    assert "the robot does not answer" in messages(done)
    assert done.outcome.ending == ev.REPLAN_LIMIT


@KINDS
def test_the_laws_of_links(kind: str, mapping: Path) -> None:
    name = "plansys2" if kind == "plansys2" else f"ros:{mapping}"
    with robot(of(kind, mapping)):
        check_link(lambda: make_link(name, read("transport/two-boxes")), MOVE, "robot")


@KINDS
def test_two_runs_cannot_drive_one_robot(kind: str, mapping: Path) -> None:
    with (
        robot(of(kind, mapping)), started(of(kind, mapping)),
        pytest.raises(UsageError, match="another run drives"),
    ):  # fmt: skip
        run(of(kind, mapping))


def test_nothing_is_left_when_we_are_killed(mapping: Path, tmp_path: Path) -> None:
    code = (
        "from hrcplan.execution.execute import execute\n"
        f"execute('transport/two-boxes', robot='ros:{mapping}', speed=1)\n"
    )
    with robot(mapping, seconds=60.0):
        child = subprocess.Popen([sys.executable, "-c", code], env=ENVIRONMENT)

        def bridges() -> Sequence[str]:
            command = ["pgrep", "-f", "links/ros/bridge.py"]
            pids = subprocess.run(command, capture_output=True, text=True).stdout.split()
            return [pid for pid in pids if _domain_of(pid) == str(DOMAIN)]

        wait_for(bridges)
        child.kill()
        child.wait()
        wait_for(lambda: not bridges())


def _domain_of(pid: str) -> str:
    try:
        entries = Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return ""
    values = dict(entry.decode().split("=", 1) for entry in entries if b"=" in entry)
    return values.get("ROS_DOMAIN_ID", "")


def wait_for(condition: Callable[[], object]) -> None:
    until = time.monotonic() + WAIT_S
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.05)


@contextmanager
def publisher() -> Iterator[Callable[..., None]]:
    """Yield what publishes a message, once a program listens."""
    argv = [ROS, str(HERE / "robots" / "publish.py")]
    pipe = subprocess.PIPE
    with subprocess.Popen(argv, stdin=pipe, stdout=pipe, text=True, env=ENVIRONMENT) as child:

        def publish(topic: str, kind: str, **fields: Any) -> None:
            assert child.stdin is not None
            assert child.stdout is not None
            order = {"topic": topic, "type": kind, "fields": fields}
            child.stdin.write(json.dumps(order) + "\n")
            child.stdin.flush()
            assert child.stdout.readline() == "sent\n"

        try:
            yield publish
        finally:
            child.kill()


def test_topics_say_what_is_true(mapping: Path) -> None:
    with robot(mapping), started(mapping) as link, publisher() as publish:
        publish("/robot/place", "std_msgs/msg/String", data="wp2")
        seen = hear(link, msg.FactsObserved)
        assert seen.facts == {("at", "robot", "wp2")}
        publish("/robot/pose", "geometry_msgs/msg/PoseStamped", **{"pose.position.x": 4.1})
        assert hear(link, msg.FactsObserved).facts == {("at", "robot", "wp4")}
        publish("/human/motivation", "std_msgs/msg/Float64", data=8.0)
        assert hear(link, msg.ValuesSensed) == msg.ValuesSensed({("motivation", "human"): 8.0})
        for _ in range(2):  # words may be said again
            publish("/human/speech", "std_msgs/msg/String", data="hello")
            assert hear(link, msg.PersonSaid) == msg.PersonSaid("human", "hello")
        publish("/stop", "std_msgs/msg/Bool", data=True)
        assert hear(link, msg.StopPressed) == msg.StopPressed("topic /stop")
        publish("/stop", "std_msgs/msg/Bool", data=False)
        hear(link, msg.StopReleased)
        link.send({"do": "observe"})
        assert ("at", "robot", "wp4") in hear(link, msg.FactsObserved).facts


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("nav2_msgs/action/NavigateToPose", "nav2_msgs/action/Navigate", "there is no nav2_msgs"),
        ("nav2_msgs/action/", "no_msgs/action/", "there is no no_msgs"),
        ("goal.pose.pose", "goal.pose.pos", "there is no field 'pose.pos'"),
        ("goal.order = 1", 'goal.order = "one"', "field 'order' is a int32"),
        ("error_code = 0", "error = 0", "there is no field 'error'"),
        ("std_msgs/msg/Float64", "std_msgs/msg/Float65", "there is no std_msgs/msg/Float65"),
        ("pose.position", "pose.place", "there is no field 'pose.place'"),
    ],
)
def test_what_ros_does_not_know_has_a_line(mapping: Path, old: str, new: str, message: str) -> None:
    text = mapping.read_text().replace(old, new, 1)
    mapping.write_text(text)
    with robot(None), pytest.raises(InputError) as caught:
        run(mapping)
    assert message in caught.value.message
    assert caught.value.line
    assert (
        "[" in text.splitlines()[caught.value.line - 1]
        or new.split(" ")[0] in (text.splitlines()[caught.value.line - 1])
    )


def test_a_robot_that_is_not_there(mapping: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(PlannerError, match="no robot listens at /robot/navigate_to_pose"):
        run(mapping)
    monkeypatch.setenv(PYTHON, sys.executable)
    with pytest.raises(PlannerError, match="has no rclpy"):
        run(mapping)
    monkeypatch.setenv(PYTHON, "no-such-python")
    with pytest.raises(PlannerError, match="no program 'no-such-python'"):
        run(mapping)
