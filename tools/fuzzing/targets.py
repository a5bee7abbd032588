"""One target per kind of input: it makes a mutant and gives it to what reads such inputs."""

from __future__ import annotations

import hashlib
import json
import random
import shutil
import sqlite3
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from unittest import mock

from click.testing import CliRunner

from fuzzing import mutate
from fuzzing.files import PAIRS, pddl, public, texts, tree
from fuzzing.pages import requests, served
from fuzzing.plans import log, plan, planned
from fuzzing.robots import links
from hrcplan.agents import load_profile
from hrcplan.bank import build_bank, find_fault, load, save
from hrcplan.cli import main
from hrcplan.execution.execute import execute
from hrcplan.execution.journal import read_journal
from hrcplan.execution.replay import replay
from hrcplan.inference import infer
from hrcplan.pddl import library
from hrcplan.plots import style
from hrcplan.studies import report_study, run_study
from hrcplan.studies.changed_mind import scenario, script

COMMANDS = (
    "plan", "validate", "check", "execute", "replay", "new-problem", "bank build", "bank show",
    "bank sample", "bank verify", "infer", "study report", "study play", "planners", "allocation",
)  # fmt: skip
OPTIONS = (
    "--json", "--timeout", "--set", "--planner", "--seed", "-o", "--profile", "--change", "--goal",
    "--human", "--journal", "--resume", "--quality", "-n", "--method", "--htn", "--name", "--from",
    "--lanes", "--speed", "--help", "-v", "--any", "--gantt", "--replan-limit", "--vary", "--plot",
)  # fmt: skip
ARGUMENTS = (
    "transport/two-boxes", "transport", "two-boxes", "kitchen/parfait-nut", "x" * 300, "a\0b", "",
    ".", "/", "-", "--", "/dev/null", "motivation human=10", "motivation human=1e999999", "=", "@",
    "not box-at green wp4@10", "(and (box-at green wp5))", "nan", "inf", "-1", "1e10", "9" * 5000,
    "steady", "case1", "hrcplan", "fast-downward", "exact", "cmd:", "cmd:true {domain} {problem}",
    "up:", "os:getcwd", "\x1b[2J", "\udcff", "oracle", "exact,kairos", "0.001", "golden", "1/3",
)  # fmt: skip
PROFILE = """[mine]
values = "log"
memory = true
replan = "worse"
replan_limit = 3
scale = 5.0
"""
DRAWN = 0.05
"""Share of the mutated rows whose figures are drawn."""

Target = Callable[[random.Random, Path], None]


def toml(rng: random.Random, folder: Path) -> None:
    """Read a mutated profile or script, and play the script."""
    path = folder / "x.toml"
    if rng.random() < 0.6:
        source = PROFILE
        path.write_bytes(mutate.text(rng, source).encode("utf-8", "replace"))
        load_profile(str(path))
        return
    golden = (scenario.HERE / "golden.toml").read_text()
    path.write_bytes(mutate.text(rng, golden).encode("utf-8", "replace"))
    read_script = script.read(str(path))
    script.episodes(read_script, ["oracle"])


@cache
def _bank(folder: Path) -> bytes:
    # Only these problems: a bank is loaded with all problems of its folder.
    goals = folder / "goals"
    goals.mkdir(exist_ok=True)
    for name in ("smoothie-berry", "parfait-nut"):
        shutil.copy(library.find_problem("kitchen", name), goals)
    save(build_bank("kitchen", str(goals)), folder / "origin.bank")
    return (folder / "origin.bank").read_bytes()


@cache
def _small_bank(folder: Path) -> bytes:
    """Return a bank of two goals that is loaded in half of the time."""
    goals = folder / "small-goals"
    goals.mkdir(exist_ok=True)
    text = texts(PAIRS[0])[1]
    (goals / "one.pddl").write_text(text)
    other = text.replace("green wp2", "green wp1").replace("two-boxes", "other-place")
    (goals / "other.pddl").write_text(other)
    save(build_bank("transport", str(goals)), folder / "small.bank")
    return (folder / "small.bank").read_bytes()


def bank(rng: random.Random, folder: Path) -> None:
    """Load, verify and use a bank with a right checksum over changed content."""
    is_small = rng.random() < 0.75
    source = (_small_bank if is_small else _bank)(folder.parent)
    n_head = struct.unpack_from("<Q", source, 16)[0]
    head, body = source[64 : 64 + n_head], source[64 + n_head :]
    if rng.random() < 0.7:
        head = json.dumps(mutate.value(rng, json.loads(head))).encode()
    else:
        body = mutate.data(rng, body) if rng.random() < 0.5 else _flipped(rng, body)
    prefix = struct.pack("<8sIIQQ", b"HRCPBANK", 1, 0, len(head), len(body))
    digest = hashlib.sha256(prefix + head + body).digest()
    path = folder / "x.bank"
    path.write_bytes(prefix + digest + head + body)
    changed = load(path)
    find_fault(path)
    seen = ("move", "robot", "wp0", "wp1") if is_small else ("get", "human", "yogurt")
    infer(changed, [seen], "exact")


def _flipped(rng: random.Random, body: bytes) -> bytes:
    found = bytearray(body)
    found[rng.randrange(len(found))] ^= 1 << rng.randrange(8)
    return bytes(found)


@cache
def _rows(folder: Path) -> Path:
    run_study("changed-mind", folder / "rows", limit=4, options={"methods": "oracle"})
    return folder / "rows"


def rows(rng: random.Random, folder: Path) -> None:
    """Report on rows in which a value, a table or some bytes are others; draw a few of them."""
    file = folder / "st" / "rows.sqlite"
    shutil.rmtree(file.parent, ignore_errors=True)  # sqlite may leave files beside its own
    file.parent.mkdir()
    shutil.copy(_rows(folder.parent) / "rows.sqlite", file)
    if rng.random() < 0.2:
        file.write_bytes(mutate.data(rng, file.read_bytes()))
    else:
        _change_rows(rng, file)
    if rng.random() < DRAWN:
        report_study(file.parent)
        return
    with _empty_figures():
        report_study(file.parent)


@contextmanager
def _empty_figures() -> Iterator[None]:
    """Lay out no figure, which takes most of the time of a report."""

    def no_figure(columns: int, rows: int, *_: float, **__: object) -> tuple[None, object]:
        return None, [[mock.MagicMock() for _ in range(rows)] for _ in range(columns)]

    with (
        mock.patch.object(style, "figure", no_figure),
        mock.patch.object(style, "svg", return_value="<svg></svg>"),
    ):
        yield


def _change_rows(rng: random.Random, file: Path) -> None:
    with suppress(sqlite3.Error), sqlite3.connect(file) as connection:
        connection.execute("pragma synchronous = off")  # not to wait for a disk
        key, value = rng.choice(connection.execute("select key, value from about").fetchall())
        if rng.random() < 0.4:
            changed = json.dumps(mutate.value(rng, json.loads(value)))
            connection.execute("update about set value = ? where key = ?", (changed, key))
        columns = connection.execute("select * from rows").description
        column = rng.choice(columns)[0]
        simple = [v for v in mutate.VALUES if isinstance(v, (str, int, float, type(None)))]
        where = "" if rng.random() < 0.5 else " where run = 0"
        new = rng.choice([*simple, b"\0\xff"])
        with suppress(OverflowError, UnicodeEncodeError):
            connection.execute(f'update rows set "{column}" = ?{where}', (new,))


@cache
def _journal(folder: Path) -> bytes:
    path = folder / "origin.journal"
    execute("transport", "two-boxes", journal=path)
    return path.read_bytes()


def journal(rng: random.Random, folder: Path) -> None:
    """Replay a mutated journal, or go on with it."""
    lines = _journal(folder.parent).splitlines(keepends=True)
    at = rng.randrange(len(lines))
    if rng.random() < 0.7:
        changed = mutate.value(rng, json.loads(lines[at]))
        if isinstance(changed, dict):
            changed["seq"] = at
        lines[at] = json.dumps(changed).encode() + b"\n"
    else:
        lines[at] = mutate.data(rng, lines[at])
    path = folder / "x.journal"
    path.write_bytes(b"".join(lines))
    if rng.random() < 0.9:
        replay(read_journal(path))
    else:
        execute("transport", "two-boxes", journal=path, resume=True)


def observations(rng: random.Random, folder: Path) -> None:
    """Infer the goal from mutated observations."""
    _bank(folder.parent)
    seen = "0.0: (get human yogurt) [1.0]\n(get human berries)\n; so\n(mix robot yogurt)\n"
    path = folder / "obs.dat"
    path.write_bytes(mutate.text(rng, seen).encode("utf-8", "replace"))
    method = rng.choice(("exact", "switching", "recursive"))
    infer(_loaded(folder.parent / "origin.bank"), path, method)


@cache
def _loaded(path: Path):  # type: ignore[no-untyped-def]
    return load(path)


def arguments(rng: random.Random, folder: Path) -> None:
    """Call a command with arguments by chance: exit code, one document, no control characters."""
    command = rng.choice(COMMANDS).split()
    words = list(command)
    for _ in range(rng.randrange(7)):
        words.append(rng.choice(OPTIONS) if rng.random() < 0.4 else rng.choice(ARGUMENTS))
    words += ["--timeout", "1"] if words[0] in ("plan", "execute") else []
    words = command + (["--json"] if rng.random() < 0.5 else []) + words[len(command) :]
    done = CliRunner().invoke(main, words)
    if done.exit_code not in (0, 1, 2, 3, 4, 5) or "internal error" in done.output:
        raise AssertionError(f"{words}: exit {done.exit_code}, {done.output[-300:]}")
    raw = [c for c in done.output if c not in "\n\t\xa0" and not c.isprintable()]
    assert not raw, f"{words}: prints {raw[:5]}"
    if words[len(command) : len(command) + 1] == ["--json"] and "--help" not in words:
        json.loads(done.stdout)


TARGETS: dict[str, Target] = {
    "pddl": pddl, "public": public, "tree": tree, "plan": plan, "log": log, "toml": toml,
    "bank": bank, "rows": rows, "journal": journal, "observations": observations,
    "arguments": arguments, "requests": requests,
    "links": links,
}  # fmt: skip


def warm(kind: str, folder: Path) -> None:
    """Make what the mutants of a kind are made of, which takes longer than any of them."""
    match kind:
        case "plan" | "log":
            for pair in PAIRS[:2]:
                planned(pair)
        case "toml":
            script.episodes(script.read("golden"), ["oracle"])
        case "bank" | "observations":
            _bank(folder)
            _small_bank(folder)
            _loaded(folder / "origin.bank")
        case "requests":
            served(folder).names()
        case "rows":
            report_study(_rows(folder))
        case "journal":
            _journal(folder)
