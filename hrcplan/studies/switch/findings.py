"""The page of the benchmark as a study, and the texts that its rows depend on."""

from __future__ import annotations

import json
from collections.abc import Sequence

from hrcplan.errors import UsageError
from hrcplan.studies.measure import mean_html
from hrcplan.studies.page import escape, table
from hrcplan.studies.study import Findings, Section, StudyOptions, StudyRow, StudyRows
from hrcplan.studies.switch.instances import listed_hashes
from hrcplan.studies.switch.methods import check
from hrcplan.studies.switch.standings import MEASURES, SHOWN, standings
from hrcplan.studies.switch.tasks import NAME, definition, hashes_of, task_names

ROW_FORMAT = 1
"""It changes when episodes get other columns or values: rows of two formats are not mixed."""
LEAD = (
    "Humans whose goal never changes, changes once, once with mistakes, or twice, in shipped and "
    "generated worlds. In <em>assistance</em> a robot helps them; in <em>inference</em> a belief "
    "watches episodes of one and the same robot. <code>hrcplan score</code> computes the same "
    "measures from traces."
)


def findings(options: StudyOptions, rows: StudyRows) -> Findings:
    """Return the table of each track."""
    sections = [_section(name, own) for name, own in rows.items() if own]
    return Findings(LEAD, (), sections)


def _section(name: str, rows: Sequence[StudyRow]) -> Section:
    head = ["", "episodes", *(MEASURES[measure].directed_head for measure in SHOWN[name])]
    lines = [
        [escape(one.method), str(one.n),
         *("\u2013" if mean is None else mean_html(mean) for mean in one.means.values())]
        for one in standings(name, rows)
    ]  # fmt: skip
    return Section(name.capitalize(), table(head, lines, "tight"))


def inputs(options: StudyOptions) -> str:
    """Return what rows depend on: the definition of the benchmark, and the hashes of its PDDL.

    Raises:
        UsageError: if a method cannot be found, or the PDDL is not that of the benchmark.
    """
    check(options)
    hashes = {task: hashes_of(task) for task in task_names()}
    for task, own in hashes.items():
        if own != listed_hashes()[task]:
            message = f"the PDDL of the task '{task}' is not that of {NAME}"
            hint = "a folder of this name may hide the shipped one; start in another folder"
            raise UsageError(message, code="other-pddl", hint=hint)
    return json.dumps([definition(), hashes, ROW_FORMAT], sort_keys=True)
