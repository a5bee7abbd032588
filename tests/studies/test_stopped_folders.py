"""A report can be written of any rows that a run has left when it was stopped."""

import random

import pytest

from hrcplan.studies.report import report_document
from hrcplan.studies.study import Study, StudyRow
from tests.studies import test_changed_mind_claims as changed_mind
from tests.studies import test_claims as failure_anticipation

ABOUT = {"study": "x", "version": "x", "seed": 0, "options": {}}


def some(rows: list[StudyRow], chance: random.Random) -> list[StudyRow]:
    """Return the rows of some cells, and of these the first runs."""
    cells = {(row.get("human", row.get("case")), row.get("method")) for row in rows}
    n_runs = {cell: chance.choice([0, 0, 1, 2, 9]) for cell in sorted(cells, key=str)}
    whole = chance.choice([0, 1, 1])
    return [
        row
        for row in rows
        if whole * n_runs[row.get("human", row.get("case")), row.get("method")] > int(row["run"])
    ]


def written(study: Study, rows: dict[str, list[StudyRow]]) -> None:
    document, _ = report_document(study, ABOUT, study.options, rows)
    for table in study.tables[1:]:
        n = sum(cell["n"] for cell in document["tables"].get(table.name, ()))
        assert n == len(rows[table.name])
    assert document["n_rows"] == len(rows[study.tables[0].name])


@pytest.mark.parametrize("seed", range(2))
def test_changed_mind(seed):
    chance = random.Random(seed)
    made_up = changed_mind.made_up(2)
    written(changed_mind.STUDY, {name: some(rows, chance) for name, rows in made_up.items()})


@pytest.mark.filterwarnings("ignore:constrained_layout")
@pytest.mark.parametrize("seed", range(2))
def test_failure_anticipation(seed):
    study, chance = failure_anticipation.STUDY, random.Random(seed)
    rows: dict[str, list[StudyRow]] = {table.name: [] for table in study.tables}
    for table in study.tables[:3]:
        for cell in table.cells(study.options):
            keys = dict(zip(table.keys, cell, strict=True))
            rows[table.name] += [
                {**keys, "run": run, **failure_anticipation.row(cell, run)}
                for run in range(chance.choice([0, 0, 1, 2]))
            ]
    for cell in [("hrcplan", 0, 5), ("replan-always", 1, 20)][: chance.randint(0, 2)]:
        keys = dict(zip(study.tables[3].keys, cell, strict=True))
        rows["allocation"].append({**keys, "run": 0, **failure_anticipation.share(cell)})
    written(study, rows)
