"""Beliefs over plan graphs, held against listed plans and enumerated histories."""

import gc
import math
import random
from itertools import pairwise
from weakref import ref

import numpy as np
import pytest

from hrcplan.bank import build
from hrcplan.bank.progress import ProgressTracker
from hrcplan.bank.team_moves import Moment, TeamMoves
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.errors import UsageError
from hrcplan.inference import batch
from hrcplan.inference.adaptive import CHOOSERS, RATES, AdaptiveBelief, StepPreferences
from hrcplan.inference.changes import ChangeFilter
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.exact import ExactBelief
from hrcplan.inference.paired_filters import PairedFilters
from hrcplan.inference.recognition.cost import CostBelief
from hrcplan.inference.recursive import Attractor, Needed, Next, Rational, RecursiveBelief
from hrcplan.inference.switching import SwitchingBelief
from hrcplan.testing import check_belief
from tests.inference import enumerated_beliefs

WORLDS = ["workshop", "hall"]


def possible(bank, steps):
    """Return the steps that can be done one after the other, without the others."""
    state, found = bank.initial, []
    for step in steps:
        after = bank.table.successor(state, step)
        if after not in (None, state):
            state = after
            found.append(step)
    return tuple(found)


def runs(bank, walk):
    """Return plans, walks without a purpose, and plans of one goal that turn to another."""
    plans = [
        enumerated_beliefs.optimal_plans(bank, goal, bank.initial)[0]
        for goal in range(len(bank.names))
    ]
    turned = [possible(bank, (*a[:2], *b)) for a, b in pairwise(plans)]
    return [*plans, *turned, *(walk(bank, seed, 6) for seed in range(4))]


@pytest.fixture(params=WORLDS)
def bank(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(params=["workshop", "hall_in_sequence"])
def listed(request):
    """Banks whose plans are listed as sequences."""
    return request.getfixturevalue(request.param)


def test_beliefs_about_a_bank_share_its_graphs_as_long_as_there_is_one(workshop):
    bank = build(workshop.goals.only(["rope-red", "wire-red"]))
    first, second = ExactBelief(bank), RecursiveBelief(bank)
    assert first.tracker.combined_graph is second.tracker.combined_graph
    assert ExactBelief(build(bank.goals)).tracker.combined_graph is not first.tracker.combined_graph
    shared = ref(first.tracker.combined_graph)
    del first
    gc.collect()
    assert shared() is second.tracker.combined_graph
    del second
    gc.collect()
    assert shared() is None


def test_the_worlds_are_of_both_kinds(workshop, hall):
    assert (workshop.agents, hall.agents) == ("dropped", "kept")


@pytest.mark.parametrize(
    "make",
    [
        ExactBelief, SwitchingBelief, RecursiveBelief, AdaptiveBelief,
        lambda bank: RecursiveBelief(bank, likelihood=Next()),
        lambda bank: RecursiveBelief(bank, likelihood=Rational(), own_steps=True),
        lambda bank: RecursiveBelief(bank, likelihood=Attractor(2)),
        lambda bank: ForestBelief(bank, n_samples=400, n_trees=10),
        lambda bank: CostBelief(bank.goals),
        lambda bank: CostBelief(bank.goals, unobserved=0, n_plans=4),
    ],
    ids=["exact", "switching", "recursive", "adaptive", "next", "rational", "attractor", "forest",
         "cost", "all-observed"],
)  # fmt: skip
def test_every_belief_keeps_the_laws(bank, walk, make):
    belief = make(bank)
    sequences = runs(bank, walk)
    check_belief(belief, sequences[:6] if isinstance(belief, CostBelief) else sequences)


def test_exact_equals_bayes_over_listed_plans(listed, walk):
    """Also after mistakes, steps that no goal explains, and on graphs from other states."""
    belief = ExactBelief(listed, mistake_rate=0.05)
    for steps in runs(listed, walk):
        for length, row in enumerate(batch(belief, steps)):
            assert row.tolist() == pytest.approx(
                enumerated_beliefs.exact(listed, steps[:length], 0.05), abs=1e-8
            )


def test_a_team_has_few_next_steps_and_mistakes_that_cost_time(hall):
    """All that loses the team no time is alike; the more time is lost, the odder a step is."""
    moves = TeamMoves(hall)
    step = hall.table.find(["go", "ann", "b", "a"])
    choices = moves.choices(hall.initial, Moment())
    n_right = choices.is_next.sum(axis=1)
    right = choices.is_next[:, choices.place(step)]
    assert 0 < right.sum() < len(hall.names)
    lost = -choices.savings[:, choices.place(step)]  # compared with waiting
    chances = []
    for goal in range(len(hall.names)):
        if right[goal]:
            chances.append(0.95 / n_right[goal])
            continue
        # Waiting is next where nothing else is; what costs t more timesteps is odder by e^(-t/2).
        assert choices.waits[goal] == (not n_right[goal])
        others = [i for i in range(len(choices.steps)) if not choices.is_next[goal, i]]
        weights = [math.exp(0.5 * choices.savings[goal, i]) for i in others]
        weights += [] if choices.waits[goal] else [1.0]
        chances.append(0.05 * math.exp(-0.5 * lost[goal]) / sum(weights))
    belief = ExactBelief(hall, mistake_rate=0.05)
    found = belief.posterior(belief.observe(belief.start(), step))
    assert found.tolist() == pytest.approx((np.array(chances) / sum(chances)).tolist())
    switching = SwitchingBelief(hall, mistake_rates=[0.05])
    found = switching.posterior(switching.observe(switching.start(), step))
    assert found.tolist() == pytest.approx((np.array(chances) / sum(chances)).tolist())


def test_a_wait_speaks_for_goals_for_which_only_waiting_loses_nothing(hall):
    waits = TeamMoves(hall).choices(hall.initial, Moment()).waits
    assert 0 < waits.sum() < len(waits)
    likelihoods = Needed(), Attractor(50), Next(), Rational()
    beliefs = ExactBelief(hall), SwitchingBelief(hall), AdaptiveBelief(hall)
    for belief in (*beliefs, *(RecursiveBelief(hall, likelihood=one) for one in likelihoods)):
        start = belief.start()
        after = belief.observe_wait(start)
        posterior = belief.posterior(after)
        assert posterior[waits].min() > 10 * posterior[~waits].max()
        assert after.progress.moment.turn == 1
        # The robot's own wait is no evidence.
        later = belief.observe_wait(after)
        assert belief.posterior(later).tolist() == posterior.tolist()
        assert later.progress.moment == Moment(0, 2, 2)


def test_waits_say_nothing_where_agents_do_not_matter(workshop):
    for kind in (ExactBelief, SwitchingBelief, RecursiveBelief, AdaptiveBelief):
        belief = kind(workshop)
        assert belief.observe_wait(belief.start()).progress is belief.tracker.start


def test_the_share_of_plans_decides(workshop):
    """The first step of a plan is as likely as the share of plans that begin with it."""
    goal = 0
    plans = enumerated_beliefs.optimal_plans(workshop, goal, workshop.initial)
    first = plans[0][0]
    belief = ExactBelief(workshop)
    seen = belief.tracker.follow(belief.start().progress, first)
    assert seen is not None
    share = sum(plan[0] == first for plan in plans) / len(plans)
    place = seen[1].goals.tolist().index(goal)
    assert math.exp(seen[1].log_shares[place]) == pytest.approx(share)


def test_switching_equals_all_histories(listed, walk):
    rates, chances = (0.01, 0.2), {"hazard": 0.15, "never": 0.3, "settles": 0.6}
    belief = SwitchingBelief(listed, mistake_rates=rates, **chances)
    for steps in [run[:4] for run in runs(listed, walk)]:
        rows = batch(belief, steps)
        for length in range(1, len(steps) + 1):
            expected = np.zeros(len(listed.names))
            for goals, _, weight in enumerated_beliefs.histories(
                listed, steps[:length], rates, **chances
            ):
                expected[goals[-1]] += weight
            assert rows[length].tolist() == pytest.approx((expected / expected.sum()).tolist())


def test_many_changes_keep_their_weight():
    """However often the goal changes, nothing is lost."""
    chain = ChangeFilter(3, 1, hazard=0.9, never=0.0, settles=0.0)
    state = chain.start()
    for goal in (0, 1, 2, 0, 1, 2, 0, 1):
        likelihood = np.full((1, 3), 0.01)
        likelihood[0, goal] = 1.0
        state = chain.step(state, likelihood)
        assert state.weights.sum() == pytest.approx(1)
        assert int(chain.goals(state).argmax()) == goal
    assert state.n_declared >= 4


def test_goal_order_does_not_matter(bank, walk):
    order = list(bank.names)
    random.Random(3).shuffle(order)
    other = build(bank.goals.only(order))
    for kind in (ExactBelief, SwitchingBelief, RecursiveBelief):
        mine, theirs = kind(bank), kind(other)
        for steps in runs(bank, walk):
            for a, b in zip(batch(mine, steps), batch(theirs, steps), strict=True):
                named = dict(zip(order, b.tolist(), strict=True))
                assert a.tolist() == pytest.approx([named[name] for name in bank.names], abs=1e-8)


@pytest.mark.parametrize("kind", [ExactBelief, SwitchingBelief, RecursiveBelief])
def test_robot_steps_move_the_world_and_are_no_evidence(workshop, kind):
    table = workshop.table
    unfold, cut = table.find(("unfold", "red")), table.find(("cut", "rope"))
    belief = kind(workshop)
    after = belief.observe(belief.start(), unfold, robot=True)
    assert belief.posterior(after).tolist() == pytest.approx([0.2] * 5)
    # What the robot did need not be done again, and sealing at once fits no goal now.
    assert belief.observe(after, unfold).world == after.world
    assert belief.posterior(belief.observe(after, cut)).argmax() in (0, 2)


def test_a_step_that_no_goal_explains_is_reported_and_the_belief_stays(workshop):
    belief = ExactBelief(workshop)
    table = workshop.table
    steps = [table.find(("unfold", "red")), table.find(("seal", "blue"))]
    state = belief.observe(belief.start(), steps[0])
    before = belief.posterior(state).tolist()
    refused = belief.observe(state, steps[1])
    assert (refused.ignored, refused.world) == ("no agent can do this step here", state.world)
    odd = belief.observe(state, table.find(("seal", "red")))
    assert odd.ignored == "no goal explains this step"
    assert belief.posterior(odd).tolist() == before
    assert odd.world != state.world


def kitchen_run(kitchen, rng, first, second, at, mistakes=()):
    """Return steps of one recipe, then of another, with mistakes between them."""
    state, found = kitchen.initial, []
    for turn in range(60):
        goal = first if turn < at else second
        graph = kitchen.graph_from(goal, state)
        following = list(graph.next(0)) if graph.n_nodes else []
        if not following:
            break
        step = int(rng.choice(following))
        if turn in mistakes:
            wrong = set(kitchen.table.applicable(state)) - set(following)
            step = int(rng.choice(sorted(s for s in wrong if "serve" not in str(kitchen.table[s]))))
        found.append(step)
        state = kitchen.table.successor(state, step)
    return found


def test_switching_finds_a_change_and_survives_mistakes(kitchen):
    rng = np.random.default_rng(11)
    belief = SwitchingBelief(kitchen)
    first, second = kitchen.names.index("stew-lentil"), kitchen.names.index("parfait-mango")
    steps = kitchen_run(kitchen, rng, first, second, at=9, mistakes=(4, 14))
    states = [belief.start()]
    for step in steps:
        states.append(belief.observe(states[-1], step))
    assert belief.posterior(states[9]).argmax() == first
    assert belief.posterior(states[-1]).argmax() == second
    assert 1 <= states[-1].n_declared <= 3  # live, a mistake may look like a change at first
    changes = belief.changes(states[1:])
    assert [abs(change.at - 9) <= 1 for change in changes] == [True]
    assert changes[0].probability > 0.9


def test_no_change_is_declared_without_one(kitchen):
    rng = np.random.default_rng(12)
    belief = SwitchingBelief(kitchen)
    for goal in range(0, 30, 5):
        states = [belief.start()]
        for step in kitchen_run(kitchen, rng, goal, goal, at=99):
            states.append(belief.observe(states[-1], step))
        assert belief.posterior(states[-1]).argmax() == goal
        assert states[-1].n_declared == 0
        assert belief.changes(states[1:]) == ()


def test_the_adaptive_filter_without_its_extras_is_the_switching_one(listed, walk):
    """With one way of choosing, and the same prior of changes for acting and declaring."""
    rates = (0.01, 0.2)
    switching = SwitchingBelief(listed, hazard=0.15, mistake_rates=rates, never=0.0)
    adaptive = AdaptiveBelief(
        listed, 0.15, dict.fromkeys(rates, 0.5), {"uniform": 1.0}, never=0.0, declaring_hazard=0.15
    )
    for steps in runs(listed, walk):
        states = switching.start(), adaptive.start()
        for step in steps:
            states = switching.observe(states[0], step), adaptive.observe(states[1], step)
            assert states[0].n_declared == states[1].n_declared
            ours, theirs = adaptive.posterior(states[1]), switching.posterior(states[0])
            assert ours.tolist() == pytest.approx(theirs.tolist())


def test_each_way_of_choosing_is_a_distribution_over_the_next_steps(listed):
    tracker = ProgressTracker(listed)
    choosers = ["uniform", "plans", "general", "special"]
    preferences = StepPreferences(tracker.combined_graph, choosers)
    totals = np.zeros((len(choosers), len(listed.names)))
    steps = {listed.table.labels[s]: s for s in listed.table.applicable(listed.initial)}
    for step in steps.values():
        move = tracker.follow(tracker.start, step)
        assert move is not None
        goals = move[1].goals
        if len(goals):
            totals[:, goals] += preferences.of(step, tracker.start, move[1])
    assert np.allclose(totals, 1)
    with pytest.raises(UsageError, match="no chooser 'random'"):
        StepPreferences(tracker.combined_graph, ["random"])


def test_a_human_who_keeps_doing_special_steps_first_becomes_known(kitchen):
    """A general step says more about a human who has done special ones so far."""
    belief = AdaptiveBelief(kitchen)
    goal = kitchen.goal_index("parfait-fruit")
    human = HUMANS.find("special-first")(kitchen, Course((goal,), seed="s"))
    state, world = belief.start(), kitchen.initial
    for turn in range(6):
        step = human.move(turn, world, None).step
        assert step is not None
        state, world = belief.observe(state, step), kitchen.table.successor(world, step)
    by_kind = state.filter_state.layers[:2].sum(axis=(0, 2))
    by_chooser = by_kind.reshape(len(RATES), len(CHOOSERS)).sum(axis=0)
    shares = dict(zip(CHOOSERS, by_chooser, strict=True))
    assert shares["special"] > CHOOSERS["special"]
    assert shares["general"] < CHOOSERS["general"]


def test_a_boltzmann_policy_is_a_distribution_over_what_can_be_done(workshop):
    tracker, total = ProgressTracker(workshop), np.zeros(len(workshop.names))
    for step in workshop.table.applicable(workshop.initial):
        move = tracker.follow(tracker.start, step)
        assert move is not None
        total += Rational(1.5)(tracker, step, move[1])
    assert total.tolist() == pytest.approx([1.0] * len(total))


def test_the_robots_own_steps_are_evidence_if_they_are_to_be(workshop):
    step = enumerated_beliefs.optimal_plans(workshop, 0, workshop.initial)[0][0]
    plain, own = RecursiveBelief(workshop), RecursiveBelief(workshop, own_steps=True)
    after = plain.observe(plain.start(), step, robot=True)
    assert plain.posterior(after).tolist() == plain.posterior(plain.start()).tolist()
    by_robot, by_human = (own.observe(own.start(), step, robot=robot) for robot in (True, False))
    assert own.posterior(by_robot).tolist() == plain.posterior(by_human).tolist()


def test_paired_filters_are_two_filters():
    rng, kinds = np.random.default_rng(3), (0.5, 0.2, 0.3)
    acting = ChangeFilter(4, 3, 0.2, 0.0, 0.9, kinds)
    declaring = ChangeFilter(4, 3, 0.1, 0.3, 0.7, kinds)
    pair = PairedFilters(acting, declaring)
    both, one, other = pair.start(), acting.start(), declaring.start()
    for turn in range(40):
        likelihood = rng.random((3, 4)) * 0.1
        likelihood[:, turn // 5 % 4] += 0.5
        both = pair.step(both, likelihood)
        one, other = acting.step(one, likelihood), declaring.step(other, likelihood)
        assert np.allclose(pair.goals(both), acting.goals(one))
        assert np.allclose(both.layers[2:4].transpose(1, 0, 2), other.weights)
        assert both.n_declared == other.n_declared
    assert both.n_declared > 3
