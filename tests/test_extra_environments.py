"""Each extra alone in an environment of its own: its commands run. Only with --all."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from urllib.request import HTTPCookieProcessor, build_opener

import pytest

from tests.test_installation import ROOT, make_environment, run, wheel

__all__ = ["wheel"]

pytestmark = [
    pytest.mark.skipif(
        "HRCPLAN_NO_SKIPS" not in os.environ, reason="only with tools/test --all: it needs pip"
    ),
    pytest.mark.xdist_group("extras"),
]

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
FOR_DEVELOPERS = {"docs", "test", "dev", "browser", "all"}
SAMPLE = ["bank", "build", "kitchen", "--goal", "parfait-nut", "--sample", "20", "-o", "plans"]
GANTT = ["plan", "transport/two-boxes", "--gantt", "plan.svg"]
STUDY = ["study", "run", "failure-anticipation", "--limit", "12", "-o", "rows"]

Talk = Callable[[Path, Path], None]
"""What uses a program that serves: it gets the folder of programs and a folder to work in."""


@dataclass(frozen=True)
class Part:
    """Commands that an extra is enough for, and what they say without it."""

    commands: Sequence[Sequence[str]] = ()
    talk: Talk | None = None
    without: Sequence[tuple[int, Sequence[str]]] = field(default=())


def hrcplan(programs: Path, *words: str, folder: Path) -> str:
    return run(programs / "hrcplan", *words, cwd=folder)


@contextmanager
def program(*command: str | Path, folder: Path, **more: int) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(command, cwd=folder, text=True, **more)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) in (0, 1, -signal.SIGINT, 130, 143)


def await_that(is_so: Callable[[], object], time_s: float = 60) -> None:
    deadline = time.monotonic() + time_s
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def browse(programs: Path, folder: Path) -> None:
    with program(programs / "hrcplan", "serve", folder=folder, stdout=subprocess.PIPE) as server:
        assert server.stdout
        address = next(m[0] for line in server.stdout if (m := re.search(r"http://\S+", line)))
        browser = build_opener(HTTPCookieProcessor())
        with browser.open(address, timeout=60) as page:
            assert "kitchen" in page.read().decode()


def edit(programs: Path, folder: Path) -> None:
    text = "(define (domain lamp) (:pre))"
    file = {
        "uri": (folder / "lamp.pddl").as_uri(),
        "languageId": "pddl",
        "version": 1,
        "text": text,
    }
    client = {"processId": None, "rootUri": None, "capabilities": {}}
    messages = [
        {"id": 1, "method": "initialize", "params": client},
        {"method": "initialized", "params": {}},
        {"method": "textDocument/didOpen", "params": {"textDocument": file}},
        {"id": 2, "method": "shutdown"},
        {"method": "exit"},
    ]
    texts = [json.dumps({"jsonrpc": "2.0", **message}) for message in messages]
    said = "".join(f"Content-Length: {len(text)}\r\n\r\n{text}" for text in texts)
    done = subprocess.run([programs / "hrcplan", "lsp"], input=said, capture_output=True, text=True,
                          cwd=folder, timeout=60, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "publishDiagnostics" in done.stdout
    assert "hoverProvider" in done.stdout


def ask_tools(programs: Path, folder: Path) -> None:
    code = """if True:
        import asyncio, sys
        from mcp import ClientSession, StdioServerParameters, stdio_client
        async def talk():
            server = StdioServerParameters(command=sys.argv[1], args=["mcp", "."])
            async with stdio_client(server) as (read, write), ClientSession(read, write) as session:
                await session.initialize()
                words = {"domain": "transport", "problem": "two-boxes"}
                result = await session.call_tool("plan", words)
                assert '"solved-optimally"' in result.content[0].text
        asyncio.run(talk())
    """
    run(programs / "python", "-c", code, programs / "hrcplan", cwd=folder)


def run_on_a_cluster(programs: Path, folder: Path) -> None:
    place = folder / "scheduler.json"
    words = ["--scheduler-file", str(place), "--no-dashboard"]
    with program(programs / "dask", "scheduler", *words, "--host", "127.0.0.1", folder=folder):
        await_that(place.exists)
        with program(programs / "dask", "worker", *words, "--nthreads", "1", folder=folder):
            hrcplan(programs, *STUDY, "--cluster", str(place), folder=folder)
    assert (folder / "rows" / "rows.sqlite").exists()


def act_in_pddlgym(programs: Path, folder: Path) -> None:
    code = """if True:
        import hrcplan
        bank = hrcplan.build_bank("kitchen", only=["parfait-nut"])
        world = hrcplan.worlds.make("pddlgym", bank)
        state, task = world.begin(), bank.goals.task
        action = next(iter(task.applicable(state)))
        assert world.do(state, action) == task.successor(state, action)
    """
    run(programs / "python", "-c", code, cwd=folder)


def learn(programs: Path, folder: Path) -> None:
    code = """if True:
        import hrcplan
        from gymnasium.utils.env_checker import check_env
        from pettingzoo.test import parallel_api_test
        check_env(hrcplan.environments.make("kitchen").unwrapped)
        parallel_api_test(hrcplan.environments.parallel_env("kitchen"), num_cycles=20)
    """
    run(programs / "python", "-c", code, cwd=folder)


MAKE_ENVIRONMENT = """if True:
    import hrcplan, sys
    try:
        hrcplan.environments.make("kitchen")
    except hrcplan.UsageError as error:
        sys.exit(f"{error}; {error.hint}")
"""


PARTS = {
    "planners": Part(
        [
            ["plan", "kitchen/parfait-nut", "--planner", "fast-downward"],
            ["plan", "kitchen/parfait-nut", "--any", "--planner", "enhsp"],
            ["plan", "kitchen/parfait-nut", "--planner", "up:fast-downward"],
            ["doctor"],
        ],
        without=[
            (5, ["plan", "kitchen/parfait-nut", "--planner", "fast-downward"]),
            (5, ["plan", "kitchen/parfait-nut", "--planner", "enhsp"]),
            (5, ["plan", "kitchen/parfait-nut", "--planner", "up:fast-downward"]),
            (5, ["doctor"]),
        ],
    ),
    "studies": Part(
        [[*STUDY, "--jobs", "2"], ["study", "report", "rows"], GANTT],
        without=[(2, [*STUDY, "--jobs", "2"]), (2, GANTT)],
    ),
    "web": Part(talk=browse, without=[(2, ["serve"])]),
    "lsp": Part(talk=edit, without=[(2, ["lsp"])]),
    "mcp": Part(talk=ask_tools, without=[(2, ["mcp", "."])]),
    "cluster": Part(talk=run_on_a_cluster, without=[(2, [*STUDY, "--cluster", "127.0.0.1:1"])]),
    "gym": Part(talk=learn, without=[(1, ["-c", MAKE_ENVIRONMENT])]),
    "java": Part([["planners"]]),
    "topk": Part([SAMPLE], without=[(5, SAMPLE)]),
    "pddlgym": Part(talk=act_in_pddlgym),
}


def test_every_extra_of_users_has_a_row() -> None:
    assert set(PARTS) == set(PROJECT["optional-dependencies"]) - FOR_DEVELOPERS


@pytest.mark.parametrize("extra", PARTS)
def test_an_extra_is_enough_for_its_commands(extra: str, wheel: Path, tmp_path: Path) -> None:
    """The packages of pddlgym have no wheels for a newer Python than 3.11; it has a row there."""
    if extra == "pddlgym" and sys.version_info >= (3, 12):
        return
    part, folder = PARTS[extra], tmp_path / "empty"
    folder.mkdir()
    programs = make_environment(tmp_path / "env", f"hrcplan[{extra}] @ {wheel.as_uri()}")
    for words in part.commands:
        assert hrcplan(programs, *words, folder=folder)
    if part.talk is not None:
        part.talk(programs, folder)


def test_commands_name_the_extra_that_they_miss(wheel: Path, tmp_path: Path) -> None:
    programs, folder = make_environment(tmp_path / "env", str(wheel)), tmp_path / "empty"
    folder.mkdir()
    for extra, part in PARTS.items():
        for code, words in part.without:
            done = subprocess.run(
                [programs / ("python" if words[0] == "-c" else "hrcplan"), *words],
                cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
            )  # fmt: skip
            said = done.stdout + done.stderr
            assert done.returncode == code, (words, said)
            assert f"pip install 'hrcplan[{extra}]'" in said, (words, said)
            assert "Traceback" not in said, words
    assert not list(folder.iterdir())
