"""``hrcplan collaborate`` over a pipe and at a terminal: sessions, faults, kills."""

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from tests.worlds import PACKED, PARCELS, WORKSHOP

COMMAND = [sys.executable, "-m", "hrcplan", "collaborate"]
PIPE_BLUE = "cut pipe\nunfold blue\npack pipe blue\ncut rope\npack rope blue\n"
TWO = PACKED.replace("ann robo", "ann bob robo")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("shop"), PACKED)


def written(folder: Path, problem: str) -> Path:
    (folder / "goals").mkdir()
    (folder / "domain.pddl").write_text(WORKSHOP)
    for name, goal in PARCELS.items():
        (folder / "goals" / f"{name}.pddl").write_text(problem.format(name=name, goal=goal))
    return folder


def collaborate(folder: Path, text: str | bytes, *words: str) -> subprocess.CompletedProcess[str]:
    raw = text if isinstance(text, bytes) else text.encode()
    done = subprocess.run(
        [*COMMAND, "domain.pddl", "goals", *words], input=raw, capture_output=True, cwd=folder,
        check=False, timeout=100,
    )  # fmt: skip
    out, err = done.stdout.decode(), done.stderr.decode()
    assert "Traceback" not in err
    return subprocess.CompletedProcess(done.args, done.returncode, out, err)


def test_a_goal_is_reached_with_a_change_of_mind(folder: Path) -> None:
    """First the human begins a parcel of wire, then it turns to the blue box."""
    # Steps that the robot was quicker with are refused, which does no harm.
    steps = PIPE_BLUE.splitlines(keepends=True)
    text = "cut wire\nunfold red\nhelp\nwhy\ngoals\nstate\nsteps\n" + 3 * "no\n\n".join(steps)
    done = collaborate(folder, f"{text}quit\n")
    assert "you: cut wire" in done.stdout
    assert re.search(r"robo: .*, for .* · [\w-]+ \d+ %", done.stdout)
    assert re.search(r"done: .*(pipe-blue|either)", done.stdout)
    assert "stopped (quit)" in done.stdout
    assert done.returncode == 1
    yes = collaborate(folder, 3 * "yes\n\n".join([*steps, ""]))
    assert "goal reached" in yes.stdout
    assert yes.returncode == 0


def test_lines_of_any_kind_harm_nothing(folder: Path) -> None:
    lines = [b"", b"x" * 10_000, b"\x00\x1b[2J\x07", b"\xff\xfe\xc3(", "cut ŵire 🔧".encode(),
             b"999999999999", b"-1", b":", b"ann:", b"nobody: cut wire", b"state motivation ann x",
             b"state ann 8", b"undo", b"failed", b"))((", b"cut wire"]  # fmt: skip
    done = collaborate(folder, b"\n".join(lines))  # the last line does not even end
    assert "you: cut wire" in done.stdout
    assert "\x1b" not in done.stdout
    assert done.returncode == 1
    assert "the input has ended" in done.stderr
    as_json = collaborate(folder, b"\n".join(lines), "--json")
    documents = [json.loads(line) for line in as_json.stdout.splitlines()]
    assert documents[-1]["error"]["code"] == "input-ended"
    assert any(d.get("event", {}).get("kind") == "begun" or
               d.get("event", {}).get("kind") == "read" for d in documents)  # fmt: skip


def test_every_event_is_one_line_of_json(folder: Path) -> None:
    done = collaborate(folder, "cut wire\nundo\nstate\ngoals\nsteps\nwhy\nquit\n", "--json")
    documents = [json.loads(line) for line in done.stdout.splitlines()]
    assert documents[0]["people"] == ["ann"]
    assert [next(iter(d)) for d in documents[-1:]] == ["outcome"]
    kinds = {d["event"]["kind"] for d in documents if "event" in d}
    assert {"said", "read", "chosen", "undone", "stopasked"} <= kinds
    assert done.stderr == ""


def test_two_people_at_one_terminal_are_named(tmp_path: Path) -> None:
    folder = written(tmp_path, TWO)
    done = collaborate(folder, "bob: cut wire\ncut rope\n1\nann:\nquit\n", "--pace", "free")
    assert "bob: cut bob wire" in done.stdout
    assert "which of these?" in done.stdout
    assert re.search(r"(ann|bob): cut (ann|bob) rope", done.stdout)


def test_a_killed_session_goes_on(folder: Path, tmp_path: Path) -> None:
    """The real thing: kill -9 while the person thinks, then --resume."""
    path = tmp_path / "killed.jsonl"
    command = [*COMMAND, "domain.pddl", "goals", "--journal", str(path)]
    running = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                               cwd=folder)  # fmt: skip
    assert running.stdin is not None
    running.stdin.write(b"cut wire\nunfold red\n")
    running.stdin.flush()
    until = time.monotonic() + 60
    while time.monotonic() < until and (
        not path.exists() or path.read_bytes().count(b'"kind":"chosen"') < 1
    ):
        time.sleep(0.02)
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    again = collaborate(folder, "pack wire red\nquit\n", "--journal", str(path), "--resume")
    assert again.stdout.count("cut wire") == 0  # what was seen before is not shown again
    assert "stopped (quit)" in again.stdout
    check = subprocess.run([sys.executable, "-m", "hrcplan", "replay", str(path)],
                           capture_output=True, check=False)  # fmt: skip
    assert b"all of them follow" in check.stdout
    refused = collaborate(folder, "quit\n", "--journal", str(path))
    assert refused.returncode == 2
    (folder / "goals" / "zzz.pddl").write_text(PACKED.format(name="zzz", goal="(cut rope)"))
    try:
        other = collaborate(folder, "quit\n", "--journal", str(path), "--resume")
    finally:
        (folder / "goals" / "zzz.pddl").unlink()
    assert other.returncode == 3
    assert "other PDDL" in other.stderr


def test_a_full_disk_is_said(folder: Path) -> None:
    if not os.path.exists("/dev/full"):
        return
    done = collaborate(folder, "cut wire\n", "--journal", "/dev/full")
    assert done.returncode == 2
    assert "cannot write the journal" in done.stderr


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [(["--method", "oracle"], 2, "has to know your goal"), (["--pace", "frei"], 2, "free"),
     (["--method", "nobody"], 2, "nobody"), (["--resume"], 2, "journal"),
     (["--human", "nobody"], 2, "nobody")],
)  # fmt: skip
def test_wrong_use_is_explained(folder: Path, words: list[str], code: int, text: str) -> None:
    done = collaborate(folder, "", *words)
    assert (done.returncode, text in done.stderr) == (code, True), done.stderr


class Session:
    """A session at a pseudo-terminal."""

    def __init__(
        self, folder: Path, *words: str, columns: int = 80,
        goals: tuple[str, ...] = ("domain.pddl", "goals"),
    ) -> None:  # fmt: skip
        self.pid, self.handle = pty.fork()
        if self.pid == 0:
            signal.signal(signal.SIGHUP, signal.SIG_DFL)  # also where the tests run under nohup
            os.chdir(folder)
            os.environ["COLUMNS"] = str(columns)
            os.execv(sys.executable, [*COMMAND, *goals, *words])
        self.text = ""

    def expect(self, pattern: str) -> None:
        """Read until a pattern is there, behind what was read before."""
        start, until = len(self.text), time.monotonic() + 30
        while not re.search(pattern, self.text[start:]):
            assert time.monotonic() < until, self.text
            if select.select([self.handle], [], [], 1.0)[0]:
                self.text += os.read(self.handle, 4096).decode()

    def type(self, text: str) -> None:
        os.write(self.handle, text.encode())

    def wait(self) -> int:
        until = time.monotonic() + 60
        while True:
            try:
                if not select.select([self.handle], [], [], 1.0)[0]:
                    assert time.monotonic() < until, self.text
                    continue
                self.text += os.read(self.handle, 4096).decode()
            except OSError:
                break
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


def test_a_session_at_a_terminal(folder: Path) -> None:
    session = Session(folder)
    session.expect("> $")
    session.type("cut pipe\n")
    session.expect(r"robo[^>]*> $")
    session.type("\n")
    session.expect("> $")
    session.type("quit\n")
    assert session.wait() == 1
    assert "stopped (quit)" in session.text


@pytest.mark.parametrize("columns", [60, 80])
def test_lines_fit_the_terminal_and_speak_of_the_domain(folder: Path, columns: int) -> None:
    session = Session(folder, columns=columns)
    for line in ("help", "state", "why", "goals", "quit"):
        session.expect("> $")
        session.type(f"{line}\n")
    session.wait()
    lines = session.text.replace("\r", "").split("\n")
    assert max(map(len, lines)) <= columns
    assert 'in your own words ("cut ' in session.text  # a step of this domain


@pytest.mark.parametrize(
    ("signal_number", "code"),
    [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)],
)
def test_signals_end_a_session_and_leave_the_journal(
    folder: Path, tmp_path: Path, signal_number: signal.Signals, code: int
) -> None:
    path = tmp_path / "stopped.jsonl"
    session = Session(folder, "--journal", str(path))
    session.expect("> $")
    os.kill(session.pid, signal_number)
    assert session.wait() == code
    assert "Traceback" not in session.text
    lines: list[dict[str, Any]] = [json.loads(line) for line in path.read_text().splitlines()]
    assert lines[0]["journal"] == 2
    assert collaborate(folder, "quit\n", "--journal", str(path), "--resume").returncode == 1
