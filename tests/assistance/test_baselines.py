"""The baselines' choices, against what can be worked out by hand."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from hrcplan.assistance import ASSISTANTS, explain
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.decision_points import DecisionPoints
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.field_similarity import (
    BEST_LIKELIHOOD,
    BEST_STAY,
    BestFieldSimilarity,
    FieldSimilarity,
)
from hrcplan.assistance.information_gain import InformationGain
from hrcplan.assistance.lookahead import Lookahead, entropy, futures
from hrcplan.assistance.step_values import StepValues
from hrcplan.bank import Bank
from hrcplan.bank.progress import ProgressTracker
from hrcplan.errors import UsageError
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.recursive import Next, RecursiveBelief


def sure(bank):
    """Return a belief that takes each goal's next steps as alike, and nothing else."""
    return RecursiveBelief(bank, stay=1.0, likelihood=Next(1e-9))


def found(assistant, state):
    """Return the values of the options by words."""
    options, table = assistant.options(state), assistant.bank.table
    return {
        " ".join(table[step].words): value
        for step, value in zip(options.steps, options.values, strict=True)
    }


def after(assistant, *words):
    state = assistant.start()
    for step in words:
        state = assistant.observe(state, assistant.bank.table.find(step))
    return state


# Recursive Bayes.


def test_the_most_similar_step_is_chosen(workshop):
    """Cutting wire helps wire-red, both-red and either; compare five fields by hand."""
    robot = FieldSimilarity(workshop)
    state = after(robot, ("cut", "wire"))
    assert found(robot, state) == pytest.approx(
        {"cut rope": -0.6, "cut pipe": -0.2, "unfold red": 0.6, "unfold blue": -0.2}
    )
    assert workshop.table[robot.choose(state)].words == ("unfold", "red")


def test_the_belief_has_no_say(workshop):
    words = [("cut", "pipe"), ("cut", "wire")]
    robots = [
        FieldSimilarity(workshop),
        FieldSimilarity(workshop, sure(workshop)),
        BestFieldSimilarity(workshop),
    ]
    assert len({str(found(robot, after(robot, *words))) for robot in robots}) == 1


def test_the_first_of_equals_is_chosen(workshop):
    robot = FieldSimilarity(workshop)
    state = after(robot, ("cut", "rope"))
    values = found(robot, state)
    assert values == pytest.approx(
        {"cut wire": -0.6, "cut pipe": -0.2, "unfold red": -0.2, "unfold blue": -0.2}
    )
    tied = [workshop.table.find(tuple(w.split())) for w, v in values.items() if v > -0.5]
    assert robot.choose(state) == min(tied)


def test_before_any_human_action_all_steps_are_alike(workshop):
    robot = FieldSimilarity(workshop)
    state = robot.observe(robot.start(), workshop.table.find(("cut", "wire")), robot=True)
    assert set(found(robot, state).values()) == {0.0}
    assert robot.choose(state) == min(robot.options(state).steps)


def test_the_robots_own_steps_are_not_the_humans_last(workshop):
    robot = FieldSimilarity(workshop)
    state = after(robot, ("cut", "wire"))
    state = robot.observe(state, robot.choose(state), robot=True)
    assert workshop.table[state.last].words == ("cut", "wire")
    assert "unfold red" not in found(robot, state)  # is done


def test_who_did_it_does_not_matter_to_a_field(hall):
    """Where agents are kept, the robot's step has the field of the human's."""
    robot = FieldSimilarity(hall)
    table = hall.table
    hers = [step for step in range(len(table)) if table[step].words[1] == "ann"]
    can = table.applicable(robot.start().world)
    state = robot.observe(robot.start(), next(step for step in hers if step in can))
    needs = robot.tracker.combined_graph.needs
    label = robot.tracker.combined_graph.label
    mine = np.where(needs[:, label[state.last]], 1, -1)
    options = robot.options(state)
    for step, value in zip(options.steps, options.values, strict=True):
        assert table[step].words[1] == "robot"
        theirs = np.where(needs[:, label[step]], 1, -1)
        cosine = mine @ theirs / np.linalg.norm(mine) / np.linalg.norm(theirs)
        assert value == pytest.approx(cosine)


def test_the_best_parameters_are_used(workshop):
    belief = BestFieldSimilarity(workshop).belief
    assert (belief.stay, belief.likelihood) == (BEST_STAY, BEST_LIKELIHOOD)


# The tree.


@pytest.fixture
def look(desk):
    return Lookahead(StepValues(ProgressTracker(desk)), width=9)


def test_responses_are_what_the_goals_want_next(desk, look):
    """Each goal's next steps are alike: unlock, its own, and for three of four goals 'all'."""
    uniform = np.full(4, 0.25)
    root = look.root(ExpectedHelp(desk).start())
    chances = {desk.table[s].words: p for s, p in look.responses(root, uniform)}
    assert chances == pytest.approx(
        {("unlock",): 3 / 12 + 1 / 8, ("work", "all"): 3 / 12, ("work", "s4"): 1 / 8}
        | {("work", f"s{i}"): 1 / 12 for i in (1, 2, 3)}
    )
    narrow = Lookahead(StepValues(ProgressTracker(desk)), width=2)
    kept = {desk.table[s].words: p for s, p in narrow.responses(root, uniform)}
    assert kept == pytest.approx({("unlock",): 0.6, ("work", "all"): 0.4})


def test_what_nobody_wants_is_no_response(desk, look):
    root = look.root(ExpectedHelp(desk).start())
    impossible = np.zeros(4)
    chances = [p for _, p in look.responses(root, impossible)]
    assert chances == pytest.approx([1 / 6] * 6)


def test_likeliest_steps_come_first(desk):
    root = Lookahead(StepValues(ProgressTracker(desk))).root(ExpectedHelp(desk).start())
    belief = np.array([0.1, 0.2, 0.3, 0.4])
    look = Lookahead(StepValues(ProgressTracker(desk)), width=3)
    words = [desk.table[s].words for s in look.steps(root, belief)]
    assert words == [("unlock",), ("work", "all"), ("work", "s4")]
    # What was seen to follow the step before comes first, whatever is believed.
    seen = Lookahead(StepValues(ProgressTracker(desk)), Bigrams(desk, 500), width=1)
    place = seen.after(root, desk.table.find(("unlock",)))
    (first,) = seen.steps(place, belief)
    label = desk.table.find(("unlock",))
    assert Bigrams(desk, 500).followers(label)[0] == first


def test_no_plans_are_made_for_what_may_never_happen(workshop, monkeypatch):
    """Sealed too early, the red box is lost to three goals; the tree leaves it at that."""
    robot = ExpectedHelp(workshop)
    state = after(robot, ("unfold", "red"))
    look = Lookahead(robot.step_values)
    monkeypatch.setattr(Bank, "graph_from", None)
    place = look.after(look.root(state), workshop.table.find(("seal", "red")))
    lost = set(np.flatnonzero(place.progress.nodes == robot.tracker.combined_graph.off).tolist())
    assert lost
    assert not lost & set(place.next_steps.goals.tolist())
    again = look.after(place, workshop.table.find(("cut", "wire")))
    assert not lost & set(again.next_steps.goals.tolist())


class Plain:
    """A belief of which nothing is known but what every belief has."""

    def __init__(self, belief):
        self.names, self.start = belief.names, belief.start
        self.observe, self.posterior = belief.observe, belief.posterior


class Quick(Plain):
    """A forest that answers for many branches at once, and counts them."""

    def __init__(self, forest):
        super().__init__(forest)
        self.label, self.n_branches = ProgressTracker(forest.bank).combined_graph.label, 0

    def posteriors_after(self, state, sequences):
        self.n_branches += len(sequences)
        return np.array([self.one(state.row.copy(), steps) for steps in sequences])

    def one(self, row, steps):
        row[[self.label[step] for step in steps]] = 1
        return self.posterior(replace(self.start(), row=row))


@pytest.mark.parametrize("world", ["workshop", "hall"])
@pytest.mark.parametrize("kind", [DecisionPoints, InformationGain])
def test_all_futures_at_once_are_what_they_are_one_by_one(request, walk, world, kind):
    bank = request.getfixturevalue(world)
    forest = ForestBelief(bank, n_samples=500, n_trees=5)
    quick = Quick(forest)
    robots = [kind(bank, belief) for belief in (forest, quick, Plain(forest))]
    for seed in range(2):
        states = [robot.start() for robot in robots]
        for step in walk(bank, seed, 3):
            states = [robot.observe(s, step) for robot, s in zip(robots, states, strict=True)]
            first, *others = (r.options(s) for r, s in zip(robots, states, strict=True))
            for other in others:
                assert first.steps == other.steps
                assert first.values == pytest.approx(other.values, abs=1e-6)
    assert quick.n_branches


def test_branches_that_begin_alike_are_followed_together(desk):
    belief = Plain(sure(desk))
    observe, n_observed = belief.observe, []
    belief.observe = lambda *args, **more: n_observed.append(more) or observe(*args, **more)
    branches = [(0, 1), (0, 1, 2), (0, 2), (0,)]
    rows = futures(belief, belief.start(), branches)
    assert [more["robot"] for more in n_observed] == [True, False, True, False]
    assert rows[3].tolist() == [0.25] * 4  # the robot's own step is no evidence


def test_entropy_is_in_bits():
    rows = np.array([[0.25] * 4, [1, 0, 0, 0], [0.5, 0.5, 0, 0]])
    assert entropy(rows).tolist() == [2, 0, 1]


# Critical decision points.


def test_cdp_prefers_what_makes_the_human_tell(desk):
    """Once 'all' is done, each goal has two next steps and one of them gives it away.

    Unlocking helps every goal, but then there is more to do that tells nothing.
    """
    robot = DecisionPoints(desk, sure(desk), support=0.0, width=9)
    values = found(robot, robot.start())
    assert values["work all"] == pytest.approx(1.0, abs=1e-6)  # 2 bits in half of the cases
    assert values["unlock"] < 0.9
    assert desk.table[robot.choose(robot.start())].words == ("work", "all")


def test_support_is_worth_bits(desk):
    alone = DecisionPoints(desk, sure(desk), support=0.0, width=9)
    helping = DecisionPoints(desk, sure(desk), support=10.0, width=9)
    base, more = found(alone, alone.start()), found(helping, helping.start())
    gained = {word: more[word] - base[word] for word in base}
    assert gained == pytest.approx(
        {"unlock": 10.0, "work all": 7.5} | {f"work s{i}": 2.5 for i in (1, 2, 3, 4)}
    )
    assert desk.table[helping.choose(helping.start())].words == ("unlock",)


# Information gain.


def test_infogain_counts_the_best_branch(desk):
    """Whatever the robot does, some response gives a goal away: all first steps are alike."""
    robot = InformationGain(desk, sure(desk), alignment=0.0, width=9)
    values = found(robot, robot.start())
    assert values == pytest.approx(dict.fromkeys(values, 2.0), abs=1e-6)


def test_agreement_counts_for_a_step_and_deviation_against_it(desk):
    """The belief is sure, so nothing is left to learn: each robot step is worth 3 or -3 bits."""
    robot = InformationGain(desk, sure(desk), alignment=3.0, width=9)
    values = found(robot, after(robot, ("work", "s2")))
    assert values == pytest.approx(
        {"unlock": 6.0, "work all": 6.0} | {f"work s{i}": 0.0 for i in (1, 3, 4)}, abs=1e-6
    )


def test_information_lost_counts_against_a_branch(desk):
    """A forest can become less sure; here it does with the human's second step."""
    belief = Plain(sure(desk))
    belief.posterior = lambda s: np.eye(4)[0] if s.n_human < 2 else np.full(4, 0.25)
    robot = InformationGain(desk, belief, alignment=0.0)
    values = found(robot, after(robot, ("work", "s1")))
    assert set(values.values()) == {-2.0}


# Both, and what they refuse.


@pytest.mark.parametrize("kind", [DecisionPoints, InformationGain])
def test_a_forest_is_the_belief_by_default(desk, kind, monkeypatch):
    small = functools.partial(ForestBelief, seed=0, n_samples=100, n_trees=2)
    monkeypatch.setattr("hrcplan.assistance.lookahead.ForestBelief", small)
    assert isinstance(kind(desk).belief, ForestBelief)


@pytest.mark.parametrize("kind", [DecisionPoints, InformationGain])
def test_the_robot_waits_only_when_nothing_can_be_done(desk, kind):
    robot = kind(desk, sure(desk))
    state = after(robot, *(desk.table[step].words for step in range(len(desk.table))))
    assert robot.options(state).steps == ()
    assert robot.choose(state) is None
    assert robot.choose(robot.start()) is not None


@pytest.mark.parametrize("name", ["recursive", "recursive-best"])
def test_the_first_method_has_nothing_to_do_at_the_end_either(desk, name):
    robot = ASSISTANTS.find(name)(desk)
    state = after(robot, *(desk.table[step].words for step in range(len(desk.table))))
    assert robot.choose(state) is None


def test_a_branch_ends_where_the_human_can_do_nothing(desk):
    """One step is left, and the robot does it."""
    words = [desk.table[step].words for step in range(len(desk.table))]
    for kind in (DecisionPoints, InformationGain):
        robot = kind(desk, sure(desk))
        state = after(robot, *words[:-1])
        assert list(found(robot, state)) == [" ".join(words[-1])]


def test_choices_can_be_explained(desk):
    for kind in (DecisionPoints, InformationGain):
        robot = kind(desk, sure(desk))
        state = after(robot, ("work", "s2"))
        reasons = explain(robot, state)
        assert reasons.goals[0] == ("second", pytest.approx(1.0))
        assert reasons.chosen == reasons.candidates[0].action
        assert "second" in dict(reasons.candidates[0].helps)


@pytest.mark.parametrize(
    ("kind", "setting", "message"),
    [
        (DecisionPoints, {"support": -1.0}, "support is worth 0 bits or more, not -1.0"),
        (InformationGain, {"alignment": float("nan")}, "alignment is worth 0 bits or more"),
        (DecisionPoints, {"width": 0}, "a tree 0 steps wide has no branches"),
        (InformationGain, {"width": -1}, "a tree -1 steps wide"),
    ],
)
def test_wrong_settings_are_refused(desk, kind, setting, message):
    with pytest.raises(UsageError, match=message):
        kind(desk, sure(desk), **setting)
