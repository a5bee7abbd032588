"""What was done in a run is drawn as a plan is."""

from hrcplan.execution.execute import execute
from hrcplan.pddl.inputs import read
from hrcplan.plots.gantt import draw


def test_a_run_with_a_failure_is_drawn() -> None:
    changes = ["motivation human=9@0"]
    run = execute("transport/two-boxes", model=False, seed=1, human="attempt", changes=changes)
    done, failed = run.timeline.as_plan()
    assert done.is_schedule
    assert len(failed) == run.outcome.failed_human + run.outcome.failed_robot >= 1
    problem = read("transport/two-boxes")
    assert draw(problem, done, "svg", failed) != draw(problem, done, "svg")
