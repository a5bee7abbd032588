"""The plots of a report as files of their own, and the rows as tables."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from hrcplan.core.files import make_folder, write_atomically
from hrcplan.plots.style import FigureCopies
from hrcplan.studies.page import anchor
from hrcplan.studies.study import Findings, StudyRow

_PLOT = re.compile(r"<svg\b.*?</svg>", re.DOTALL)
_NAMESPACE = 'xmlns="http://www.w3.org/2000/svg"'
_XLINK = 'xmlns:xlink="http://www.w3.org/1999/xlink"'


def write_figures(
    findings: Findings, rows: Mapping[str, Sequence[StudyRow]], folder: Path,
    copies: FigureCopies | None = None,
) -> tuple[Path, ...]:  # fmt: skip
    """Write every plot of a report as an SVG file, and every table of rows as a CSV file.

    Args:
        findings: Their sections hold the plots.
        rows: The rows of each table.
        folder: Where to write; it is made if it is missing.
        copies: The same plots in other forms, by their SVG text; they are written, too.

    Returns:
        The files; plots are named after their section.

    Raises:
        UsageError: if they cannot be written.
    """
    files: dict[Path, str | bytes] = {}
    for section in findings.sections:
        plots = _PLOT.findall(section.html)
        for number, plot in enumerate(plots, start=1):
            name = anchor(section.title) + (f"-{number}" if len(plots) > 1 else "")
            files[folder / f"{name}.svg"] = _standalone(plot)
            for form, data in (copies or {}).get(plot, {}).items():
                files[folder / f"{name}.{form}"] = data
    for table, lines in rows.items():
        files[folder / f"{table}.csv"] = _csv(lines)
    make_folder(folder)
    for path, content in files.items():
        write_atomically(path, content)
    return tuple(files)


def _standalone(plot: str) -> str:
    """Return a plot of a page as a file: with the namespaces that a page does not need."""
    for attribute in (_XLINK, _NAMESPACE):
        if attribute.partition("=")[0] + "=" not in plot.partition(">")[0]:
            plot = plot.replace("<svg", f"<svg {attribute}", 1)
    return f"{plot}\n"


def _csv(lines: Sequence[StudyRow]) -> str:
    text = io.StringIO()
    columns = list(dict.fromkeys(key for line in lines for key in line))
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return text.getvalue()
