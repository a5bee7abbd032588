"""Hostile programs under the guard: each limit holds, and nothing is ever left behind."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import pytest

import hrcplan.planners.process as process
from hrcplan.planners.process import FinishedProcess, ProcessEnd, ProcessLimits, run

HOSTILE = Path(__file__).with_name("hostile")
PYTHON = (sys.executable, "-I", "-S")


def processes(word: str) -> list[int]:
    """Return the processes with this word in their command line."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if word in (folder / "cmdline").read_text(errors="replace"):
                found.append(int(folder.name))
        except OSError:
            continue
    return found


def state_and_parent(pid: int) -> tuple[str, int]:
    """Return the state letter and the parent of a process, "X" and 0 if there is none."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return "X", 0
    state, parent = stat.rpartition(")")[2].split()[:2]
    return state, int(parent)


def is_running(pid: int) -> bool:
    """Return whether a process can still do anything; init may take its time over a zombie."""
    return state_and_parent(pid)[0] not in "XZ"


def children(of: int) -> list[int]:
    """Return the children of a process, zombies included."""
    pids = [int(folder.name) for folder in Path("/proc").glob("[0-9]*")]
    return sorted(pid for pid in pids if state_and_parent(pid)[1] == of)


def guards(caller: "subprocess.Popen[bytes]") -> list[int]:
    """Return the supervisor processes of a process."""
    return sorted(set(processes("guard.py")) & set(children(caller.pid)))


def await_that(condition: Callable[[], object], within_s: float = 30.0) -> None:
    """Wait until the condition holds; it holds at once, or on a busy machine a little later."""
    started_s = time.monotonic()
    while not condition():
        assert time.monotonic() - started_s < within_s
        time.sleep(0.01)


@pytest.fixture
def marker() -> Iterator[str]:
    """Yield a word for a command line; afterwards no process may carry it, nor be our child."""
    word = f"marker-{uuid.uuid4().hex}"
    before = children(os.getpid())
    yield word
    left = processes(word)
    for pid in left:  # a failed test must not disturb the next one
        os.kill(pid, signal.SIGKILL)
    assert left == []
    assert children(os.getpid()) == before


@pytest.fixture
def call(marker: str, tmp_path: Path) -> Callable[..., FinishedProcess]:
    """Return a function that runs a hostile script under limits."""

    def call(script: str, *words: object, time_s: float = 30.0, **limits: int) -> FinishedProcess:
        start = PYTHON if script.endswith(".py") else ("sh",)
        argv = [*start, str(HOSTILE / script), *map(str, words), marker]
        return run(argv, cwd=tmp_path, limits=ProcessLimits(time_s, **limits))

    return call


Call = Callable[..., FinishedProcess]


def test_exit_code_and_both_outputs_come_back(tmp_path: Path) -> None:
    finished = run(
        ["sh", "-c", "pwd; echo bad >&2; exit 7"], cwd=tmp_path, limits=ProcessLimits(300)
    )
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, 7)
    assert (finished.stdout, finished.stderr) == (f"{tmp_path.resolve()}\n", "bad\n")
    assert 0 < finished.wall_s < 30


def test_death_by_signal_is_a_negative_code(tmp_path: Path) -> None:
    finished = run(["sh", "-c", "kill -SEGV $$"], cwd=tmp_path, limits=ProcessLimits(300))
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, -signal.SIGSEGV)


def test_broken_utf8_is_replaced(tmp_path: Path) -> None:
    finished = run(["printf", r"caf\351 \303\251"], cwd=tmp_path, limits=ProcessLimits(30))
    assert finished.stdout == "caf� é"


def test_standard_input_is_empty(tmp_path: Path) -> None:
    finished = run(["cat"], cwd=tmp_path, limits=ProcessLimits(30))
    assert (finished.end, finished.code, finished.stdout) == (ProcessEnd.EXITED, 0, "")


def test_environment_is_the_given_one(tmp_path: Path) -> None:
    env = {"PATH": os.environ["PATH"], "VALUE": "a b\nc", "LARGE": "x" * 100_000}
    finished = run(["env", "-0"], cwd=tmp_path, limits=ProcessLimits(30), env=env)
    assert dict(line.split("=", 1) for line in finished.stdout.split("\0") if line) == env


def test_environment_is_ours_by_default(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HRCPLAN_TEST_VALUE", "here")
    finished = run(["printenv", "HRCPLAN_TEST_VALUE"], cwd=tmp_path, limits=ProcessLimits(30))
    assert finished.stdout == "here\n"


def test_program_leads_a_session_of_its_own(tmp_path: Path) -> None:
    script = "import os; print(os.getpid() == os.getsid(0) == os.getpgrp(), os.getsid(0))"
    finished = run([*PYTHON, "-c", script], cwd=tmp_path, limits=ProcessLimits(30))
    leads, session = finished.stdout.split()
    assert leads == "True"
    assert int(session) != os.getsid(0)


def test_program_has_no_foreign_files_open_and_default_signals(tmp_path: Path) -> None:
    finished = run(["ls", "/proc/self/fd"], cwd=tmp_path, limits=ProcessLimits(30))
    assert finished.stdout.split() == ["0", "1", "2", "3"]  # 3 is the folder that ls reads
    finished = run(["grep", "SigIgn", "/proc/self/status"], cwd=tmp_path, limits=ProcessLimits(30))
    assert int(finished.stdout.split()[1], 16) == 0


@pytest.mark.parametrize("name", ["no-such-planner", "./no-such-planner", "./plain", "/"])
def test_program_that_cannot_run_is_missing(tmp_path: Path, name: str) -> None:
    (tmp_path / "plain").write_text("not executable")
    finished = run([name], cwd=tmp_path, limits=ProcessLimits(30))
    assert (finished.end, finished.code, finished.stdout) == (ProcessEnd.MISSING, None, "")
    assert finished.stderr in {"No such file or directory", "Permission denied"}


def test_wrong_arguments_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no program"):
        run([], cwd=tmp_path, limits=ProcessLimits(30))
    with pytest.raises(FileNotFoundError):
        run(["true"], cwd=tmp_path / "nowhere", limits=ProcessLimits(30))
    for limits in ({"time_s": float("nan")}, {"time_s": 1, "output_bytes": -1}):
        with pytest.raises(ValueError, match="not a limit"):
            ProcessLimits(**limits)


def test_program_that_hangs_times_out_with_its_plan(call: Call) -> None:
    finished = call("hang.py", time_s=1.5)
    assert (finished.end, finished.code, finished.stdout) == (
        ProcessEnd.TIMEOUT,
        None,
        "plan 1\n",
    )
    assert 1.5 <= finished.wall_s < 30  # it hangs for 60


def test_no_time_at_all_is_a_timeout(call: Call) -> None:
    assert call("hang.py", time_s=-1.0).end is ProcessEnd.TIMEOUT


def test_program_that_ignores_signals_is_killed(call: Call) -> None:
    finished = call("stubborn.py", time_s=1.5)
    assert (finished.end, finished.stdout) == (ProcessEnd.TIMEOUT, "not listening\n")
    assert 1.8 <= finished.wall_s < 30


def test_last_words_after_the_time_limit_are_kept(call: Call) -> None:
    finished = call("polite.py", time_s=1.5)
    assert (finished.end, finished.stderr) == (ProcessEnd.TIMEOUT, "last plan\n")


def test_background_child_goes_when_the_program_exits(call: Call) -> None:
    finished = call("abandon.sh")
    assert (finished.end, finished.code, finished.stdout) == (ProcessEnd.EXITED, 0, "done\n")
    assert finished.wall_s < 25


def test_daemon_goes_when_the_program_exits(call: Call) -> None:
    finished = call("daemon.py")
    assert (finished.end, finished.code, finished.stdout) == (
        ProcessEnd.EXITED,
        0,
        "daemon runs\n",
    )


def test_daemon_goes_at_the_time_limit(call: Call) -> None:
    assert call("daemon.py", "hang", time_s=1.5).end is ProcessEnd.TIMEOUT


def test_process_that_keeps_changing_is_caught(call: Call) -> None:
    finished = call("relay.py")
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, 0)
    assert finished.wall_s < 25


@pytest.mark.parametrize("stream", [1, 2])
def test_flood_is_cut(call: Call, stream: int) -> None:
    finished = call("flood.py", stream, output_bytes=1_000_000)
    assert (finished.end, finished.code) == (ProcessEnd.OUTPUT, None)
    outputs = [finished.stdout, finished.stderr]
    assert outputs.pop(stream - 1) == "x" * 1_000_000
    assert outputs == [""]
    assert finished.wall_s < 25


@pytest.mark.parametrize(("room", "ended"), [(5, ProcessEnd.EXITED), (4, ProcessEnd.OUTPUT)])
def test_output_limit_is_exact(tmp_path: Path, room: int, ended: ProcessEnd) -> None:
    limits = ProcessLimits(30, output_bytes=room)
    finished = run(["sh", "-c", "printf abc; printf de >&2"], cwd=tmp_path, limits=limits)
    assert finished.end is ended
    assert len(finished.stdout + finished.stderr) == room


def test_large_output_is_complete(tmp_path: Path) -> None:
    finished = run(["seq", "400000"], cwd=tmp_path, limits=ProcessLimits(30))
    assert finished.stdout == "".join(f"{number}\n" for number in range(1, 400001))


@pytest.mark.parametrize("generations", [0, 1, 2])
def test_memory_counts_in_every_generation(call: Call, generations: int) -> None:
    finished = call("eat.py", 200, generations, memory_bytes=100 << 20)
    assert (finished.end, finished.code) == (ProcessEnd.MEMORY, None)
    assert finished.wall_s < 25


def test_memory_of_several_processes_adds_up(marker: str, tmp_path: Path) -> None:
    eat = f"{' '.join(PYTHON)} {HOSTILE / 'eat.py'} 40 0 {marker}"
    limits = ProcessLimits(30, memory_bytes=100 << 20)
    finished = run(["sh", "-c", f"{eat} & {eat} & {eat} & wait"], cwd=tmp_path, limits=limits)
    assert finished.end is ProcessEnd.MEMORY


def test_memory_below_the_limit_is_left_alone(call: Call) -> None:
    finished = call("eat.py", 40, 0, time_s=1.5, memory_bytes=100 << 20)
    assert (finished.end, finished.stdout) == (ProcessEnd.TIMEOUT, "full\n")


def test_shared_and_reserved_memory_is_not_counted(call: Call) -> None:
    finished = call("share.py", 60, 4, memory_bytes=150 << 20)
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, 0)


def test_program_that_closes_its_outputs_is_awaited(call: Call) -> None:
    finished = call("quiet.py")
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, 3)
    assert finished.wall_s >= 0.2


def test_program_dies_with_its_guard(call: Call, marker: str) -> None:
    finished = call("regicide.py")
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, -signal.SIGKILL)
    assert "supervisor process was lost" in finished.stderr
    await_that(lambda: not processes(marker))  # the one case in which nobody can wait for it


def test_guard_that_never_works_is_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    false = shutil.which("false")
    monkeypatch.setattr(sys, "executable", false)
    env = {"LARGE": "x" * 1_000_000}
    finished = run(["true"], cwd=tmp_path, limits=ProcessLimits(30), env=env)
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, -signal.SIGKILL)


def test_guard_is_not_ended_by_the_program(tmp_path: Path) -> None:
    script = "kill -TERM $PPID; kill -INT $PPID; kill -HUP $PPID; exit 5"
    assert run(["sh", "-c", script], cwd=tmp_path, limits=ProcessLimits(30)).code == 5


def test_exit_code_survives_ignored_child_signals(tmp_path: Path) -> None:
    before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    try:
        assert run(["sh", "-c", "exit 7"], cwd=tmp_path, limits=ProcessLimits(30)).code == 7
    finally:
        signal.signal(signal.SIGCHLD, before)


def test_crash_leaves_no_core_file(tmp_path: Path) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (hard, hard))
    try:
        finished = run(["sh", "-c", "ulimit -c"], cwd=tmp_path, limits=ProcessLimits(30))
    finally:
        resource.setrlimit(resource.RLIMIT_CORE, (soft, hard))
    assert finished.stdout == "0\n"


def test_two_at_once_from_threads(call: Call) -> None:
    with ThreadPoolExecutor() as pool:
        slow = pool.submit(call, "hang.py", time_s=0.8)
        quick = pool.submit(call, "daemon.py")
        assert quick.result().end is ProcessEnd.EXITED
        assert not slow.done()
        assert slow.result().end is ProcessEnd.TIMEOUT


def test_many_calls_leave_nothing(marker: str, tmp_path: Path) -> None:
    run(["true", marker], cwd=tmp_path, limits=ProcessLimits(30))
    files, before = os.listdir("/proc/self/fd"), children(os.getpid())
    for _ in range(50):
        assert run(["true", marker], cwd=tmp_path, limits=ProcessLimits(30)).code == 0
    assert os.listdir("/proc/self/fd") == files
    assert children(os.getpid()) == before


@pytest.fixture
def caller(marker: str, tmp_path: Path) -> Iterator[Callable[..., subprocess.Popen[bytes]]]:
    """Return a function that starts a Python process which calls ``run`` on a script.

    It waits until the script runs; for that the script makes the file ``ready``.
    """
    package = str(Path(process.__file__).resolve().parents[2])
    started = []

    def start(script: str, *words: str, fork: bool = False) -> subprocess.Popen[bytes]:
        hostile = [*PYTHON, str(HOSTILE / script), *words, marker]
        caller = subprocess.Popen(
            [sys.executable, str(HOSTILE / "caller.py"), str(tmp_path / "outcome"), *hostile],
            env={**os.environ, "PYTHONPATH": package, "FORK": "yes" if fork else ""},
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        started.append(caller)
        await_that((tmp_path / "ready").exists)
        return caller

    yield start
    for caller in started:
        caller.kill()
        caller.wait()


Caller = Callable[..., subprocess.Popen[bytes]]


@pytest.mark.parametrize("script", ["hang.py", "stubborn.py", "daemon.py"])
def test_program_goes_when_hrcplan_is_killed(caller: Caller, marker: str, script: str) -> None:
    killed = caller(script, "hang")
    (guard,) = guards(killed)
    os.killpg(killed.pid, signal.SIGKILL)  # as a job control would, with all that is near
    killed.wait()
    await_that(lambda: not processes(marker))
    await_that(lambda: not is_running(guard))


def test_program_goes_although_a_fork_of_hrcplan_lives(caller: Caller) -> None:
    killed = caller("hang.py", fork=True)
    await_that(lambda: len(children(killed.pid)) == 2)
    (guard,) = guards(killed)
    (fork,) = set(children(killed.pid)) - {guard}
    (inner,) = children(guard)
    (program,) = children(inner)
    killed.kill()
    killed.wait()
    try:
        await_that(lambda: not is_running(program))
        assert is_running(fork)
    finally:
        os.kill(fork, signal.SIGKILL)
        await_that(lambda: not is_running(fork))


def test_interrupt_ends_the_program_and_is_raised_again(
    caller: Caller, marker: str, tmp_path: Path
) -> None:
    interrupted = caller("stubborn.py")
    os.kill(interrupted.pid, signal.SIGINT)
    assert interrupted.wait(3) == -signal.SIGINT
    assert (tmp_path / "outcome").read_text() == "KeyboardInterrupt"
    assert processes(marker) == []  # gone before the exception got out


def test_interrupt_from_the_terminal_does_not_reach_the_program(
    caller: Caller, tmp_path: Path
) -> None:
    interrupted = caller("polite.py")
    os.killpg(interrupted.pid, signal.SIGINT)  # what a terminal does on Ctrl-C
    interrupted.wait(3)
    assert (tmp_path / "outcome").read_text() == "KeyboardInterrupt"
    assert not (tmp_path / "interrupted").exists()


def family_of(caller: "subprocess.Popen[bytes]") -> tuple[int, int]:
    """Return the two supervisor processes of a caller: the watcher and, below it, the guard."""
    (watcher,) = guards(caller)
    (guard,) = set(processes("guard.py")) & set(children(watcher))
    return watcher, guard


@pytest.mark.parametrize("script", ["hang.py", "stubborn.py", "daemon.py"])
@pytest.mark.parametrize("which", [[0], [1], [0, 1], [1, 0]], ids=str)
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_nothing_is_left_when_supervisors_are_killed_or_stopped(
    caller: Caller, marker: str, tmp_path: Path, script: str, which: list[int], number: int
) -> None:
    alive = caller(script, "hang")
    family = family_of(alive)
    for index in which:
        with suppress(ProcessLookupError):  # the other one has cleared up already
            os.kill(family[index], number)
    if number == signal.SIGSTOP:  # only the end of the caller, or its deadline, can help
        alive.kill()
        for index in which:
            with suppress(ProcessLookupError):
                os.kill(family[index], signal.SIGCONT)
    alive.wait(20)
    await_that(lambda: set(processes(marker)) <= {alive.pid})
    await_that(lambda: not any(map(is_running, family)))


def test_a_stopped_supervisor_does_not_hang_the_caller(
    marker: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(process, "_PATIENCE_S", 0.5)
    script = f"(sleep 300; : {marker}) & kill -STOP $(ps -o ppid= -p $PPID) $PPID; sleep 300"
    finished = run(["sh", "-c", script, marker], cwd=tmp_path, limits=ProcessLimits(0.5))
    assert (finished.end, finished.code) == (ProcessEnd.EXITED, -signal.SIGKILL)
    assert "supervisor process was lost" in finished.stderr
    assert processes(marker) == []


@pytest.mark.parametrize("number", ["SIGKILL", "SIGSTOP"])
@pytest.mark.parametrize("levels", [2, 3])
def test_nothing_is_left_of_a_planner_that_ends_its_worker_too(
    marker: str, number: str, levels: int
) -> None:
    """Guard, watcher, and the copy of hrcplan that waits for them."""
    words = [sys.executable, "-S", HOSTILE / "dynasty.py", number, levels, marker]
    planner = "cmd:" + " ".join(map(str, words)) + " {domain} {problem}"
    command = [sys.executable, "-P", "-m", "hrcplan", "plan", "transport/two-boxes"]
    done = subprocess.run(
        [*command, "--planner", planner, "--timeout", "2"], text=True, check=False,
        capture_output=True, timeout=60,
    )  # fmt: skip
    assert done.returncode in (4, 5), done.stdout + done.stderr
    assert processes(marker) == []
