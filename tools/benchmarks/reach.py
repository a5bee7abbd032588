"""Editors, layout, unified-planning and language models: what the way through them adds."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from mcp import ClientSession, StdioServerParameters, stdio_client
from rows import Row, interleaved, milliseconds, timed, worked
from unified_planning.shortcuts import OneshotPlanner, Problem, get_environment
from unified_planning.test.examples import get_example_problems

from hrcplan.pddl.check import check
from hrcplan.pddl.inputs import read
from hrcplan.pddl.layout import format_text
from hrcplan.planners.up import to_up
from hrcplan.planners.up_engine import register

N_LINES, N_CHANGES, N_CALLS = 1_000, 60, 15
PEER = "fast-downward-opt"
MOST_DIAGNOSTICS_S = 0.010
ACTION = """  (:action load-{n}
    :parameters (?b - box ?p - place)
    :precondition (and (at ?b ?p) (free ?p))
    :effect (and (not (at ?b ?p)) (free ?p)))"""


def rows() -> Iterator[Row]:
    """Yield what each way in takes, next to the same work without it."""
    yield from _editor_rows()
    yield from _engine_rows()
    yield from _tool_rows()


def _domain() -> str:
    head = """(define (domain loads)
  (:requirements :strips :typing)
  (:types box place - object)
  (:predicates (at ?b - box ?p - place) (free ?p - place))
"""
    actions = [ACTION.format(n=n) for n in range((N_LINES - 5) // 4)]
    return head + "\n".join(actions) + "\n)\n"


def _editor_rows() -> Iterator[Row]:
    text = _domain()
    with TemporaryDirectory() as folder:
        path = Path(folder, "loads.pddl")
        path.write_text(text)
        shown = _diagnostics_s(path, text)
        runs = {
            "check": lambda: worked(lambda: check([str(path)], {str(path): text})),
            "format": lambda: worked(lambda: format_text(text)),
        }
        found = interleaved(runs, N_CALLS)
    alone = f"`check` alone, in process: {milliseconds(found['check'])}"
    n_lines = len(text.splitlines())
    yield Row(f"lsp: faults after a change, of {n_lines:,} lines", milliseconds(shown), alone,
              "<= 10 ms", shown > MOST_DIAGNOSTICS_S)  # fmt: skip
    yield Row(f"format, {n_lines:,} lines", milliseconds(found["format"]), alone)


def _diagnostics_s(path: Path, text: str) -> float:
    """Return the processor time from a change to its faults, of a server in another process."""
    command = [sys.executable, "-m", "hrcplan", "lsp"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as server:
        document = {"uri": path.as_uri(), "languageId": "pddl", "version": 1, "text": text}
        client = {"processId": None, "rootUri": None, "capabilities": {}}
        _send(server, {"id": 1, "method": "initialize", "params": client})
        _send(server, {"method": "initialized", "params": {}})
        _send(server, {"method": "textDocument/didOpen", "params": {"textDocument": document}})
        _await_faults(server)
        start_s = _processor_s(server.pid)
        for version in range(2, N_CHANGES):
            change = {
                "textDocument": {"uri": document["uri"], "version": version},
                "contentChanges": [{"text": text.replace("(free", "(fre", version % 2)}],
            }
            _send(server, {"method": "textDocument/didChange", "params": change})
            _await_faults(server)
        spent_s = _processor_s(server.pid) - start_s
        server.terminate()
    return spent_s / (N_CHANGES - 2)


def _processor_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _send(server: subprocess.Popen[bytes], message: dict[str, object]) -> None:
    data = json.dumps({"jsonrpc": "2.0", **message}).encode()
    assert server.stdin
    server.stdin.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
    server.stdin.flush()


def _await_faults(server: subprocess.Popen[bytes]) -> None:
    assert server.stdout
    while True:
        length = 0
        while line := server.stdout.readline().strip():
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        if b"publishDiagnostics" in server.stdout.read(length):
            return


def _engine_rows() -> Iterator[Row]:
    get_environment().credits_stream = None
    register()
    problems = get_example_problems()
    blocks = problems["hierarchical_blocks_world"].problem
    boxes = to_up(read("transport", "two-boxes"), with_time=True)
    jobs = {"ours": ("hrcplan", blocks), "theirs": (PEER, blocks), "boxes": ("hrcplan", boxes)}
    runs = {name: partial(worked, partial(_solve, *job)) for name, job in jobs.items()}
    found = interleaved(runs, 5)
    yield Row("unified-planning: engine hrcplan, its example hierarchical_blocks_world",
              milliseconds(found["ours"]), f"its engine {PEER}: {milliseconds(found['theirs'])}",
    )  # fmt: skip
    yield Row("the same engine, transport/two-boxes, proven (58.00051)",
              milliseconds(found["boxes"]), "no engine that comes with it takes this problem",
    )  # fmt: skip


def _solve(name: str, problem: Problem) -> None:
    with OneshotPlanner(name=name) as planner:
        assert planner.solve(problem).plan is not None


def _tool_rows() -> Iterator[Row]:
    command = [sys.executable, "-m", "hrcplan", "check", "--json", "domains/kitchen.pddl"]
    root = Path(__file__).resolve().parents[2]
    process = partial(subprocess.run, command, cwd=root, check=True, capture_output=True)
    call_s, ping_s = asyncio.run(_talk(root))
    alone = interleaved({"process": lambda: timed(process)}, 5)["process"]
    words = f"`check --json` as a command: {milliseconds(alone)}; an empty message: "
    yield Row("mcp: the tool `check`, there and back", milliseconds(call_s),
              words + milliseconds(ping_s))  # fmt: skip


async def _talk(root: Path) -> tuple[float, float]:
    server = StdioServerParameters(command=sys.executable, args=["-m", "hrcplan", "mcp", str(root)])
    calls, pings = [], []
    async with stdio_client(server) as (read, write), ClientSession(read, write) as session:
        await session.initialize()
        for _ in range(N_CALLS):
            start = time.perf_counter()
            await session.call_tool("check", {"files": ["domains/kitchen.pddl"]})
            calls.append(time.perf_counter() - start)
            start = time.perf_counter()
            await session.send_ping()
            pings.append(time.perf_counter() - start)
    return median(calls), median(pings)
