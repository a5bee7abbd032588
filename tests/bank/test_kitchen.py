"""The kitchen is calibrated: what was fixed about its recipes before any method ran on them."""

import random
import re
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from hrcplan.bank import Bank
from hrcplan.validation import validate

MEALS = ("oatmeal", "parfait", "pasta", "salad", "smoothie", "stew")
N_STEPS = {"oatmeal-apple": 22, "parfait-nut": 17, "pasta-bean": 23, "salad-greek": 20}


@pytest.fixture(scope="module")
def step_sets(kitchen: Bank) -> list[frozenset[int]]:
    return [graph.used_steps for graph in kitchen.graphs]


@pytest.fixture(scope="module")
def before(kitchen: Bank) -> list[dict[int, frozenset[int]]]:
    """For each goal, the steps that come before a step in all of its plans."""
    found = []
    for graph in kitchen.graphs:
        used = sorted(graph.used_steps)
        place = {step: i for i, step in enumerate(used)}
        done = np.zeros((graph.n_nodes, len(used)), dtype=np.bool_)
        always = np.ones((len(used), len(used)), dtype=np.bool_)
        for edges, sources in graph.edges_by_layer():
            columns = np.array([place[step] for step in graph.steps[edges].tolist()], dtype=int)
            now = done[sources]
            np.logical_and.at(always, columns, now)
            now[np.arange(len(now)), columns] = True
            done[graph.targets[edges]] = now
        found.append(
            {step: frozenset(used[j] for j in np.flatnonzero(always[i]))
             for i, step in enumerate(used)}
        )  # fmt: skip
    return found


def meal(name: str) -> str:
    return name.partition("-")[0]


def test_thirty_recipes_of_six_meals(kitchen):
    assert [meal(name) for name in kitchen.names] == [m for m in MEALS for _ in range(5)]
    assert kitchen.agents == "dropped"


def test_lengths(kitchen, step_sets):
    lengths = [graph.n_steps for graph in kitchen.graphs]
    assert min(lengths) == 17
    assert max(lengths) == 23
    assert 20.1 <= sum(lengths) / 30 <= 20.7
    # Every step of a recipe is done exactly once, so plans are orders of one set.
    assert lengths == [len(steps) for steps in step_sets]
    for name, n_steps in N_STEPS.items():
        assert lengths[kitchen.goal_index(name)] == n_steps


def test_more_than_a_million_plans_each(kitchen):
    assert min(graph.plans for graph in kitchen.graphs) > 10**6


def test_overlaps(kitchen, step_sets):
    pairs = list(permutations(range(30), 2))
    overlap = {(i, j): len(step_sets[i] & step_sets[j]) for i, j in pairs}
    alike = [n for (i, j), n in overlap.items() if meal(kitchen.names[i]) == meal(kitchen.names[j])]
    assert sum(overlap.values()) / len(pairs) >= 5
    assert sum(alike) / len(alike) >= 11
    assert not any(step_sets[i] <= step_sets[j] for i, j in pairs)


def test_combined_length_with_an_oracle_helper(kitchen, step_sets):
    """Human and robot do needed steps of the first goal, uniformly, until the human changes at one
    of their turns; what is done stays done."""
    rng, totals = random.Random(1), []
    for i, j in permutations(range(30), 2):
        graph, node, done = kitchen.graphs[i], 0, set()
        changed_at = rng.choice(range(2, graph.n_steps, 2))
        for _ in range(changed_at):
            step, node = rng.choice(list(graph.next(node).items()))
            done.add(step)
        totals.append(changed_at + len(step_sets[j] - done))
    assert abs(sum(totals) / len(totals) - 28.7) <= 1.5


def test_accuracy_of_the_exact_posterior_on_uniform_prefixes(kitchen):
    rng, n_plans, right = np.random.default_rng(1), 40, 0.0
    for goal in range(30):
        for plan in kitchen.sample(goal, n_plans, rng):
            nodes = dict.fromkeys(range(30), 0)
            for step in plan:
                followers = {h: kitchen.graphs[h].next(n).get(step) for h, n in nodes.items()}
                nodes = {h: n for h, n in followers.items() if n is not None}
                weights = {h: likelihood(kitchen.graphs[h], n) for h, n in nodes.items()}
                best = [h for h, w in weights.items() if w >= max(weights.values()) * (1 - 1e-9)]
                right += (goal in best) / len(best) / len(plan)
    assert 0.85 <= right / (30 * n_plans) <= 0.90


def likelihood(graph, node):
    return graph.plans_from(node) / graph.plans / graph.n_steps


def test_no_dead_ends_after_a_change(kitchen, before):
    """What must come before a step does not depend on the recipe, so whatever is done of two
    recipes, in any order, is for each of them the beginning of a plan."""
    serve = [kitchen.table.find(["serve"])]
    for one, other in permutations(before, 2):
        for step in one.keys() & other.keys():
            if step not in serve:
                assert one[step] == other[step]


def test_states_between_two_recipes_are_nodes_of_both(kitchen):
    rng = random.Random(2)
    for i, j in permutations(range(30), 2):
        state, plan = kitchen.initial, iter(())
        for goal in (i, j, i):
            graph = kitchen.graphs[goal]
            for _ in range(rng.randrange(1, 8)):
                node = graph.node_of(state)
                assert node is not None
                steps = [s for s in graph.next(node) if kitchen.table[s].words != ("serve",)]
                if steps:
                    state = kitchen.table.successor(state, rng.choice(steps))
        assert all(kitchen.graphs[g].node_of(state) is not None for g in range(30))
        del plan


def test_serving_too_early_is_no_change_of_place(kitchen):
    """The next step undoes it, so every recipe stays where it was in its graph."""
    state = kitchen.table.successor(kitchen.initial, kitchen.table.find(["serve"]))
    for goal, graph in enumerate(kitchen.graphs):
        assert graph.node_of(state) is None
        assert kitchen.locate(goal, state) == (graph, 0)
        rerooted = kitchen.graph_from(goal, state)
        assert rerooted.plans == graph.plans
        assert rerooted.next(0).keys() == graph.next(0).keys()
        if goal == 2:
            break


def test_fruit_and_yogurt_in_the_glass_tell_a_parfait(kitchen):
    """A smoothie is blended and never poured into the glass (the paper's Fig. 4)."""
    for graph in kitchen.graphs:
        into = {
            kitchen.table[s].words[-1]
            for s in graph.used_steps
            if kitchen.table[s].words[0] == "pour"
        }
        assert ("glass" in into) == (meal(graph.goal) == "parfait")
        assert ("blender" in into) == (meal(graph.goal) == "smoothie")


def test_sampled_plans_are_valid(kitchen):
    rng = np.random.default_rng(3)
    for goal in range(30):
        problem = replace(kitchen.goals.problem, goal=kitchen.goals.formulas[goal])
        for plan in kitchen.sample(goal, 3, rng):
            report = validate(problem, kitchen.as_plan(plan))
            assert report.valid, report.reason
            assert not re.search("serve", str(kitchen.as_plan(plan[:-1])))
