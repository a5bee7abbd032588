"""Against K*: its complete list of optimal plans is what the graphs hold."""

from fractions import Fraction

import pytest

from hrcplan.bank import BuildOptions, StepTable, build, build_bank, from_problems
from hrcplan.bank.enumerated import step_task
from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.bank.walk import plans
from hrcplan.errors import LimitError, MissingPlannerError
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.planners import kstar
from hrcplan.planners.lowering import lower
from hrcplan.planners.process import ProcessLimits

LIMITS = ProcessLimits(time_s=120, output_bytes=1 << 28)


def listed(bank, goal, quality):
    task, steps = step_task(bank.table, bank.goals.formulas[goal])
    found = kstar.list_plans(lower(task), LIMITS, quality=float(quality))
    assert found.complete
    return [tuple(steps[action.index] for action in plan) for plan in found.plans]


@pytest.mark.parametrize(
    ("problem", "goal", "cost"),
    [
        (("kitchen", "stew-bean"), "(and (blended milk) (mixed honey bowl) (served))", "steps"),
        (("kitchen", "stew-bean"), "(and (blended milk) (mixed honey bowl) (served))", "task"),
        (("kitchen", "stew-bean"), "(or (cooked beans) (cooked lentils))", "steps"),
        (("kitchen", "stew-bean"), "(or (cooked beans) (cooked lentils))", "task"),
        (("transport", "two-boxes"), None, "task"),  # by steps its plans are team plans
    ],
)
def test_shipped_domains(problem, goal, cost):
    loaded = read(*problem)
    bank = build(
        from_problems([with_goal(loaded, goal, "g") if goal else loaded]), BuildOptions(cost=cost)
    )
    wanted = listed(bank, 0, 1)
    found = list(plans(bank.graphs[0]))
    assert len(wanted) == len(set(wanted)) == len(found) == bank.graphs[0].plans >= 50
    assert set(wanted) == set(found)


@pytest.mark.parametrize(
    ("folder", "goals"),
    [
        ("block-words_p01_hyp-0_full", [4, 15, 19]),
        ("easy-ipc-grid_p5-5-5_hyp-0_full", [1, 2]),
        ("kitchen_generic_hyp-0_full_0", [1, 2]),
    ],
)
def test_goal_recognition_domains(folder, goals, instances):
    path = instances / folder
    bank = build_bank(str(path / "domain.pddl"), str(path))
    for goal in goals:
        found = list(plans(bank.graphs[goal]))
        assert set(listed(bank, goal, 1)) == set(found)
        assert len(found) == bank.graphs[goal].plans > 1


def test_logistics(instances):
    goals = read_instance(instances / "logistics_p01_hyp-3_full").goals
    bank = build(from_problems([with_goal(goals.problem, "(and (at obj11 pos21))", "g")]))
    assert set(listed(bank, 0, 1)) == set(plans(bank.graphs[0])) != set()
    assert bank.graphs[0].n_steps >= 9


def test_plans_that_are_not_optimal():
    """K* also lists plans with steps that change nothing, or that go on after the goal."""
    goal = with_goal(read("kitchen", "stew-bean"), "(and (mixed honey bowl) (served))", "g")
    bank = build(from_problems([goal]), BuildOptions(quality=Fraction(6, 5)))
    graph = bank.graphs[0]
    assert graph.final_costs == (5, 6)
    assert set(plans(graph)) == {plan for plan in listed(bank, 0, 1.2) if to_the_point(bank, plan)}


def to_the_point(bank, plan):
    state = bank.initial
    for step in plan:
        after = bank.table.successor(state, step)
        if after == state or bank.goals.is_reached(0, state):
            return False
        state = after
    return True


def test_a_bank_of_listed_plans():
    bank = build_bank("kitchen", None, BuildOptions(sample=50), only=["parfait-nut"])
    whole = build_bank("kitchen", only=["parfait-nut"])
    graph = bank.graphs[0]
    assert not graph.complete
    assert 50 <= graph.plans < whole.graphs[0].plans
    assert all(whole.graphs[0].after(plan) is not None for plan in plans(graph))
    few = build(two_pots(), BuildOptions(sample=5000)).graphs[0]
    assert few.complete
    assert set(plans(few)) == set(plans(build(two_pots()).graphs[0]))


def two_pots():
    loaded = read("kitchen", "stew-bean")
    return from_problems([with_goal(loaded, "(or (cooked beans) (cooked lentils))", "g")])


def test_limits_of_listing(monkeypatch):
    task, _ = step_task(StepTable(two_pots().task), two_pots().formulas[0])
    with pytest.raises(LimitError):
        kstar.list_plans(lower(task), ProcessLimits(time_s=0), n=3)
    with pytest.raises(ValueError, match="number of plans or a quality"):
        kstar.list_plans(lower(task), LIMITS, quality=None)
    monkeypatch.setattr(kstar, "find_spec", lambda name: None)
    monkeypatch.setattr("hrcplan.core.extras.find_spec", lambda name: None)
    with pytest.raises(MissingPlannerError, match=r"hrcplan\[topk\]"):
        kstar.list_plans(lower(task), LIMITS, n=3)
