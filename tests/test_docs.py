"""Documents are true: console blocks and Python examples in them print what stands there.

A block shows commands after ``$ `` and what they print; ``...`` stands for anything. The blocks of
one document share a folder, so a file that one command writes is there for the next.
"""

from __future__ import annotations

import doctest
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def sessions(text: str) -> Iterator[tuple[str, str]]:
    """Yield command and expected output of every console block."""
    for block in re.findall(r"```console\n(.*?)```", text, re.DOTALL):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, printed = part.partition("\n")
            yield command, printed


def run(command: str, folder: Path) -> str:
    """Return what a command prints, stderr included; hrcplan is this checkout's."""
    ours = f"{sys.executable} -m hrcplan"
    line = re.sub(r"^(tools/)?hrcplan\b", ours, command)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NO_COLOR": "1", "COLUMNS": "100"}
    done = subprocess.run(
        f"{{ {line}; }} 2>&1", shell=True, cwd=folder, env=environment, capture_output=True,
        text=True, timeout=120, check=False,
    )  # fmt: skip
    return done.stdout


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_console_blocks(document: Path, tmp_path: Path) -> None:
    checker = doctest.OutputChecker()
    for command, expected in sessions(document.read_text(encoding="utf-8")):
        got = run(command, tmp_path)
        example = doctest.Example(command, expected)
        difference = checker.output_difference(example, got, FLAGS)
        assert checker.check_output(expected, got, FLAGS), f"$ {command}\n{difference}"


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_python_examples(
    document: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    found = doctest.testfile(str(document), module_relative=False, optionflags=FLAGS)
    assert found.failed == 0, capsys.readouterr().out


def test_there_is_something_to_run() -> None:
    texts = [path.read_text(encoding="utf-8") for path in DOCUMENTS]
    assert any(list(sessions(text)) for text in texts)
    assert any(doctest.DocTestParser().get_examples(text) for text in texts)
