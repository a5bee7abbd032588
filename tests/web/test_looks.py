"""Files to look at: every kind has a page, and nothing else is read."""

from pathlib import Path

import pytest

from hrcplan import plan
from hrcplan.bank import build_bank, save
from hrcplan.errors import HrcplanError, InputError
from hrcplan.execution.execute import execute
from hrcplan.plans import format_plan
from hrcplan.web.looks import look_files, look_page


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
    assert "<svg" in look_page(file, bank.names[0])
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
