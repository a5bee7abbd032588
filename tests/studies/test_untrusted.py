"""Rows, scripts and journals are data: they cannot choose which code runs."""

from __future__ import annotations

import json
import sqlite3
import sys
from pathlib import Path

import pytest

from hrcplan.errors import UsageError
from hrcplan.execution.execute import execute
from hrcplan.studies import report_study, run_study
from hrcplan.studies.changed_mind import scenario, script

TRAP = "raise SystemExit('code of the current folder')\n"
WORKSHOP = Path(__file__).parent / "workshop"
TASK = {"domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP)}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "trap.py").write_text(TRAP)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_rows_cannot_name_a_study_of_their_own(folder: Path) -> None:
    run_study(
        "changed-mind", folder / "out", runs=1, limit=1, options={**TASK, "methods": "oracle"}
    )
    assert report_study(folder / "out", "changed-mind")["study"] == "changed-mind"
    with sqlite3.connect(folder / "out" / "rows.sqlite") as rows:
        rows.execute("update about set value=? where key='study'", (json.dumps("trap:STUDY"),))
    with pytest.raises(UsageError, match="a file cannot name the study 'trap:STUDY'"):
        report_study(folder / "out")
    with pytest.raises(UsageError, match="the rows are of the study 'trap:STUDY'"):
        report_study(folder / "out", "changed-mind")
    assert "trap" not in sys.modules


def test_a_script_cannot_name_a_method_of_its_own(folder: Path) -> None:
    text = (scenario.HERE / "golden.toml").read_text(encoding="utf-8")
    text = "\n".join(line for line in text.splitlines() if not line.startswith("methods"))
    (folder / "script.toml").write_text(text + '\nmethods = ["trap:Robot"]\n')
    with pytest.raises(UsageError, match="a file cannot name the method 'trap:Robot'"):
        script.episodes(script.read("script.toml"))
    assert "trap" not in sys.modules


@pytest.mark.parametrize("planner", ["trap:Planner", "cmd:touch trapped"])
def test_a_journal_cannot_name_a_planner_of_its_own(folder: Path, planner: str) -> None:
    journal = folder / "run.jsonl"
    execute("transport", "handover", journal=journal)
    first, *rest = journal.read_text().splitlines()
    assert '"planners": ["auto"]' in first or '"planners":["auto"]' in first
    journal.write_text("\n".join([first.replace('["auto"]', json.dumps([planner])), *rest[:5], ""]))
    with pytest.raises(UsageError, match="a file cannot name the planner"):
        execute("transport", "handover", journal=journal, resume=True)
    assert "trap" not in sys.modules
    assert not (folder / "trapped").exists()
