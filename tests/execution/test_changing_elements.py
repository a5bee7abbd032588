"""Simulated humans whose state drifts, or changes in several places; failures that cost time."""

from hrcplan.execution import Spec, engine_for
from hrcplan.execution import events as ev
from hrcplan.execution.simulate import cause_of, nature_of


def test_an_element_rises_step_by_step_to_its_level():
    spec = Spec(case=1, drift_s=25, seed="drift")
    changes = nature_of(spec, engine_for(spec)).changes
    (key,) = {key for change in changes for key in change.values}
    assert [change.values[key] for change in changes] == list(range(2, 11))
    assert [change.t for change in changes] == [25.0 * step for step in range(9)]


def test_several_elements_change_and_the_first_is_the_one_that_changes_alone():
    spec = Spec(case=2, n_elements=3, when="random", seed="three")
    engine = engine_for(spec)
    changes = nature_of(spec, engine).changes
    keys = [key for change in changes for key in change.values]
    assert len(set(keys)) == 3
    assert cause_of(spec, engine) in keys
    assert [change.t for change in changes] == sorted(change.t for change in changes)
    (alone,) = nature_of(Spec(case=2, when="random", seed="three"), engine).changes
    assert alone in changes


def test_an_action_that_a_domain_has_to_do_without():
    names = {a.name for a in engine_for(Spec(without=("take",))).model.problem.domain.actions}
    assert names == {"move", "grasp", "place"}


def test_a_failed_action_lasts_longer():
    ends = {}
    for failure_s in (0.0, 120.0):
        spec = Spec(case=1, seed="costly", failure_s=failure_s)
        engine, failures = engine_for(spec), []

        def watch(run, event, commands, failures=failures):
            if isinstance(event, ev.Ended) and event.outcome == ev.FAILED:
                failures.append(event.t)

        engine.run(nature_of(spec, engine), watch=watch)
        ends[failure_s] = failures[0]
    assert ends[120.0] == ends[0.0] + 120.0
