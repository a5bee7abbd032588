"""Who does what at which price: on graphs that are built in steps, and in teams."""

import numpy as np
import pytest
from click.testing import CliRunner

from hrcplan.bank import BuildOptions, build_bank, save
from hrcplan.bank.allocation import allocations
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP, cost_to_go_of
from hrcplan.cli.main import main

EAGER, WEARY = ({("motivation", "human"): value} for value in (1, 9))


def of(bank, values):
    return {one.goal: one for one in allocations(bank, values)}


@pytest.fixture(scope="module")
def boxes():
    return build_bank("transport", "transport-goals")


@pytest.mark.parametrize("cost", ["steps", "task"])
def test_a_weary_human_is_spared_in_the_kitchen(cost):
    bank = build_bank("kitchen", recipe=BuildOptions(cost), only=["parfait-fruit"])
    eager, weary = of(bank, EAGER)["parfait-fruit"], of(bank, WEARY)["parfait-fruit"]
    assert eager.either == sum(weary.actions.values()) > 0
    assert weary.actions["human"] == 0


def test_a_weary_human_is_spared_in_a_team(boxes):
    eager, weary = of(boxes, EAGER), of(boxes, WEARY)
    assert eager["sorted"].actions["human"] > 0
    assert weary["sorted"].actions["human"] == 0
    assert weary["sorted"].timesteps > eager["sorted"].timesteps
    assert weary["sorted"].cost > eager["sorted"].cost


def test_interactions_are_priced_and_named():
    bank = build_bank("transport-coached")
    assert "remind" in bank.note
    assert of(bank, EAGER)["two-boxes"].interactions == 0
    assert of(bank, WEARY)["two-boxes"].interactions > 0


def test_without_prices_a_team_plan_is_one_of_fewest_timesteps(boxes):
    costs = cost_to_go_of(boxes)
    places = np.arange(500)
    for goal in range(len(boxes.names)):
        priced = costs.priced(goal, np.zeros(len(boxes.table.ops)), 1.0)
        for turn in range(len(boxes.team)):
            timesteps = costs.of(places, turn)[goal]
            expected = np.where(timesteps < NEVER, timesteps // TIMESTEP, np.inf)
            assert priced[turn, places].tolist() == expected.tolist()


def test_the_command_takes_values_and_profiles(boxes, tmp_path):
    path = str(tmp_path / "boxes.bank")
    save(boxes, path)
    weary = ["--set", "motivation human=9"]
    texts = [
        CliRunner().invoke(main, ["bank", "show", path, "--allocation", *more]).output
        for more in ([], weary, [*weary, "--profile", "hrcplan"])
    ]
    assert len(set(texts)) == 3
    assert CliRunner().invoke(main, ["bank", "show", path, *weary]).exit_code == 2
