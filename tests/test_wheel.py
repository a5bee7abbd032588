"""The wheel carries the PDDL, and an editable installation does not: there the checkout counts."""

import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

import hrcplan

ROOT = Path(__file__).parents[1]


def pddl_files() -> set[str]:
    return {
        path.relative_to(ROOT).as_posix()
        for folder in ("domains", "problems")
        for path in (ROOT / folder).rglob("*.pddl")
    }


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of what a wheel is built from, so that nothing is written into the checkout."""
    copy = tmp_path_factory.mktemp("checkout")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, copy)
    for name in ("hrcplan", "domains", "problems"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    return copy


def built(checkout: Path, hook: str, target: Path) -> set[str]:
    """Return the names inside the wheel that pip's own build hook makes."""
    code = f"import sys, hatchling.build; print(hatchling.build.{hook}(sys.argv[1]))"
    command = [sys.executable, "-c", code, str(target)]
    run = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True)
    with zipfile.ZipFile(target / run.stdout.split()[-1]) as wheel:
        return set(wheel.namelist())


def test_wheel_carries_code_types_and_pddl(checkout: Path, tmp_path: Path) -> None:
    names = built(checkout, "build_wheel", tmp_path)
    assert {"hrcplan/__init__.py", "hrcplan/cli/__init__.py", "hrcplan/py.typed"} <= names
    shipped = {name.removeprefix("hrcplan/_pddl/") for name in names if "/_pddl/" in name}
    assert shipped == pddl_files() != set()
    tops = {name.partition("/")[0] for name in names if ".dist-info/" not in name}
    assert tops == {"hrcplan"}


def test_metadata_has_no_relative_links(checkout: Path, tmp_path: Path) -> None:
    built(checkout, "build_wheel", tmp_path)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as file:
        (name,) = (name for name in file.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = file.read(name).decode()
    links = re.findall(r"\]\(([^)\s]+)", metadata)
    assert len(links) > 10
    assert not [link for link in links if not link.startswith(("https://", "#"))]
    assert "main/docs/images/two-boxes.svg" in metadata


def test_archives_hold_what_they_should_and_pass_twine(checkout: Path, tmp_path: Path) -> None:
    built(checkout, "build_wheel", tmp_path)
    code = "import sys, hatchling.build; print(hatchling.build.build_sdist(sys.argv[1]))"
    command = [sys.executable, "-c", code, str(tmp_path)]
    subprocess.run(command, cwd=checkout, capture_output=True, check=True)
    (sdist,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(sdist) as file:
        names = {name.partition("/")[2] for name in file.getnames()}
    assert {"pyproject.toml", "README.md", "LICENSE", "domains/kitchen.pddl"} <= names
    assert not [name for name in names if name.startswith((".ci", ".venv", ".github"))]
    archives = [str(sdist), *map(str, tmp_path.glob("*.whl"))]
    done = subprocess.run(
        [sys.executable, "-m", "twine", "check", "--strict", *archives],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout


def test_editable_installation_holds_no_copies(checkout: Path, tmp_path: Path) -> None:
    names = built(checkout, "build_editable", tmp_path)
    assert not [name for name in names if name.endswith((".pddl", ".py"))]


def test_package_and_project_name_the_same_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert hrcplan.__version__ == project["version"]
