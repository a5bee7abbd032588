"""The paper's assistant: sequences, changes, trees; beside trees that are grown in full."""

from dataclasses import FrozenInstanceError
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrcplan.assistance import ASSISTANTS, explain
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.rhp.assistant import RecedingHorizonPlanner, RhpState
from hrcplan.assistance.rhp.consistency import Subset
from hrcplan.assistance.rhp.tree import RecedingHorizonTree, TreeRoot
from hrcplan.bank import Bank, build
from hrcplan.core.bits import positions
from hrcplan.errors import UsageError
from hrcplan.inference.belief import IMPOSSIBLE
from hrcplan.inference.classifier.forest import ForestBelief, ForestState
from hrcplan.inference.switching import SwitchingBelief
from hrcplan.pddl.conventions import people, robots
from tests.worlds import world

# Dishes share a bowl; each has two things of its own, which wait for nothing.
TABLE = """
(define (domain table) (:requirements :strips :typing)
  (:types agent thing - object)
  (:predicates (controllable ?a - agent) (out ?x - thing) (clean ?x - thing) (heavy ?x - thing))
  (:action lay :parameters (?a - agent ?x - thing) :precondition () :effect (out ?x))
  (:action wash :parameters (?a - agent ?x - thing)
    :precondition (out ?x) :effect (clean ?x)))
"""
SET = """
(define (problem {name}) (:domain table)
  (:objects ann robo - agent bowl cup fork lid pan pot mat - thing)
  (:init (controllable robo))
  (:goal (and (out bowl) {goal})))
"""
MEALS = {
    "soup": "(out cup) (out lid)",
    "stew": "(out pan) (out lid) (out pot)",
    "cake": "(out fork) (clean fork)",
}


@pytest.fixture(scope="session")
def meals() -> Bank:
    return build(world(TABLE, SET, MEALS))


@pytest.fixture(scope="session", params=["workshop", "hall", "meals"])
def rhp(request) -> RecedingHorizonPlanner:
    return RecedingHorizonPlanner(request.getfixturevalue(request.param), "presence", n_sampled=50)


@pytest.fixture(scope="session")
def of_meals(meals) -> RecedingHorizonPlanner:
    return RecedingHorizonPlanner(meals, "presence", n_sampled=50)


def _step(bank, *words):
    found = bank.table.find(words)
    assert found is not None
    return found


def _watch(rhp, *history, state=None):
    """Return the state after steps; those of the robot stand in brackets."""
    state = rhp.start() if state is None else state
    for step in history:
        robot = isinstance(step, list)
        state = rhp.observe(state, step[0] if robot else step, robot=robot)
        assert state.ignored is None
    return state


@st.composite
def _turns(draw, rhp, most=8):
    """A state after turns in which the human does anything it can, and the robot what it likes.

    And the steps that led there, as `_watch` reads them.
    """
    bank, state, done = rhp.bank, rhp.start(), []
    others, own = people(bank.goals.problem), robots(bank.goals.problem)
    for _ in range(draw(st.integers(0, most))):
        can = [s for s in bank.table.applicable(state.world) if _can(bank, state, s, others)]
        if not can:
            break
        done.append(draw(st.sampled_from(can)))
        state = rhp.observe(state, done[-1])
        chosen = rhp.choose(state)
        if chosen is not None:
            assert _can(bank, state, chosen, own)
            done.append([chosen])
            state = rhp.observe(state, chosen, robot=True)
    return state, done


def _can(bank, state, step, agents):
    return bank.table.doer(state.world, step, agents) is not None


# Sequences and changes.


@given(data=st.data())
@settings(max_examples=40, deadline=None)
def test_laws(data, rhp):
    state, _ = data.draw(_turns(rhp))
    posterior = rhp.posterior(state)
    assert posterior.sum() == pytest.approx(1)
    assert (posterior >= 0).all()
    assert len(state.sequences) == len(state.plausible) <= 3
    for sequence, goals in zip(state.sequences, state.plausible, strict=True):
        assert sequence[-1:] == state.human[-1:]
        left = iter(state.human)
        assert all(step in left for step in sequence)
        fits = rhp.consistency.goals(sequence)
        assert goals == (fits or rhp.consistency.everything)
    with pytest.raises(FrozenInstanceError):
        state.n_declared = 7


@given(data=st.data())
@settings(max_examples=10, deadline=None)
def test_nothing_is_remembered_outside_states(data, rhp):
    """Another one, which has seen nothing else, comes to the same."""
    state, done = data.draw(_turns(rhp))
    other = RecedingHorizonPlanner(rhp.bank, "presence", n_sampled=50)
    again = _watch(other, *done)
    assert (again.sequences, again.n_declared) == (state.sequences, state.n_declared)
    assert other.posterior(again).tolist() == rhp.posterior(state).tolist()
    assert other.options(again) == rhp.options(state) == rhp.options(state)


def test_a_change_is_declared_when_nothing_fits(of_meals):
    """After cup and lid comes the fork: only the shared bowl is still of use."""
    bank = of_meals.bank
    bowl, cup, lid, fork = (_step(bank, "lay", x) for x in ("bowl", "cup", "lid", "fork"))
    pan = _step(bank, "lay", "pan")
    before = _watch(of_meals, bowl, [pan], cup, lid)
    assert before.sequences == ((bowl, cup, lid),)
    assert before.n_declared == 0
    after = _watch(of_meals, fork, state=before)
    assert after.n_declared == 1
    assert after.sequences == ((bowl, fork), (fork,))
    assert [list(positions(goals)) for goals in after.plausible] == [[2], [2]]
    assert after.robot == ()
    assert after.human == (bowl, cup, lid, fork)
    assert of_meals.posterior(after).argmax() == 2
    assert before.n_declared == 0


def test_sequences_that_stop_fitting_are_dropped(of_meals):
    """Back from the cake, the lid fits with cup or pan, and the next step says with which."""
    bank = of_meals.bank
    bowl, cup, pan, lid, fork = (
        _step(bank, "lay", x) for x in ("bowl", "cup", "pan", "lid", "fork")
    )
    state = _watch(of_meals, cup, pan, fork, lid)
    assert state.n_declared == 3
    assert state.sequences == ((pan, lid), (cup, lid), (lid,))
    kept = _watch(of_meals, bowl, state=state)
    assert kept.sequences == ((pan, lid, bowl), (cup, lid, bowl), (lid, bowl))
    pot, wash = _step(bank, "lay", "pot"), _step(bank, "wash", "fork")
    fewer = _watch(of_meals, pot, state=kept)
    assert fewer.sequences == ((pan, lid, bowl, pot), (lid, bowl, pot))
    assert kept.n_declared == fewer.n_declared == 3
    assert _watch(of_meals, wash, state=kept).sequences == (
        (fork, bowl, wash), (bowl, wash), (fork, wash),
    )  # fmt: skip


def test_the_complete_history_is_searched_again(of_meals):
    bank = of_meals.bank
    bowl, cup, lid, fork = (_step(bank, "lay", x) for x in ("bowl", "cup", "lid", "fork"))
    state = _watch(of_meals, bowl, cup, fork, lid)
    assert state.n_declared == 2
    assert state.sequences[0] == (bowl, cup, lid)


def test_a_step_without_use_leaves_all_goals_plausible(of_meals):
    mat, bowl = (_step(of_meals.bank, "lay", x) for x in ("mat", "bowl"))
    state = _watch(of_meals, mat)
    assert state.n_declared == 1
    assert state.sequences == ((mat,),)
    assert state.plausible == (7,)
    assert of_meals.posterior(state) == pytest.approx(1 / 3, rel=0.2)
    assert _watch(of_meals, bowl, state=state).sequences == ((bowl,),)


def test_an_impossible_step_is_ignored(of_meals):
    state = of_meals.observe(of_meals.start(), _step(of_meals.bank, "wash", "fork"))
    assert state.ignored == IMPOSSIBLE
    assert state.human == ()


@pytest.mark.parametrize("consistency", ["subset", "subsequence", "sampled"])
def test_number_of_sequences_is_an_option(workshop, consistency):
    rhp = RecedingHorizonPlanner(
        workshop, "presence", n_sequences=1, consistency=consistency, n_sampled=20
    )
    cut = [_step(workshop, "cut", x) for x in ("rope", "wire", "pipe")]
    assert _watch(rhp, *cut).sequences == ((cut[0], cut[2]),)


# The guess.


def test_a_forest_guesses_the_mean(of_meals):
    bank = of_meals.bank
    forest = ForestBelief(bank, n_samples=600, n_trees=5)
    rhp = RecedingHorizonPlanner(bank, forest, n_sampled=20)
    assert rhp.posterior(rhp.start()) == pytest.approx(1 / 3)
    cup, pan, fork = (_step(bank, "lay", x) for x in ("cup", "pan", "fork"))
    bowl, wash = _step(bank, "lay", "bowl"), _step(bank, "wash", "fork")
    state = _watch(rhp, bowl, cup, pan, [fork], [wash])
    expected = []
    for sequence in ((bowl, pan), (pan,)):
        row = np.zeros(len(bank.table), dtype=np.uint8)
        row[[*sequence, fork, wash]] = 1
        expected.append(forest.posterior(ForestState(bank.initial, row)))
    assert state.sequences == ((bowl, pan), (pan,))
    assert rhp.posterior(state) == pytest.approx(np.mean(expected, axis=0))


def test_a_belief_may_follow_all_steps_by_itself(workshop):
    belief = SwitchingBelief(workshop)
    rhp = RecedingHorizonPlanner(workshop, belief, n_sampled=20)
    rope, red = _step(workshop, "cut", "rope"), _step(workshop, "unfold", "red")
    own = belief.observe(belief.observe(belief.start(), rope), red, robot=True)
    state = _watch(rhp, rope, [red])
    assert rhp.posterior(state).tolist() == belief.posterior(own).tolist()


# Trees.


def _in_full(tree, root):
    """Return costs of first steps, with every branch grown and costed as the equations say."""
    people, own = tree.people, tree.step_values.agents
    start = tree.imagined_steps.begin(root.progress)
    level = [((s,), start) for s in tree.next_steps(root, start, root.last, own)]
    costs = {path: [-field[tree.label[path[0]]] for field in root.fields] for path, _ in level}
    closed = {}
    for _ in range(1, tree.n_levels):
        every = [*costs.values(), *closed.values()]
        least = [min(c) for c in zip(*every, strict=True)] if every else []
        grown, after = [], {}
        for path, progress in level:
            then = tree.imagined_steps.after(progress, path[-1])
            longer = [
                ((*path, answer, step), later)
                for answer in tree.next_steps(root, then, path[-1], people)
                for later in [tree.imagined_steps.after(then, answer)]
                for step in tree.next_steps(root, later, answer, own) or [None]
            ]
            if not longer:
                closed[path] = costs[path]
            for new, later in longer:
                if new[-1] is None:
                    closed[new] = costs[path]
                    continue
                grown.append((new, later))
                after[new] = [
                    cost - (field[tree.label[new[-1]]] if cost == low else 0)
                    for cost, low, field in zip(costs[path], least, root.fields, strict=True)
                ]
        level, costs = grown, after
    found = {}
    for path, by_tree in [*costs.items(), *closed.items()]:
        found[path[0]] = min(sum(by_tree), found.get(path[0], 0))
    return found


@given(data=st.data())
@settings(max_examples=60, deadline=None)
def test_costs_are_those_of_trees_in_full(data, rhp):
    state, _ = data.draw(_turns(rhp, 5))
    n_trees = data.draw(st.integers(1, 3))
    width = max(rhp.tracker.combined_graph.label) + 1
    field = st.lists(st.integers(0, 3), min_size=width, max_size=width)
    fields = tuple(data.draw(field) for _ in range(n_trees))
    root = TreeRoot(state.progress, state.last, fields, (), lambda: rhp.posterior(state))
    branching, depth = data.draw(st.integers(1, 4)), data.draw(st.integers(1, 5))
    tree = RecedingHorizonTree(rhp.step_values, rhp.tree.bigrams, rhp.tree.people, branching, depth)
    assert tree.costs(root) == _in_full(tree, root)


def test_branches_that_end_early_count_too(hall):
    """Where only one can go on, some branches end before others, and stay among the cheapest."""
    rhp = RecedingHorizonPlanner(hall, "presence", n_sampled=50)
    moves = [("go", "robot", "c", "d"), ("go", "ann", "b", "c")]
    state = _watch(rhp, *(_step(hall, *words) for words in moves))
    rng = np.random.default_rng(0)
    for _ in range(60):
        fields = tuple(rng.integers(0, 4, (3, len(hall.table))).tolist())
        root = TreeRoot(state.progress, state.last, fields, (), lambda: rhp.posterior(state))
        tree = RecedingHorizonTree(rhp.step_values, rhp.tree.bigrams, rhp.tree.people, 4, 7)
        assert tree.costs(root) == _in_full(tree, root)


@given(data=st.data())
@settings(max_examples=30, deadline=None)
def test_looking_ahead_is_what_would_follow(data, rhp):
    """Imagined steps lead where real ones do, as far as goals stay on their graphs."""
    state, _ = data.draw(_turns(rhp, 4))
    ahead, real = rhp.tree.imagined_steps, state.progress
    progress = ahead.begin(real)
    for _ in range(3):
        can = rhp.bank.table.applicable(real.world)
        if not can:
            return
        step = data.draw(st.sampled_from(can))
        progress, real = ahead.after(progress, step), rhp.tracker.follow(real, step)[0]
        assert progress.world == real.world
        on_graph = progress.nodes != rhp.tracker.combined_graph.off
        assert (progress.nodes[on_graph] == real.nodes[on_graph]).all()
        lost = set(np.flatnonzero(~on_graph).tolist())
        assert lost == set(np.flatnonzero(real.nodes == rhp.tracker.combined_graph.off).tolist())


def test_early_attraction_comes_first(of_meals):
    """A step that attracts less now is not made good by what it would be followed by."""
    bank = of_meals.bank
    bowl, lid, fork = (_step(bank, "lay", x) for x in ("bowl", "lid", "fork"))
    wash = _step(bank, "wash", "fork")
    field = [0] * len(bank.table)
    field[bowl], field[lid], field[fork], field[wash] = 3, 3, 2, 9
    state = of_meals.start()
    root = TreeRoot(state.progress, None, (field,), (), lambda: of_meals.posterior(state))
    tree = RecedingHorizonTree(
        of_meals.step_values, of_meals.tree.bigrams, of_meals.tree.people, 9, 3
    )
    costs = tree.costs(root)
    assert costs[fork] == -2
    assert costs[bowl] == costs[lid] == -12


def test_trees_of_several_sequences_add_up(of_meals):
    bank = of_meals.bank
    bowl, lid = (_step(bank, "lay", x) for x in ("bowl", "lid"))
    one, two = [0] * len(bank.table), [0] * len(bank.table)
    one[bowl], two[lid], two[bowl] = 4, 5, 1
    state = of_meals.start()
    root = TreeRoot(state.progress, None, (one, two), (), lambda: of_meals.posterior(state))
    costs = RecedingHorizonTree(
        of_meals.step_values, of_meals.tree.bigrams, of_meals.tree.people, 9, 1
    ).costs(root)
    assert (costs[bowl], costs[lid]) == (-5, -5)
    assert of_meals.field(5) == [
        sum(step in of_meals.bank.graphs[g].used_steps for g in (0, 2))
        for step in range(len(bank.table))
    ]


def test_the_robot_does_what_most_plausible_goals_need(of_meals):
    """Soup and stew both need the lid; the bowl all need, but it is there."""
    bowl, lid = (_step(of_meals.bank, "lay", x) for x in ("bowl", "lid"))
    assert of_meals.choose(_watch(of_meals, bowl)) == lid
    assert of_meals.choose(of_meals.start()) == bowl


def test_nothing_is_done_where_no_plan_goes_on(of_meals):
    laid = [_step(of_meals.bank, "lay", x) for x in ("bowl", "cup", "lid", "pan", "fork", "pot")]
    state = _watch(of_meals, *laid, [_step(of_meals.bank, "wash", "fork")])
    assert of_meals.choose(state) is None


def test_a_needless_step_is_better_than_to_wait(of_meals):
    """The paper's agents cannot wait, even if only goals that are ruled out go on."""
    bank = of_meals.bank
    bowl, cup, lid = (_step(bank, "lay", x) for x in ("bowl", "cup", "lid"))
    options = of_meals.options(_watch(of_meals, bowl, cup, [lid]))
    assert options.steps
    assert set(options.values) == {0.0}
    assert options.best == options.steps[0]


# 2-grams.


def test_bigrams_count_what_follows_in_sampled_plans(workshop):
    label, rng = workshop.table.labels, np.random.default_rng(4)
    seen = np.zeros((len(workshop.names), len(label), len(label)), dtype=int)
    for goal in range(len(workshop.names)):
        for row in workshop.sampler(goal).draw(30, rng).tolist():
            plan = [label[step] for step in row if step >= 0]
            for before, after in pairwise(plan):
                seen[goal, before, after] += 1
    grams = Bigrams(workshop, 30, seed=4)
    for before in range(len(label)):
        assert grams.times(before).tolist() == seen[:, before].sum(axis=0).tolist()
        for n in range(6):
            weighted = seen[1, before] + n * seen[3, before] + n * seen[4, before]
            expected = sorted(np.flatnonzero(weighted), key=lambda after: -weighted[after])
            assert grams.followers(before, (0b10, *[0b11000] * n)) == expected
    total = seen.sum(axis=(0, 2))
    assert grams.share(0, 1) == pytest.approx(seen[:, 0, 1].sum() / total[0])


def test_without_bigrams_the_belief_prunes(of_meals):
    """After the mat nothing was ever seen; what the likeliest goals want is tried first."""
    mat = _step(of_meals.bank, "lay", "mat")
    state = _watch(of_meals, mat)
    root = TreeRoot(state.progress, mat, ([0] * len(of_meals.bank.table),), (), lambda: belief)
    tree = RecedingHorizonTree(
        of_meals.step_values, of_meals.tree.bigrams, of_meals.tree.people, 2, 3
    )
    bowl, fork, lid = (_step(of_meals.bank, "lay", x) for x in ("bowl", "fork", "lid"))
    belief = np.array([0.1, 0.2, 0.7])
    assert tree.next_steps(root, state.progress, mat, tree.people) == [bowl, fork]
    belief = np.array([0.8, 0.1, 0.1])
    assert tree.next_steps(root, state.progress, mat, tree.people) == [bowl, lid]
    assert tree.next_steps(root, state.progress, None, tree.people) == [bowl, lid]


def test_plausible_bigrams_try_nothing_else_first(workshop):
    rhp = RecedingHorizonPlanner(
        workshop, "presence", bigrams="plausible", branching=1, n_sampled=50
    )
    state = _watch(rhp, _step(workshop, "cut", "pipe"))
    (first,) = rhp.options(state).steps
    assert first in workshop.graphs[3].used_steps | workshop.graphs[4].used_steps


# Ways in.


def test_it_is_the_method_of_the_paper():
    assert ASSISTANTS.find("rhp") is RecedingHorizonPlanner
    with pytest.warns(DeprecationWarning, match="'paper' is deprecated"):
        assert ASSISTANTS.find("paper") is RecedingHorizonPlanner


def test_why_names_what_was_weighed(of_meals):
    state = _watch(of_meals, _step(of_meals.bank, "lay", "bowl"))
    found = explain(of_meals, state)
    assert found.chosen == "(lay lid)"
    assert found.candidates[0].action == "(lay lid)"
    assert {name for name, _ in found.candidates[0].helps} >= {"soup", "stew"}


@pytest.mark.parametrize("option", [{"bigrams": "all"}, {"consistency": "loose"}])
def test_unknown_words_are_refused(meals, option):
    with pytest.raises(UsageError, match=next(iter(option.values()))):
        RecedingHorizonPlanner(meals, "presence", **option)


def test_an_own_consistency_is_taken(meals):
    own = Subset(meals)
    assert (
        RecedingHorizonPlanner(meals, "presence", consistency=own, n_sampled=5).consistency is own
    )


def test_states_say_where_the_world_is(of_meals):
    state = of_meals.start()
    assert isinstance(state, RhpState)
    assert (state.world, state.last) == (of_meals.bank.initial, None)
    assert of_meals.names == tuple(MEALS)
