"""The laws of studies: the built-in ones keep them, and each is broken once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hrcplan.errors import UsageError
from hrcplan.execution.worlds import chance
from hrcplan.plots import style
from hrcplan.studies.estimate import estimate
from hrcplan.studies.study import (
    STUDIES,
    Cell,
    Claim,
    Findings,
    Section,
    Seed,
    Study,
    StudyOptions,
    StudyRow,
    StudyRows,
    StudyTable,
)
from hrcplan.testing import check_study

STUDIES_FOLDER = Path(__file__).parent.parent / "studies"
FETCH, WORKSHOP = STUDIES_FOLDER / "fetch", STUDIES_FOLDER / "workshop"
QUICK: Mapping[str, dict[str, str | None]] = {
    "failure-anticipation": {
        "domain": str(FETCH / "domain.pddl"), "problem": str(FETCH / "four-items.pddl"),
    },
    "changed-mind": {
        "domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP),
        "methods": "recursive,oracle", "humans": "optimal",
    },
    "collaboration": {
        "domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP), "methods": "joint",
    },
}  # fmt: skip
"""Options with which the built-in studies are small; every other study is run as it is."""


# The episodes of participants are those of people; tests/web plays them.
@pytest.mark.parametrize("name", [name for name in STUDIES.names() if name != "participants"])
def test_every_study_keeps_the_laws(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # Figures take long; tests/studies compares those of two reports byte by byte.
    monkeypatch.setattr(style, "svg", lambda drawing, name, label: f"<svg>{label}</svg>")
    check_study(STUDIES.find(name), QUICK.get(name), runs=1, limit=2)


def sixes(options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    """Return the row of one throw of dice, as many as the cell says."""
    (n_dice,) = cell
    return {"n_sixes": sum(chance.uniform(seed, i) < 1 / 6 for i in range(int(n_dice)))}


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    mean = estimate([float(row["n_sixes"] or 0) for row in rows["rows"]])
    claim = Claim("some are sixes", mean.mean > 0 if mean.n else None, f"mean of {mean.n} throws")
    return Findings("<p>Dice.</p>", [claim], [Section("More", "<p>None.</p>")])


TABLE = StudyTable("rows", ("n_dice",), ("n_sixes",), lambda options: [(1,), (2,)], sixes)
DICE = Study("dice", "Dice", (TABLE,), ("n_sixes",), findings, lambda options: "")


def test_a_small_study_keeps_the_laws() -> None:
    check_study(DICE)
    with pytest.raises(UsageError, match="no option 'colour'"):
        check_study(DICE, {"colour": "red"})


def of_table(**fields: Any) -> Study:
    return replace(DICE, tables=(replace(TABLE, **fields),))


def of_row(**values: Any) -> Study:
    return of_table(episode=lambda options, cell, seed: dict(values))


def changed_rows(options: StudyOptions, rows: StudyRows) -> Findings:
    for row in rows["rows"]:
        row["n_sixes"] = float(row["n_sixes"] or 0) + 1
    return findings(options, rows)


def counted(options: StudyOptions, rows: StudyRows) -> Findings:
    return replace(findings(options, rows), lead=str(next(COUNT)))


COUNT = itertools.count()


@pytest.mark.parametrize(
    ("study", "message"),
    [
        ("dice", "this is no Study: 'dice'"),
        (replace(DICE, tables=()), "a study has a table"),
        (replace(DICE, tables=(TABLE, TABLE)), "two tables have one name"),
        (of_table(columns=("n_sixes", "run")), "has a column twice"),
        (of_table(grown={"luck": lambda row: 0}), r"has no grown \['luck'\]"),
        (replace(DICE, measures=("luck",)), "has no column luck"),
        (of_table(cells=lambda options: [(next(COUNT),)]), "differ when asked again"),
        (of_table(cells=lambda options: [(1,), (1,)]), "has a cell twice"),
        (of_table(cells=lambda options: [(1, 2)]), "one value for each of"),
        (of_table(cells=lambda options: []), "there is no episode"),
        (replace(DICE, inputs=lambda options: str(next(COUNT))), "returns another text"),
        (of_row(), "lacks a column, or has one more: n_sixes"),
        (of_row(n_sixes=1, luck=2), "lacks a column, or has one more: luck"),
        (
            of_table(episode=lambda options, cell, seed: {"n_sixes": next(COUNT)}),
            "rows, cell .2,., run 1: n_sixes is ",
        ),
        (of_row(n_sixes=1e300), "a file cannot hold the rows: .*n_sixes = 1e.300"),
        (of_row(n_sixes=math.nan), "a file changes the row"),
        (of_row(n_sixes=1 << 64), "a file cannot hold the rows"),
        (of_row(n_sixes="\udc80"), "a file cannot hold the rows"),
        (of_table(name="order"), "a file cannot hold the rows"),
        (
            replace(DICE, findings=lambda options, rows: rows["rows"][0]["n_sixes"]),
            "no report of 0 rows: IndexError",
        ),
        (replace(DICE, findings=changed_rows), "a report changes the rows"),
        (replace(DICE, findings=counted), "a report of the same rows differs"),
    ],
)
def test_a_study_that_breaks_a_law(study: Study, message: str) -> None:
    with pytest.raises(AssertionError, match=message):
        check_study(study)


def test_columns_of_the_clock_may_differ() -> None:
    check_study(
        of_table(
            clocked=("wall_s",),
            episode=lambda options, cell, seed: {"n_sixes": 1, "wall_s": next(COUNT)},
        )
    )
