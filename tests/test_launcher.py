"""The launcher, run for real in small projects of its own, and without any network.

The project that it installs here builds itself with a backend of forty lines, and what it depends
on are empty wheels in a folder, so that pip does its real work and finds everything nearby.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[1] / "tools"

# One worker runs them all: the first two tests share an installation.
pytestmark = pytest.mark.xdist_group("launcher")

PYPROJECT = """
[build-system]
requires = []
build-backend = "backend"
backend-path = ["."]
"""

BACKEND = '''
import pathlib, time, zipfile

METADATA = """Metadata-Version: 2.1
Name: hrcplan
Version: 1
Provides-Extra: planners
Provides-Extra: studies
Provides-Extra: test
Requires-Dist: part-java ; extra == "planners"
Requires-Dist: part-java ; extra == "test"
Requires-Dist: part-test ; extra == "test"
"""

def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    with open("builds.log", "a") as log:
        log.write("build\\n")
    while pathlib.Path("wait").exists():
        time.sleep(0.02)
    name = "hrcplan-1-py3-none-any.whl"
    info = "hrcplan-1.dist-info/"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w") as wheel:
        wheel.writestr("hrcplan.pth", str(pathlib.Path.cwd()))
        wheel.writestr(info + "METADATA", METADATA)
        wheel.writestr(info + "WHEEL", "Wheel-Version: 1.0\\nTag: py3-none-any\\n")
        wheel.writestr(info + "entry_points.txt", "[console_scripts]\\nhrcplan = hrc:main\\n")
        wheel.writestr(info + "RECORD", "")
    return name
'''

# What is started prints where it was called, with what, and which parts it finds.
MODULE = """
import importlib.metadata, os, sys

def main():
    found = {d.name: d.version for d in importlib.metadata.distributions() if "part" in d.name}
    parts = [f"{name}={found[name]}" for name in sorted(found)]
    print(os.getcwd(), sys.argv[1:], *parts)
    sys.exit(7)
"""


def empty_wheel(folder: Path, name: str, version: str) -> None:
    info = f"{name}-{version}.dist-info"
    with zipfile.ZipFile(folder / f"{name}-{version}-py3-none-any.whl", "w") as wheel:
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        wheel.writestr(f"{info}/METADATA", metadata)
        wheel.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nTag: py3-none-any\n")
        wheel.writestr(f"{info}/RECORD", "")


def make_project(root: Path) -> Path:
    """Return a checkout with the real tools/ around a project that needs no network."""
    root.mkdir()
    shutil.copytree(TOOLS, root / "tools")
    (root / "pyproject.toml").write_text(PYPROJECT)
    (root / "backend.py").write_text(BACKEND)
    (root / "hrc.py").write_text(MODULE)
    (root / "constraints.txt").write_text("part_java==1\n")
    (root / "wheels").mkdir()
    for name, version in (("part_java", "1"), ("part_java", "2"), ("part_test", "1")):
        empty_wheel(root / "wheels", name, version)
    return root


def environment(root: Path, extra: Mapping[str, str]) -> dict[str, str]:
    # No index and no settings of this machine: a look at the network would fail, not pass unseen.
    return {
        **os.environ,
        "HRCPLAN_PYTHON": sys.executable,
        "PIP_CONFIG_FILE": os.devnull,
        "PIP_NO_INDEX": "1",
        "PIP_FIND_LINKS": (root / "wheels").as_uri(),
        **extra,
    }


def start(
    root: Path, *args: str, cwd: Path | None = None, tool: Path | None = None, **extra: str
) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [tool or root / "tools" / "hrcplan", *args],
        cwd=cwd or root,
        env=environment(root, extra),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def outcome(process: "subprocess.Popen[str]") -> tuple[int, str, str]:
    stdout, stderr = process.communicate(timeout=60)
    return process.returncode, stdout, stderr


def builds(root: Path) -> int:
    log = root / "builds.log"
    return len(log.read_text().splitlines()) if log.exists() else 0


def wait_for_build(root: Path) -> None:
    deadline = time.monotonic() + 60
    while not builds(root):
        assert time.monotonic() < deadline, "pip never came to build the project"
        time.sleep(0.02)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project whose path has a blank, after the first call from another folder."""
    root = make_project(tmp_path_factory.mktemp("launcher") / "a checkout")
    elsewhere = root.parent
    code, stdout, stderr = outcome(
        start(root, "plan", "a b", cwd=elsewhere, VIRTUAL_ENV="/nowhere")
    )
    assert code == 7, stderr
    assert stdout == f"{elsewhere} ['plan', 'a b'] part_java=1\n"
    assert "installing into .venv" in stderr
    assert "installing 1 packages" in stderr
    assert len(stderr.splitlines()) <= 10
    assert "Looking in links" not in stderr
    assert builds(root) == 1
    return root


def test_installed_project_starts_without_pip_and_without_a_word(
    installed: Path, tmp_path: Path
) -> None:
    before = builds(installed)
    link = tmp_path / "link"
    link.symlink_to(installed / "tools" / "hrcplan")
    # PYTHONHOME alone would keep any interpreter from starting.
    code, stdout, stderr = outcome(
        start(installed, cwd=tmp_path, tool=link, PYTHONHOME="/nowhere", PIP_FIND_LINKS="/nowhere")
    )
    assert (code, stdout, stderr) == (7, f"{tmp_path} [] part_java=1\n", "")
    assert builds(installed) == before


def test_changed_pins_update_and_the_test_extra_stays(installed: Path) -> None:
    before = builds(installed)
    # tools/test stops at pytest, which this project does not have; only its installation counts.
    outcome(start(installed, "--version", tool=installed / "tools" / "test"))
    _, stdout, stderr = outcome(start(installed))
    assert stdout.endswith("part_java=1 part_test=1\n")
    assert stderr == "", "the test extra contains what tools/hrcplan needs"
    assert builds(installed) == before + 1

    (installed / "constraints.txt").write_text("part_java==2\n")
    _, stdout, stderr = outcome(start(installed))
    assert stdout.endswith("part_java=2 part_test=1\n")
    assert "with the extras 'test'" in stderr
    assert builds(installed) == before + 2


@pytest.mark.parametrize(("args", "no_skips"), [([], ""), (["--all"], "1")])
def test_every_check_runs_and_all_allows_no_skips(
    tmp_path: Path, args: list[str], no_skips: str
) -> None:
    root = make_project(tmp_path / "checkout")
    outcome(start(root, "--version", tool=root / "tools" / "test"))
    # nvim is there, so that --all has nothing to install.
    for name in ("ruff", "mypy", "lint-imports", "pytest", "mkdocs", "nvim"):
        tool = root / ".venv" / "bin" / name
        tool.write_text(f'#!/bin/sh\necho "called {name} <$HRCPLAN_NO_SKIPS> $*"\n')
        tool.chmod(0o755)
    code, stdout, stderr = outcome(
        start(root, *args, tool=root / "tools" / "test", HRCPLAN_NO_SKIPS="")
    )
    assert code == 0, stderr
    called = [line for line in stdout.splitlines() if line.startswith("called ")]
    assert [line.split()[1] for line in called] == [
        "ruff",
        "ruff",
        "mypy",
        "lint-imports",
        "mkdocs",
        "pytest",
    ]
    assert f"<{no_skips}>" in called[-1]
    assert "--durations=15" in called[-1]


def test_two_first_calls_at_once_install_once(tmp_path: Path) -> None:
    root = make_project(tmp_path / "checkout")
    (root / "wait").touch()
    first = start(root)
    wait_for_build(root)
    second = start(root)
    assert second.stderr is not None
    assert "waiting for another installation" in second.stderr.readline()
    (root / "wait").unlink()
    for process in (first, second):
        code, stdout, _ = outcome(process)
        assert (code, stdout) == (7, f"{root} [] part_java=1\n")
    assert builds(root) == 1

    # A copied checkout has an environment full of the old place's paths: it gets its own.
    copy = Path(shutil.copytree(root, tmp_path / "copy", symlinks=True))
    shutil.rmtree(root)
    code, stdout, stderr = outcome(start(copy))
    assert (code, stdout) == (7, f"{copy} [] part_java=1\n"), stderr


def test_killed_installation_is_repeated(tmp_path: Path) -> None:
    root = make_project(tmp_path / "checkout")
    (root / "wait").touch()
    killed = start(root)
    wait_for_build(root)
    os.killpg(killed.pid, signal.SIGKILL)
    killed.communicate(timeout=60)
    (root / "wait").unlink()
    code, stdout, stderr = outcome(start(root))
    assert (code, stdout) == (7, f"{root} [] part_java=1\n"), stderr
    assert builds(root) == 2


def test_launcher_installs_what_the_readme_runs() -> None:
    launcher = (TOOLS / "hrcplan").read_text()
    (extras,) = re.findall(r"^need_venv (.+)$", launcher, re.MULTILINE)
    # tools/hrcplan serve stands in README.md, tools/hrcplan lsp in docs/how-to/editors.md.
    assert {"planners", "studies", "web", "lsp"} <= set(extras.split(","))


def test_failed_installation_says_so_and_is_no_answer(tmp_path: Path) -> None:
    root = make_project(tmp_path / "checkout")
    (root / "constraints.txt").write_text("part_java==3\n")
    code, stdout, stderr = outcome(start(root))
    assert (code, stdout) == (126, "")
    assert "ERROR: " in stderr
    assert "part-java" in stderr
    assert len(stderr.splitlines()) <= 10
    assert "the next call tries again" in stderr
    assert not (root / ".venv" / "hrcplan-stamp").exists()


def test_verbose_shows_the_words_of_pip(tmp_path: Path) -> None:
    code, _, stderr = outcome(start(make_project(tmp_path / "checkout"), "plan", "--verbose"))
    assert code == 7
    assert "Looking in links" in stderr


def test_missing_venv_module_names_the_package(tmp_path: Path) -> None:
    root = make_project(tmp_path / "checkout")
    # As on Debian without that package: ensurepip is not there.
    (tmp_path / "ensurepip.py").write_text("raise ModuleNotFoundError('ensurepip')")
    python = tmp_path / "python"
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{tmp_path}" exec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    code, stdout, stderr = outcome(start(root, HRCPLAN_PYTHON=str(python)))
    assert (code, stdout) == (126, "")
    assert f"apt install python3.{sys.version_info.minor}-venv" in stderr
    assert not (root / ".venv").exists()


@pytest.mark.parametrize("python", ["/bin/false", "/no/such/python"])
def test_no_fitting_python_says_what_is_needed(tmp_path: Path, python: str) -> None:
    code, stdout, stderr = outcome(start(make_project(tmp_path / "c"), HRCPLAN_PYTHON=python))
    assert (code, stdout) == (126, "")
    assert "needs Python 3.11 or newer" in stderr
    assert python in stderr


def test_a_strangers_environment_is_left_alone(tmp_path: Path) -> None:
    root = make_project(tmp_path / "checkout")
    (root / ".venv").mkdir()
    (root / ".venv" / "precious").touch()
    code, _, stderr = outcome(start(root))
    assert code == 126
    assert "not made by this launcher" in stderr
    assert (root / ".venv" / "precious").exists()


@pytest.mark.parametrize(("forbidden", "expected"), [("1", 1), ("", 0)])
@pytest.mark.parametrize("options", [[], ["-n", "1"]])
def test_no_skips_mode_turns_a_skip_into_a_failure(
    tmp_path: Path, forbidden: str, expected: int, options: list[str]
) -> None:
    shutil.copy(Path(__file__).with_name("conftest.py"), tmp_path)
    (tmp_path / "test_skip.py").write_text(
        "import pytest\n\ndef test_good(): pass\n\n@pytest.mark.skip\ndef test_skipped(): pass\n"
    )
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options],
        cwd=tmp_path,
        env={**os.environ, "HRCPLAN_NO_SKIPS": forbidden},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert run.returncode == expected, run.stdout + run.stderr
    assert ("test_skip.py::test_skipped" in run.stdout) == bool(expected)
