"""Steps of real people as PDDL and traces; the reader of annotations that are not part of this."""

import json
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference import infer

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "real_traces.py"
FIRST = "nusar_9011-a01_9011_user_id.csv"
TOYS = {
    FIRST: "0,10,attach,chassis,wheel,correct,\n10,20,attach,cabin,chassis,mistake,wrong order\n"
    "20,30,detach,cabin,chassis,correction,\n30,40,attach,cabin,chassis,correct,\n",
    "nusar_9012-a01_9012_user_id.csv": "0,9,attach,wheel,chassis,correct,\n"
    "9,20,attach,chassis,cabin,correct\n",  # some lines have no remark
    "nusar_9013-b02_9013_user_id.csv": "0,9,inspect,wheel,chassis,correct,\n"
    "9,20,attach,wheel,chassis,correct,\n20,31,attach,crane arm,chassis,correct,\n",
    "readme.csv": "no,toy\n",
}


def call(kind, source, target, *words):
    command = [sys.executable, str(TOOL), kind, str(source), "-o", str(target), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def cooks(tmp_path_factory):
    """The recordings of this repository, as PDDL and traces."""
    target = tmp_path_factory.mktemp("cooks")
    assert call("captaincook4d", ROOT / "tests/data/captaincook4d", target).returncode == 0
    return target


def test_every_recording_is_a_trace_of_one_of_the_recipes(cooks):
    truth = json.loads((cooks / "truth.json").read_text())
    assert len(truth["goals"]) == len(read_instance(cooks).goals) == 24
    assert len(truth["recordings"]) == 384
    assert all((cooks / f"{name}.jsonl").is_file() for name in truth["recordings"])


@pytest.mark.parametrize("recording", ["1_7", "8_3"])
def test_what_a_person_cooks_is_inferred(cooks, recording):
    true = json.loads((cooks / "truth.json").read_text())["recordings"][recording]
    inference = infer(cooks, cooks / f"{recording}.jsonl")
    assert inference.posterior[-1][true] > 0.9
    assert inference.changed is not None
    assert inference.changed < 0.5


def test_mistake_annotations_are_read(tmp_path):
    source, target = tmp_path / "annotations", tmp_path / "out"
    source.mkdir()
    for name, text in TOYS.items():
        (source / name).write_text(text)
    assert call("assembly101", source, target).returncode == 0
    truth = json.loads((target / "truth.json").read_text())
    assert truth["goals"] == ["a01", "b02"]
    inference = infer(target, target / f"{Path(FIRST).stem}.jsonl")
    assert inference.actions[1:3] == (
        "(attach human cabin chassis)", "(detach human cabin chassis)",
    )  # fmt: skip
    assert inference.ignored == ()
    assert inference.posterior[-1][0] > inference.posterior[-1][1]


def test_a_file_with_other_columns_is_named(tmp_path):
    (tmp_path / FIRST).write_text("0,10,attach\n")
    found = call("assembly101", tmp_path, tmp_path / "out")
    assert found.returncode == 3
    assert "3 columns" in found.stderr


def test_what_comes_before_is_followed_through():
    closure = runpy.run_path(str(TOOL))["closure"]
    assert closure("abc", [("a", "b"), ("b", "c")]) == {"a": set(), "b": {"a"}, "c": {"a", "b"}}
