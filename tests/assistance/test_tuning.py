"""The tool that tunes assistants, on a few goals made by chance."""

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from hrcplan.inference.recursive import Attractor, Needed

TOOL = Path(__file__).parents[2] / "tools" / "tune_changed_mind.py"


@pytest.fixture(scope="module")
def tool():
    spec = spec_from_file_location("tune_changed_mind", TOOL)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(tool, monkeypatch, capsys, *words):
    small = ["--goals", "4", "--seeds", "1", "--episodes", "3"]
    monkeypatch.setattr(sys, "argv", ["tune", *words, *small])
    assert tool.main() == 0
    return capsys.readouterr().out.splitlines()[4:]


def test_all_combinations_are_tried(tool):
    found = tool.combinations(
        ["stay=.8,.9", "likelihood=Needed(.1),Attractor(2)", "rates=(.1,),()"]
    )
    assert len(found) == 8
    assert found[0] == {"stay": 0.8, "likelihood": Needed(0.1), "rates": (0.1,)}
    assert found[-1] == {"stay": 0.9, "likelihood": Attractor(2), "rates": ()}


@pytest.mark.parametrize(
    "words",
    [
        ("recursive", "--set", "stay=.9,.5", "--set", "likelihood=Next(.1)"),
        ("hrcplan", "--set", "waste_price=.05,100", "--by", "waste"),
        ("hrcplan", "--chains", "--human", "habit", "inertia", "--set", "hazard=.1,.6"),
    ],
)
def test_settings_are_listed_the_best_first(tool, monkeypatch, capsys, words):
    rows = run(tool, monkeypatch, capsys, *words)
    scores = [float(row.split()[0]) for row in rows]
    assert len(rows) == 2
    assert scores == sorted(scores, reverse="waste" not in words)
    assert rows[0].split()[1:4] == ["0.00", "±", "0.00"]


def test_the_same_setting_meets_the_same_humans(tool, monkeypatch, capsys):
    rows = run(tool, monkeypatch, capsys, "recursive", "--set", "stay=.9,.9")
    assert rows[0] == rows[1]


def test_an_unknown_setting_is_refused(tool, monkeypatch, capsys):
    with pytest.raises(SystemExit, match="neither recursive nor its belief has 'hope'"):
        run(tool, monkeypatch, capsys, "recursive", "--set", "hope=1")
