"""Copies of this process: they end when asked, and never run the caller's code."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from hrcplan.planners.workers import Worker, end, largest_beyond


def test_a_copy_that_is_ended_at_once_does_not_run_the_callers_handler(tmp_path: Path) -> None:
    """The caller's handler of SIGTERM leaves its code; in a copy that would run it twice."""
    escapes = tmp_path / "escapes"

    def leave(number: int, frame: object) -> None:
        raise SystemExit(143)

    before = signal.signal(signal.SIGTERM, leave)
    parent = os.getpid()
    try:
        for _ in range(150):
            try:
                worker = Worker(lambda send: time.sleep(30))
                end([worker])
            except SystemExit:
                if os.getpid() != parent:
                    escapes.touch()
                    os._exit(1)
                raise
    finally:
        signal.signal(signal.SIGTERM, before)
    assert not escapes.exists()


def hold(megabytes: int, in_child: bool, send: Callable[[object], None]) -> None:
    """Hold memory, in this copy or in a program that it starts."""
    if in_child:
        code = f"data = bytearray(b'x') * ({megabytes} << 20); print(flush=True); input()"
        program = subprocess.Popen(
            [sys.executable, "-I", "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        assert program.stdout
        program.stdout.readline()
        send("ready")
        program.wait()
    data = bytearray(b"x") * (megabytes << 20)
    send("ready")
    time.sleep(60)
    assert data


def test_the_largest_of_all_that_use_too_much_memory_is_named() -> None:
    workers = [Worker[object](partial(hold, 20, False)), Worker[object](partial(hold, 60, True))]
    try:
        assert [worker.receive() for worker in workers] == [["ready"], ["ready"]]
        assert largest_beyond(workers, 70 << 20) is workers[1]
        assert largest_beyond(workers[:1], 1 << 30) is None
    finally:
        end(workers)
