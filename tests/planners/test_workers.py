"""Copies of this process: they end when asked, and never run the caller's code."""

import os
import signal
import time
from pathlib import Path

from hrcplan.planners.workers import Worker, end


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
