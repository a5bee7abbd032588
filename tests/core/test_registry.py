"""One rule finds every part: built-in names, entry points, prefixes, then ``module:Class``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Protocol, runtime_checkable

import pytest

from hrcplan.assistance import ASSISTANTS
from hrcplan.core.registry import ObjectRegistry, PartNames, Registry, members, methods
from hrcplan.episodes.humans import HUMANS
from hrcplan.episodes.worlds import WORLDS
from hrcplan.errors import UsageError
from hrcplan.execution.natures import NATURES
from hrcplan.inference.registry import METHODS
from hrcplan.planners.registry import PLANNERS
from hrcplan.studies.study import STUDIES

REGISTRIES: dict[str, PartNames] = {
    "planner": PLANNERS,
    "belief": METHODS,
    "assistant": ASSISTANTS,
    "human": HUMANS,
    "nature": NATURES,
    "world": WORLDS,
    "study": STUDIES,
}


@runtime_checkable
class Tool(Protocol):
    """A part that only these tests know."""

    size: int

    @property
    def colour(self) -> str: ...

    def use(self) -> str: ...


TOOLS: Registry[[], Tool] = Registry(
    "tool", {}, "hrcplan.tests.tools", Tool, prefixes={"sharp": "builtins:str"}
)

GOOD = "class Saw:\n    size = 3\n    colour = 'red'\n    def use(self): return 'cuts'\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty current folder; modules that are imported from it are forgotten afterwards."""
    monkeypatch.chdir(tmp_path)
    before = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - before:
        del sys.modules[name]


@pytest.mark.parametrize("registry", REGISTRIES.values(), ids=list(REGISTRIES))
def test_every_built_in_part_keeps_its_protocol(registry: Registry | ObjectRegistry) -> None:
    for name in registry.built_in:
        assert registry.find(name) is registry.find_listed(name)


@pytest.mark.parametrize("registry", REGISTRIES.values(), ids=list(REGISTRIES))
def test_an_unknown_name_has_one_kind_of_error(registry: Registry | ObjectRegistry) -> None:
    for find in (registry.find, registry.find_listed):
        with pytest.raises(UsageError, match="there is no ") as error:
            find("zzz")
        assert error.value.code == f"unknown-{registry.kind}"
        assert error.value.hint is not None


def test_a_module_of_the_current_folder_is_found_and_the_path_is_as_before(folder: Path) -> None:
    (folder / "toolbox.py").write_text("import toolhelper\n" + GOOD)
    (folder / "toolhelper.py").write_text("")
    path = list(sys.path)
    assert TOOLS.make("toolbox:Saw").use() == "cuts"
    assert sys.path == path


def test_an_installed_module_wins_over_the_current_folder(folder: Path) -> None:
    """Also its own imports never see the current folder."""
    (folder / "graphlib.py").write_text("raise SystemExit('shadowed')")
    sys.modules.pop("graphlib", None)
    with pytest.raises(UsageError, match="is no tool"):
        TOOLS.find("graphlib:TopologicalSorter")


@pytest.mark.parametrize(
    ("text", "name", "message", "hint"),
    [
        (None, "toolbox:Saw", "there is no module 'toolbox'", "in the current folder|and in '"),
        (None, "toolbox.py:Saw", "there is no module", "toolbox:Saw"),
        (GOOD, "toolbox:Sav", "has no 'Sav'", "'Saw'"),
        (GOOD, "toolbox.inner:Saw", "there is no module 'toolbox.inner'", "looked among"),
        ("import no_such_package", "toolbox:Saw", "No module named 'no_such_package'", "python"),
        ("1 / 0", "toolbox:Saw", "ZeroDivisionError", "python"),
        ("class Saw(", "toolbox:Saw", "SyntaxError", "python"),
        ("raise SystemExit(3)", "toolbox:Saw", "SystemExit: 3", "python"),
        ("def Saw(): pass", "toolbox:Saw", "is no class", None),
        ("class Saw: pass", "toolbox:Saw", "it has no use", "see Tool"),
        ("class Saw:\n def use(self): pass", "toolbox:Saw", "it has no size, colour", "see Tool"),
    ],
)
def test_a_part_that_is_none_is_named_with_a_hint(
    folder: Path, text: str | None, name: str, message: str, hint: str | None
) -> None:
    if text is not None:
        (folder / "toolbox.py").write_text(text)
    with pytest.raises(UsageError, match=message) as error:
        TOOLS.make(name)
    assert error.value.code in ("unknown-tool", "not-a-tool")
    if hint is not None:
        assert error.value.hint is not None
        assert any(part in error.value.hint for part in hint.split("|"))


def test_a_data_file_cannot_load_code(folder: Path) -> None:
    (folder / "toolbox.py").write_text("raise SystemExit('code of a data file')")
    for registry in REGISTRIES.values():
        with pytest.raises(UsageError, match="a file cannot name the") as error:
            registry.find_listed("toolbox:Saw")
        assert error.value.code == f"unknown-{registry.kind}"
    with pytest.raises(UsageError, match="a file cannot name the planner 'cmd:touch gone'"):
        PLANNERS.find_listed("cmd:touch gone")
    assert PLANNERS.find_listed("up:pyperplan")().card.name == "up:pyperplan"


def test_a_prefix_makes_a_part_from_the_rest_of_the_name() -> None:
    registry: Registry[[], str] = Registry("text", {}, "-", str, prefixes={"say": "builtins:str"})
    assert registry.make("say:a:b") == "a:b"
    with pytest.raises(UsageError, match="there is no text 'say:'"):
        registry.make("say:")


def test_an_earlier_name_still_works_and_says_so() -> None:
    registry: Registry[[], str] = Registry(
        "text", {"new": "builtins:str"}, "-", str, aliases={"old": "new"}
    )
    with pytest.warns(DeprecationWarning, match="text 'old' is deprecated; its name is 'new'"):
        assert registry.make("old") == ""
    assert registry.names() == ["new"]


def test_what_a_protocol_requires() -> None:
    assert members(Tool) == ["size", "colour", "use"]
    assert methods(Tool) == ["use"]


def test_the_installed_command_finds_a_planner_in_the_current_folder(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from hrcplan.planners.contract import Answer, Capabilities, Status\n"
        "class Lazy:\n"
        "    card = Capabilities('lazy', 'gives up', temporal=True)\n"
        "    def missing(self): return None\n"
        "    def solve(self, request): return Answer(Status.UNSOLVED)\n"
    )
    program = str(Path(sys.executable).parent / "hrcplan")
    arguments = ["plan", "transport", "two-boxes", "--planner"]

    def call(planner: str) -> tuple[int, str]:
        done = subprocess.run(
            [program, *arguments, planner], cwd=tmp_path, check=False,
            capture_output=True, text=True,
        )  # fmt: skip
        return done.returncode, done.stdout + done.stderr

    code, text = call("mine:Lazy")
    assert "(lazy, " in text
    assert code != 2
    code, text = call("mine:Busy")
    assert code == 2
    assert "has no 'Busy'" in text
    assert "Traceback" not in text
