"""Ctrl-C during planning: exit 130, one message, and nothing left behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent


def running(marker: str) -> list[str]:
    """Return the processes whose command line holds a marker."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = entry.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if marker in line and str(os.getpid()) != entry.parent.name:
            found.append(line)
    return found


@pytest.mark.parametrize("flags", [[], ["--json"]], ids=["text", "json"])
def test_ctrl_c_leaves_nothing_behind(tmp_path: Path, flags: list[str]) -> None:
    marker = f"marker-{os.getpid()}-{tmp_path.name}"
    planner = (
        f"cmd:{sys.executable} -c 'import time; time.sleep(60)' {marker} {{domain}} {{problem}}"
    )
    words = ["plan", "kitchen/parfait-nut", "--planner", planner, *flags]
    process = subprocess.Popen(
        [sys.executable, "-m", "hrcplan", *words], cwd=tmp_path, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    sleeper = f"sleep(60) {marker}"
    limit = time.monotonic() + 20
    while not running(sleeper) and time.monotonic() < limit:
        time.sleep(0.05)
    assert running(sleeper)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "Traceback" not in err
    if flags:
        assert json.loads(out)["error"]["code"] == "interrupted"
    else:
        assert err.strip() == "error: interrupted"
    limit = time.monotonic() + 5
    while running(marker) and time.monotonic() < limit:
        time.sleep(0.05)
    assert running(marker) == []
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_the_command_line_is_imported(tmp_path: Path) -> None:
    (tmp_path / "click.py").write_text("raise KeyboardInterrupt\n")
    run = subprocess.run(
        [sys.executable, "-m", "hrcplan", "planners"], capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}:{ROOT}"}, check=False, timeout=20,
    )  # fmt: skip
    assert run.returncode == 130
    assert run.stderr == "error: interrupted\n"


def test_a_terminal_that_closes_leaves_no_temporary_folder(tmp_path: Path) -> None:
    marker = f"marker-{os.getpid()}-{tmp_path.name}"
    planner = (
        f"cmd:{sys.executable} -c 'import time; time.sleep(60)' {marker} {{domain}} {{problem}}"
    )
    process = subprocess.Popen(
        [sys.executable, "-m", "hrcplan", "plan", "kitchen/parfait-nut", "--planner", planner],
        env={**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # not that of nohup
    )  # fmt: skip
    limit = time.monotonic() + 20
    while not running(f"sleep(60) {marker}") and time.monotonic() < limit:
        time.sleep(0.05)
    assert any(tmp_path.iterdir())
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=20)
    assert process.returncode == 129
    assert list(tmp_path.iterdir()) == []
