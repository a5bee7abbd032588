"""Links that are programs: ``cmd:PROGRAM``, in any language, and the simulated robot."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from hrcplan.core.files import cache_folder
from hrcplan.core.json_values import JsonValue
from hrcplan.errors import MissingPlannerError, PlannerError, UsageError
from hrcplan.execution.links.messages import BadLine, Feedback, LinkEnded, LinkMessage, message_of
from hrcplan.planners.line_process import LineProcess

FLOOD = 16 << 20  # bytes between two messages of use, after which a program counts as broken


class ProcessLink:
    """A program that speaks JSON lines on its standard input and output.

    Two runs cannot use the same command at a time: a robot follows one master.
    """

    def __init__(self, command: str) -> None:
        try:
            self.argv = shlex.split(command)
        except ValueError as error:
            raise UsageError(f"cmd:{command} is no command line: {error}") from None
        if not self.argv:
            raise UsageError("cmd: needs a program", hint="for example cmd:my-robot --port 1")
        self.name = f"cmd:{command}"
        self._program: LineProcess | None = None
        self._locks: list[int] = []
        self._n_useless = 0

    def start(self) -> None:
        """Start the program.

        Raises:
            MissingPlannerError: if there is no such program.
            UsageError: if another run uses this command.
            PlannerError: if it cannot be started.
        """
        if shutil.which(self.argv[0]) is None:
            raise MissingPlannerError(f"there is no program '{self.argv[0]}'")
        if not self._locks:
            self._locks = _locks(self._resources())
        self._end_program()
        try:
            self._program = LineProcess(self.argv, cwd=Path.cwd(), env=self._environment())
        except OSError as error:
            raise PlannerError(f"{self.name} cannot be started: {error}") from None

    def _resources(self) -> Sequence[str]:
        """Return the names of what no other run may use at the same time."""
        return [self.name]

    def _environment(self) -> Mapping[str, str] | None:
        """Return the environment of the program; None for that of hrcplan."""
        return None

    def _message(self, line: str | None) -> LinkMessage | None:
        """Return what a line says; None if it is of no interest."""
        return message_of(line)

    def send(self, message: Mapping[str, JsonValue]) -> bool:
        """Send a message; return whether the program takes it."""
        return self._program is not None and self._program.write_line(json.dumps(message))

    def receive(self, timeout_s: float) -> Sequence[LinkMessage]:
        """Return the messages that arrive next, none after a time; `LinkEnded` at the end."""
        program = self._program
        if program is None:
            return [LinkEnded("it was never started")]
        before = program.n_bytes
        lines = program.read_lines(timeout_s)
        messages = [m for line in lines if (m := self._message(line)) is not None]
        self._n_useless += program.n_bytes - before
        if not all(isinstance(message, BadLine | Feedback) for message in messages):
            self._n_useless = 0
        if program.ending is not None:
            words = program.last_words.splitlines()
            messages.append(LinkEnded(": ".join([program.ending, *words[-1:]])))
        elif self._n_useless > FLOOD:
            messages.append(LinkEnded(f"more than {FLOOD >> 20} MiB without a message of use"))
            self._end_program()
        return messages

    def _end_program(self) -> None:
        if self._program is not None:
            self._program.close()
            self._program = None
        self._n_useless = 0

    def close(self) -> None:
        """End the program, and all that it started."""
        self._end_program()
        for lock in self._locks:
            os.close(lock)
        self._locks = []


class SimulatedRobot(ProcessLink):
    """The robot of ``hrcplan robot --simulated``, in a process of its own."""

    def __init__(self) -> None:
        super().__init__(
            shlex.join([sys.executable, "-P", "-m", "hrcplan", "robot", "--simulated"])
        )

    def _resources(self) -> Sequence[str]:
        """Return no names: any number of simulated robots may run."""
        return []


def _locks(names: Sequence[str]) -> list[int]:
    """Return the open locks of what a run uses; none if there is no folder for locks.

    Raises:
        UsageError: if another process holds one.
    """
    folder = cache_folder()
    locks: list[int] = []
    if folder is None:
        return locks
    for name in names:
        try:
            lock = _lock(folder, name)
        except UsageError:
            for other in locks:
                os.close(other)
            raise
        locks += [] if lock is None else [lock]
    return locks


def _lock(folder: Path, name: str) -> int | None:
    """Return the open lock of a name; None if it cannot be written.

    Raises:
        UsageError: if another process holds it.
    """
    file_name = hashlib.sha256(name.encode()).hexdigest()[:16]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = os.open(folder / f"robot-{file_name}.lock", os.O_RDWR | os.O_CREAT, 0o600)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(lock)
        message = f"another run drives the robot of {name}"
        raise UsageError(message, code="robot-busy", hint="end it first") from None
    return lock
