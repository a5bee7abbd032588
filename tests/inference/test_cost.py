"""The method cost: on benchmark instances, with unobserved actions, and as a distribution."""

import dataclasses

import numpy as np
import pytest

from hrcplan.bank import Goals
from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference.observations import Resolver
from hrcplan.inference.recognition.cost import CostBelief
from hrcplan.inference.run import infer, run

GRID, BLOCKS = "easy-ipc-grid_p5-5-5_hyp-0_full", "block-words_p01_hyp-0_full"
LOGISTICS, KITCHEN = "logistics_p01_hyp-3_full", "kitchen_generic_hyp-0_full_0"


@pytest.mark.parametrize("folder", [GRID, BLOCKS, LOGISTICS])
def test_the_true_goal_is_found_once_it_is_reached(instances, folder):
    instance = read_instance(instances / folder)
    found = infer(str(instances / folder))
    assert found.method == "cost"
    assert len(found.posterior) == len(instance.observations) + 1
    assert found.posterior[-1].index(max(found.posterior[-1])) == instance.true_goal
    assert found.ignored == ()
    assert all(sum(row) == pytest.approx(1) for row in found.posterior)
    assert len(set(found.posterior[0])) == 1


@pytest.mark.parametrize("folder", [GRID, LOGISTICS])
def test_the_same_numbers_whatever_happened_before(instances, folder):
    """Nothing depends on time, on earlier calls, or on other beliefs."""
    first = infer(str(instances / folder))
    infer(str(instances / KITCHEN))
    assert infer(str(instances / folder)) == first


def test_what_can_be_done_is_a_distribution_for_each_goal(instances):
    instance = read_instance(instances / BLOCKS)
    belief = CostBelief(instance.goals)
    state = belief.start()
    for words in instance.observations:
        steps, policy = belief._policy(state, state.world, [])
        assert len(steps) == policy.shape[1]
        assert policy.sum(axis=1) == pytest.approx(np.ones((2, len(instance.goals))))
        step = belief.steps.find(words)
        assert step in steps
        state = belief.observe(state, step)


def test_the_robot_moves_the_world_and_is_no_evidence(hall):
    goals: Goals = hall.goals
    belief = CostBelief(goals)
    step = belief.steps.applicable(belief.start().world)[0]
    before = belief.start()
    after = belief.observe(before, step, robot=True)
    assert after.world != before.world
    assert after.filter_state is before.filter_state


def test_a_goal_that_gets_out_of_reach_is_improbable(workshop):
    """Sealed boxes cannot be unfolded again, so nothing more can be packed into them."""
    belief = CostBelief(workshop.goals)
    state = belief.start()
    for words in (("unfold", "red"), ("seal", "red")):
        state = belief.observe(state, belief.steps.find(words))
    lost = np.isinf(state.shares[0].costs)
    assert lost.tolist() == [True, True, True, False, False]
    assert belief.posterior(state)[lost].sum() < 0.01


def test_unobserved_actions_are_put_in_between(instances):
    """Every second action is left out: what could not have been done follows what makes it so."""
    instance = read_instance(instances / LOGISTICS)
    some = instance.observations[1::2]
    belief = CostBelief(instance.goals)
    found = run(belief, Resolver(belief.steps, instance.goals), some, "cost")
    assert found.ignored == ()
    order = sorted(range(len(instance.goals)), key=lambda goal: -found.posterior[-1][goal])
    assert instance.true_goal in order[:3]
    state = belief.start()
    for words in some:
        step = belief.steps.find(words)
        assert step is not None
        state = belief.observe(state, step)
    assert state.n_bridged > 0


def test_action_names_that_are_declared_twice(instances):
    """Observed under the name that they share, the one that can be done is meant."""
    instance = read_instance(instances / KITCHEN)
    aliases = instance.goals.aliases
    assert aliases
    belief = CostBelief(instance.goals)
    resolver = Resolver(belief.steps, instance.goals)
    name = next(iter(aliases))
    steps = [belief.steps.find((alias,)) for alias in aliases[name]]
    worlds = [value for step in steps for value in [belief.goals.task.actions[step].tests[0][1]]
              if step is not None]  # fmt: skip
    for step, world in zip(steps, worlds, strict=True):
        found = resolver.find((name,), world)
        assert not isinstance(found, str)
        assert belief.steps.successor(world, found.index) is not None
        assert found.index <= step


def test_places_are_values(workshop):
    belief = CostBelief(workshop.goals)
    with pytest.raises(dataclasses.FrozenInstanceError):
        belief.start().world = 3
