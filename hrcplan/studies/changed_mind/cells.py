"""Rows of one table by human and method: their means, and paired differences between methods."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.studies.cells import PairedCells
from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.episodes import UNIT
from hrcplan.studies.changed_mind.measures import DECLARED
from hrcplan.studies.study import StudyOptions, StudyRow

KEYS = ("human", "method")


class Cells(PairedCells):
    """The rows of a table by human and method."""

    def __init__(self, table: str, options: StudyOptions, rows: Sequence[StudyRow]) -> None:
        super().__init__(rows, scenario.cells(table, options), KEYS, UNIT)
        self._declaring = {
            method
            for (_, method), own in self.rows.items()
            if any(row["n_detected"] or row["false_changes"] for row in own)
        }

    @property
    def humans(self) -> list[str]:
        """Humans that have rows, in the order of the study."""
        return self.cases

    def has_values(self, case: str, method: str, measure: str) -> bool:
        """Return whether rows say anything about a measure.

        A method that never declared a change, to any human, has no values of declared changes.
        """
        if measure in DECLARED and method not in self._declaring:
            return False
        return super().has_values(case, method, measure)
