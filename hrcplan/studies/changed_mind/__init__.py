"""The changed-mind paper: a robot infers the goal of a human, which may change, and helps.

Ghose, Gitelson, Jin, Abawe, Vázquez, Scassellati: I've Changed My Mind: Robots Adapting to Changing
Human Goals during Collaboration. The four measures of its Figure 3, its robot study (Figure 4), and
what goes beyond it; ``docs/papers/changed-mind.md`` says how its gaps were read.
"""

from __future__ import annotations

from functools import partial

from hrcplan.studies.changed_mind import episodes, scenario
from hrcplan.studies.changed_mind.findings import findings
from hrcplan.studies.study import Study, StudyTable

STUDY = Study(
    name="changed-mind",
    title="Changed mind",
    tables=tuple(
        StudyTable(name, ("human", "method"), episodes.COLUMNS, partial(scenario.cells, name),
              episodes.simulate, at_most=table.get("at_most"), clocked=episodes.CLOCKED,
              grown=episodes.GROWN, traced=episodes.simulate_with_trace)
        for name, table in scenario.data()["tables"].items()
    ),
    measures=episodes.MEASURES,
    details=episodes.DETAILS,
    options=scenario.defaults(),
    findings=findings,
    inputs=scenario.inputs,
    runs=scenario.runs,
    prepare=scenario.prepare,
    files=scenario.files,
    is_ready=lambda cell: not scenario.needs_forest(str(cell[1])),
    unit=episodes.UNIT,
    renamed=dict.fromkeys(("method", "methods"), scenario.RENAMED),
)  # fmt: skip
