"""Distances and the cost method: against breadth-first search, and on benchmark instances."""

import dataclasses

import numpy as np
import pytest

from hrcplan.bank.ramirez_geffner import read_instance
from hrcplan.inference.observations import Resolver
from hrcplan.inference.recognition.cost import CostBelief
from hrcplan.inference.recognition.optimal import FastDownwardProver, Searcher, search
from hrcplan.inference.run import infer, run
from hrcplan.search.distances import Distances
from hrcplan.search.relaxed_plan import Relaxation
from hrcplan.task import BitEffect
from hrcplan.task.steps import Operator
from tests.inference import enumerated_beliefs

GRID, BLOCKS = "easy-ipc-grid_p5-5-5_hyp-0_full", "block-words_p01_hyp-0_full"
LOGISTICS, KITCHEN = "logistics_p01_hyp-3_full", "kitchen_generic_hyp-0_full_0"


def reached(bank, seed, n):
    """Return states that random steps lead to."""
    rng, state, found = np.random.default_rng(seed), bank.initial, []
    for _ in range(n):
        options = bank.table.applicable(state)
        if not options:
            break
        state = bank.table.successor(state, options[rng.integers(len(options))])
        found.append(state)
    return found


@pytest.fixture(params=["workshop", "hall"])
def bank(request):
    return request.getfixturevalue(request.param)


def test_proven_distances_are_those_of_breadth_first_search(bank):
    ops = bank.table.ops
    for state in reached(bank, 1, 4):
        for goal, tests in enumerate(bank.goals.tests):
            if len(tests) > 1:
                continue
            way = search([Searcher(ops, tests[0]).text(state)], 5.0, 10.0)[0]
            plans = enumerated_beliefs.optimal_plans(bank, goal, state)
            assert (way is None) == (not plans)
            if way is not None:
                assert way.cost == len(plans[0]) == len(way.ops)
                for op in way.ops:
                    assert ops[op].is_enabled(state)
                    state = ops[op].apply(state)
                assert bank.goals.is_reached(goal, state)


def test_relaxed_plans_are_plans_where_nothing_is_ever_lost(bank):
    """Every estimate is enough to reach the goal without deletes, and zero just at the goal."""
    ops, goals = bank.table.ops, bank.goals.tests
    relaxation = Relaxation(ops, goals)
    states = [bank.initial, *reached(bank, 2, 8)]
    for state, costs in zip(states, relaxation.costs(states), strict=True):
        assert relaxation.costs([state])[0] == costs
        for goal, cost in enumerate(costs):
            assert (cost == 0) == bank.goals.is_reached(goal, state)


def test_an_estimate_is_missing_only_out_of_reach(workshop):
    """Sealed boxes cannot be unfolded again, so nothing more can be packed into them."""
    table = workshop.table
    state = workshop.initial
    for words in (("unfold", "red"), ("seal", "red")):
        state = table.successor(state, table.find(words))
    costs = Relaxation(table.ops, workshop.goals.tests).costs([state])[0]
    assert [cost is None for cost in costs] == [True, True, True, False, False]


def test_long_chains_need_no_recursion():
    """A corridor of three thousand places: one op each, and only the ones on the way count."""
    ops = [
        Operator(((1 << i, 1 << i),), (BitEffect(1 << i + 1, 0),), (), i, 1) for i in range(3000)
    ]
    goals = [((1 << place, 1 << place),) for place in (3000, 7, 0)]
    relaxation = Relaxation(ops[:60], [((1 << 60, 1 << 60),)])
    assert relaxation.costs([1]) == [[60.0]]
    long = Relaxation(ops, goals)
    literals = [long._ids[2 * place] for place in range(3001)]
    by_number = [0] * 3001
    for place, literal in enumerate(literals):
        by_number[literal] = place - 1  # its supporter; the first holds
    assert long._costs(by_number) == [3000.0, 7.0, 0.0]


def test_without_a_prover_distances_are_estimates(workshop):
    distances = Distances(workshop.table.ops, workshop.goals.tests, 20.0)
    first = distances.first(workshop.initial)
    assert all(goal.distance == goal.estimate and not goal.is_proven for goal in first)
    assert any(goal.estimate for goal in first)
    assert distances.bridge(workshop.initial, workshop.goals.tests[0]) is None


def test_a_way_is_carried_on_without_a_search(workshop):
    """What was done can stand at the beginning of a known way, in another order too."""
    distances = Distances(
        workshop.table.ops, workshop.goals.tests, 20.0, FastDownwardProver(workshop.table.ops)
    )
    places = distances.first(workshop.initial)
    way = places[0].way
    assert way is not None
    for done in way.ops:
        if not distances.ops[done].is_enabled(workshop.initial):
            continue
        after = distances.ops[done].apply(workshop.initial)
        rest = distances._rest_of(0, way, [done], after)
        assert rest is not None
        assert rest.cost == way.cost - 1
    assert distances._rest_of(0, way, [10**6], workshop.initial) is None


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


def test_without_time_relaxed_plans_answer_and_a_note_says_so(instances):
    instance = read_instance(instances / LOGISTICS)
    found = infer(str(instances / LOGISTICS), timeout_s=1e-6)
    assert found.note is not None
    assert "estimates" in found.note
    assert found.posterior[-1].index(max(found.posterior[-1])) == instance.true_goal


def test_unobserved_actions_are_put_in_between(instances):
    """Every second action is left out: what could not have been done follows what makes it so."""
    instance = read_instance(instances / LOGISTICS)
    some = instance.observations[1::2]
    belief = CostBelief(instance.goals, timeout_s=10)
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
    belief = CostBelief(instance.goals, timeout_s=5)
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
    belief = CostBelief(workshop.goals, timeout_s=5)
    with pytest.raises(dataclasses.FrozenInstanceError):
        belief.start().world = 3
