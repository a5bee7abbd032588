"""Sampling is uniform, also where plans differ in length; large counts stay exact."""

from collections import Counter
from fractions import Fraction
from math import factorial

import numpy as np
import pytest

from hrcplan.bank import BuildLimits, BuildOptions, build, build_bank, from_problems
from hrcplan.bank.multisets import is_subset, step_multisets
from hrcplan.bank.walk import Sampler, plans
from hrcplan.errors import LimitError, UnsupportedError, UsageError
from hrcplan.pddl.inputs import read


def chi_square(counts, n_kinds):
    """Return the statistic's distance from its mean, in standard deviations."""
    expected = sum(counts.values()) / n_kinds
    statistic = sum((n - expected) ** 2 / expected for n in counts.values())
    statistic += (n_kinds - len(counts)) * expected
    return (statistic - (n_kinds - 1)) / (2 * (n_kinds - 1)) ** 0.5


@pytest.mark.parametrize(
    "recipe",
    [
        BuildOptions(),
        BuildOptions(quality=Fraction(9, 8)),
        BuildOptions(alternatives=Fraction(9, 8)),
    ],
    ids=str,
)
def test_every_plan_has_the_same_chance(recipe):
    bank = build(from_problems([read("transport", "two-boxes")]), recipe)
    graph, rng = bank.graphs[0], np.random.default_rng(11)
    drawn = Counter(bank.sample(0, 60 * graph.plans, rng))
    assert set(drawn) <= set(plans(graph))
    assert abs(chi_square(drawn, graph.plans)) < 4


def test_filtered_samples_are_uniform():
    bank = build(
        from_problems([read("transport", "two-boxes")]),
        BuildOptions(quality=Fraction(9, 8)),
    )
    keep = bank.irredundant(0)
    kept = set(bank.plans(0, keep))
    drawn = Counter(bank.sample(0, 10 * len(kept), np.random.default_rng(5), keep))
    assert set(drawn) <= kept
    assert abs(chi_square(drawn, len(kept))) < 4
    with pytest.raises(LimitError, match="hardly any plan"):
        bank.sample(0, 5, np.random.default_rng(5), lambda steps: False)


def test_same_seed_same_plans(kitchen):
    one, two = (kitchen.sample(4, 50, np.random.default_rng(9)) for _ in range(2))
    assert one == two != kitchen.sample(4, 50, np.random.default_rng(10))
    big = Sampler(kitchen.graphs[4]).draw(20_000, np.random.default_rng(9))
    assert big.shape == (20_000, kitchen.graphs[4].n_steps)
    assert len(np.unique(big, axis=0)) == 20_000
    assert Sampler(kitchen.graphs[4]).draw(0, np.random.default_rng(9)).shape[0] == 0


def independent(n, read_world):
    facts = " ".join(f"(p{i})" for i in range(n))
    steps = " ".join(
        f"(:action do{i} :parameters () :precondition (and) :effect (p{i}))" for i in range(n)
    )
    domain = f"(define (domain d) (:requirements :strips) (:predicates {facts}) {steps})"
    return read_world(domain, f"(define (problem g) (:domain d) (:init) (:goal (and {facts})))")


@pytest.fixture(scope="module")
def chains(read_world):
    """22 chains of 3 steps would be too many states; 3 chains of 22 have 12,167, and 9e29 plans."""
    facts = [[f"c{i}-{j}" for j in range(22)] for i in range(3)]
    steps = [
        f"(:action do-{chain[j]} :parameters ()"
        f" :precondition (and {f'({chain[j - 1]})' if j else ''}) :effect ({chain[j]}))"
        for chain in facts
        for j in range(22)
    ]
    names = " ".join(f"({fact})" for chain in facts for fact in chain)
    goal = " ".join(f"({chain[-1]})" for chain in facts)
    return build(read_world(
        f"(define (domain d) (:requirements :strips) (:predicates {names}) {' '.join(steps)})",
        f"(define (problem g) (:domain d) (:init) (:goal (and {goal})))",
    ))  # fmt: skip


def test_counts_beyond_64_bits_are_exact(chains):
    graph = chains.graphs[0]
    expected = factorial(66) // factorial(22) ** 3
    assert graph.plans == expected > 2**64
    assert graph.n_paths_from_root[-1] == expected
    assert graph.n_nodes == 23**3
    middle = graph.after(next(plans(graph))[:33])
    assert graph.ways_to(middle) * graph.plans_from(middle) < expected
    plan = chains.sample(0, 1, np.random.default_rng(0))[0]
    assert graph.after(plan) == graph.n_nodes - 1
    assert is_subset(graph, plan[::2]) is True


def test_more_facts_than_a_word_holds(chains):
    assert chains.graphs[0].packing.n_words == 2
    state = chains.initial
    for step in chains.sample(0, 1, np.random.default_rng(2))[0]:
        node = chains.graphs[0].node_of(state)
        assert chains.graphs[0].state(node) == state
        state = chains.table.successor(state, step)


def test_counts_of_independent_steps(read_world):
    for n in (1, 7, 12):
        graph = build(independent(n, read_world)).graphs[0]
        assert (graph.plans, graph.n_nodes, graph.n_edges) == (factorial(n), 2**n, n * 2 ** (n - 1))


def test_too_many_kinds_of_plans(read_world):
    """16 choices between two steps: 65,536 multisets; the bitmask search still answers."""
    n = 16
    facts = " ".join(f"(p{i})" for i in range(n))
    steps = " ".join(
        f"(:action {s}{i} :parameters () :precondition (and {f'(p{i - 1})' if i else ''})"
        f" :effect (p{i}))"
        for i in range(n) for s in ("left", "right")
    )  # fmt: skip
    domain = f"(define (domain d) (:requirements :strips) (:predicates {facts}) {steps})"
    bank = build(read_world(domain, f"(define (problem g) (:domain d) (:init) (:goal (p{n - 1})))"))
    graph, find = bank.graphs[0], bank.table.find
    assert graph.plans == 2**n
    assert step_multisets(graph) is None
    assert is_subset(graph, [find([f"left{i}"]) for i in range(n)]) is True
    assert is_subset(graph, [find(["left3"]), find(["right3"])]) is False
    assert is_subset(graph, [find(["left3"])] * 21) is None


def test_limits_name_what_to_lower(kitchen):
    for recipe in (
        BuildOptions(),
        BuildOptions(quality=Fraction(6, 5)),
        BuildOptions(alternatives=Fraction(2)),
    ):
        with pytest.raises(LimitError) as caught:
            build(kitchen.goals, recipe, mib=1)
        assert caught.value.code == "memory"
        assert "--quality" in caught.value.hint
        assert "--sample" in caught.value.hint
        with pytest.raises(LimitError) as caught:
            build(kitchen.goals, recipe, timeout_s=0)
        assert caught.value.code == "timeout"
    with pytest.raises(LimitError):
        kitchen.graph_from(0, kitchen.initial, BuildLimits(mib=0))


def test_a_kitchen_of_two_goals_and_more_than_optimal_plans():
    bank = build_bank(
        "kitchen", None, BuildOptions(quality=Fraction(107, 100)), only=["parfait-nut"]
    )
    graph = bank.graphs[0]
    assert graph.final_costs == (17, 18)
    optimal = build_bank("kitchen", only=["parfait-nut"]).graphs[0]
    ends = graph.is_goal & (graph.layer_of == graph.final_layers[0])
    assert sum(graph.n_paths_from_root[ends].tolist()) == optimal.plans
    # One more step: 153 others could come before most of the 17, so many more plans than 100 times.
    assert graph.plans > 100 * optimal.plans


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"quality": Fraction(2), "sample": 3}, "exclude each other"),
        ({"quality": Fraction(1, 2)}, "at least 1"),
        ({"alternatives": Fraction(1, 2)}, "at least 1"),
        ({"sample": 0}, "at least one plan"),
    ],
)
def test_recipes_that_make_no_sense(wrong, message):
    with pytest.raises(UsageError, match=message):
        BuildOptions(**wrong)


def test_costs_that_a_bank_cannot_hold(read_world):
    world = read_world(
        """(define (domain d) (:requirements :strips :action-costs) (:predicates (p))
        (:functions (total-cost) (gain))
        (:action a :parameters () :precondition (and)
          :effect (and (p) (increase (total-cost) (gain)))))""",
        "(define (problem g) (:domain d) (:init (= (total-cost) 0) (= (gain) -1)) (:goal (p)))",
    )
    assert build(world).graphs[0].plans == 1
    with pytest.raises(UnsupportedError, match="not negative"):
        build(world, BuildOptions(cost="task"))
    with pytest.raises(UnsupportedError, match="no bank cost 'time'"):
        build(world, BuildOptions(cost="time"))
