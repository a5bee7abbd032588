"""The page on migration is true: names that still work, and what becomes of older files."""

from __future__ import annotations

import ast
import json
import re
import sqlite3
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

import hrcplan
from hrcplan.agents.profile import OLD_NAMES as OLD_PROFILES
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.bank import Bank, load
from hrcplan.bank import store as bank_store
from hrcplan.collaboration.journal import FORMAT as COLLABORATION_FORMAT
from hrcplan.errors import InputError, UsageError
from hrcplan.execution.journal import FORMAT, read_journal
from hrcplan.execution.natures import OLD_NAMES as OLD_HUMANS
from hrcplan.inference.classifier import cache
from hrcplan.studies import report_study, run_study
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.episodes import GROWN
from hrcplan.studies.study import STUDIES
from tests.schema import REFERENCE

ROOT = Path(__file__).resolve().parent.parent
TEXT = (REFERENCE / "migration.md").read_text("utf-8")
JOURNAL = ROOT / "tests" / "data" / "journals" / "version-0.1.jsonl"
ROWS = [[cell.strip() for cell in line.strip("|").split(" | ")]
        for line in TEXT.splitlines() if line.startswith("| ")]  # fmt: skip
RENAMED_ATTRIBUTE = re.compile(r"^    (\w+) = Renamed\(\"(\w+)\"\)", re.MULTILINE)


def old_names() -> Iterator[tuple[str, str]]:
    """Yield each old name that the code takes, with the present one."""
    yield from ((f"hrcplan.{old}", new) for old, (*_, new) in hrcplan._DEPRECATED.items())
    for table in (OLD_PROFILES, OLD_HUMANS, ASSISTANTS.aliases):
        yield from table.items()
    for study in map(STUDIES.find, STUDIES.built_in):
        yield from (pair for table in study.renamed.values() for pair in table.items())
    for path in sorted((ROOT / "hrcplan").rglob("*.py")):
        text = path.read_text("utf-8")
        yield from RENAMED_ATTRIBUTE.findall(text)
        for node in ast.walk(ast.parse(text)) if "warn_old_name(" in text else ():
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "warn_old_name":
                old, new = node.args[1:3]
                if isinstance(old, ast.Constant) and isinstance(new, ast.Constant):
                    yield str(old.value), str(new.value)


def test_every_old_name_is_on_the_page() -> None:
    names = set(old_names())
    assert len(names) > 10
    for old, new in names:
        rows = [row for row in ROWS if re.search(rf"`{re.escape(old)}\b", row[0])]
        assert any(f"`{new}" in row[1] for row in rows), f"{old} is now {new}"


def test_the_formats_of_the_page_are_those_of_the_code() -> None:
    table = TEXT.partition("## Formats")[2]
    versions = dict(re.findall(r"^\| ([^|]+) \| (\d+) \|", table, re.MULTILINE))
    assert {name: int(version) for name, version in versions.items()} == {
        "journals of runs": FORMAT,
        "journals of collaborations": COLLABORATION_FORMAT,
        "banks of sequences": bank_store.VERSION,
        "banks of team plans": bank_store.TEAM_VERSION,
        "trained forests": cache.VERSION,
        "rows of `changed-mind`": scenario.ROW_FORMAT,
    }


def test_a_journal_of_another_format_is_refused(tmp_path: Path) -> None:
    assert read_journal(JOURNAL).setup().world == "simulated"
    first, *others = JOURNAL.read_text("utf-8").splitlines()
    later_format = max(FORMAT, COLLABORATION_FORMAT) + 1
    later = json.dumps({**json.loads(first), "journal": later_format})
    (tmp_path / "later.jsonl").write_text("\n".join([later, *others, ""]))
    with pytest.raises(
        InputError, match=f"format {later_format}; that of a run has format 1"
    ) as error:
        read_journal(tmp_path / "later.jsonl").setup()
    assert error.value.code in TEXT


def test_a_bank_of_another_format_is_refused(tmp_path: Path, workshop: Bank, hall: Bank) -> None:
    for bank, version in ((workshop, bank_store.VERSION), (hall, bank_store.TEAM_VERSION)):
        bank_store.save(bank, tmp_path / "a.bank")
        data = (tmp_path / "a.bank").read_bytes()
        assert data[8:12] == struct.pack("<I", version)
        (tmp_path / "a.bank").write_bytes(data[:8] + struct.pack("<I", 3) + data[12:])
        with pytest.raises(InputError, match="format 3; this hrcplan reads 1 and 2") as error:
            load(tmp_path / "a.bank")
        assert error.value.code in TEXT


def test_rows_of_another_version_are_reported_and_not_added_to(tmp_path: Path) -> None:
    assert all(f"`{column}`" in TEXT for column in GROWN)
    folder = ROOT / "tests" / "studies" / "fetch"
    options = {"domain": str(folder / "domain.pddl"), "problem": str(folder / "four-items.pddl")}
    run_study("failure-anticipation", tmp_path, options=options, limit=1)
    with sqlite3.connect(tmp_path / "rows.sqlite") as file:
        file.execute("update about set value = '\"0.0.9\"' where key = 'version'")
        file.execute("update rows set method = 'paper' where method = 'replan-always'")
    (row,) = report_study(tmp_path)["rows"]
    assert row["cell"]["method"] == "replan-always"
    with pytest.raises(UsageError, match=r"rows of version 0\.0\.9") as error:
        run_study("failure-anticipation", tmp_path, options=options, limit=2)
    assert error.value.code in TEXT
