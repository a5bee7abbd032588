"""Counts and plans against every sequence of small random worlds."""

from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.bank import BuildOptions, build
from hrcplan.bank.construct import optimal_graph
from hrcplan.bank.multisets import is_subset
from hrcplan.bank.walk import is_prefix, is_subsequence, plans

FACTS = [f"p{i}" for i in range(5)]
MAX_PLANS = 3_000


@st.composite
def literals(draw, low, high, positive=2):
    """Draw some facts, one in ``positive + 1`` of them negated."""
    chosen = draw(st.lists(st.sampled_from(FACTS), min_size=low, max_size=high, unique=True))
    return [f"({n})" if draw(st.integers(0, positive)) else f"(not ({n}))" for n in chosen]


@st.composite
def actions(draw, index, agents):
    """Draw an action; most of them lead from one fact to the next, so that plans are long."""
    before, after = draw(literals(0, 2)), draw(literals(0, 1, positive=0))
    if index and draw(st.integers(0, 3)):
        before.append(f"({FACTS[draw(st.integers(0, index - 1))]})")
    after.append(f"({FACTS[index % len(FACTS)]})")
    if draw(st.integers(0, 5)) == 0:
        before = [f"(or (and {' '.join(before)}) ({draw(st.sampled_from(FACTS))}))"]
    if draw(st.integers(0, 4)) == 0:
        given_, then = draw(literals(1, 1)), draw(literals(1, 1))
        after.append(f"(when {given_[0]} {then[0]})")
    if agents and draw(st.integers(0, 2)) == 0:
        before.append("(able ?a)")
    if agents == "moving" and draw(st.booleans()):
        after.append(draw(st.sampled_from(["(able ?a)", "(not (able ?a))"])))
    cost = draw(st.sampled_from(["1", "1", "2", "0.5", "0"]))
    params = "?a - agent" if agents else ""
    return (
        f"(:action do{index} :parameters ({params}) :precondition (and {' '.join(before)})"
        f" :effect (and {' '.join(after)} (increase (total-cost) {cost})))"
    )


@st.composite
def worlds(draw, agents=("", "fixed", "moving")):
    kind = draw(st.sampled_from(agents))
    text = " ".join(draw(actions(i, kind)) for i in range(draw(st.integers(3, 6))))
    typing = "(:types agent)" if kind else ""
    able = "(able ?a - agent)" if kind else ""
    domain = f"""(define (domain d) (:requirements :adl :action-costs) {typing}
      (:predicates {able} {" ".join(f"({f})" for f in FACTS)}) (:functions (total-cost)) {text})"""
    objects = "(:objects ann bob - agent)" if kind else ""
    start = draw(st.lists(st.sampled_from(["(p0)", "(p1)"]), max_size=1))
    start += ["(able ann)"] if kind else []
    goal = " ".join([*draw(literals(1, 2)), draw(st.sampled_from(["(p2)", "(p3)", "(p4)"]))])
    if draw(st.integers(0, 4)) == 0:
        goal = f"(or (and {goal}) (and {' '.join(draw(literals(2, 3)))}))"
    problem = f"""(define (problem g) (:domain d) {objects}
      (:init {" ".join(start)} (= (total-cost) 0)) (:goal (and {goal}))
      (:metric minimize (total-cost)))"""
    return domain, problem


RECIPES = [
    BuildOptions(),
    BuildOptions(cost="task"),
    BuildOptions(quality=Fraction(3, 2)),
    BuildOptions(cost="task", quality=Fraction(4, 3)),
    BuildOptions(alternatives=Fraction(2)),
    BuildOptions(cost="task", alternatives=Fraction(3, 2)),
]


def expected(brute, recipe):
    """Return the plans that a recipe asks for, the slow way; None if there are too many."""
    best = brute.optimum()
    if best is None:
        return {}
    if 0 not in brute.costs:
        found = brute.plans(best * (recipe.alternatives or recipe.quality))
    else:  # zero-cost steps: ordered by cost and then steps, each bounded by the factor
        factor = recipe.alternatives or recipe.quality
        shortest = next(
            n for n in range(50) if any(c == best for c in brute.plans(best, n).values())
        )
        found = brute.plans(best * factor, int(shortest * factor))
    if recipe.alternatives is not None:
        found = {plan: cost for plan, cost in found.items() if brute.irredundant(plan)}
    return found


@pytest.mark.parametrize("recipe", RECIPES, ids=str)
@settings(max_examples=40)
@given(world=worlds())
def test_graphs_hold_exactly_the_plans_of_every_sequence(recipe, world, read_world, brute, words):
    goals = read_world(*world)
    bank = build(goals, recipe)
    if bank.team:  # test_team.py
        return
    graph, slow = bank.graphs[0], brute(bank)
    if recipe.alternatives is None and graph.plans > MAX_PLANS:
        return
    wanted = expected(slow, recipe)
    found = words(bank, plans(graph))
    assert len(found) == len(set(found)) == graph.plans
    assert set(found) == wanted.keys()
    costs = [wanted[plan] for plan in found]
    assert costs == sorted(costs)
    assert graph.optimal_cost == (min(costs) if costs else None)
    assert graph.n_steps == min((len(p) for p in found if wanted[p] == costs[0]), default=0)
    assert sum(int(n) for n in graph.n_paths_from_root[graph.is_goal]) == graph.plans


@settings(max_examples=60)
@given(world=worlds(), data=st.data())
def test_histories_against_the_list_of_plans(world, data, read_world):
    bank = build(read_world(*world), BuildOptions(quality=Fraction(3, 2)))
    graph = bank.graphs[0]
    if graph.plans > 2000:
        return
    listed = list(plans(graph))
    steps = (
        data.draw(st.lists(st.integers(0, len(bank.table) - 1), max_size=4))
        if len(bank.table)
        else []
    )
    assert is_prefix(graph, steps) == any(list(p[: len(steps)]) == steps for p in listed)
    assert graph.plans_with_prefix(steps) == sum(list(p[: len(steps)]) == steps for p in listed)
    inside = [iter(p) for p in listed]
    assert is_subsequence(graph, steps) == any(all(s in it for s in steps) for it in inside)
    fits = any(all(p.count(s) >= steps.count(s) for s in steps) for p in listed)
    if graph.n_nodes:
        assert is_subset(graph, steps) == fits


@settings(max_examples=60)
@given(world=worlds(agents=("", "fixed")))
def test_landmarks_only_save_work(world, read_world):
    bank = build(read_world(*world), BuildOptions(cost="task"))
    blind = optimal_graph(bank.table, bank.goals.tests[0], bank.initial, name="g", blind=True)
    assert blind.steps.tolist() == bank.graphs[0].steps.tolist()
    assert blind.targets.tolist() == bank.graphs[0].targets.tolist()
    assert blind.rows.tolist() == bank.graphs[0].rows.tolist()


@settings(max_examples=40)
@given(world=worlds(agents=("", "fixed")), data=st.data())
def test_a_graph_from_another_state_goes_on_from_there(world, data, read_world, brute, words):
    bank = build(read_world(*world))
    state = bank.initial
    for _ in range(data.draw(st.integers(0, 3))):
        steps = bank.table.applicable(state)
        if steps:
            state = bank.table.successor(state, data.draw(st.sampled_from(steps)))
    task = bank.goals.task.with_goal(bank.goals.formulas[0])
    task.initial = state
    slow = type(brute(bank))(task, brute(bank).labels, brute(bank).costs)
    best = slow.optimum()
    wanted = set() if best is None else slow.plans(best).keys()
    assert set(words(bank, plans(bank.graph_from(0, state)))) == wanted
    graph, node = bank.locate(0, state)
    if graph is not bank.graphs[0]:
        assert (0 if node is None else graph.plans_from(node)) == len(wanted)
        return
    # On its own graph a state is where the facts are that the graph looks at: all goes on there.
    while not graph.is_goal[node]:
        step, node = data.draw(st.sampled_from(sorted(graph.next(node).items())))
        state = bank.table.successor(state, step)
    assert bank.goals.is_reached(0, state)


def test_filters_agree_with_the_slow_way(read_world, brute, words):
    bank = build(read_world(*LOOP), BuildOptions(quality=Fraction(2)))
    slow, graph = brute(bank), bank.graphs[0]
    listed = words(bank, plans(graph))
    kept = words(bank, bank.plans(0, bank.irredundant(0)))
    assert kept == [plan for plan in listed if slow.irredundant(plan)]
    assert 0 < len(kept) < len(listed)
    for plan in plans(graph):
        states = [bank.initial]
        for step in plan:
            states.append(bank.table.successor(states[-1], step))
        assert bank.loop_free(plan) == (len(set(states)) == len(states))
    assert {bank.loop_free(plan) for plan in plans(graph)} == {True, False}


LOOP = (
    """(define (domain d) (:requirements :strips :negative-preconditions) (:predicates (a) (b) (c))
    (:action on :parameters () :precondition (not (a)) :effect (a))
    (:action off :parameters () :precondition (a) :effect (not (a)))
    (:action go :parameters () :precondition (a) :effect (b))
    (:action end :parameters () :precondition (b) :effect (c)))""",
    "(define (problem g) (:domain d) (:init) (:goal (c)))",
)

TWO_WAYS = (
    """(define (domain d) (:requirements :strips) (:predicates (a) (b) (c) (left) (right) (goal))
    (:action l1 :parameters () :precondition (and) :effect (a))
    (:action l2 :parameters () :precondition (a) :effect (left))
    (:action r1 :parameters () :precondition (and) :effect (b))
    (:action r2 :parameters () :precondition (b) :effect (left))
    (:action x :parameters () :precondition (and) :effect (c))
    (:action end :parameters () :precondition (and (left) (c)) :effect (goal)))""",
    "(define (problem g) (:domain d) (:init) (:goal (goal)))",
)


def test_alternative_step_sets_of_one_length(read_world):
    """Two ways of three orders each; as orders of one partial order there would be more."""
    bank = build(read_world(*TWO_WAYS))
    graph = bank.graphs[0]
    assert graph.plans == 6
    sets = {frozenset(plan) for plan in plans(graph)}
    assert len(sets) == 2
    orders = set(plans(graph))
    before = {(a, b) for a in graph.used_steps for b in graph.used_steps if a != b} - {
        (b, a) for plan in orders for a, b in _pairs(plan)
    }
    mixed = [p for p in orders if any((a, b) in before for a, b in pairwise(p[::-1]))]
    assert not mixed
    find = bank.table.find
    assert is_subset(graph, [find(["l2"]), find(["l1"]), find(["x"])])
    assert not is_subset(graph, [find(["l2"]), find(["r1"])])
    assert is_subsequence(graph, [find(["l1"]), find(["end"])])
    assert not is_subsequence(graph, [find(["l1"]), find(["r2"])])


def _pairs(plan):
    return [(a, b) for i, a in enumerate(plan) for b in plan[i + 1 :]]
