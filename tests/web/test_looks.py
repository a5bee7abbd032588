"""Files to look at: every kind has a page, and nothing else is read."""

import json
import re
from functools import cache
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from hrcplan import plan
from hrcplan.bank import build_bank, save
from hrcplan.cli.allocation import as_json
from hrcplan.errors import HrcplanError, InputError
from hrcplan.execution.execute import execute
from hrcplan.pddl.inputs import read
from hrcplan.planners.allocation import diagram
from hrcplan.plans import format_plan
from hrcplan.web.looks import look_files, look_page


def saved_rows(page: str) -> list[list[str]]:
    """Return the table that the button CSV of a picture saves."""
    match = re.search('data-rows="([^"]*)"', page)
    assert match is not None
    rows: list[list[str]] = json.loads(unescape(match[1]))
    return rows


def write_plan(folder: Path) -> Path:
    result = plan("transport/two-boxes").plan
    assert result is not None
    path = folder / "two.plan"
    path.write_text(format_plan(result))
    return path


def test_a_plan_is_shown_with_its_costs(tmp_path: Path) -> None:
    page = look_page(look_files([write_plan(tmp_path)])[0])
    assert "valid: cost 24, metric 58.00051, makespan 200.003" in page
    assert "(grasp human blue wp4)" in page
    assert '"action": "place"' in page


def test_a_plan_that_fails_says_why(tmp_path: Path) -> None:
    path = write_plan(tmp_path)
    path.write_text("\n".join(path.read_text().splitlines()[:-1]))
    assert "not valid: the goal" in look_page(look_files([path])[0])


def test_a_plan_of_nothing_that_is_known_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.plan"
    path.write_text("(fly moon)")
    with pytest.raises(InputError, match="no problem"):
        look_page(look_files([path])[0])


def test_a_journal_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    execute("transport/two-boxes", journal=path)
    file = look_files([tmp_path])[0]
    assert file.kind == "journal"
    assert "goal reached" in look_page(file)


def test_a_bank_is_shown_with_chains_and_cliques(tmp_path: Path) -> None:
    bank = build_bank("transport", "transport-goals")
    path = tmp_path / "w.bank"
    save(bank, path)
    file = look_files([path])[0]
    assert file.kind == "bank"
    page = look_page(file)
    assert all(name in page for name in bank.names)
    page = look_page(file, bank.names[0])
    assert "<svg" in page
    assert "/static/dom.js" in page
    assert saved_rows(page)[:2] == [["steps", "states"], ["0", "1"]]
    with pytest.raises(HrcplanError):
        look_page(file, "<b>")


def test_a_damaged_bank_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "w.bank"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError):
        look_page(look_files([path])[0])


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        look_files([tmp_path / "nothing"])


def test_links_out_of_a_folder_are_not_followed(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (tmp_path / "secret.plan").write_text("(a b)")
    (folder / "link.plan").symlink_to(tmp_path / "secret.plan")
    assert look_files([folder]) == []


def test_the_report_of_a_study_is_shown(tmp_path: Path) -> None:
    (tmp_path / "report.html").write_text("<!DOCTYPE html><title>report</title>")
    file = look_files([tmp_path])[0]
    assert (file.kind, "report" in look_page(file)) == ("study", True)


@cache
def diagram_text() -> str:
    problem = read("transport", "two-boxes")
    return json.dumps(as_json(diagram(problem, ("motivation", "human"))), indent=2)


def diagram_document() -> dict[str, Any]:
    document: dict[str, Any] = json.loads(diagram_text())
    return document


def test_an_allocation_diagram_is_shown(tmp_path: Path) -> None:
    path = tmp_path / "who.json"
    path.write_text(diagram_text())
    (file,) = look_files([tmp_path])
    assert file.title == "allocation who.json"
    page = look_page(file)
    assert "now 1; flips at 9.5" in page
    assert "(move robot wp0 wp3)" in page
    assert saved_rows(page)[:2] == [
        ["from", "to", "human", "robot", "metric at 0", "per unit"],
        ["0", "9.5", "4", "4", "54", "4"],
    ]


def test_names_in_an_allocation_diagram_are_text(tmp_path: Path) -> None:
    document = diagram_document()
    document["element"] = "<b>x"
    for piece in document["pieces"]:
        piece["n_actions"] = {'"><script>': 1}
        piece["plan"] = ["<i>"]
    path = tmp_path / "who.json"
    path.write_text(json.dumps(document))
    page = look_page(look_files([path])[0])
    assert not any(markup in page for markup in ("<b>", "<i>", '"><script>'))


@pytest.mark.parametrize(
    ("key", "value"),
    [("from", "0"), ("to", float("nan")), ("to", -1), ("from", 10**400), ("slope", None),
     ("n_actions", {"robot": -1}), ("n_actions", 3), ("plan", "x"), ("from", 0.5)],
)  # fmt: skip
def test_a_damaged_allocation_diagram_is_an_error(tmp_path: Path, key: str, value: object) -> None:
    document = diagram_document()
    document["pieces"][-1][key] = value
    path = tmp_path / "who.json"
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match="no allocation diagram"):
        look_page(look_files([path])[0])
