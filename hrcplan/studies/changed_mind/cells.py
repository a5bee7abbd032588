"""Rows of one table by human and method: their means, and paired differences between methods."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.studies.changed_mind import scenario
from hrcplan.studies.changed_mind.episodes import UNIT
from hrcplan.studies.changed_mind.measures import DECLARED
from hrcplan.studies.estimate import Interval, MeanEstimate, estimate_clustered
from hrcplan.studies.report import cells_of, estimates
from hrcplan.studies.study import StudyOptions, StudyRow

KEYS = ("human", "method")


class Cells:
    """The rows of a table, without the cells that have none.

    Attributes:
        rows: Rows by human and method.
        humans: Humans that have rows, in the order of the study.
        methods: Methods in the same way.
    """

    def __init__(self, table: str, options: StudyOptions, rows: Sequence[StudyRow]) -> None:
        by_cell = cells_of(rows, KEYS, scenario.cells(table, options))
        self.rows: dict[tuple[str, str], Sequence[StudyRow]] = {
            (str(human), str(method)): own for (human, method), own in by_cell.items() if own
        }
        self.humans = list(dict.fromkeys(human for human, _ in self.rows))
        order = [str(method) for _, method in by_cell]
        has = {method for _, method in self.rows}
        self.methods = [method for method in dict.fromkeys(order) if method in has]
        self._declaring = {
            method
            for (_, method), own in self.rows.items()
            if any(row["n_detected"] or row["false_changes"] for row in own)
        }
        self._means: dict[tuple[str, str, str], MeanEstimate | None] = {}
        self._gaps: dict[tuple[str, str, str, str, float], Interval | None] = {}

    def methods_of(self, human: str) -> list[str]:
        """Return the methods that have rows of a human."""
        return [method for method in self.methods if (human, method) in self.rows]

    def n_runs(self, human: str, method: str) -> int:
        """Return how many rows a cell has."""
        return len(self.rows.get((human, method), ()))

    def n_pairs(self, human: str, method: str) -> int:
        """Return of how many pairs of goals, or single goals, the rows of a cell are."""
        return len({tuple(row[key] for key in UNIT) for row in self.rows.get((human, method), ())})

    def mean(self, human: str, method: str, measure: str) -> MeanEstimate | None:
        """Return the mean over pairs of goals; None without values.

        A method that never declared a change, to any human, has no values of declared changes.
        """
        key = (human, method, measure)
        if key not in self._means:
            self._means[key] = self._mean(*key)
        return self._means[key]

    def _mean(self, human: str, method: str, measure: str) -> MeanEstimate | None:
        if measure in DECLARED and method not in self._declaring:
            return None
        rows = self.rows.get((human, method), ())
        mean = estimates(rows, (measure,), UNIT)[measure]
        return mean if mean.n else None

    def difference(
        self, human: str, ours: str, theirs: str, measure: str, share: float = 1.0
    ) -> Interval | None:
        """Return the mean of the first minus the second, or minus a share of the second.

        It is taken over the runs in which both have a value. The interval is cluster-robust by
        first and by second goal. None if there is no such run, or no value at all of a method.
        """
        key = (human, ours, theirs, measure, share)
        if key not in self._gaps:
            self._gaps[key] = self._difference(*key)
        return self._gaps[key]

    def _difference(
        self, human: str, ours: str, theirs: str, measure: str, share: float
    ) -> Interval | None:
        if not all(self.mean(human, method, measure) for method in (ours, theirs)):
            return None
        beside = {row["run"]: row for row in self.rows[human, theirs]}
        values = []
        for row in self.rows[human, ours]:
            a, b = row[measure], beside.get(row["run"], {}).get(measure)
            if a is not None and b is not None:
                values.append(((row["first"], row["second"]), float(a) - share * float(b)))
        return estimate_clustered(values).interval if values else None
