"""``hrcplan allocation``: the table, the document, and what it says to mistakes."""

import json

import pytest
from click.testing import CliRunner

from hrcplan.cli import output
from hrcplan.cli.allocation import command


@pytest.fixture(autouse=True)
def words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output, "JSON", False)


def run(*args: str) -> str:
    found = CliRunner().invoke(command, args, standalone_mode=False)
    assert found.exception is None, found.exception
    return found.output


def test_the_table_says_where_it_flips() -> None:
    text = run("transport/two-boxes", "motivation human")
    assert text.startswith("transport/two-boxes: who does how much")
    assert "  0 … 9.5           4      4      54 + 4 v" in text
    assert text.endswith("flips at 9.5; now 1, so it may move by 8.5\n")


def test_the_document() -> None:
    value = json.loads(run("transport", "two-boxes", "(motivation human)", "--json"))
    assert {k: value[k] for k in ("element", "value", "flips", "radius", "stays_best")} == {
        "element": "motivation human", "value": 1, "flips": [9.5], "radius": 8.5,
        "stays_best": [0, 9.5],
    }  # fmt: skip
    assert [(p["from"], p["to"], p["n_actions"]) for p in value["pieces"]] == [
        (0, 9.5, {"human": 4, "robot": 4}), (9.5, 10, {"human": 0, "robot": 8})]  # fmt: skip
    assert len(value["pieces"][1]["plan"]) == 8


def test_set_and_range() -> None:
    text = run("transport/two-boxes", "motivation human", "--set", "knowledge human=4",
               "--range", "0", "7")  # fmt: skip
    assert "flips at 6.5; now 1, so it may move by 5.5" in text
    text = run("transport/two-boxes", "motivation human", "--range", "0", "7")
    assert text.endswith("now 1: one allocation is best throughout\n")
