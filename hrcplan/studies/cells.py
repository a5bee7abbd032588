"""Rows of one table by case and method: their means, and paired differences between methods."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.studies.estimate import Interval, MeanEstimate, estimate_clustered
from hrcplan.studies.report import cells_of, estimates
from hrcplan.studies.study import Cell, StudyRow


class PairedCells:
    """The rows of a table whose cells are a case and a method, without the cells that have none.

    Runs of one number are paired over the methods of a case.

    Args:
        rows: The rows of the table.
        order: Its cells, in their order.
        keys: The columns of case and method.
        unit: The columns of which each combination counts once in an error.

    Attributes:
        rows: Rows by case and method.
        cases: Cases that have rows, in the order of the study.
        methods: Methods in the same way.
    """

    def __init__(
        self, rows: Sequence[StudyRow], order: Sequence[Cell], keys: tuple[str, str],
        unit: tuple[str, ...],
    ) -> None:  # fmt: skip
        by_cell = cells_of(rows, keys, order)
        self.unit = unit
        self.rows: dict[tuple[str, str], Sequence[StudyRow]] = {
            (str(case), str(method)): own for (case, method), own in by_cell.items() if own
        }
        self.cases = list(dict.fromkeys(case for case, _ in self.rows))
        has = {method for _, method in self.rows}
        methods = dict.fromkeys(str(method) for _, method in by_cell)
        self.methods = [method for method in methods if method in has]
        self._means: dict[tuple[str, str, str], MeanEstimate | None] = {}
        self._gaps: dict[tuple[str, str, str, str, float], Interval | None] = {}

    def methods_of(self, case: str) -> list[str]:
        """Return the methods that have rows of a case."""
        return [method for method in self.methods if (case, method) in self.rows]

    def n_runs(self, case: str, method: str) -> int:
        """Return how many rows a cell has."""
        return len(self.rows.get((case, method), ()))

    def n_pairs(self, case: str, method: str) -> int:
        """Return of how many units, such as pairs of goals, the rows of a cell are."""
        rows = self.rows.get((case, method), ())
        return len({tuple(row[key] for key in self.unit) for row in rows})

    def has_values(self, case: str, method: str, measure: str) -> bool:
        """Return whether the rows of a cell say anything about a measure."""
        return (case, method) in self.rows

    def mean(self, case: str, method: str, measure: str) -> MeanEstimate | None:
        """Return the mean over units; None without values."""
        key = (case, method, measure)
        if key not in self._means:
            mean = None
            if self.has_values(*key):
                mean = estimates(self.rows[case, method], (measure,), self.unit)[measure]
            self._means[key] = mean if mean is not None and mean.n else None
        return self._means[key]

    def difference(
        self, case: str, ours: str, theirs: str, measure: str, share: float = 1.0
    ) -> Interval | None:
        """Return the mean of the first minus the second, or minus a share of the second.

        It is taken over the runs in which both have a value. The interval is cluster-robust by each
        column of the unit. None if there is no such run, or no value at all of a method.
        """
        key = (case, ours, theirs, measure, share)
        if key not in self._gaps:
            self._gaps[key] = self._difference(*key)
        return self._gaps[key]

    def _difference(
        self, case: str, ours: str, theirs: str, measure: str, share: float
    ) -> Interval | None:
        if not all(self.mean(case, method, measure) for method in (ours, theirs)):
            return None
        beside = {row["run"]: row for row in self.rows[case, theirs]}
        values = []
        for row in self.rows[case, ours]:
            a, b = row[measure], beside.get(row["run"], {}).get(measure)
            if a is not None and b is not None:
                clusters = tuple(row[key] for key in self.unit)
                values.append((clusters, float(a) - share * float(b)))
        return estimate_clustered(values).interval if values else None
