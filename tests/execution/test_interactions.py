"""Beyond the paper: interactions, estimation, and failure memory, in simulated runs."""

from collections.abc import Mapping
from typing import Any

import pytest

from hrcplan.agents import load_profile
from hrcplan.execution import Outcome, Spec, engine_for, means, simulate
from hrcplan.execution import events as ev
from hrcplan.execution.execute import carry_out, prepare_run
from hrcplan.execution.journal import read_journal
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.replay import replay
from hrcplan.execution.simulate import Engine
from hrcplan.execution.worlds.simulated import Nature, StateChange
from hrcplan.pddl.inputs import read
from hrcplan.planners.expected_price import with_success

MOTIVATION = ("motivation", "human")
COACHED: Mapping[str, Any] = {"domain": "transport-coached", "profile": "hrcplan", "case": 2}
MEMORY: Mapping[str, Any] = {"model": False, "profile": "hrcplan"}
ESTIMATED: Mapping[str, Any] = {"model": False, "profile": "estimated"}


def rows(n: int, **changes: Any) -> list[Outcome]:
    return [simulate(Spec(seed=f"beyond-{i}", planner="exact", **changes)) for i in range(n)]


def coached(probability: float, seed: int = 0, value: float = 8) -> tuple[Outcome, list[str]]:
    """Return a run whose human is unmotivated from the start, and what was done in it."""
    problem = with_success(read("transport-coached", "two-boxes"), probability)
    model = ExecutionModel(problem)
    engine = Engine(Monitor(model, load_profile("hrcplan")), Replanner(model))
    nature = Nature(seed, (StateChange(0.0, {MOTIVATION: value}),), sensed="before")
    done: list[str] = []

    def watch(run: object, event: ev.Event, commands: tuple[ev.Command, ...]) -> None:
        done.extend(str(c) for c in commands if isinstance(c, ev.Dispatch))

    return engine.outcome(engine.run(nature, watch=watch)), done


def test_a_reminder_that_works_needs_no_replan() -> None:
    row, done = coached(1)
    assert done[0] == "(remind robot human)"
    assert (row.success, row.replans, row.plans_confirmed, row.interactions) == (True, 0, 0, 1)
    assert (row.executed_human, row.failed_human) == (4, 0)
    assert row.makespan_s == pytest.approx(250, abs=1)


def test_one_that_does_not_is_planned_again() -> None:
    """Seeds in which the first reminder fails: the state is sensed unchanged, and it replans."""
    found = [coached(0.5, seed) for seed in range(12)]
    again = [row for row, done in found if done.count("(remind robot human)") == 2]
    assert again
    for row in again:
        assert (row.success, row.interactions, row.replans) == (True, 2, 1)
        assert row.makespan_s == pytest.approx(300, abs=1)


def test_what_never_works_is_not_tried() -> None:
    row, done = coached(0, value=10)
    assert row.success
    assert not any("remind" in step for step in done)
    assert row.executed_human == 0


def test_an_interaction_that_leaves_more_is_worth_less() -> None:
    """What is left is a sensed value like others, and told to the planner like others."""
    problem = read("transport-coached", "two-boxes").with_values({("residual",): 5})
    model = ExecutionModel(problem)
    engine = Engine(Monitor(model, load_profile("hrcplan")), Replanner(model))
    told = engine.monitor.decider.planner_values(engine.monitor.begin())
    assert float(told["residual",]) == pytest.approx(1 + 6.93, abs=0.01)
    assert told[MOTIVATION] == 1


def test_what_could_only_get_worse_is_no_state_of_the_task() -> None:
    """Every element is below what is left, so no interaction is offered but for the raised one."""
    residual = ((("residual",), 3),)
    engine = engine_for(Spec(planner="exact", values=residual, **COACHED))
    assert means(rows(20, values=residual, **COACHED))["success_pct"][0] == 100
    kept = engine.planner._groundings._structures
    assert max(len(values) for k in kept for values in k.task.value_sets.values()) == 2
    assert all(sum(len(v) > 1 for v in k.task.value_sets.values()) <= 1 for k in kept)


def test_a_journal_of_interactions_replays(tmp_path: Any) -> None:
    problem = read("transport-coached", "two-boxes")
    path = tmp_path / "run.jsonl"
    prepared = prepare_run(
        problem, profile="hrcplan", human="partly-cooperative", planner="exact", seed=3
    )
    done = carry_out(prepared, journal=path)
    found = replay(read_journal(path))
    assert found.difference is None
    assert found.row == done.outcome


def test_estimates_are_replayed_too(tmp_path: Any) -> None:
    path = tmp_path / "run.jsonl"
    prepared = prepare_run(read("transport", "two-boxes"), profile="estimated", model=False,
                           human="uncooperative", planner="exact", seed=5)  # fmt: skip
    done = carry_out(prepared, journal=path)
    found = replay(read_journal(path))
    assert (found.difference, found.row) == (None, done.outcome)


def test_the_same_seed_gives_the_same_rows() -> None:
    for changes in (COACHED, {"case": 2, **ESTIMATED}):
        first = rows(6, **changes)
        for known in (engine_for(Spec(planner="exact", **changes)).planner,):
            known._answers.clear()
        assert rows(6, **changes) == first


def test_interactions_keep_the_human_at_work() -> None:
    """Bands of the goals, wide enough for 60 runs."""
    measures = means(rows(60, **COACHED))
    assert measures["success_pct"][0] == 100
    assert measures["successful_human_pct"][0] >= 40
    assert measures["makespan_s"][0] <= 275 + 2 * measures["makespan_s"][1]
    assert measures["replans"][0] <= 1.2 + 2 * measures["replans"][1]


@pytest.mark.parametrize("method", [MEMORY, ESTIMATED])
@pytest.mark.parametrize("when", ["start", "random"])
@pytest.mark.parametrize("case", [1, 2])
def test_without_sensing_failures_are_enough(
    method: Mapping[str, Any], when: str, case: int
) -> None:
    measures = means(rows(40, case=case, when=when, **method))
    assert measures["success_pct"][0] == 100
    assert measures["replans"][0] <= 2


def test_a_probability_of_ones_own() -> None:
    sure = means(rows(25, success=1.0, **COACHED))
    rare = means(rows(25, success=0.4, **COACHED))
    assert sure["replans"][0] < rare["replans"][0]
    assert sure["makespan_s"][0] < rare["makespan_s"][0]
