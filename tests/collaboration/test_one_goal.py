"""With one goal the companion asks the planner, and is the executor of plans."""

from functools import lru_cache

import pytest

from hrcplan.bank import Bank, from_problems
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.collaborate import assistant_of, make_setup, parts_with
from hrcplan.collaboration.persons import CooperativePerson
from hrcplan.execution.execute import carry_out, prepare_run
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.outcome import outcome_of
from hrcplan.execution.replanner import Replanner
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.task.steps import StepTable


@lru_cache
def planner() -> Replanner:
    return Replanner(ExecutionModel(two_boxes()))


@lru_cache
def two_boxes() -> Problem:
    return read("transport", "two-boxes")


@lru_cache
def bank() -> Bank:
    goals = from_problems([two_boxes()])
    return Bank(goals, StepTable(goals.task), ())


@pytest.mark.parametrize(
    ("human", "changes", "seed"),
    [("steady", (), 1), ("uncooperative,attempt", (), 3), ("partly-cooperative", (), 4),
     ("steady", ("motivation human=9@60",), 1), ("uncooperative", (), 11)],
)  # fmt: skip
def test_one_goal_is_carried_out_as_execute_does(
    human: str, changes: tuple[str, ...], seed: int
) -> None:
    prepared = prepare_run(
        two_boxes(), human=human, changes=changes, seed=seed, provider=planner()
    )  # fmt: skip
    executed = carry_out(prepared)
    setup = make_setup(bank(), pace="free")
    adviser = Adviser(setup, bank(), assistant_of(setup), planner())
    run = parts_with(setup, bank(), adviser, CooperativePerson(), prepared.setup.nature).run()
    assert outcome_of(run.run, setup.robots) == executed.outcome
    assert run.run.state == executed.run.state
