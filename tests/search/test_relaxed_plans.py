"""Relaxed plans: each reaches its goal, and achievers have equal shares."""

import numpy as np
import pytest

from hrcplan.search.bridge import find_bridge
from hrcplan.search.relaxed_plans import RelaxedPlans
from hrcplan.task import BitEffect
from hrcplan.task.steps import Operator


def operator(step, needs, adds, deletes=0):
    return Operator(((needs, needs),), (BitEffect(adds, deletes),), (), step, 1)


def states_of(bank, seed, n):
    """Return the initial state and those that random steps lead to."""
    rng, states = np.random.default_rng(seed), [bank.initial]
    while len(states) < n:
        options = bank.table.applicable(states[-1])
        if not options:
            break
        states.append(bank.table.successor(states[-1], options[rng.integers(len(options))]))
    return states


@pytest.mark.parametrize("name", ["workshop", "hall"])
def test_a_relaxed_plan_reaches_its_goal_if_nothing_is_ever_lost(name, request):
    """Checked with literals of both signs: what is true stays true, and what is false too."""
    bank = request.getfixturevalue(name)
    ops, goals = bank.table.ops, bank.goals.tests
    plans = RelaxedPlans(ops, goals, n_plans=1)
    for state in states_of(bank, 2, 9):
        shares = plans.shares(state)
        for goal, tests in enumerate(goals):
            assert (shares.costs[goal] == 0) == bank.goals.is_reached(goal, state)
            if np.isinf(shares.costs[goal]):
                continue
            true, false = state, ~state
            plan = [ops[i] for i in np.flatnonzero(shares.ops[:, goal])]
            for _ in plan:
                for op in plan:
                    if any(m & v & ~true == 0 and m & ~v & ~false == 0 for m, v in op.tests):
                        after = op.apply(true)
                        true, false = true | after, false | ~after
            assert any(v & ~true == 0 and m & ~v & ~false == 0 for m, v in tests)


def test_first_achievers_have_equal_shares():
    """Two ways of two steps make fact 3 true, and one of three steps that comes too late."""
    ops = [operator(0, 1, 2), operator(1, 1, 4), operator(2, 2, 8), operator(3, 4, 8),
           operator(4, 1, 16), operator(5, 16, 32), operator(6, 32, 8)]  # fmt: skip
    shares = RelaxedPlans(ops, [[(8, 8)], [(2, 2)], [(64, 64)]]).shares(1)
    assert shares.ops[:, 0].tolist() == [0.5, 0.5, 0.5, 0.5, 0, 0, 0]
    assert shares.facts[:4, 0].tolist() == [0, 0.5, 0.5, 1]
    assert shares.costs.tolist() == [2, 1, np.inf]


def test_shares_depend_on_the_state_alone(hall):
    states = states_of(hall, 3, 5)
    plans = RelaxedPlans(hall.table.ops, hall.goals.tests)
    forth = [plans.shares(state).ops for state in states]
    back = [plans.shares(state).ops for state in reversed(states)]
    assert all((a == b).all() for a, b in zip(forth, reversed(back), strict=True))


def test_long_chains_need_no_recursion():
    ops = [operator(i, 1 << i, 1 << i + 1) for i in range(3000)]
    goals = [[(1 << place, 1 << place)] for place in (3000, 7, 0)]
    assert RelaxedPlans(ops, goals).shares(1).costs.tolist() == [3000, 7, 0]


def test_a_bridge_leads_to_its_tests_within_its_budget(hall):
    table = hall.table
    test = hall.goals.tests[0]
    way = find_bridge(table, hall.initial, test)
    state = hall.initial
    for step in way:
        state = table.successor(state, step)
    assert hall.goals.is_reached(0, state)
    assert find_bridge(table, state, test, max_expansions=1) == ()
    assert find_bridge(table, hall.initial, test, max_expansions=1) is None
