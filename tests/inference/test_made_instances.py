"""Instances that no planner has a part in: what tools/make_recognition.py writes is true."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from hrcplan.bank import build
from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference import infer

ROOT = Path(__file__).resolve().parents[2]
SETS = ROOT / "tests" / "data" / "recognition" / "instances.toml"


def make(folder: Path, *words: str, sets: Path = SETS) -> list[Path]:
    tool = ROOT / "tools" / "make_recognition.py"
    command = [sys.executable, str(tool), str(sets), "-o", str(folder), *words]
    subprocess.run(command, check=True, capture_output=True)
    return sorted(place.parent for place in folder.glob("*/*/obs.dat"))


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> list[Path]:
    """Two runs of a ferry, the first with a change of goal."""
    return make(tmp_path_factory.mktemp("made"), "-n", "1", "--only", "ferry", "--changes")


def test_an_unchanged_run_is_an_optimal_plan(runs):
    instance = read_instance(runs[1])
    assert json.loads((runs[1] / "change.json").read_text())["at"] is None
    bank = build(instance.goals.only([instance.goals.names[instance.true_goal]]))
    steps = [bank.table.find(words) for words in instance.observations]
    graph = bank.graphs[0]
    node = graph.after(steps)
    assert node is not None
    assert graph.is_goal[node]


def test_a_changed_run_ends_at_another_goal(runs):
    instance = read_instance(runs[0])
    change = json.loads((runs[0] / "change.json").read_text())
    assert change["to"] == instance.true_goal != change["from"]
    assert 0 < change["at"] < len(instance.observations)
    task, state = instance.goals.task, instance.goals.task.initial
    for words in instance.observations:
        (action,) = task.find(words[0], words[1:])
        assert task.is_applicable(state, action)
        state = task.successor(state, action)
    assert instance.goals.is_reached(change["to"], state)


def test_the_same_arguments_write_the_same_files(runs, tmp_path):
    for place in make(tmp_path, "-n", "1", "--only", "ferry", "--changes"):
        for path in place.iterdir():
            twin = runs[0].parent / place.name / path.name
            assert path.read_bytes() == twin.read_bytes()


def test_hidden_actions_are_not_observed_and_the_goal_is_seen_none_the_less(tmp_path):
    """Only the ferry is seen, not the cars; that some actions are unobserved explains it."""
    for name in ("ferry.pddl", "ferry-harbour.pddl"):
        (tmp_path / name).write_text((SETS.parent / name).read_text())
    sets = tmp_path / "sets.toml"
    table = ('[ferry]', 'problem = "ferry-harbour.pddl"', 'goals = ["at"]', "facts = 2",
             'hidden = ["board", "debark"]')  # fmt: skip
    sets.write_text("\n".join(table))
    (place,) = make(tmp_path, "-n", "1", sets=sets)
    instance = read_instance(place)
    assert {words[0] for words in instance.observations} == {"sail"}
    rows = [infer(str(place), unobserved=p).posterior[-1] for p in (0.0, 0.5)]
    assert rows[1][instance.true_goal] > rows[0][instance.true_goal]
