"""Plots of a report are files of their own."""

import csv
from pathlib import Path
from xml.etree import ElementTree

from hrcplan.plots import style
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


@style.styled
def drawn(name: str) -> str:
    figure, grid = style.figure(1, 1, 4, 3)
    grid[0, 0].plot([0, 1], [1, 0])
    return style.svg(figure, name, "a line")


def test_plots_are_also_pdf_and_png_for_papers(tmp_path: Path) -> None:
    alone = drawn("line")
    with style.copies() as copies:
        assert drawn("line") == alone  # the page stays the same, byte by byte
    again = dict(copies)
    with style.copies() as copies:
        drawn("line")
    assert copies == again
    files = write_figures(Findings("", (), [Section("One", alone)]), {}, tmp_path, copies)
    assert [path.name for path in files] == ["one.svg", "one.pdf", "one.png"]
    assert files[1].read_bytes().startswith(b"%PDF-")
    assert b"/Type3" not in files[1].read_bytes()
    assert files[2].read_bytes().startswith(b"\x89PNG\r\n")


def test_copies_end_with_the_block() -> None:
    with style.copies() as copies:
        pass
    drawn("line")
    assert copies == {}
