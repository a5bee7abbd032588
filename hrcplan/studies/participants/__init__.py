"""People instead of simulated humans: rows of trials, with the measures of the changed-mind study.

``hrcplan study collect`` writes the rows from journals; nothing here runs an episode.
"""

from __future__ import annotations

from hrcplan.errors import UsageError
from hrcplan.studies.participants.findings import findings
from hrcplan.studies.participants.rows import COLUMNS, DETAILS, MEASURES
from hrcplan.studies.study import Cell, Seed, Study, StudyOptions, StudyRow, StudyTable

NAME = "participants"


def _no_episode(options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    message = "people cannot be run; 'hrcplan study collect' writes what they did"
    raise UsageError(message, code="no-episodes", hint="hrcplan serve --study FILE")


def _cells(options: StudyOptions) -> list[Cell]:
    return [("people", method) for method in options.get("methods", "").split(",") if method]


STUDY = Study(
    name=NAME,
    title="A study with participants",
    tables=(StudyTable("trials", ("human", "method"), COLUMNS, _cells, _no_episode),),
    measures=MEASURES,
    details=DETAILS,
    options={"methods": "", "title": "", "participants": ""},
    findings=findings,
    inputs=lambda options: "",
    runs=lambda options: 0,
    unit=("participant",),
)
