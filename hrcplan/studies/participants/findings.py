"""The report of a study with participants: measures by robot, and every trial."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.core.text import plural
from hrcplan.studies import page
from hrcplan.studies.changed_mind.measures import MEASURES
from hrcplan.studies.estimate import estimate_by
from hrcplan.studies.study import Findings, Section, StudyOptions, StudyRow, StudyRows

SHOWN = ("reached_pct", "total_steps", "extra_steps", "correct_pct", "first_correct",
         "detection_delay", "wasted_robot_steps", "human_mistakes")  # fmt: skip


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return the content of the page."""
    trials = rows["trials"]
    people = len({row["participant"] for row in trials})
    lead = (
        f"{page.escape(str(options.get('title') or 'A study'))}: {plural(people, 'participant')}, "
        f"{plural(len(trials), 'trial')}. The measures are those of simulated humans, by the same "
        "code; a step that no plan of the goal has next counts as a mistake. Errors are those of "
        "means over participants."
    )
    return Findings(lead, (), (_means(trials), _trials(trials)))


def _means(trials: Sequence[StudyRow]) -> Section:
    by_method: dict[str, list[StudyRow]] = {}
    for row in trials:
        by_method.setdefault(str(row["method"]), []).append(row)
    head = ["robot", "trials", *(MEASURES[name].head for name in SHOWN)]
    body = [
        [page.escape(method), str(len(rows)), *(_mean(rows, name) for name in SHOWN)]
        for method, rows in by_method.items()
    ]
    return Section("Robots compared", page.table(head, body))


def _mean(rows: Sequence[StudyRow], name: str) -> str:
    pairs = [
        ((row["participant"],), float(row[name] or 0)) for row in rows if row[name] is not None
    ]
    if not pairs:
        return "-"
    mean = estimate_by(pairs)
    error = f' <span class="se">± {mean.se:.2f}</span>' if mean.is_known else ""
    return f"{mean.mean:.2f}{error}"


def _trials(trials: Sequence[StudyRow]) -> Section:
    head = ["participant", "trial", "robot", "goals", "changed after", "ending", "steps",
            "right guesses"]  # fmt: skip
    body = [
        [str(row["participant"]), str(row["trial"]), page.escape(str(row["method"])),
         page.escape(str(row["goals"])), str(row["turns"] or "-"), str(row["ending"]),
         str(row["total_steps"]), f"{float(row['correct_pct'] or 0):.0f} %"]
        for row in sorted(trials, key=lambda row: (str(row["participant"]), int(row["trial"] or 0)))
    ]  # fmt: skip
    return Section("Every trial", page.table(head, body, "tight"))
