"""Laws of studies."""

from __future__ import annotations

import copy
import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hrcplan import __version__
from hrcplan.errors import HrcplanError
from hrcplan.studies import page
from hrcplan.studies.report import report_document
from hrcplan.studies.store import Store
from hrcplan.studies.study import (
    Episode,
    Seed,
    Study,
    StudyOptions,
    StudyRow,
    StudyTable,
    episodes,
)

ReportRows = dict[str, list[StudyRow]]
_SEED = 0


def check_study(
    study: Study, options: Mapping[str, str | None] | None = None, *, runs: int = 2,
    limit: int | None = 12,
) -> None:  # fmt: skip
    """Test the laws of studies.

    Cells, inputs and rows depend on options, cell and seed only: asked again, in another order,
    they are the same, but for the columns that a clock measures. A row has the columns of its
    table, and a file can hold it. The report follows from the rows alone, and changes none of them.
    It can be made of no rows, too.

    Args:
        study: The study.
        options: Its options; by default its own.
        runs: Runs per cell.
        limit: Episodes of the first table, and of all others together, as in `run_study`.

    Raises:
        AssertionError: if a law is broken.
        UsageError: if the study has no such option.
    """
    assert isinstance(study, Study), f"this is no Study: {study!r}"
    _check_columns(study)
    choice = study.with_defaults(options or {})
    for table in study.tables:
        _check_cells(table, choice)
    assert study.inputs(choice) == study.inputs(choice), "inputs() returns another text"
    study.prepare(choice, 1, lambda text: None)
    pairs = _repeatable_rows(study, choice, list(episodes(study, choice, runs, limit)))
    about = {"study": study.name, "version": __version__, "seed": _SEED, "options": {**choice}}
    rows = _stored_rows(study, about, pairs)
    _report(study, choice, about, {table.name: [] for table in study.tables})
    before = copy.deepcopy(rows)
    report = _report(study, choice, about, rows)
    assert rows == before, "a report changes the rows"
    assert _report(study, choice, about, rows) == report, "a report of the same rows differs"


def _check_columns(study: Study) -> None:
    names = [table.name for table in study.tables]
    assert names, "a study has a table"
    assert len(set(names)) == len(names), f"two tables have one name: {names}"
    for table in study.tables:
        columns = (*table.keys, "run", *table.columns, *table.clocked)
        assert len(set(columns)) == len(columns), f"{table.name} has a column twice: {columns}"
        assert set(table.grown) <= set(columns), f"{table.name} has no grown {[*table.grown]}"
    main = study.tables[0]
    columns = (*main.keys, "run", *main.columns, *main.clocked)
    for name in (*study.measures, *study.details, *study.unit):
        assert name in columns, f"{main.name} has no column {name}, which is to be reported"


def _check_cells(table: StudyTable, options: StudyOptions) -> None:
    cells = list(table.cells(options))
    assert list(table.cells(options)) == cells, f"the cells of {table.name} differ when asked again"
    assert len(set(cells)) == len(cells), f"{table.name} has a cell twice"
    for cell in cells:
        is_cell = isinstance(cell, tuple) and len(cell) == len(table.keys)
        assert is_cell, f"a cell of {table.name} has one value for each of {table.keys}: {cell!r}"


def _repeatable_rows(
    study: Study, options: StudyOptions, all_episodes: Sequence[Episode]
) -> list[tuple[Episode, StudyRow]]:
    """Return the rows of episodes, which are the same when asked for in the other order."""
    assert all_episodes, "there is no episode"
    pairs = [(episode, _row(study, options, episode)) for episode in all_episodes]
    for episode, row in reversed(pairs):
        again = _row(study, options, episode)
        for name in study.table(episode.table).columns:
            is_same = repr(again[name]) == repr(row[name])
            assert is_same, f"{_place(episode)}: {name} is {again[name]!r} after {row[name]!r}"
    return pairs


def _row(study: Study, options: StudyOptions, episode: Episode) -> StudyRow:
    table = study.table(episode.table)
    row = table.episode(options, episode.cell, Seed(_SEED, episode.run))
    names = {*table.columns, *table.clocked}
    differing = ", ".join(sorted(names ^ set(row)))
    assert not differing, f"{_place(episode)}: the row lacks a column, or has one more: {differing}"
    return dict(row)


def _place(episode: Episode) -> str:
    return f"{episode.table}, cell {episode.cell}, run {episode.run}"


def _stored_rows(
    study: Study, about: dict[str, Any], pairs: Sequence[tuple[Episode, StudyRow]]
) -> ReportRows:
    """Return rows as they are read from a file that they were written to."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            with Store.to_write(Path(folder), about, study.tables) as store:
                for table in study.tables:
                    own = [(e, row) for e, row in pairs if e.table == table.name]
                    if own:
                        store.add(table, own)
                store.compact()
                rows_read = {table.name: store.rows(table) for table in study.tables}
        except (HrcplanError, OverflowError, UnicodeError) as error:
            raise AssertionError(f"a file cannot hold the rows: {error}") from error
    for episode, row in pairs:
        table = study.table(episode.table)
        keys = {**dict(zip(table.keys, episode.cell, strict=True)), "run": episode.run}
        message = f"{_place(episode)}: a file changes the row, or puts it into another cell"
        assert {**keys, **row} in rows_read[table.name], message
    return rows_read


def _report(study: Study, options: StudyOptions, about: dict[str, Any], rows: ReportRows) -> str:
    """Return the two files of a report as one text."""
    try:
        document, findings = report_document(study, about, options, rows)
        html = page.html(study.title, about, document["n_rows"], findings)
        return json.dumps(document, allow_nan=False) + html
    except Exception as error:
        n_rows = sum(map(len, rows.values()))
        raise AssertionError(f"no report of {n_rows} rows: {error!r}") from error
