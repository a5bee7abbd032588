"""Ways out of a command: broken outputs, closed streams, hostile names, one JSON document."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from hrcplan.cli import main
from hrcplan.cli.options import MOST_SECONDS, SECONDS

ROOT = Path(__file__).parents[2]
ENV = {**os.environ, "PYTHONPATH": str(ROOT)}
HRCPLAN = f"{sys.executable} -m hrcplan"
ESCAPES = "\x1b[2J\x9b31m\u202e\r\x07"


def shell(script: str, folder: Path, **env: str) -> subprocess.CompletedProcess[bytes]:
    """Run a line of sh with ``hrcplan`` in it."""
    line = script.replace("hrcplan ", f"{HRCPLAN} ", 1)
    return subprocess.run(["sh", "-c", line], cwd=folder, env={**ENV, **env}, capture_output=True,
                          check=False, timeout=60)  # fmt: skip


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


@pytest.mark.parametrize(
    ("script", "code"),
    [
        ("hrcplan plan nosuch x --json > /dev/full", 3),
        ("hrcplan plan nosuch x 2> /dev/full", 3),
        ("hrcplan check nosuch.pddl > /dev/full", 2),
        ("hrcplan planners --nosuch 2> /dev/full", 2),
        ("hrcplan planners >&- 2>&-", 0),
        ("hrcplan planners <&- >&-", 0),
        ("hrcplan execute transport/two-boxes >&-", 0),
        ("hrcplan collaborate transport transport-goals < /dev/null 2> /dev/full", 1),
    ],
)
def test_a_full_disk_is_no_traceback(script: str, code: int, tmp_path: Path) -> None:
    done = shell(script, tmp_path)
    assert (done.returncode, b"Traceback" in done.stderr) == (code, False)
    assert b"Exception ignored" not in done.stderr


@pytest.mark.parametrize("words", ["plan nosuch x --json", "check nosuch.pddl"])
def test_a_closed_pipe_is_quiet(words: str, tmp_path: Path) -> None:
    done = shell(f"(sleep 1; hrcplan {words}; echo $? >&2) | true", tmp_path)
    code = b"3" if "--json" in words else b"2"
    assert done.stderr.strip() == code


def test_closed_standard_streams_do_not_reach_the_planner(tmp_path: Path) -> None:
    words = "plan kitchen/parfait-fruit --planner fast-downward"
    assert shell(f"hrcplan {words} -o x.plan >&- 2>&-", tmp_path).returncode == 0
    assert "(" in (tmp_path / "x.plan").read_text()
    done = shell(f"hrcplan {words} <&- >&-", tmp_path)
    assert (done.returncode, b"error" in done.stderr) == (0, False)


def test_a_name_that_is_no_text_can_be_said(tmp_path: Path) -> None:
    done = shell("hrcplan plan \"$(printf '\\377')\" x --json", tmp_path,
                 PYTHONIOENCODING="utf-8:strict")  # fmt: skip
    assert done.returncode == 3
    assert json.loads(done.stdout)["error"]["path"] == "\udcff"


@pytest.mark.parametrize("words", [["plan", "transport/two-boxes"], ["check", "nosuch.pddl"]])
def test_a_stream_that_cannot_show_lines_gets_escapes(words: list[str], tmp_path: Path) -> None:
    done = shell(f"hrcplan {' '.join(words)}", tmp_path, PYTHONIOENCODING="ascii:strict")
    assert done.returncode in (0, 3)
    assert b"Traceback" not in done.stderr
    assert b"internal" not in done.stderr


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["plan"], 2),
        (["plan", "transport/two-boxes", "--timeout", "abc"], 2),
        (["plan", "transport/two-boxes", "--nosuch"], 2),
        (["nosuch"], 2),
        (["bank"], 2),
        (["bank", "nosuch"], 2),
        (["check", "x" * 300], 3),
        (["plan", "x" * 300, "y"], 3),
        (["plan", "transport", "y" * 5000], 3),
        (["plan", "a\0b", "y"], 2),
        (["replay", "a\0b"], 2),
        (["study", "report", "a\0b"], 2),
        (["plan", "transport/two-boxes", "-o", "x" * 300], 2),
        (["validate", "transport/two-boxes", "x" * 300], 3),
        (["study", "report", "x" * 300], 3),
        (["infer", "x" * 300, "y"], 3),
        (["bank", "show", "x" * 300], 3),
        (["bank", "build", "kitchen", "x" * 300, "-o", "b"], 3),
        (["bank", "build", "kitchen", "--quality", "1e999999999", "-o", "b"], 2),
        (["execute", "transport/two-boxes", "--journal", "x" * 300], 2),
        (["execute", "transport/two-boxes", "--journal", "x" * 300, "--resume"], 2),
        (["execute", "transport/two-boxes", "--profile", "x" * 300 + ".toml"], 3),
        (["replay", "x" * 300], 3),
        (["study", "play", "x" * 300], 3),
        (["new-problem", "x" * 300, "--from", "y", "--goal", "(and)", "--name", "n"], 3),
    ],
    ids=lambda value: " ".join(value)[:50] if isinstance(value, list) else str(value),
)
def test_every_error_is_one_json_document(words: list[str], code: int) -> None:
    done = run(*words, "--json")
    assert done.exit_code == code, done.output
    document = json.loads(done.stdout)
    error = document["error"] if "error" in document else document["diagnostics"][0]
    assert "internal" not in error["code"]
    assert error["message"]


@pytest.mark.parametrize("flags", [[], ["--json"]], ids=["text", "json"])
def test_nothing_that_a_file_says_steers_the_terminal(tmp_path: Path, flags: list[str]) -> None:
    domain, problem = tmp_path / f"d{ESCAPES}.pddl", tmp_path / f"p{ESCAPES}.pddl"
    evil = ESCAPES.replace("\r", "")
    domain.write_text(
        f"(define (domain d{evil}) (:requirements :strips) (:predicates (p ?x{evil}) (q{evil}))"
        f" (:action a{evil} :parameters (?x{evil}) :effect (p ?x{evil})))"
    )
    problem.write_text(
        f"(define (problem q{evil}) (:domain d{evil}) (:objects o{evil}) (:init)"
        f" (:goal (p o{evil})))"
    )
    (tmp_path / "plan").write_text(f"(a{evil} o{evil} x)")
    both = [str(domain), str(problem)]
    for words in (
        ["check", *both],
        ["plan", *both, "--planner", "fast-downward"],
        ["plan", *both, "--set", f"p{evil}=3"],
        ["validate", *both, str(tmp_path / "plan")],
        ["execute", *both],
        ["bank", "build", str(domain), str(tmp_path), "-o", str(tmp_path / "b")],
        ["infer", str(domain)],
        ["plan", f"nosuch{ESCAPES}", "x"],
    ):
        done = run(*words, *flags)
        raw = [c for c in done.output if c not in "\n\t" and not c.isprintable()]
        assert raw == [], (words, done.output)


def test_a_table_keeps_its_own_colours_and_shows_escapes(
    capsys: pytest.CaptureFixture[str],
) -> None:
    from rich.table import Table

    from hrcplan.cli import output

    table = Table("head")
    table.add_row("[red]red[/] \x1b[2J\u202e")
    output.table(table)
    shown = capsys.readouterr().out
    assert "red \\x1b[2J\\u202e" in shown


@pytest.mark.parametrize(
    ("words", "target"),
    [
        (["plan", "d.pddl", "p.pddl", "-o"], "p.pddl"),
        (["plan", "d.pddl", "p.pddl", "-o"], "d.pddl"),
        (["plan", "d.pddl", "p.pddl", "-o"], "link.pddl"),
        (["new-problem", "d.pddl", "--from", "p.pddl", "--vary", "--name", "n", "-o"], "p.pddl"),
        (["bank", "build", "d.pddl", "goals", "-o"], "goals/g.pddl"),
    ],
)
def test_a_result_does_not_replace_what_was_read(
    words: list[str], target: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "goals").mkdir()
    for name, source in (
        ("d.pddl", "domains/kitchen.pddl"),
        ("p.pddl", "problems/kitchen/parfait-nut.pddl"),
        ("goals/g.pddl", "problems/kitchen/parfait-nut.pddl"),
    ):
        (tmp_path / name).write_bytes((ROOT / source).read_bytes())
    (tmp_path / "link.pddl").symlink_to("p.pddl")
    before = (tmp_path / target).read_bytes()
    done = run(*words, target)
    assert (done.exit_code, (tmp_path / target).read_bytes()) == (2, before)
    assert "the command reads it" in done.stderr


def test_long_names_and_links_to_themselves(tmp_path: Path) -> None:
    long = tmp_path / ("n" * 250)
    assert run("plan", "transport/two-boxes", "-o", str(long)).exit_code == 0
    assert long.is_file()
    loop = tmp_path / "loop"
    loop.symlink_to("loop")
    done = run("plan", "transport/two-boxes", "-o", str(loop))
    assert (done.exit_code, loop.is_symlink()) == (2, True)
    assert "symbolic links" in done.stderr


def test_python_m_does_not_import_from_the_current_folder(tmp_path: Path) -> None:
    for name in ("rich_click", "numpy", "json"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit(99)")
    done = shell("hrcplan check nosuch.pddl", tmp_path)
    assert done.returncode == 3, done.stderr


@pytest.mark.parametrize(
    "words",
    [
        ["plan", "kitchen/pasta-bean", "--timeout", "nan"],
        ["plan", "kitchen/pasta-bean", "--timeout", "-inf"],
        ["execute", "transport/two-boxes", "--timeout", "nan"],
        ["execute", "transport/two-boxes", "--speed", "inf"],
        ["allocation", "transport/two-boxes", "motivation human", "--range", "nan", "3"],
        ["allocation", "transport/two-boxes", "motivation human", "--range", "3", "inf"],
        ["study", "run", "changed-mind", "--runs", "9" * 20, "-o", "none"],
        ["study", "run", "changed-mind", "--jobs", "9" * 20, "-o", "none"],
        ["validate", "transport/two-boxes", "none", "--epsilon", "nan"],
    ],
    ids=lambda words: f"{words[0]} {words[-2]} {words[-1][:4]}",
)
def test_a_limit_that_is_none_is_named(words: list[str], tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-m", "hrcplan", *words], capture_output=True, text=True, cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False, timeout=60,
    )  # fmt: skip
    assert run.returncode == 2
    assert next(word for word in words if word.startswith("--")) in run.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("seconds", ["inf", "1e10"])
def test_a_timeout_may_be_endless(seconds: str) -> None:
    assert SECONDS.convert(seconds, None, None) == MOST_SECONDS


def test_a_planner_in_this_process_leaves_no_words_at_the_exit(tmp_path: Path) -> None:
    """kairos would report its own objects as leaks if they were not taken away."""
    (tmp_path / "d.pddl").write_text(
        "(define (domain d) (:predicates (p)) (:action a :parameters () :effect (p)))"
    )
    (tmp_path / "p.pddl").write_text("(define (problem x) (:domain d) (:init) (:goal (p)))")
    words = ["execute", "--planner", "kairos", str(tmp_path / "d.pddl"), str(tmp_path / "p.pddl")]
    done = subprocess.run(
        [sys.executable, "-P", "-m", "hrcplan", *words], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_standard_input_without_an_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hrcplan.pddl.source.MAX_BYTES", 1 << 20)
    done = CliRunner().invoke(main, ["format", "-"], input=b" " * (2 << 20))
    assert done.exit_code == 3
    assert "more than 1 MiB" in done.output


@pytest.mark.parametrize(
    "words",
    [
        "study run changed-mind -o x --limit 18446744073709551616",
        "new-problem transport --from two-boxes --vary --name x --new-objects 1000000000",
        f"bank build transport -o x --sample 1{'0' * 30}",
    ],
)
def test_a_number_of_things_has_a_bound(words: str) -> None:
    assert run(*words.split()).exit_code == 2
