"""Plots of a report are files of their own."""

import csv
from pathlib import Path
from xml.etree import ElementTree

from hrcplan.studies.figure_files import write_figures
from hrcplan.studies.study import Findings, Section

PLOT = '<svg viewBox="0 0 1 1"><rect width="1" height="1"/></svg>'


def test_plots_and_rows_are_files(tmp_path: Path) -> None:
    sections = [Section("Table I, means", f"<p>x</p>{PLOT}{PLOT}"), Section("One", PLOT)]
    rows = {"main": [{"human": "a,b", "run": 1}, {"human": "c", "steps": None}]}
    files = write_figures(Findings("", (), sections), rows, tmp_path / "figures")
    names = [path.name for path in files]
    assert names == ["table-i-means-1.svg", "table-i-means-2.svg", "one.svg", "main.csv"]
    for path in files[:3]:
        assert ElementTree.parse(path).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    lines = list(csv.DictReader(files[3].read_text().splitlines()))
    assert lines[0] == {"human": "a,b", "run": "1", "steps": ""}
