"""The measures are those of the paper: rows of its Table I come out to the last digit."""

import pytest

from hrcplan.execution import Outcome, Spec, engine_for, means, simulate
from hrcplan.execution.worlds.simulated import Nature, StateChange

# Types of runs without the model: four actions each, in lock-step, six failures at one.
UNTOUCHED = Outcome(True, "goal reached", assigned_human=4, assigned_robot=4, executed_human=4,
                executed_robot=4)  # fmt: skip
AT_FIRST = Outcome(False, "replan limit", replans_failure=5, assigned_human=6 * 4,
               assigned_robot=4 + 3 + 2 + 1, executed_robot=4, failed_human=6)  # fmt: skip
AT_THIRD = Outcome(False, "replan limit", replans_failure=5, assigned_human=4 + 10,
               assigned_robot=5, executed_human=2, executed_robot=4, failed_human=6)  # fmt: skip


@pytest.mark.parametrize(
    ("counts", "printed"),
    [
        ((10, 28, 2), (25.00, 3.75, 44.50, 65.60, 34.40, 14.17, 85.83)),
        ((15, 22, 3), (37.50, 3.125, 36.75, 63.10, 36.90, 21.25, 78.75)),
    ],
    ids=["1a", "2a"],
)
def test_rows_of_table_1(counts: tuple[int, int, int], printed: tuple[float, ...]) -> None:
    rows = [row for row, n in zip((UNTOUCHED, AT_FIRST, AT_THIRD), counts, strict=True)
            for _ in range(n)]  # fmt: skip
    found = [mean for mean, _ in list(means(rows).values())[:7]]
    assert found == pytest.approx(printed, abs=0.005)


@pytest.mark.parametrize(
    ("element", "like"),
    [
        (("motivation", "human"), AT_FIRST),
        (("capacity", "human", "wp5"), AT_THIRD),
        (("capacity", "human", "wp3"), UNTOUCHED),
    ],
)
def test_simulated_runs_are_of_these_types(element: tuple[str, ...], like: Outcome) -> None:
    """Without the model the same plan is tried again until the replan limit ends the run."""
    engine = engine_for(Spec(model=False, profile="replan-always"))
    run = engine.run(Nature(0, (StateChange(0.0, {element: 10}),)))
    found = engine.outcome(run)
    counted = {k: v for k, v in found.to_json().items() if k != "makespan_s"}
    assert counted == {k: v for k, v in like.to_json().items() if k != "makespan_s"}


def test_standard_error_and_empty_means() -> None:
    assert means([])["replans"] == (0.0, 0.0)
    assert means([UNTOUCHED, AT_FIRST])["success_pct"] == (50.0, 50.0)


def test_no_action_at_all_is_no_division_by_zero() -> None:
    assert Outcome(False, "no plan").measures()["failed_pct"] == 0.0


def test_the_same_seed_gives_the_same_row_and_another_seed_others() -> None:
    specs = [Spec(case=2, seed=f"s/{i}") for i in range(6)]
    rows = [simulate(spec) for spec in specs]
    assert rows == [simulate(spec) for spec in reversed(specs)][::-1]
    assert len(set(rows)) > 1
