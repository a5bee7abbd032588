"""The table of the benchmark: each method's measures over all instances, with their intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hrcplan.studies.changed_mind.measures import DECLARED
from hrcplan.studies.changed_mind.measures import MEASURES as OF_CHANGES
from hrcplan.studies.estimate import MeanEstimate, estimate_by
from hrcplan.studies.measure import Measure
from hrcplan.studies.study import StudyRow
from hrcplan.studies.switch.episodes import KEYS
from hrcplan.studies.switch.methods import ASSISTANCE, INFERENCE

MEASURES: Mapping[str, Measure] = {
    **OF_CHANGES,
    "brier": Measure("Brier score", "Brier|score", "0 to 2"),
}
SHOWN = {
    ASSISTANCE: ("reached_pct", "total_steps", "extra_vs_oracle", "wasted_robot_steps",
                 "first_correct", "correct_pct", "detection_delay", "false_changes"),
    INFERENCE: ("brier", "correct_pct", "top3_pct", "first_correct", "last_incorrect_pct",
                "detection_delay", "false_changes"),
}  # fmt: skip
"""The measures of each table that are shown; success stands before cost."""
ORDER = {ASSISTANCE: ("reached_pct", "total_steps"), INFERENCE: ("brier",)}
"""By which measures methods are ordered, the best first."""


@dataclass(frozen=True, slots=True)
class Standing:
    """What a method reaches in some instances of a table; None for a measure without values."""

    method: str
    n: int
    means: Mapping[str, MeanEstimate | None]


def standings(table: str, rows: Sequence[StudyRow]) -> list[Standing]:
    """Return the standing of each method over all rows, the best method first."""
    by_method: dict[str, list[StudyRow]] = {}
    for row in rows:
        by_method.setdefault(str(row["method"]), []).append(row)
    entries = [standing(table, method, own) for method, own in by_method.items()]
    return sorted(entries, key=lambda one: _place(table, one))


def _place(table: str, one: Standing) -> tuple[float, ...]:
    """Return what methods are sorted by: less is better, and nothing is worst."""
    place = []
    for name in ORDER[table]:
        sign = -1 if MEASURES[name].more_is_better else 1
        mean = one.means.get(name)
        place.append(float("inf") if mean is None else sign * mean.mean)
    return tuple(place)


def standing(table: str, method: str, rows: Sequence[StudyRow]) -> Standing:
    """Return the standing of a method in some rows.

    Runs with one pair of goals count once, and those that share a goal of a task are not taken as
    independent. A method that never declares a change has no value of declared changes.
    """
    is_declaring = any(row["n_detected"] or row["false_changes"] for row in rows)
    names = [name for name in SHOWN[table] if is_declaring or name not in DECLARED]
    means = {name: _mean(name, rows) for name in names}
    return Standing(method, len(rows), {name: means.get(name) for name in SHOWN[table]})


def _mean(name: str, rows: Sequence[StudyRow]) -> MeanEstimate | None:
    values = [(_clusters(row), float(row[name] or 0)) for row in rows if row[name] is not None]
    return estimate_by(values) if values else None


def _clusters(row: StudyRow) -> tuple[str, ...]:
    second = row["first"] if row["second"] is None else row["second"]
    return (f"{row['task']}: {row['first']}", f"{row['task']}: {second}")


def by_task_and_human(
    table: str, rows: Sequence[StudyRow]
) -> list[tuple[dict[str, str], Standing]]:
    """Return the standing of each method in each task with each human, in the order of rows."""
    by_cell: dict[tuple[str, ...], list[StudyRow]] = {}
    for row in rows:
        by_cell.setdefault(tuple(str(row[key]) for key in KEYS), []).append(row)
    return [
        ({"task": cell[0], "human": cell[1]}, standing(table, cell[2], own))
        for cell, own in by_cell.items()
    ]
