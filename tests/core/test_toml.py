"""TOML of users: damaged files, wrong types and absurd numbers are errors of the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrcplan.agents import load_profile
from hrcplan.errors import InputError, UsageError
from hrcplan.studies.changed_mind import scenario, script

GOLDEN = (scenario.HERE / "golden.toml").read_bytes()
DEEP = b"[" * 5000 + b"]" * 5000
DAMAGED = {
    "deep": b"x = " + DEEP,
    "latin-1": b'x = "\xff"',
    "nul": b'x = "\0"',
    "digits": b"x = " + b"9" * 10_000,
    "cut": GOLDEN[:200],
    "large": b"#" + b"x" * (1 << 21),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_toml_is_named(name: str, tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_bytes(DAMAGED[name])
    for reading in (load_profile, script.read):
        with pytest.raises(InputError) as caught:
            reading(str(path))
        assert caught.value.path == str(path)


@pytest.mark.parametrize(
    "text",
    [
        "p = 3",
        "p = []",
        "[p]\nscale = nan",
        "[p]\nscale = 1e400\ncap = inf",
        "[p]\nscale = true",
        '[p]\ncap = "60"',
        "[p]\nreplan_limit = 2.5",
        "[p]\nreplan_limit = true",
        "[p]\nmemory = 1",
        "[p]\nvalues = []",
        "[p]\nvalues = {}",
        "[p]\nreplan = 1979-05-27",
        "[p]\nname = 3",
        "[p]\nname = []",
        "",
    ],
)
def test_a_profile_of_wrong_types_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(text)
    with pytest.raises(InputError):
        load_profile(str(path))


def test_a_whole_number_stands_for_a_float(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text("[mine]\nscale = 20\n")
    assert load_profile(str(tmp_path / "own.toml")).scale == 20


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("title", "1979-05-27"),
        ("title", "3"),
        ("domain", "1.5"),
        ("domain", '"a\\u0000b/c"'),
        ("domain", '"' + "a" * 300 + '"'),
        ("methods", '["os:getcwd"]'),
        ("methods", '["this:s"]'),
        ("methods", "[]"),
        ("methods", "[1]"),
        ("wanted", "3"),
        ("wanted", '["nosuch"]'),
        ("change_turns", "[1.5]"),
        ("change_turns", "[true]"),
        ("human", '["(nosuch)"]'),
        ("human", "[[]]"),
    ],
)
def test_a_script_of_wrong_values_is_refused(key: str, value: str, tmp_path: Path) -> None:
    lines = [f"{key} = {value}"]
    depth = 0
    for line in GOLDEN.decode().splitlines():
        begins = depth == 0 and line.startswith(f"{key} =")
        if not begins and depth == 0:
            lines.append(line)
            continue
        depth += line.count("[") - line.count("]")
    path = tmp_path / "own.toml"
    path.write_text("\n".join(lines))
    with pytest.raises((InputError, UsageError)):
        script.episodes(script.read(str(path)))
