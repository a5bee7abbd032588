"""Files of other projects: read, planned with a valid plan, or refused by name."""

from pathlib import Path

import pytest

import hrcplan
from hrcplan.errors import PddlError

PUBLIC = Path(__file__).parents[1] / "data" / "public"
PLANNED = [
    "plansys2/elevator",
    "plansys2/factory",
    "plansys2/road-trip",
    "plansys2/simple",
    "plansys2/simple-constants",
    "unified-planning/counters",
    "unified-planning/depot",
    "unified-planning/depots-temporal",
    "unified-planning/farmland",
    "unified-planning/fn-counters",
    "unified-planning/matchcellar",
    "unified-planning/miconic",
    "unified-planning/parking_action_cost",
    "unified-planning/plant-watering",
    "unified-planning/rovers-numeric",
    "unified-planning/safe_road",
    "unified-planning/sailing",
    "unified-planning/tpp",
    "unified-planning/tpp_metric",
    "unified-planning/viplan_hh",
    "unified-planning/visit_precedence",
    "pddlgym/conditionalferry",
    "pddlgym/derivedblocks",
    "pddlgym/elevator",
    "pddlgym/equalityblocks",
    "pddlgym/hanoi",
    "pddlgym/quantifiedblocks",
]
CONTINUOUS = [
    "unified-planning/car-linear",
    "unified-planning/car_nl",
    "val/coffee",
    "val/drive",
    "val/sleeping-beauty",
    "val/tanks",
    "val/vending",
]
READ = ["plansys2/charging", "unified-planning/citycar", "unified-planning/robot_fastener"]
REFUSED = {
    "pddlgym/river": "probabilistic effects",
    "pddlgym/tireworld": "probabilistic effects",
    "unified-planning/object_fluents": "functions have numbers as values",
}


def problem_in(name: str) -> hrcplan.Problem:
    return hrcplan.read(PUBLIC / name / "domain.pddl", PUBLIC / name / "problem.pddl")


def test_every_file_has_its_line() -> None:
    folders = {str(file.parent.relative_to(PUBLIC)) for file in PUBLIC.glob("*/*/domain.pddl")}
    assert folders == {*PLANNED, *CONTINUOUS, *READ, *REFUSED}


@pytest.mark.parametrize("name", [*READ, *CONTINUOUS])
def test_it_is_read(name: str) -> None:
    assert problem_in(name).goal


@pytest.mark.parametrize("name", PLANNED)
def test_it_is_planned(name: str) -> None:
    result = hrcplan.plan(problem_in(name), any_plan=True, timeout_s=60)
    assert result.report is not None
    assert result.report.valid


@pytest.mark.parametrize(("name", "reason"), REFUSED.items())
def test_it_is_refused_by_name(name: str, reason: str) -> None:
    with pytest.raises(PddlError, match=reason):
        problem_in(name)
