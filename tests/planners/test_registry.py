"""Planners of other packages, found by their entry point."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from hrcplan.errors import MissingPlannerError
from hrcplan.planners import registry

PLANNER = """
from hrcplan.planners.contract import Answer, Capabilities, Status

class Lazy:
    card = Capabilities("lazy", "gives up at once", temporal=True)
    def missing(self):
        return None
    def solve(self, request):
        return Answer(Status.UNSOLVED, note="not in the mood")
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package installed by hand: a module, and the metadata that pip would write."""
    info = tmp_path / "lazy_planner-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lazy-planner\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[hrcplan.planners]\nlazy = lazy_planner:Lazy\nbroken = lazy_planner:Gone\n"
    )
    (tmp_path / "lazy_planner.py").write_text(PLANNER)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "lazy_planner", raising=False)
    return tmp_path


def test_an_installed_planner_has_a_name(package: Path) -> None:
    assert {"lazy", "exact", "kairos"} <= set(registry.names())
    assert registry.make("lazy").card.summary == "gives up at once"


def test_a_broken_entry_point_is_loud(package: Path) -> None:
    with pytest.raises(MissingPlannerError, match="'broken' cannot be loaded"):
        registry.make("broken")


def test_every_planner_of_ours_has_a_card() -> None:
    for name in registry.BUILT_IN:
        card = registry.make(name).card
        assert card.name == name
        assert card.metric in ("none", "cost", "cost+time")
