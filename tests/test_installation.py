"""The wheel in an empty environment: small, complete, and without any extra. Only with --all."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MIB = 1 << 20

pytestmark = [
    pytest.mark.skipif(
        "HRCPLAN_NO_SKIPS" not in os.environ, reason="only with tools/test --all: it needs pip"
    ),
    pytest.mark.xdist_group("installation"),
]


def run(*command: str | Path, cwd: Path) -> str:
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def works(python: str) -> bool:
    if shutil.which(python) is None:
        return False
    version = subprocess.run([python, "-c", "import venv, ensurepip"], check=False)
    return version.returncode == 0


# The interpreter of the tests, and those of other versions that this machine has.
OTHERS = [f"python3.{minor}" for minor in (11, 12, 13) if minor != sys.version_info.minor]
PYTHONS = [sys.executable, *filter(works, OTHERS)]


@pytest.fixture(scope="module", params=PYTHONS)
def environment(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Path:
    """An environment that holds the wheel and what it depends on."""
    folder = tmp_path_factory.mktemp("installation")
    code = "import sys, hatchling.build; print(hatchling.build.build_wheel(sys.argv[1]))"
    wheel = run(sys.executable, "-c", code, str(folder), cwd=ROOT).split()[-1]
    run(request.param, "-m", "venv", folder / "env", cwd=folder)
    python = folder / "env" / "bin" / "python"
    pins = ROOT / "constraints.txt"
    run(python, "-m", "pip", "install", "-q", "-c", pins, folder / wheel, cwd=folder)
    return folder / "env"


def test_core_stays_below_150_mib(environment: Path) -> None:
    files = [path for path in environment.rglob("*") if path.is_file() and not path.is_symlink()]
    assert sum(path.stat().st_size for path in files) < 150 * MIB


def test_wheel_proves_a_plan(environment: Path, tmp_path: Path) -> None:
    program = environment / "bin" / "hrcplan"
    answer = json.loads(run(program, "plan", "transport/two-boxes", "--json", cwd=tmp_path))
    assert answer["status"] == "solved-optimally"
    assert answer["metric"] == pytest.approx(58.00051)


def test_wheel_collaborates(environment: Path, tmp_path: Path) -> None:
    program = environment / "bin" / "hrcplan"
    words = ["collaborate", "kitchen", "--human", "simulated", "--seed", "3"]
    assert "serve" in run(program, *words, cwd=tmp_path)
