"""The page of the study."""
from __future__ import annotations

from hrcplan.studies.study import Findings, StudyOptions, StudyRows


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return claims and sections."""
    return Findings("", [], [])
