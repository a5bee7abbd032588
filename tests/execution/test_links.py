"""Robot links: every fault of a real program ends in the right event and a named ending."""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from hrcplan.errors import InputError, MissingPlannerError, PlannerError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.execute import Execution, execute
from hrcplan.execution.journal import read_journal
from hrcplan.execution.links import LINKS, RobotLink, session, simulated_robot
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links import world as link_world
from hrcplan.execution.links.process import FLOOD, ProcessLink
from hrcplan.execution.replay import replay
from hrcplan.pddl.inputs import read

ODD = Path(__file__).parent / "robots" / "odd.py"
ALONE = """(define (domain alone) (:requirements :typing) (:types agent)
  (:predicates (rested ?a - agent))
  (:action rest :parameters (?a - agent) :effect (rested ?a)))"""
ALONE_PROBLEM = """(define (problem one) (:domain alone) (:objects anna - agent) (:init)
  (:goal (rested anna)))"""
SPEED = 100  # an action of 50 s is late after 1.5 s


def odd(*words: object) -> str:
    """Return the link to the odd robot in one of its modes."""
    return f"cmd:{shlex.join([sys.executable, '-S', str(ODD), *map(str, words)])}"


@pytest.fixture(autouse=True)
def short_waits(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(link_world, "ACCEPT_S", 0.3)
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path / "cache"))


def run(*words: object, speed: float = SPEED, **options: object) -> Execution:
    options = {"robot": odd(*words), "speed": speed, **options}
    return execute("transport/two-boxes", **options)  # type: ignore[arg-type]


def messages(done: Execution) -> str:
    return "\n".join(message.message for message in done.timeline.messages)


def outcomes(done: Execution, agent: str = "robot") -> list[str]:
    return [bar.outcome for bar in done.timeline.bars.values() if bar.agent == agent]


def test_success() -> None:
    done = run("plain")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done) == ["done"] * 4
    assert messages(done) == ""


def test_failure_is_planned_around() -> None:
    done = run("fail")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "failed"
    assert done.outcome.replans_failure == 1
    assert "(move robot wp0 wp3): slipped" in messages(done)


def test_a_refusal_is_a_failure_with_a_reason() -> None:
    done = run("reject")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "failed"
    assert "the robot refuses (move robot wp0 wp3): the path is blocked" in messages(done)


def test_feedback_is_shown() -> None:
    done = run("feedback")
    assert done.outcome.ending == ev.GOAL
    assert "(move robot wp0 wp3): half way" in messages(done)


def test_of_an_unknown_outcome_what_is_observed_counts() -> None:
    done = run("unknown")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "unknown"
    moves = [
        b.args for b in done.timeline.bars.values() if b.agent == "robot" and b.action == "move"
    ]
    assert ("robot", "wp0", "wp3") in moves[:1]
    assert ("robot", "wp0", "wp3") not in moves[1:]  # it is there already


def test_a_robot_that_dies_while_it_acts_is_started_again(tmp_path: Path) -> None:
    done = run("die", tmp_path / "mark")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == "unknown"
    assert "ended: signal 9" in messages(done)
    assert "was started again" in messages(done)


def test_a_robot_that_keeps_dying_is_lost() -> None:
    done = run("die", "/dev/null/none")  # its mark can never be made
    assert done.outcome.ending == ev.STOPPED
    assert "the robot is lost" in done.run.why


def test_a_deaf_robot_is_asked_three_times() -> None:
    done = run("deaf", replan_limit=1)
    assert done.outcome.ending in (ev.GOAL, ev.REPLAN_LIMIT, ev.NO_PLAN)
    assert "unknown" in outcomes(done)
    assert "the robot does not answer" in messages(done)


def test_a_lost_acceptance_is_asked_for_again() -> None:
    done = run("lost-acceptance")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done) == ["done"] * 4


def test_a_result_counts_once() -> None:
    done = run("twice")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done) == ["done"] * 4
    assert "action 99, which was never dispatched" in messages(done)


@pytest.mark.parametrize(("mode", "words"), [("garbage", "no JSON"), ("long", "too long")])
def test_lines_that_are_no_messages_are_reported(mode: str, words: str) -> None:
    done = run(mode)
    assert done.outcome.ending == ev.GOAL
    assert words in messages(done)
    assert "\x1b" not in messages(done)
    assert outcomes(done) == ["done"] * 4


def test_a_flood_ends_the_program(tmp_path: Path) -> None:
    done = run("flood", tmp_path / "mark")
    assert done.outcome.ending == ev.GOAL
    assert f"more than {FLOOD >> 20} MiB" in messages(done)


def test_an_emergency_stop_cancels_everything_until_it_is_released() -> None:
    done = run("stop", speed=200)
    assert done.outcome.ending == ev.GOAL
    assert "emergency stop: a person is too near" in messages(done)
    assert "the emergency stop is released" in messages(done)
    pressed, released = (m.t for m in done.timeline.messages if m.code == "emergency-stop")
    assert released - pressed < 30  # its .3 s would be 60 s if the clock of the run went on
    assert outcomes(done)[0] == ev.CANCELLED
    assert done.outcome.replans_failure == done.outcome.replans_deviation == 0  # the plan goes on


def test_what_is_sensed_makes_the_monitor_replan() -> None:
    done = run("sense")
    assert done.outcome.ending == ev.GOAL
    assert done.outcome.replans_change == 1
    assert "(nonsense x)" in messages(done) or "nonsense" in messages(done)


def test_what_is_observed_and_not_believed_is_planned_from() -> None:
    done = run("teleport")
    assert done.outcome.ending == ev.GOAL
    moves = [bar.args for bar in done.timeline.bars.values() if bar.args[0] == "robot"]
    assert moves == [("robot", "wp0", "wp3")]  # from where it is, the human had better do it all
    assert ("at", "robot", "wp5") in done.run.state.facts
    assert "no fact" in messages(done)


def test_a_static_fact_that_a_robot_denies_is_planned_with() -> None:
    done = run("close")
    assert done.outcome.ending == ev.GOAL
    moves = [bar.args for bar in done.timeline.bars.values() if bar.action == "move"]
    assert ("robot", "wp3", "wp2") not in moves
    assert done.outcome.replans_deviation == 1
    assert "'red' is no box of the problem" in messages(done)
    assert "has to stand in :objects" in messages(done)


def test_a_result_after_the_cancelling_of_a_late_action() -> None:
    """The driver gives an action up after three times its duration; then the robot says done."""
    done = run("late")
    assert done.outcome.ending == ev.GOAL
    assert outcomes(done)[0] == ev.FAILED
    moves = [bar.args for bar in done.timeline.bars.values() if bar.args[:2] == ("robot", "wp0")]
    assert moves == [("robot", "wp0", "wp3")]  # it is there, so it does not move again


def test_a_run_with_a_robot_can_be_replayed(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    done = run("fail", journal=path)
    again = replay(read_journal(path))
    assert (again.row, again.difference) == (done.outcome, None)


@pytest.mark.parametrize("part", [0.1, 0.3, 0.5, 0.7])
def test_a_run_with_a_robot_can_be_resumed(tmp_path: Path, part: float) -> None:
    """What was under way has an unknown outcome, and no effect of it is assumed."""
    path = tmp_path / "run.jsonl"
    run("plain", journal=path)
    lines = path.read_text().splitlines(keepends=True)
    kept = lines[: int(part * len(lines))]
    path.write_text("".join(kept))
    done = run("plain", journal=path, resume=True)
    assert done.outcome.ending == ev.GOAL
    assert replay(read_journal(path)).difference is None
    under_way = {
        item["number"]
        for line in map(json.loads, kept)
        for item in line.get("decided", ())
        if item["kind"] == "dispatch"
    } - {
        line["event"]["number"]
        for line in map(json.loads, kept)
        if line.get("event", {}).get("kind") == "ended"
    }
    unknown = {n for n, bar in done.timeline.bars.items() if bar.outcome == ev.UNKNOWN}
    assert unknown == under_way
    assert "goes on from its journal" in messages(done)


def test_what_a_robot_observes_counts_when_a_run_is_resumed(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    run("unknown", journal=path)
    lines = path.read_text().splitlines(keepends=True)
    first = next(n for n, line in enumerate(lines) if '"kind":"dispatch"' in line)
    path.write_text("".join(lines[: first + 1]))
    done = run("unknown", journal=path, resume=True)  # it observes that it is at wp3
    assert done.outcome.ending == ev.GOAL
    moves = [b.args for b in done.timeline.bars.values() if b.args[:2] == ("robot", "wp0")]
    assert moves == [("robot", "wp0", "wp3")]


def test_a_journal_says_whether_a_robot_is_needed(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    execute("transport/two-boxes", journal=path)
    with pytest.raises(UsageError, match="of a simulation"):
        run("plain", journal=path, resume=True)
    path.unlink()
    run("plain", journal=path)
    with pytest.raises(UsageError, match="of a run with a robot"):
        execute("transport/two-boxes", journal=path, resume=True)


def test_two_runs_cannot_drive_one_robot() -> None:
    link = ProcessLink(odd("plain").removeprefix("cmd:"))
    link.start()
    try:
        with pytest.raises(UsageError, match="another run drives the robot"):
            run("plain")
    finally:
        link.close()
    assert run("plain").outcome.ending == ev.GOAL


def test_programs_that_are_no_robots(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "READY_S", 0.3)
    with pytest.raises(MissingPlannerError, match="no program 'no-such-robot'"):
        execute("transport/two-boxes", robot="cmd:no-such-robot")
    with pytest.raises(PlannerError, match="ended: exit code 3"):
        execute("transport/two-boxes", robot="cmd:sh -c 'exit 3'")
    with pytest.raises(PlannerError, match="does not say that it is ready"):
        run("mute")
    with pytest.raises(UsageError, match="takes actions of nobody"):
        run("stranger")
    with pytest.raises(UsageError, match="no command line"):
        execute("transport/two-boxes", robot="cmd:'")
    with pytest.raises(UsageError, match="no agent of this problem takes commands"):
        execute(ALONE, ALONE_PROBLEM, robot=odd("plain"))


def test_nothing_is_left_of_a_robot_when_we_are_killed(tmp_path: Path) -> None:
    mark = tmp_path / "a-mark-of-its-own"
    code = (
        "from hrcplan.execution.execute import execute\n"
        f"execute('transport/two-boxes', robot={odd('endless', mark)!r}, speed=1)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code], cwd=Path(__file__).parents[2])

    def robots() -> list[str]:
        found = subprocess.run(["pgrep", "-f", str(mark)], capture_output=True, text=True).stdout
        return [pid for pid in found.split() if int(pid) != child.pid]

    wait_for(robots)
    child.send_signal(signal.SIGKILL)
    child.wait()
    wait_for(lambda: not robots())


def wait_for(condition: Callable[[], object]) -> None:
    until = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.05)


class Scripted:
    """A link without a program: what it is told, and when it answers, is up to the test."""

    def __init__(self) -> None:
        self.replies: list[msg.LinkMessage] = []

    def start(self) -> None:
        self.replies = [msg.LinkReady()]

    def send(self, message: object) -> bool:
        assert isinstance(message, dict)
        if message["do"] == "dispatch":
            self.replies.append(msg.ActionEnded(message["n"], ev.DONE))
        return True

    def receive(self, timeout_s: float) -> list[msg.LinkMessage]:
        replies, self.replies = self.replies, []
        if not replies:
            time.sleep(min(timeout_s, 0.01))
        return replies

    def close(self) -> None:
        self.replies = []


def test_a_link_of_ones_own_is_an_object_of_four_methods() -> None:
    link = Scripted()
    assert isinstance(link, RobotLink)
    assert execute("transport/two-boxes", robot=link, speed=1000).outcome.ending == ev.GOAL


def test_a_clock_that_jumps_does_no_harm() -> None:
    from hrcplan.agents import load_profile
    from hrcplan.execution.model import ExecutionModel
    from hrcplan.execution.monitor import Monitor
    from hrcplan.execution.replanner import Replanner
    from hrcplan.execution.simulate import Engine
    from hrcplan.execution.worlds.simulated import Nature

    ticks = iter(range(10**9))
    jumps = {400: -50.0, 900: 30.0}
    offset = 0.0

    def clock() -> float:
        nonlocal offset
        tick = next(ticks)
        offset += jumps.get(tick, 0.0)
        return tick * 0.001 + offset

    model = ExecutionModel(read("transport", "two-boxes"))
    world = link_world.LinkWorld(model, Nature(), Scripted(), speed=1000, clock=clock)
    engine = Engine(Monitor(model, load_profile("hrcplan")), Replanner(model))
    times: list[float] = []
    run = engine.run(Nature(), None, lambda run, *_: times.append(run.t), world)
    assert run.ending == ev.GOAL
    assert times == sorted(times)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("", "no JSON"),
        ("[]", "no JSON object"),
        ('{"event": "dance"}', "no event of a link"),
        ('{"event": "accepted"}', "no 'n'"),
        ('{"event": "accepted", "n": true}', "no number"),
        ('{"event": "ended", "n": 1, "outcome": "great"}', "'outcome' is one of"),
        ('{"event": "observed", "facts": [3]}', "a fact is a text"),
        ('{"event": "sensed", "values": {"motivation human": "x"}}', "is no number"),
        ('{"event": "sensed", "values": {"motivation human": NaN}}', "is not finite"),
        ('{"event": "sensed", "values": {"motivation human": 1%s}}' % (400 * "0"), "too large"),
        ('{"event": "sensed", "values": [["motivation human", 1]]}', "no JSON object"),
        ('{"event": "begun", "action": ["move"]}', "str instance"),
        ("[" * 100_000, "no JSON"),
        (None, "too long"),
    ],
)
def test_bad_lines(line: str | None, reason: str) -> None:
    message = msg.message_of(line)
    assert isinstance(message, msg.BadLine)
    assert reason in message.reason


def test_what_people_say_to_an_execution_does_not_end_it() -> None:
    class Talks(Scripted):
        n_silent = 3

        def receive(self, timeout_s: float) -> list[msg.LinkMessage]:
            if self.replies and not isinstance(self.replies[0], msg.LinkReady):
                self.n_silent -= 1
                if self.n_silent > 0:
                    return [msg.PersonSaid("human", "hello")] if self.n_silent == 2 else []
            return super().receive(timeout_s)

    done = execute("transport/two-boxes", robot=Talks(), speed=1000)
    assert done.outcome.ending == ev.GOAL
    assert "collaborate hears people" in messages(done)


@pytest.mark.parametrize(
    "line",
    [b"hello", b"[]", b"{}", b'{"do": "dispatch"}', b"[" * 100_000, b"\xff", b"1" * 5000,
     b"x" * (1 << 21)],
    ids=lambda line: str(line[:20]),
)  # fmt: skip
def test_the_simulated_robot_refuses_what_is_no_command(
    line: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    read_end, write_end = os.pipe()
    thread = threading.Thread(target=_written, args=[write_end, line + b"\n"])
    thread.start()
    monkeypatch.setattr(simulated_robot, "STDIN", read_end)
    with pytest.raises(InputError):
        simulated_robot.SimulatedRobotProgram().run()
    os.close(read_end)
    thread.join()


def _written(handle: int, data: bytes) -> None:
    with contextlib.suppress(BrokenPipeError), os.fdopen(handle, "wb") as file:
        file.write(data)


def test_files_cannot_name_programs_as_robots() -> None:
    with pytest.raises(UsageError, match="a file cannot name the link"):
        LINKS.find_listed(odd("plain"))


def test_the_simulated_robot_from_the_command_line(tmp_path: Path) -> None:
    robot = f"cmd:{sys.executable} -m hrcplan robot --simulated --speed 1000 --fail 0.2 --seed 2"
    finished = subprocess.run(
        [sys.executable, "-m", "hrcplan", "execute", "transport/two-boxes", "--robot", robot,
         "--speed", "1000", "--json"],
        capture_output=True, text=True, check=False, cwd=Path(__file__).parents[2],
        env={**os.environ, "HRCPLAN_CACHE": str(tmp_path)},
    )  # fmt: skip
    assert finished.returncode == 0, finished.stderr
    assert json.loads(finished.stdout)["ending"] == ev.GOAL


def test_the_simulated_robot_runs_no_code_of_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("importlib", "json", "runpy", "click"):
        (tmp_path / f"{name}.py").write_text("open('trap', 'w'); raise SystemExit('trapped')")
    monkeypatch.chdir(tmp_path)
    problem = read("transport", "handover")
    outcome = execute(problem, robot="simulated", speed=SPEED).outcome
    assert "program ended" not in outcome.ending
    assert not (tmp_path / "trap").exists()
