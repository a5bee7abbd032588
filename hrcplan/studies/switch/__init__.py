"""The benchmark hrcplan-switch: humans whose goal may change, in shipped and generated worlds.

In the table `assistance` a robot helps such a human; in the table `inference` a belief watches
episodes of one and the same robot. ``benchmark.toml`` is the definition, ``instances.json`` lists
the instances, and `hrcplan.studies.switch.score.score` judges traces of any origin.
"""

from __future__ import annotations

from functools import partial

from hrcplan.studies.study import Study, StudyTable
from hrcplan.studies.switch import episodes, methods
from hrcplan.studies.switch.findings import findings, inputs
from hrcplan.studies.switch.tasks import all_pddl_files, definition

STUDY = Study(
    name="switch",
    title="hrcplan-switch",
    version=definition()["version"],
    tables=tuple(
        StudyTable(
            table, episodes.KEYS, episodes.COLUMNS[table], partial(methods.cells, table),
            partial(episodes.simulate, table), at_most=definition()["runs"],
            traced=partial(episodes.simulate_with_trace, table),
        )
        for table in definition()["tables"]
    ),
    measures=(*episodes.HELP, *episodes.GUESSES),
    details=episodes.COUNTS,
    options={"methods": ""},
    findings=findings,
    inputs=inputs,
    runs=lambda options: int(definition()["runs"]),
    prepare=methods.prepare,
    files=methods.files,
    pddl=lambda options: all_pddl_files(),
    is_ready=lambda cell: not methods.needs_training(str(cell[2])),
    unit=("first", "second"),
)  # fmt: skip
