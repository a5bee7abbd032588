"""Claims can fail: each follows from the rows, here made up so that all of them hold, then bent."""

import sqlite3
from pathlib import Path
from typing import Any

import pytest

from hrcplan.studies import report_study
from hrcplan.studies.estimate import difference, estimate
from hrcplan.studies.failure_anticipation import claims, figures, scenario
from hrcplan.studies.store import Store
from hrcplan.studies.study import Episode, StudyRow, find

STUDY = find("failure-anticipation")
RUNS = 6
PRINTED = scenario.data()["printed"]
WITHOUT, WITH = (100, 0.9, 9.0, 40.0, 300.0), (100, 0.6, 5.0, 45.0, 250.0)
"""Success, replans, failed, the human's successful share and makespan without and with the model;
of the paper's own method the cells are as printed."""
NAMES = ("success_pct", "replans", "failed_pct", "successful_human_pct", "makespan_s")


def row(cell: tuple[Any, ...], run: int) -> StudyRow:
    values = dict(zip(NAMES, WITHOUT if cell[0][1] == "a" else WITH, strict=True))
    if cell[1] == "replan-always":
        values |= dict(zip(PRINTED["columns"], PRINTED[cell[0]], strict=True))
    wobble = 0.01 * (run - (RUNS - 1) / 2)  # so that there is a standard error
    for name in ("replans", "failed_pct", "successful_human_pct"):
        values[name] += wobble
    return {**dict.fromkeys(STUDY.tables[0].columns, 0), **values, "value": 5.0}


def share(cell: tuple[Any, ...]) -> StudyRow:
    _, at, value = cell
    return {"n_human": 2 if value < 10 - at else 0, "n_robot": 4, "cost": 1.0}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    options = scenario.defaults()
    about = {"study": STUDY.name, "version": "x", "seed": 0, "options": options}
    with Store.to_write(tmp_path, about, STUDY.tables) as store:
        for table in STUDY.tables[:2]:
            cells = table.cells(options)
            made = [
                (Episode(table.name, cell, run), row(cell, run))
                for cell in cells
                for run in range(RUNS)
            ]
            store.add(table, made)
        allocation = STUDY.table("allocation")
        profiles = ("replan-always", "hrcplan")
        cells = [(p, at, v) for p in profiles for at in range(3) for v in range(21)]
        store.add(allocation, [(Episode("allocation", cell, 0), share(cell)) for cell in cells])
    return tmp_path


def verdicts(folder: Path) -> dict[str, bool]:
    with Store.to_read(folder) as store:
        rows = {table.name: store.rows(table) for table in STUDY.tables}
    return {claim.claim: claim.holds for claim in claims.claims(scenario.defaults(), rows)}


def bend(folder: Path, statement: str) -> set[str]:
    """Return the claims that do not hold after a statement has changed the rows."""
    with sqlite3.connect(folder / "rows.sqlite") as rows:
        assert rows.execute(statement).rowcount > 0
    return {claim for claim, holds in verdicts(folder).items() if not holds}


def test_made_up_rows_make_all_claims_hold(folder: Path) -> None:
    found = verdicts(folder)
    assert all(found.values()), found
    assert {claims.H1, claims.H2} < set(found)
    assert sum(text.startswith("Above 10") for text in found) == 3
    assert sum(text.startswith("Table I") for text in found) == 4
    assert sum("sensing lowers" in text for text in found) == 12
    reported = {claim["claim"]: claim["holds"] for claim in report_study(folder)["claims"]}
    assert reported == found


PAPER = "where \"case\" = '{}' and method = 'replan-always'"
BASELINE = "where profile = 'replan-always'"
BENT = [
    (f"update rows set success_pct = 37.5 {PAPER.format('2b')}", claims.H1),
    (f"update rows set replans = 3.76 {PAPER.format('1b')}", claims.H1),
    (f"update rows set failed_pct = 40 {PAPER.format('2b')}", claims.H1),
    (f"update rows set failed_pct = 40 {PAPER.format('2b')}", claims.H2),
    (f"update rows set successful_human_pct = 10 {PAPER.format('1b')}", claims.H2),
    (f"update rows set successful_human_pct = 18 {PAPER.format('2b')}", claims.H2),
    (f"delete from rows {PAPER.format('1a')}", claims.H1),
    (
        f"update allocation set n_human = 1 {BASELINE} and value = 11",
        "Above 10",
    ),
    ("update allocation set n_human = 1 where profile = 'hrcplan' and value = 20", "Above 10"),
    ("update allocation set n_human = 0", "Above 10"),
    ("delete from allocation where value > 10", "Above 10"),
    ("delete from allocation", "Above 10"),
    (f"update rows set success_pct = 36 {PAPER.format('1a')}", "1a replan-always"),
    (f"update rows set replans = 1.06 {PAPER.format('1b')}", "1b replan-always"),
    ("update rows set success_pct = 99.9 where method = 'all-fail'", "2b all-fail"),
    ("update rows set failed_pct = failed_pct + .6 where method = 'hrcplan'", "2b hrcplan"),
    ("delete from variants", "2b hrcplan"),
    (f"update rows set replans = 1 {PAPER.format('1b')}", "Table I, case 1b"),
    ("update rows set failed_pct = 9 where method = 'hrcplan'", "Case 1, the scenario of the"),
    ("update variants set failed_pct = 9 where method = 'drift'", "Case 2, drift: sensing"),
    ("update variants set makespan_s = 300 where method = 'costly failures'", "Case 1, costly"),
]


@pytest.mark.parametrize(("statement", "claim"), BENT)
def test_bent_rows_make_a_claim_fail(folder: Path, statement: str, claim: str) -> None:
    failed = bend(folder, statement)
    assert any(text.startswith(claim) for text in failed), failed


def test_of_the_papers_profile_later_changes_are_a_claim_of_their_own(folder: Path) -> None:
    statement = "update allocation set n_human = 1 where profile = 'replan-always' and action = 1"
    (claim,) = bend(folder, statement)
    assert claim.endswith("(replan-always profile, change at any time)")


def test_too_few_runs_show_nothing(folder: Path) -> None:
    assert claims.H1 in bend(folder, "delete from rows where run > 0")


def test_estimates() -> None:
    assert estimate([]).n == 0
    one = estimate([3.0])
    assert (one.mean, one.se, one.is_above_zero) == (3.0, 0.0, False)
    four = estimate([1, 2, 3, 4])
    assert four.mean == 2.5
    assert four.se == pytest.approx((5 / 3 / 4) ** 0.5)
    assert four.is_above_zero
    assert not four.is_below_zero
    assert four.se_of(16) == pytest.approx(four.se / 2)


def test_differences_are_over_the_runs_that_both_have() -> None:
    found = difference({1: 2.0, 2: 3.0, 3: 9.0}, {2: 1.0, 1: 2.0})
    assert (found.mean, found.n) == (1.0, 2)


def test_who_does_what_can_be_drawn_from_part_of_the_rows():
    """A limit may leave out values for some of the times of the change."""
    points = [(0, 1), (0, 2), (1, 1), (2, 3)]
    rows = [
        {"profile": profile, "action": at, "value": value, "n_human": 1, "n_robot": 2}
        for profile in ("replan-always", "hrcplan")
        for at, value in points
    ]
    assert "<svg" in figures.allocation(rows, "motivation human")
