"""The shipped household: people and a robot who move, carry and differ."""

from collections.abc import Iterator

import pytest

import hrcplan
from hrcplan.bank import Bank, build, read_goals
from hrcplan.bank.cost_to_go import cost_to_go_of
from hrcplan.collaboration.collaborate import course_of, make_setup, simulated
from hrcplan.pddl.library import domain_names, find_domain


@pytest.fixture(scope="module")
def bank() -> Iterator[Bank]:
    bank = build(read_goals("household"))
    costs = cost_to_go_of(bank)  # shared by all episodes as long as one needs them
    yield bank
    del costs


def test_agents_differ_and_wait_for_each_other_in_every_team_plan(bank: Bank) -> None:
    assert bank.team == ("anna", "robot")
    assert len(bank.names) == 10
    assert min(graph.plans for graph in bank.graphs) >= 1


@pytest.mark.parametrize("pace", ["turns", "free"])
def test_a_goal_that_changes_is_reached(bank: Bank, pace: str) -> None:
    setup = make_setup(bank, pace=pace, human={"who": "frontier"})
    for seed in range(3):
        done = simulated(setup, bank, course_of(bank, seed)).run()
        assert done.reached >= {bank.names[course_of(bank, seed).goals[-1]]}


def test_only_agents_that_can_do_what_the_plan_needs_do_it() -> None:
    plan = hrcplan.plan("household/tidy-up").plan
    assert plan is not None
    assert {action.args[0] for action in plan.actions if "suitcase" in action.args} == {"robot"}
    assert {action.args[0] for action in plan.actions if "bath" in action.args} == {"anna"}


def test_a_failure_is_anticipated_and_the_other_agent_takes_over() -> None:
    """Anna is tired: the robot carries all that it can."""
    problem = hrcplan.read("household/departure")
    alone, tired = (
        hrcplan.execute(problem, changes=changes).outcome
        for changes in ((), ("motivation anna=9@0",))
    )
    assert alone.success
    assert tired.success
    assert tired.replans == 1
    assert tired.executed_robot > alone.executed_robot


@pytest.mark.parametrize("folder", ["household-family", "transport-goals"])
def test_a_folder_of_goals_has_the_domain_that_its_problems_name(folder: str) -> None:
    assert folder not in domain_names()
    assert find_domain(folder).stem == folder.partition("-")[0]
