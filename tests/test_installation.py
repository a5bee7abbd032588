"""The wheel in an empty environment: small, complete, and without any extra. Only with --all."""

import json
import os
import shutil
import subprocess
import sys
import tarfile
import warnings
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


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built from the sdist, as it comes from an index."""
    folder = tmp_path_factory.mktemp("wheel")
    code = "import sys, hatchling.build as b; print(getattr(b, sys.argv[1])(sys.argv[2]))"
    sdist = folder / run(sys.executable, "-c", code, "build_sdist", folder, cwd=ROOT).split()[-1]
    with tarfile.open(sdist) as file:
        file.extractall(folder, filter="data")
    source = folder / sdist.name.removesuffix(".tar.gz")
    name = run(sys.executable, "-c", code, "build_wheel", folder, cwd=source).split()[-1]
    return folder / name


def install(python: Path, requirement: str) -> None:
    """Install something with its dependencies, at the versions that are tested."""
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "-q", "--no-compile"]
    run(*pip, "-c", ROOT / "constraints.txt", requirement, cwd=python.parent)


def make_environment(folder: Path, requirement: str, python: str = sys.executable) -> Path:
    """Return the programs of a new environment that holds a requirement and nothing else."""
    run(python, "-m", "venv", "--without-pip", folder, cwd=folder.parent)
    install(folder / "bin" / "python", requirement)
    return folder / "bin"


@pytest.fixture(scope="module", params=PYTHONS)
def environment(
    wheel: Path, tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> Path:
    """An environment that holds the wheel and what it depends on."""
    folder = tmp_path_factory.mktemp("core") / "env"
    return make_environment(folder, str(wheel), request.param).parent


def test_every_python_that_is_missing_here_is_named() -> None:
    """The core is tried with those that are here; a machine that lacks one says so in its log."""
    absent = [name for name in OTHERS if not works(name)]
    if absent:
        warnings.warn(f"not on this machine, so not tried: {', '.join(absent)}", stacklevel=1)
    assert works(sys.executable)


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
