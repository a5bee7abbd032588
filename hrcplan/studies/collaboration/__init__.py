"""Goals that change while agents' states drift: what a robot gains that weighs both.

Neither the changed-mind paper nor the failure-anticipation paper has both. Measures are those of
both papers, and what a collaboration costs; ``docs/papers/collaboration.md`` says what comes out.
"""

from __future__ import annotations

from functools import partial

from hrcplan.studies.collaboration import episodes, scenario
from hrcplan.studies.collaboration.findings import findings
from hrcplan.studies.collaboration.measures import DETAILS, MEASURES
from hrcplan.studies.study import Study, StudyTable

STUDY = Study(
    name="collaboration",
    title="Collaboration",
    tables=tuple(
        StudyTable(name, scenario.KEYS, episodes.COLUMNS, partial(scenario.cells, name),
              episodes.simulate, at_most=table.get("at_most"),
              traced=episodes.simulate_with_trace)
        for name, table in scenario.data()["tables"].items()
    ),
    measures=tuple(MEASURES),
    details=DETAILS,
    options=scenario.defaults(),
    findings=findings,
    inputs=scenario.inputs,
    runs=scenario.runs,
    files=scenario.files,
    unit=episodes.UNIT,
)  # fmt: skip
