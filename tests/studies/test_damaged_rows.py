"""Rows that are damaged, or say what no study says, are an error of the file."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from hrcplan.errors import InputError, UsageError
from hrcplan.studies import report_study, run_study

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("study")
    run_study("changed-mind", path, limit=4, options={"methods": "oracle"})
    return path


@pytest.mark.parametrize(
    "statement",
    [
        "update about set value = 'x' where key = 'options'",
        "update about set value = '\"x\"' where key = 'options'",
        "update about set value = '{\"a\": 3}' where key = 'options'",
        "update about set value = '3' where key = 'study'",
        "update about set value = '\"this:s\"' where key = 'study'",
        "update about set value = x'00ff' where key = 'seed'",
        "update about set value = null where key = 'seed'",
        f"update about set value = '{'[' * 100_000}' where key = 'seed'",
        "update about set value = '[]' where key = 'version'",
        "delete from about where key = 'study'",
        "delete from about where key = 'seed'",
        "delete from about where key = 'version'",
        "drop table about",
        "alter table about rename column value to other",
        "update rows set total_steps = 'x'",
        "update rows set total_steps = x'00'",
        "update rows set total_steps = 1e300",
        "update rows set total_steps = 9223372036854775807",
        "update rows set total_steps = cast(x'ff' as text)",
        "alter table rows rename column total_steps to other",
        "alter table rows drop column total_steps",
        "update rows set run = run + 4611686018427387904",
    ],
)
def test_damaged_rows_are_an_input_error(folder: Path, tmp_path: Path, statement: str) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    with sqlite3.connect(copy / "rows.sqlite") as file:
        file.execute(statement)
    file.close()
    with pytest.raises((InputError, UsageError)):
        report_study(copy)
    assert not (copy / "report.json").exists()


def test_an_option_without_a_value_is_the_default(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    with sqlite3.connect(copy / "rows.sqlite") as file:
        (text,) = file.execute("select value from about where key = 'options'").fetchone()
        nothing = json.dumps(dict.fromkeys(json.loads(text)))
        file.execute("update about set value = ? where key = 'options'", (nothing,))
    file.close()
    assert report_study(copy)["n_rows"] == report_study(folder)["n_rows"]


def test_workers_import_nothing_from_the_current_folder(tmp_path: Path) -> None:
    for name in ("joblib", "pickle", "numpy", "loky"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit(f'{__name__} of the folder')")
    fetch = Path(__file__).parent / "fetch"
    words = ["study", "run", "failure-anticipation", "--domain", str(fetch / "domain.pddl"),
             "--problem", str(fetch / "four-items.pddl"), "--limit", "16", "--jobs", "2",
             "-o", "st"]  # fmt: skip
    code = "from hrcplan.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-P", "-c", code, *words, "--json"], cwd=tmp_path, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["n_new"] >= 16  # enough for workers
    assert "of the folder" not in done.stderr


def test_a_name_in_the_schema_that_is_no_utf_8_is_an_input_error(
    folder: Path, tmp_path: Path
) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    data = bytearray((copy / "rows.sqlite").read_bytes())
    data[data.rindex(b"tablerows") + 5] = 0xAB  # SQLite quotes the byte in its message
    (copy / "rows.sqlite").write_bytes(data)
    with pytest.raises(InputError, match=r"damaged|not a file of rows"):
        report_study(copy)
