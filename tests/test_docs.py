"""Documents are true: console blocks and Python examples in them print what stands there.

A console block shows commands after ``$ `` and what they print; ``...`` stands for anything. A
block with a ``title`` is a file of that name. The blocks of one document share a folder, in order,
so a file that one block writes is there for the next.
"""

from __future__ import annotations

import doctest
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy  # noqa: F401  (its threads can be limited once it is loaded)
import pytest
from threadpoolctl import threadpool_limits

import hrcplan

ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
NAMES = {path: path.relative_to(ROOT).as_posix() for path in DOCUMENTS}
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


BLOCK = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```$", re.DOTALL | re.MULTILINE)


PROGRESS = re.compile(r"^(after \d+ s: .*|[\d,]+ .* …|[\d,]+ of [\d,]+ episodes.*)\n", re.MULTILINE)
"""What a command says while it works: only a slow machine sees it."""


def sessions(text: str, folder: Path) -> Iterator[tuple[str, str]]:
    """Write the titled blocks of a document, and yield its commands with what they print."""
    for language, title, block in BLOCK.findall(text):
        if title:
            file = folder / title
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block, "utf-8")
        elif language == "console":
            for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                command, _, printed = part.partition("\n")
                yield command, printed


def run(command: str, folder: Path) -> str:
    """Return what a command prints, stderr included but for its progress.

    hrcplan is this checkout's.
    """
    ours = f"{sys.executable} -m hrcplan"
    line = re.sub(r"^(tools/)?hrcplan\b", ours, command)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"  # for words in quotes
    environment = {
        **os.environ, "PYTHONPATH": str(ROOT), "NO_COLOR": "1", "COLUMNS": "100", "PATH": path,
    }  # fmt: skip
    done = subprocess.run(
        f"exec 2>&1\n{line}", shell=True, cwd=folder, env=environment, capture_output=True,
        text=True, timeout=120, check=False,
    )  # fmt: skip
    return PROGRESS.sub("", done.stdout)


@pytest.mark.parametrize("document", DOCUMENTS, ids=NAMES.get)
def test_console_blocks(document: Path, tmp_path: Path) -> None:
    checker = doctest.OutputChecker()
    for command, expected in sessions(document.read_text(encoding="utf-8"), tmp_path):
        got = run(command, tmp_path)
        example = doctest.Example(command, expected)
        difference = checker.output_difference(example, got, FLAGS)
        assert checker.check_output(expected, got, FLAGS), f"$ {command}\n{difference}"


@pytest.mark.parametrize("document", DOCUMENTS, ids=NAMES.get)
def test_python_examples(
    document: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    with threadpool_limits(1):  # threads of small products wait for each other on a busy machine
        found = doctest.testfile(str(document), module_relative=False, optionflags=FLAGS)
    assert found.failed == 0, capsys.readouterr().out


def test_there_is_something_to_run(tmp_path: Path) -> None:
    texts = [path.read_text(encoding="utf-8") for path in DOCUMENTS]
    assert sum(len(list(sessions(text, tmp_path))) for text in texts) > 20
    assert sum(len(doctest.DocTestParser().get_examples(text)) for text in texts) > 20


def test_every_page_is_in_the_navigation() -> None:
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    for path in DOCUMENTS[1:]:
        assert path.relative_to(ROOT / "docs").as_posix() in navigation


LINK = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)(?:#[^)]*)?\)")


def test_links_lead_to_files() -> None:
    """Also those of pages that are not on the site; `mkdocs build --strict` looks at anchors."""
    made = {ROOT / "docs" / "reference" / "cli.md"}
    targets = {(path, path.parent / link) for path in [*DOCUMENTS, ROOT / "CONTRIBUTING.md"]
               for link in LINK.findall(path.read_text("utf-8"))}  # fmt: skip
    assert len(targets) > 50
    missing = {f"{NAMES.get(path, path.name)}: {target.name}" for path, target in targets
               if not target.resolve().exists() and target.resolve() not in made}  # fmt: skip
    assert missing == set()


def test_the_site_is_built_with_its_warnings() -> None:
    """With --quiet, MkDocs sees no warning, and --strict lets everything pass."""
    (line,) = (line for line in (ROOT / "tools" / "test").read_text().splitlines()
               if "mkdocs build" in line)  # fmt: skip
    assert "--strict" in line
    assert "--quiet" not in line


def test_every_exported_name_has_a_place_in_the_reference() -> None:
    pages = "".join(p.read_text("utf-8") for p in (ROOT / "docs/reference/python").glob("*.md"))
    documented = set(re.findall(r"hrcplan\.(\w+)", pages)) | {"load_bank"}
    errors = {name for name in hrcplan.__all__ if name.endswith("Error")} | {"Diagnostic"}
    assert set(hrcplan.__all__) - errors <= documented
