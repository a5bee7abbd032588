"""Run a program that may hang, fork, flood or eat memory, and leave nothing behind.

``run`` starts the program in a session of its own, under a small supervisor process
(``guard.py``) that outlives neither the program nor hrcplan. Time, memory and output have
limits; reaching one is an expected outcome and comes back as a value with the output so far.
It may be called from any thread. Linux only (``/proc``, child subreaper).
"""

import contextlib
import enum
import marshal
import math
import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from stat import S_ISREG
from typing import IO

from hrcplan.planners import orphans

_GUARD = Path(__file__).resolve().with_name("guard.py")
_CHUNK = 1 << 16
_PATIENCE_S = 10.0  # beyond the time limit: longer than a guard that can run takes to clear up
_LONG_S = 3600.0
_TICK_S = 0.1


@dataclass(frozen=True)
class ProcessLimits:
    """What a program may use.

    Attributes:
        time_s: Wall-clock seconds from the program's start; zero or less ends it at once.
        memory_bytes: Resident memory of the program and all its descendants together, or None
            for no limit. It is looked at about 50 times a second, so a short peak may pass.
            Address space is not limited: a Java runtime reserves far more than it uses.
        output_bytes: Bytes of standard output and standard error together.

    Raises:
        ValueError: if the time is not a number, or memory or output is negative.
    """

    time_s: float
    memory_bytes: int | None = 4 << 30
    output_bytes: int = 16 << 20

    def __post_init__(self) -> None:
        """Refuse what is not a limit."""
        if math.isnan(self.time_s) or self.output_bytes < 0 or (self.memory_bytes or 0) < 0:
            raise ValueError(f"not a limit: {self!r}")


def text_of(path: Path, most_bytes: int = ProcessLimits.output_bytes) -> str | None:
    """Return the text of a file that a program wrote; None if there is none, or if it is larger.

    Folders, FIFOs, links and the like are no such files.
    """
    try:
        stat = path.lstat()
    except FileNotFoundError:
        return None
    if not S_ISREG(stat.st_mode) or stat.st_size > most_bytes:
        return None
    return path.read_text("utf-8", "replace")


class ProcessEnd(enum.Enum):
    """Why a program is no longer running."""

    EXITED = "exited"  # by itself or by a signal from another process
    TIMEOUT = "timeout"
    MEMORY = "memory"
    OUTPUT = "output"
    MISSING = "missing"  # not found, or not executable; it never ran


@dataclass(frozen=True)
class FinishedProcess:
    """How a program ended and what it wrote.

    Attributes:
        end: What ended it.
        code: Exit code, or minus the number of the signal that killed it; None unless ``EXITED``.
        stdout: Standard output as UTF-8, wrong bytes replaced. At a limit: what came before it.
        stderr: Standard error, in the same way; if ``MISSING``, the operating system's reason.
        wall_s: Wall-clock seconds of the whole call, clearing up included.
    """

    end: ProcessEnd
    code: int | None
    stdout: str
    stderr: str
    wall_s: float


def run(
    argv: Sequence[str], *, cwd: Path, limits: ProcessLimits, env: Mapping[str, str] | None = None,
    on_tick: Callable[[], None] | None = None,
) -> FinishedProcess:  # fmt: skip
    r"""Return how a program ended, once it and everything it started is gone.

    At a limit the whole tree gets SIGTERM, and SIGKILL 0.3 s later (memory: SIGKILL at once).
    Children that the program leaves behind when it exits are ended too, also daemons. If
    this process dies, even by SIGKILL, or is interrupted, the tree is ended too.

    Args:
        argv: Program and arguments; a program without a slash is looked up in ``PATH`` of its
            environment. Standard input is empty.
        cwd: Working directory of the program.
        limits: What it may use.
        env: Its whole environment; by default that of this process.
        on_tick: Is called about ten times a second while the program runs.

    Raises:
        ValueError: if ``argv`` is empty.
        OSError: if ``cwd`` is no directory, or no further process can be started.
        KeyboardInterrupt: after the tree was ended, if this process is interrupted meanwhile.

    Example:
        >>> run(["echo", "found a plan"], cwd=Path("/"), limits=ProcessLimits(time_s=5)).stdout
        'found a plan\n'
        >>> run(["sleep", "60"], cwd=Path("/"), limits=ProcessLimits(time_s=0.1)).end
        <ProcessEnd.TIMEOUT: 'timeout'>
    """
    started_s = time.monotonic()
    with guarded_program(job_message(argv, limits, env), cwd) as (guard, report):
        output, answer = _collect(guard, report, limits, on_tick)
        if not output.is_over and not answer:
            orphans.end_tree(guard.pid)
    end, code, message = _verdict(output, answer)
    stdout, stderr = (
        bytes(stream).decode("utf-8", "replace") for stream in output.streams.values()
    )
    return FinishedProcess(end, code, stdout, stderr + message, time.monotonic() - started_s)


def job_message(
    argv: Sequence[str], limits: ProcessLimits, env: Mapping[str, str] | None,
    stdin: int | None = None,
) -> bytes:  # fmt: skip
    """Return the message to the guard: bytes as the operating system wants them."""
    if not argv:
        raise ValueError("no program to run")
    variables = os.environ if env is None else env
    environment = {os.fsencode(name): os.fsencode(value) for name, value in variables.items()}
    words = [os.fsencode(word) for word in argv]
    return marshal.dumps(
        (words, environment, os.getpid(), limits.time_s, limits.memory_bytes, stdin)
    )


@contextlib.contextmanager
def guarded_program(
    job: bytes, cwd: Path, stdin: int | None = None
) -> Iterator[tuple[subprocess.Popen[bytes], int]]:
    """Yield the guard at work on a job, and where it reports the end of the program.

    On the way out the guard's lifeline is cut and its end awaited: then nothing is left of the
    program. ``stdin`` is the file descriptor that the program reads, if any.
    """
    report, report_write = os.pipe()
    try:
        with contextlib.ExitStack() as exits:
            family = exits.enter_context(orphans.adoption())
            try:
                guard = _start(report_write, cwd, stdin)
            finally:
                os.close(report_write)
            exits.callback(_await_end, guard, family)
            for pipe in (guard.stdout, guard.stderr, guard.stdin):
                assert pipe
                exits.callback(_close, pipe)
            with contextlib.suppress(BrokenPipeError):  # a guard that died is noticed later
                assert guard.stdin
                guard.stdin.write(job)
                guard.stdin.flush()
            yield guard, report
    finally:
        os.close(report)


def _await_end(guard: subprocess.Popen[bytes], family: orphans.Family) -> None:
    """Return when nothing is left of a program, also if its guard was killed or is stopped."""
    try:
        guard.wait(_PATIENCE_S)
    except subprocess.TimeoutExpired:
        orphans.end_tree(guard.pid)
    if guard.wait():
        family.end_orphans()


def _start(report_write: int, cwd: Path, stdin: int | None) -> subprocess.Popen[bytes]:
    """Start a guard in a session of its own, so that Ctrl-C reaches this process only."""
    return subprocess.Popen(
        # -I -S: the surroundings of a planner cannot disturb the guard, and it starts faster.
        [sys.executable, "-I", "-S", str(_GUARD), str(report_write)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        pass_fds=(report_write,) if stdin is None else (report_write, stdin),
        cwd=cwd,
        start_new_session=True,
    )


def _close(pipe: IO[bytes]) -> None:
    """Close a pipe whose other end may be gone."""
    with contextlib.suppress(BrokenPipeError):
        pipe.close()


@dataclass
class _Output:
    """What a program wrote, by file descriptor, as long as there is room."""

    room: int
    streams: dict[int, bytearray]
    is_over: bool = False

    def take(self, fd: int) -> bool:
        """Keep what can be read now; return whether more may come."""
        # One byte more than fits tells "exactly full" from "too much".
        piece = os.read(fd, min(_CHUNK, self.room + 1))
        head = piece[: self.room]
        self.streams[fd] += head
        self.room -= len(head)
        self.is_over = self.is_over or len(head) < len(piece)
        return bool(piece) and not self.is_over


def _collect(
    guard: subprocess.Popen[bytes],
    report: int,
    limits: ProcessLimits,
    on_tick: Callable[[], None] | None,
) -> tuple[_Output, bytes]:
    """Return the output and the guard's answer; none if the output is too long, or none comes."""
    assert guard.stdout
    assert guard.stderr
    streams = {pipe.fileno(): bytearray() for pipe in (guard.stdout, guard.stderr)}
    output = _Output(limits.output_bytes, streams)
    deadline = time.monotonic() + max(0.0, limits.time_s) + _PATIENCE_S
    tick_at = time.monotonic() + _TICK_S
    with selectors.PollSelector() as ready:
        for fd in (*streams, report):
            ready.register(fd, selectors.EVENT_READ)
        while not output.is_over:
            left_s = min(deadline - time.monotonic(), _LONG_S)
            if left_s <= 0:  # guard and watcher are stopped
                return output, b""
            wait_s = left_s if on_tick is None else min(left_s, _TICK_S)
            woken = {key.fd for key, _ in ready.select(wait_s)}
            if on_tick is not None and time.monotonic() >= tick_at:
                on_tick()
                tick_at = time.monotonic() + _TICK_S
            if not woken:
                continue
            # At the answer everything that could write is gone, so silence is the end: the end of
            # file may never come, if a process that cannot be killed holds the pipe.
            if woken == {report}:
                return output, os.read(report, _CHUNK)
            for fd in woken - {report}:
                if not output.take(fd):
                    ready.unregister(fd)
    return output, b""


def _verdict(output: _Output, answer: bytes) -> tuple[ProcessEnd, int | None, str]:
    """Return what ended the program, its exit code, and a remark for its standard error."""
    if output.is_over:
        return ProcessEnd.OUTPUT, None, ""
    reason, code, message = marshal.loads(answer) if answer else ("lost", None, "")
    if reason in ("lost", "abandoned"):  # the guard was killed, and then the program
        return ProcessEnd.EXITED, -signal.SIGKILL, "hrcplan: the supervisor process was lost\n"
    return ProcessEnd(reason), code, message
