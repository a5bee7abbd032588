"""``hrcplan collaborate`` over a pipe and at a terminal: sessions, faults, kills."""

import json
import os
import pty
import re
import resource
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.worlds import ERRAND, ERRANDS, HALL, PACKED, PARCELS, WORKSHOP

COMMAND = [sys.executable, "-m", "hrcplan", "collaborate"]
PIPE_BLUE = "cut pipe\nunfold blue\npack pipe blue\ncut rope\npack rope blue\n"
TWO = PACKED.replace("ann robo", "ann bob robo")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("shop"), PACKED)


def written(folder: Path, problem: str, goals: Mapping[str, str] = PARCELS) -> Path:
    (folder / "goals").mkdir()
    (folder / "domain.pddl").write_text(WORKSHOP)
    for name, goal in goals.items():
        (folder / "goals" / f"{name}.pddl").write_text(problem.format(name=name, goal=goal))
    return folder


def collaborate(
    folder: Path, text: str | bytes, *words: str, before: Callable[[], None] | None = None
) -> subprocess.CompletedProcess[str]:
    raw = text if isinstance(text, bytes) else text.encode()
    done = subprocess.run(
        [*COMMAND, "domain.pddl", "goals", *words], input=raw, capture_output=True, cwd=folder,
        check=False, timeout=100, preexec_fn=before,
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


@pytest.mark.parametrize(
    ("pace", "text", "code", "reached"),
    [("turns", "cut rope\nyes\n", 0, "small"), ("free", "cut rope\nyes\n", 0, "small"),
     ("turns", "cut rope\ncut pipe\nno\nyes\n", 0, "large"),
     ("free", "cut rope\ncut pipe\nyes\n", 0, "large"),
     ("turns", "cut rope\nquit\n", 1, ""), ("free", "cut rope\nquit\n", 1, "")],
)  # fmt: skip
def test_a_goal_within_another_ends_with_who_confirms_it(
    tmp_path: Path, pace: str, text: str, code: int, reached: str
) -> None:
    """In turns the robot acts next, with what only the larger goal needs: it has to hear no."""
    folder = written(tmp_path, PACKED, {"small": "(cut rope)", "large": "(cut rope) (cut pipe)"})
    done = collaborate(folder, text, "--pace", pace)
    assert done.returncode == code, done.stdout
    assert "done: small. Was that all?" in done.stdout
    assert f"goal reached ({reached})" in done.stdout or not reached
    assert ("say no, and the robot goes on" in done.stdout) == ("no" in text)


def test_words_that_name_another_agent_are_no_step_of_the_one_who_is_asked(tmp_path: Path) -> None:
    goals = {"rope": "(cut rope)", "never": "(cut rope) (whole rope)"}
    folder = written(tmp_path, TWO, goals)
    lines = ["robo cut rope", "(cut robo rope)", "robo: cut rope", "zoe: cut rope", "quit"]
    done = collaborate(folder, "\n".join(lines))
    assert done.stdout.count("these words name robo") == 3
    assert "there is no zoe" in done.stdout
    assert "0 human" in done.stdout
    assert "warning: goal 'never' has no plan" in done.stderr


def test_what_an_action_needs_is_not_said_of_one_that_is_possible(tmp_path: Path) -> None:
    folder = tmp_path
    (folder / "goals").mkdir()
    (folder / "domain.pddl").write_text(HALL)
    for name, goal in ERRANDS.items():
        (folder / "goals" / f"{name}.pddl").write_text(ERRAND.format(name=name, goal=goal))
    done = collaborate(folder, "go a b\nquit\n")
    assert "(go ann a b) needs (at ann a)" in done.stdout


def test_stop_and_go_are_confirmed(folder: Path) -> None:
    done = collaborate(folder, "stop\ngo\nquit\n")
    stopped, goes_on = (done.stdout.index(words) for words in ("the robot stops", "robot goes on"))
    assert stopped < goes_on


def test_of_several_robots_those_that_wait_are_named(tmp_path: Path) -> None:
    problem = PACKED.replace("ann robo", "ann robo helper").replace(
        "(controllable robo)", "(controllable robo) (controllable helper)"
    )
    out = collaborate(written(tmp_path, problem), "cut wire\n\n\n\n\n\nquit\n").stdout
    assert "robo and helper wait · " in out
    assert "robot waits" not in out


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


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_a_device_is_no_journal(folder: Path) -> None:
    done = collaborate(folder, "cut wire\n", "--journal", "/dev/full")
    assert done.returncode == 2
    assert "cannot write the journal" in done.stderr


def test_a_session_goes_on_after_the_disk_was_full(folder: Path, tmp_path: Path) -> None:
    """The disk is full in the middle of a line."""
    path = tmp_path / "full.jsonl"
    assert collaborate(folder, "quit\n", "--journal", str(path)).returncode == 1
    n_bytes = path.stat().st_size + 1000
    path.unlink()
    full = collaborate(
        folder, 9 * "cut wire\nundo\n", "--journal", str(path),
        before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (n_bytes, n_bytes)),
    )  # fmt: skip
    assert full.returncode == 2
    assert "cannot write the journal" in full.stderr
    assert "--resume" in full.stderr
    whole = path.read_bytes()
    assert not whole.endswith(b"\n")
    again = collaborate(folder, "quit\n", "--journal", str(path), "--resume")
    assert "stopped (quit)" in again.stdout
    assert path.read_bytes().startswith(whole[: whole.rindex(b"\n") + 1])


def test_input_that_is_closed_has_ended(folder: Path) -> None:
    done = collaborate(folder, "", before=lambda: os.close(0))
    assert (done.returncode, "the input has ended" in done.stderr) == (1, True)


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
        goals: tuple[str, ...] = ("domain.pddl", "goals"), is_deaf: bool = False,
    ) -> None:  # fmt: skip
        self.pid, self.handle = pty.fork()
        if self.pid == 0:
            # The default also where the tests run under nohup.
            signal.signal(signal.SIGHUP, signal.SIG_IGN if is_deaf else signal.SIG_DFL)
            os.chdir(folder)
            os.environ["COLUMNS"] = str(columns)
            os.execv(sys.executable, [*COMMAND, *goals, *words])
        self.text = ""

    def expect(self, pattern: str) -> None:
        """Read until a pattern is there, behind what was read before."""
        start, until = len(self.text), time.monotonic() + 120
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
    session.expect(r"in your own words or by number[^>]*> $")
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


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_ctrl_c_ends_a_session(folder: Path, tmp_path: Path, pace: str) -> None:
    path = tmp_path / "interrupted.jsonl"
    session = Session(folder, "--journal", str(path), "--pace", pace)
    session.expect("> $")
    session.type("cut wire\n")
    session.expect(r"cut wire[^>]*> $")
    session.type("cut r\x03")  # a line that is not whole is no step
    assert session.wait() == 130
    assert "Traceback" not in session.text
    assert "--resume" in session.text
    again = collaborate(folder, "quit\n", "--journal", str(path), "--resume")
    assert "1 human and" in again.stdout


@pytest.mark.parametrize("is_deaf", [False, True])
def test_a_terminal_that_is_closed_ends_a_session(
    folder: Path, tmp_path: Path, is_deaf: bool
) -> None:
    """Also where nobody hears the signal, as under nohup: the input has ended then."""
    path = tmp_path / "closed.jsonl"
    session = Session(folder, "--journal", str(path), is_deaf=is_deaf)
    session.expect("> $")
    session.type("cut wire\n")
    session.expect(r"cut wire[^>]*> $")
    os.close(session.handle)
    code = os.waitstatus_to_exitcode(os.waitpid(session.pid, 0)[1])
    assert code in ((1, 2) if is_deaf else (129,))
    again = collaborate(folder, "quit\n", "--journal", str(path), "--resume")
    assert "1 human and" in again.stdout
