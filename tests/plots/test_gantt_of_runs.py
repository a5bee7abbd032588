"""What was done in a run is drawn as a plan is."""

import pytest

from hrcplan.execution.execute import execute
from hrcplan.pddl.inputs import read
from hrcplan.plots.gantt import draw


@pytest.mark.parametrize(("changes", "n_failed"), [((), 0), (("motivation human=9@0",), 1)])
def test_a_run_with_and_without_failures(changes: tuple[str, ...], n_failed: int) -> None:
    run = execute("transport/two-boxes", model=False, seed=1, human="attempt", changes=changes)
    done, failed = run.timeline.as_plan()
    assert done.is_schedule
    assert len(failed) == n_failed
    assert draw(read("transport/two-boxes"), done, "svg", failed).startswith(b"<")
