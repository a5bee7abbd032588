"""Planners whose programs are broken: garbage, crashes, hangs, full disks, children left behind."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from hrcplan.errors import PlannerError
from hrcplan.pddl.inputs import read
from hrcplan.planners import enhsp, fast_downward
from hrcplan.planners.command import CommandPlanner
from hrcplan.planners.contract import Planner, Request, Status
from hrcplan.planners.result import Result, ask
from hrcplan.planners.solve import solve

SAYS_SOLVED = "printf 'Problem Solved\\n'"


def script(folder: Path, body: str) -> Path:
    path = folder / "program"
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(0o755)
    return path


def asked(planner: Planner, time_s: float) -> Result:
    request = Request(read("kitchen", "parfait-nut"), time.monotonic() + time_s, any_plan=True)
    return ask(planner, request, False, "")


Install = Callable[[str], enhsp.Enhsp]


@pytest.fixture
def java(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    def install(body: str) -> enhsp.Enhsp:
        path = script(tmp_path, body)
        monkeypatch.setattr(enhsp, "find_java", lambda: path)
        return enhsp.Enhsp()

    return install


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("echo 'Error: Could not create the Java Virtual Machine.'; exit 1", "exit code 1.*Java"),
        ("head -c 100000 /dev/urandom; exit 3", "exit code 3"),
        ("kill -SEGV $$", "exit code -11"),
        (f"{SAYS_SOLVED}; head -c 9000 /dev/urandom > plan", "is no plan"),
        (f"{SAYS_SOLVED}; echo '(get robot' > plan", "is no plan"),
        (f"{SAYS_SOLVED}; echo '(fly robot moon)' > plan", "is no action|is no plan"),
        ("echo 'Exception in thread main'", "Exception in thread"),
    ],
)
def test_a_broken_java_is_named(java: Install, body: str, words: str) -> None:
    with pytest.raises(PlannerError, match=words) as caught:
        asked(java(body), 20)
    assert caught.value.exit_code == 5


@pytest.mark.parametrize(
    "body",
    [
        "echo 'what is this?'",
        "true",
        f"{SAYS_SOLVED}; mkfifo plan",
        f"{SAYS_SOLVED}; mkdir plan",
        f"{SAYS_SOLVED}; ln -s /dev/zero plan",
        f"{SAYS_SOLVED}; truncate -s 9G plan",
    ],
)
def test_a_java_without_a_plan_has_none(java: Install, body: str) -> None:
    answer = asked(java(body), 20)
    assert answer.status is Status.UNSOLVED
    assert answer.plan is None


def test_a_java_that_hangs_and_leaves_children_is_ended(java: Install, tmp_path: Path) -> None:
    mark = tmp_path / "children"
    body = f"for i in 1 2; do (setsid sleep 300 & echo $! >> {mark}); done; sleep 300"
    answer = asked(java(body), 1)
    assert (answer.status, answer.attempts[0].outcome) == (Status.UNSOLVED, "stopped: timeout")
    assert len(mark.read_text().split()) == 2
    assert not [pid for pid in mark.read_text().split() if _lives(int(pid))]


def _lives(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_auto_goes_on_without_a_broken_java(java: Install) -> None:
    java("exit 1")
    assert solve(read("kitchen", "parfait-nut"), any_plan=True, timeout_s=30).plan is not None


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("kill -KILL $$", "exit code -9"),  # what the kernel does where memory ends
        ("echo 'search exit code: 32'; exit 32", "exit code 32"),
        ("echo '(get robot\n; cost = 3 (unit cost)' > plan", "is no plan"),
    ],
)
def test_a_broken_search_is_named(
    body: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = script(tmp_path, body)
    monkeypatch.setattr(fast_downward, "find_binary", lambda: path)
    with pytest.raises(PlannerError, match=words):
        asked(fast_downward.FastDownward(), 20)


def test_of_half_written_plans_the_last_whole_one_counts(tmp_path: Path) -> None:
    best = solve(read("transport", "two-boxes"), "exact", timeout_s=30).plan
    (tmp_path / "whole").write_text(str(best))
    path = script(
        tmp_path, f"cp {tmp_path}/whole plan.1; head -c 40 {tmp_path}/whole > plan.2; kill -KILL $$"
    )
    request = Request(read("transport", "two-boxes"), time.monotonic() + 20)
    result = ask(CommandPlanner(f"{path} {{domain}} {{problem}}"), request, False, "")
    assert result.plan == best


@pytest.mark.parametrize("planner", ["fast-downward", "enhsp", "cmd:true {domain} {problem}"])
def test_a_full_disk_is_named(planner: str) -> None:
    command = f"ulimit -f 0; exec {sys.executable} -P -m hrcplan plan kitchen/parfait-nut --planner"
    done = subprocess.run(
        ["bash", "-c", f"{command} '{planner}'"], capture_output=True, text=True,
        check=False, env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (5, "")
    assert "cannot use its files" in done.stderr
    assert "Traceback" not in done.stderr
