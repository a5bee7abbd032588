"""The promised names are there, are what they say, and cost nothing until they are used."""

from __future__ import annotations

import subprocess
import sys

import pytest

import hrcplan


def test_all_names_resolve() -> None:
    assert set(hrcplan.__all__) == set(hrcplan._HOMES)
    for name in hrcplan.__all__:
        assert getattr(hrcplan, name).__name__ == name
    assert set(hrcplan.__all__) <= set(dir(hrcplan))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = hrcplan.nonsense


def test_importing_the_package_imports_nothing_else() -> None:
    code = "import sys, hrcplan; print([m for m in sys.modules if m.startswith('hrcplan.')])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_problem_added_a_second_ago_is_seen_and_planned() -> None:
    from hrcplan.pddl import library

    folder = library.root() / "problems" / "transport"
    added = folder / "added-just-now.pddl"
    text = (folder / "two-boxes.pddl").read_text(encoding="utf-8")
    added.write_text(text.replace("(problem two-boxes)", "(problem added-just-now)"), "utf-8")
    try:
        assert "added-just-now" in library.problem_names("transport")
        assert hrcplan.plan("transport", "added-just-now").report.cost == 24
    finally:
        added.unlink()
