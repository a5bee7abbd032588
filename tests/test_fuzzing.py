"""A short run of tools/fuzz with a fixed seed: only typed errors come out, and soon."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# Rows take a study and its figures; tests/studies/test_damaged_rows.py is the short run of them.
N = {
    "pddl": 60,
    "public": 60,
    "tree": 60,
    "plan": 60,
    "log": 60,
    "toml": 40,
    "bank": 20,
    "journal": 40,
    "observations": 40,
    "arguments": 25,
    "requests": 60,
    "links": 40,
}


@pytest.mark.parametrize("kind", N)
def test_mutants_are_read_or_refused(kind: str) -> None:
    words = ["--kind", kind, "--n", str(N[kind]), "--seed", "1"]
    done = subprocess.run(
        [sys.executable, "-P", "-m", "fuzzing", *words], text=True, check=False,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), str(ROOT)])},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{N[kind]} mutants" in done.stdout
    if kind in ("pddl", "public", "tree"):
        share = int(done.stdout.split("%")[0].split()[-1])
        assert share >= 70, "most mutants get past the tokens"


STARVED = """
import sys, time
from pathlib import Path
import fuzzing.campaign as c
c.LONG_S = 0.2
naps = {"once": [1.0, 0.0], "always": [1.0, 1.0]}[sys.argv[1]]
c.TARGETS["plan"] = lambda dice, folder: time.sleep(naps.pop(0))
print(len(c.campaign("plan", 1, 1, Path(sys.argv[2])).faults))
"""


@pytest.mark.parametrize(("when", "n_faults"), [("once", 0), ("always", 1)])
def test_what_waits_once_is_tried_again(tmp_path: Path, when: str, n_faults: int) -> None:
    done = subprocess.run(
        [sys.executable, "-P", "-c", STARVED, when, str(tmp_path)], text=True, check=True,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), str(ROOT)])},
    )  # fmt: skip
    assert done.stdout == f"{n_faults}\n"
