"""The failure-anticipation paper: plans fail less because their cost includes the human's state.

Izquierdo-Badiola, Canal, Rizzo, Alenyà: Improved Task Planning through Failure Anticipation in
Human-Robot Collaboration. Cases 1a to 2b of its Table I, its Figure 5, and what goes beyond it;
``docs/papers/failure-anticipation.md`` says how its gaps were read.
"""

from __future__ import annotations

from functools import partial

from hrcplan.studies.failure_anticipation import episodes, measures, scenario
from hrcplan.studies.failure_anticipation.findings import findings
from hrcplan.studies.study import Study, StudyTable

STUDY = Study(
    name="failure-anticipation",
    title="Failure anticipation",
    tables=(
        StudyTable("rows", ("case", "method"), episodes.COLUMNS,
              partial(scenario.cells, "methods"), partial(episodes.simulate, "methods")),
        StudyTable("variants", ("case", "method"), episodes.COLUMNS,
              partial(scenario.cells, "variants"), partial(episodes.simulate, "variants"),
              at_most=200),
        StudyTable("sweeps", ("parameter", "setting"), episodes.COLUMNS,
              scenario.sweep_cells, episodes.swept, at_most=100),
        StudyTable("allocation", ("profile", "action", "value"), episodes.SHARES,
              episodes.allocation_cells, episodes.allocation, at_most=1),
        StudyTable("example", ("variant",), episodes.TOLD,
              episodes.example_cells, episodes.example, at_most=1),
    ),
    measures=measures.MAIN,
    details=measures.DETAILS,
    options=scenario.defaults(),
    findings=findings,
    inputs=scenario.inputs,
    renamed={key: {"paper": "replan-always"} for key in ("method", "profile")},
)  # fmt: skip
