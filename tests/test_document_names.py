"""Modules, files, classes and constants that documents name in backticks exist."""

from __future__ import annotations

import ast
import builtins
import re
from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest

from tests.test_architecture import MODULES, PACKAGE, ROOT, TREES

DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
CODE_BLOCK = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
DOTTED = re.compile(r"hrcplan(?:\.\w+)+")
CLASS = re.compile(r"([A-Z][a-z]\w*)(?:\.(\w+))?")
CALL = re.compile(r"\.?([a-z_]\w+)\([^()]*\)")
CONSTANT = re.compile(r"[A-Z][A-Z_]+[A-Z]")
PYTHON_FILE = re.compile(r"[\w/*-]+\.py")
FOLDER = re.compile(r"[\w-]+(?:/[\w-]+)*/")
OLD_NAME = re.compile(r"^\|[^|]*\|([^|]*)\| (?:gone|works).*\|$", re.MULTILINE)
TITLE = re.compile(r"^```\w+ title=\"([^\"]+)\"$", re.MULTILINE)
SOURCE = "\n".join(path.read_text("utf-8") for path in MODULES.values())


def members() -> dict[str, set[str]]:
    """Return the top-level names of the package, each with what classes of that name define."""
    names: dict[str, set[str]] = defaultdict(set)
    for tree in TREES.values():
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                names[node.name] |= set(bound(node.body))
            for name in bound([node]):
                names[name] |= set()
    return names


def bound(body: list[ast.stmt]) -> Iterator[str]:
    """Yield the names that statements define."""
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, ast.Assign):
            yield from (name.id for target in node.targets for name in ast.walk(target)
                        if isinstance(name, ast.Name))  # fmt: skip
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id


NAMES = members()


def is_defined(dotted: str) -> bool:
    """Whether ``hrcplan.a.b`` is a module, or a name in one."""
    words = dotted.split(".")
    for n in range(len(words), 0, -1):
        if ".".join(words[:n]) in MODULES:
            value: object = import_module(".".join(words[:n]))
            for word in words[n:]:
                if word not in dir(value) and word not in getattr(value, "__all__", ()):
                    return False
                value = getattr(value, word)
            return True
    return False


def is_file(name: str) -> bool:
    """Whether there is a file or folder of a name; one without a folder may be in any."""
    if "/" not in name.rstrip("/"):
        return any(PACKAGE.rglob(name)) or (ROOT / name).exists()
    return any((base / name).exists() for base in (ROOT, PACKAGE, ROOT / "docs"))


def fault(word: str) -> str | None:
    """Return what a document says that is not there; None if it is, or is no name."""
    if DOTTED.fullmatch(word):
        return None if is_defined(word) else f"no {word}"
    if (match := CLASS.fullmatch(word)) is not None:
        name, member = match.groups()
        if name not in NAMES and name not in dir(builtins):
            return f"no class {name}"
        return None if member is None or member in NAMES[name] else f"{name} has no {member}"
    if CONSTANT.fullmatch(word):
        is_used = re.search(rf"\b{word}\b", SOURCE)  # also variables of the shell
        return None if is_used or word.startswith("PYTHON") else f"no constant {word}"
    if (match := CALL.fullmatch(word)) is not None:
        name = match[1]
        is_function = re.search(rf"\bdef {name}\(|\b{name}: ", SOURCE)
        return None if is_function or name in dir(builtins) else f"no function {name}"
    if PYTHON_FILE.fullmatch(word) or FOLDER.fullmatch(word):
        return None if is_file(word) else f"no file {word}"
    return None


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: d.relative_to(ROOT).as_posix())
def test_names_in_backticks_exist(document: Path) -> None:
    text = document.read_text("utf-8")
    names = re.findall(r"`([^`\n]+)`", OLD_NAME.sub(r"\1", CODE_BLOCK.sub("", text)))
    faults = {name: fault(name) for name in names if name not in TITLE.findall(text)}
    assert {name: what for name, what in faults.items() if what is not None} == {}


@pytest.mark.parametrize(
    "word",
    ["hrcplan.plann", "hrcplan.testing.check_all", "Plann", "Plan.rowss", "PLANNERSS", "modl.py",
     "execution/modl.py", "executions/", "hrcplan.planners.solve.solv", "solv(problem)"],
)  # fmt: skip
def test_a_name_that_does_not_exist_is_a_fault(word: str) -> None:
    assert fault(word) is not None


@pytest.mark.parametrize(
    "word",
    ["hrcplan.plan", "hrcplan.testing.check_plan", "Plan", "Plan.rows", "PLANNERS", "model.py",
     "execution/model.py", "execution/", "hrcplan.planners.solve", "solve(problem)", "a word"],
)  # fmt: skip
def test_a_name_that_exists_is_none(word: str) -> None:
    assert fault(word) is None
