"""From rows to ``report.json`` and ``report.html``: the same rows give the same bytes."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from hrcplan.core.files import write_atomically
from hrcplan.core.text import cut
from hrcplan.errors import InputError, UsageError
from hrcplan.plots.style import copies
from hrcplan.studies import page
from hrcplan.studies.estimate import MeanEstimate, estimate, estimate_by
from hrcplan.studies.figure_files import write_figures
from hrcplan.studies.store import FILE, Store
from hrcplan.studies.study import (
    STUDIES,
    Cell,
    Findings,
    Study,
    StudyOptions,
    StudyRow,
    StudyTable,
)

JSON_FILE, PAGE_FILE = "report.json", "report.html"


def report_study(
    folder: str | Path, study_name: str | None = None, figures: str | Path | None = None
) -> dict[str, Any]:
    """Write the report of a folder of rows, and return what is in ``report.json``.

    Args:
        folder: The folder of the rows.
        study_name: The study; needed if it is your own (``module:NAME``): the rows alone cannot
            make hrcplan load code.
        figures: A folder to which plots (SVG, PDF and PNG) and rows (CSV) are written, too.

    Raises:
        InputError: if the folder has no rows, or they are damaged or of no known study.
        UsageError: if it is not the study of the rows, or the report cannot be written.
    """
    folder = Path(folder)
    with Store.to_read(folder) as store:
        about = store.about()
        study = _study(about, folder, study_name)
        given_options = {
            key: study.present_name(key, value)
            for key, value in about["options"].items()
            if value is not None
        }
        options = {**study.options, **given_options}  # earlier versions had fewer
        rows = {t.name: study.present_rows(t, store.rows(t)) for t in study.tables}
    forms = nullcontext() if figures is None else copies()
    with _rows_of(folder), forms as figure_copies:
        document, findings = report_document(study, about, options, rows)
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    write_atomically(folder / JSON_FILE, text)
    text = page.html(study.title, about, document["n_rows"], findings)
    write_atomically(folder / PAGE_FILE, text)
    if figures is not None:
        write_figures(findings, rows, Path(figures), figure_copies)
    return document


@contextmanager
def _rows_of(folder: Path) -> Iterator[None]:
    """Say of rows in which nothing can be counted that they are damaged."""
    try:
        yield
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
        what = cut(f"{type(error).__name__}: {error}", 160)
        message = f"the rows in {folder / FILE} make no sense: {what}"
        raise InputError(message, code="bad-rows", path=str(folder / FILE)) from error


def report_document(
    study: Study, about: dict[str, Any], options: StudyOptions, rows: dict[str, list[StudyRow]]
) -> tuple[dict[str, Any], Findings]:
    """Return the report of rows as a JSON object, and the findings in it.

    Args:
        study: The study.
        about: What the rows depend on: options, seed, version.
        options: The options, by the names of this version.
        rows: The rows of each table.
    """
    main = study.tables[0]
    findings = study.findings(options, rows)
    by_cell = cells_of(rows[main.name], main.keys, main.cells(options))
    document = {
        "study": study.name,
        "n_rows": len(rows[main.name]),
        "rows": [_summary(study, cell, summary) for cell, summary in by_cell.items() if summary],
        "tables": {
            t.name: cells
            for t in study.tables[1:]
            if (cells := _cells(study, t, options, rows[t.name]))
        },
        "claims": [
            {"claim": c.claim, "verdict": c.verdict, "holds": c.holds, "evidence": c.evidence}
            for c in findings.claims
        ],
        "about": about,
    }
    return document, findings


def _study(about: dict[str, Any], folder: Path, name: str | None) -> Study:
    if not {"study", "options", "seed", "version"} <= about.keys():
        raise InputError("not the rows of a study", code="bad-rows", path=str(folder / FILE))
    own = about["study"]
    if name is None:
        return STUDIES.find_listed(str(own))
    if name != own:
        raise UsageError(f"the rows are of the study '{own}', not of '{name}'", path=str(folder))
    return STUDIES.find(name)


def cells_of(
    rows: Sequence[StudyRow], keys: Sequence[str], order: Sequence[Cell]
) -> dict[Cell, list[StudyRow]]:
    """Return rows by their cell: known cells in their order, then others as they come."""
    by_cell: dict[Cell, list[StudyRow]] = {cell: [] for cell in order}
    for row in rows:
        by_cell.setdefault(tuple(row[key] for key in keys), []).append(row)  # type: ignore[misc]
    return by_cell


def estimates(
    rows: Sequence[StudyRow], names: Sequence[str], unit: Sequence[str] = ()
) -> dict[str, MeanEstimate]:
    """Return the estimate of each named column over rows, or over units of them.

    Rows without a value are left out.
    """
    by_name: dict[str, MeanEstimate] = {}
    for name in names:
        with_value = [row for row in rows if row.get(name) is not None]
        values = [float(row[name] or 0) for row in with_value]
        units = [tuple(row[key] for key in unit) for row in with_value]
        by_name[name] = estimate_by(zip(units, values, strict=True)) if unit else estimate(values)
    return by_name


def _summary(study: Study, cell: Cell, rows: Sequence[StudyRow]) -> dict[str, Any]:
    return {
        "cell": dict(zip(study.tables[0].keys, cell, strict=True)),
        "n": len(rows),
        "measures": _figures(estimates(rows, study.measures, study.unit)),
        "details": _figures(estimates(rows, study.details, study.unit)),
    }


def _cells(
    study: Study, table: StudyTable, options: StudyOptions, rows: Sequence[StudyRow]
) -> list[dict[str, Any]]:
    """Return the cells of a further table: those that have rows, with the measures they have."""
    names = (*study.measures, *study.details)
    cells = cells_of(rows, table.keys, table.cells(options) if rows else ())
    return [
        {
            "cell": dict(zip(table.keys, cell, strict=True)),
            "n": len(own),
            "measures": {
                name: figures
                for name, figures in _figures(estimates(own, names, _unit(study, own))).items()
                if figures["mean"] is not None
            },
        }
        for cell, own in cells.items()
        if own
    ]


def _unit(study: Study, rows: Sequence[StudyRow]) -> tuple[str, ...]:
    """Return the columns that name what counts once, where rows have them."""
    return study.unit if all(name in rows[0] for name in study.unit) else ()


def _figures(by_name: dict[str, MeanEstimate]) -> dict[str, dict[str, float | None]]:
    """Return means and standard errors; None where no row has a value, or too few for an error."""
    return {
        name: {"mean": e.mean if e.n else None, "se": e.se if e.is_known else None}
        for name, e in by_name.items()
    }
