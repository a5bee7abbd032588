"""The robot that weighs goal and agent state: prices, take-overs, questions, unknown goals."""

from functools import lru_cache

import numpy as np
import pytest

from hrcplan.assistance.bounded_roots import unrooted
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.joint_help import JointHelp
from hrcplan.assistance.priced_moves import PricedMoves
from hrcplan.assistance.questions import ASK_PRICE, AskingRecord, answer_likelihood
from hrcplan.assistance.situation import Situation
from hrcplan.assistance.step_prices import PriceModel
from hrcplan.assistance.team_help import ACTION
from hrcplan.assistance.turn_costs import costs_to_go
from hrcplan.bank import Bank, build, build_bank
from hrcplan.bank.cost_to_go import NEVER, TIMESTEP, cost_to_go_of
from hrcplan.bank.team_moves import Moment
from tests.worlds import ERRAND, ERRANDS, HALL, PACKED, PARCELS, WORKSHOP, random_walk, world

TIRED = {("motivation", "human"): 7}
STOVE = {("capacity", "human", "stove"): 24}


@lru_cache
def bank_of(name: str) -> Bank:
    match name:
        case "hall":
            return build(world(HALL, ERRAND, ERRANDS))
        case "kitchen":
            return build_bank("kitchen", only=["pasta-bean", "pasta-tomato", "salad-bean"])
    return build(world(WORKSHOP, PACKED, PARCELS))


@lru_cache
def joint(name: str) -> JointHelp:
    return JointHelp(bank_of(name))


@pytest.mark.parametrize("name", ["workshop", "kitchen", "hall"])
def test_with_low_agent_states_it_is_the_robot_of_expected_help(name: str) -> None:
    bank = bank_of(name)
    plain, robot = ExpectedHelp(bank), joint(name)
    for seed in range(4):
        state, other = robot.start(), plain.start()
        for n, step in enumerate(random_walk(bank, seed, 8)):
            assert robot.helper({}).options(state.progress, robot.posterior(state)) == (
                plain.options(other)
            )
            advice = JointHelp(bank, asks=False).advise(state, Situation())
            assert advice.step == plain.choose(other)
            state = robot.observe(state, step, robot=bool(n % 2))
            other = plain.observe(other, step, robot=bool(n % 2))


@pytest.mark.parametrize("name", ["workshop", "kitchen"])
def test_costs_of_turns_are_the_steps_that_are_left(name: str) -> None:
    prices = PriceModel(bank_of(name)).prices({})
    for graph in bank_of(name).graphs:
        assert np.array_equal(costs_to_go(graph, prices), graph.steps_left)


def test_costs_of_a_team_are_its_timesteps() -> None:
    bank = bank_of("hall")
    costs = cost_to_go_of(bank)
    prices = PriceModel(bank).prices({})
    for goal in range(len(bank.names)):
        priced = costs.priced(goal, prices.extra[[op.step for op in bank.table.ops]] + ACTION, 1.0)
        plain = np.stack([costs.of(np.arange(priced.shape[1]), turn)[goal] for turn in (0, 1)])
        assert np.array_equal(np.where(plain < NEVER, plain / TIMESTEP, np.inf), priced)


def test_priced_moves_at_low_prices_are_the_moves() -> None:
    robot, bank = joint("hall"), bank_of("hall")
    moves = robot.tracker.moves
    assert moves is not None
    priced = PricedMoves(moves, PriceModel(bank).prices({}))
    priced.price_goals(range(len(bank.names)))
    for turn in (0, 1):
        ours = priced.choices(bank.initial, Moment(turn))
        assert np.array_equal(ours.costs, moves.choices(bank.initial, Moment(turn)).costs)


def test_a_step_that_is_hard_for_people_is_taken_over() -> None:
    """Both steps are next; the robot leaves the one that people can do, and does the other."""
    bank, robot = bank_of("kitchen"), joint("kitchen")
    state = robot.start()
    names = [("get", "pan"), ("get", "pasta"), ("pour", "pasta", "pan"), ("collect_water", "pan")]
    for words in names:
        step = bank.table.find(words)
        assert step is not None
        state = robot.observe(state, step)
    choice = robot.helper(STOVE).options(state.progress, robot.posterior(state))
    assert choice.best is not None
    assert "stove" in str(bank.table[choice.best])
    prices = robot.price_model.prices(STOVE)
    assert prices.human[choice.best] > 5 > 1 == prices.robot[choice.best]


@pytest.mark.parametrize(("name", "values"), [("kitchen", STOVE), ("kitchen", TIRED), ("hall", {})])
def test_the_plain_robot_counts_agent_state_in_the_same_way(name, values) -> None:
    bank, robot = bank_of(name), joint(name)
    priced = ExpectedHelp(bank, agent_state=values)
    state = priced.start()
    for n, step in enumerate(random_walk(bank, 3, 6)):
        expected = robot.helper(values).options(state.progress, priced.posterior(state))
        assert priced.options(state) == expected
        state = priced.observe(state, step, robot=bool(n % 2))


def test_values_at_their_low_value_are_no_prices() -> None:
    bank = bank_of("kitchen")
    low = PriceModel(bank).agents.low
    assert ExpectedHelp(bank, agent_state=low).options(ExpectedHelp(bank).start()) == (
        ExpectedHelp(bank).options(ExpectedHelp(bank).start())
    )


def test_costs_of_tired_people_are_higher() -> None:
    graph = bank_of("kitchen").graphs[0]
    prices = joint("kitchen").price_model.prices(TIRED)
    costs = costs_to_go(graph, prices)
    assert (costs >= graph.steps_left - 1e-9).all()
    assert costs[0] > graph.steps_left[0]


def test_a_step_is_worth_the_same_whether_an_even_or_an_odd_number_is_left() -> None:
    """With strict turns it would be worth nothing every second time, and the robot would wait."""
    graph = bank_of("kitchen").graphs[0]
    prices = joint("kitchen").price_model.prices(TIRED)
    costs = costs_to_go(graph, prices)
    by_layer = [costs[graph.steps_left == n].min() for n in range(2, int(graph.steps_left[0]) + 1)]
    saved = np.diff(by_layer)
    assert saved.min() > 1
    assert np.ptp(saved) < 0.1


def test_each_question_costs_more_than_the_one_before() -> None:
    prices = [AskingRecord(n, n).price for n in range(4)]
    assert prices == sorted(set(prices))
    assert prices[0] == ASK_PRICE > AskingRecord(people_wait=True).price
    assert AskingRecord(2, 2).chance_of_answer == 1 > AskingRecord(2, 1).chance_of_answer


def test_an_answer_settles_the_goal_and_something_else_rules_the_options_out() -> None:
    robot = joint("workshop")
    state = robot.observe_answer(robot.start(), (0, 1), 1)
    assert robot.posterior(state).argmax() == 1
    assert robot.posterior(state).max() > 0.9
    other = robot.observe_answer(robot.start(), (0, 1), None)
    assert robot.posterior(other)[:2].sum() < 0.05
    assert other.none > robot.start().none > state.none
    assert answer_likelihood(3, (0, 1), None).tolist() == [0.01, 0.01, 0.98]


def test_standing_still_speaks_against_goals_of_which_there_is_a_step() -> None:
    robot, bank = joint("workshop"), bank_of("workshop")
    step = bank.table.find(("cut", "pipe"))
    assert step is not None
    state = robot.observe(robot.start(), step)
    idle = robot.observe_pause(state)
    assert robot.posterior(idle).tolist() == pytest.approx(robot.posterior(state).tolist())
    assert robot.observe_pause(idle, is_evidence=False) == idle
    assert robot.chance_of_pause(state, "ann") < 0.5


def test_steps_that_no_goal_explains_point_to_a_goal_that_is_not_listed() -> None:
    robot, bank = joint("kitchen"), bank_of("kitchen")
    state = robot.start()
    for thing in ("honey", "raisins", "milk", "chocolate"):
        step = bank.table.find(("get", thing))
        assert step is not None
        before, state = state.none, robot.observe(state, step)
        assert state.none > before
    assert state.none > 0.5
    advice = robot.advise(state, Situation())
    assert advice.question is None
    assert advice.step is None or (
        robot.helper({}).n_helped(state.progress, advice.step, robot.posterior(state)) > 1
    )


def test_few_graphs_are_made_after_one_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sealing the red box first takes goals off their graphs; the likeliest gets a graph first."""
    monkeypatch.setattr("hrcplan.assistance.bounded_roots.MAX_ROOTS", 1)
    bank = build(world(WORKSHOP, PACKED, PARCELS))
    robot = JointHelp(bank)
    state = robot.start()
    missing: list[int] = []
    for words in (("unfold", "blue"), ("unfold", "red"), ("seal", "blue"), ("cut", "rope")):
        step = bank.table.find(words)
        assert step is not None
        before, state = state, robot.observe(state, step)
        made = [g for g, place in state.progress.off.items() if place.graph is not None]
        known = [g for g, place in before.progress.off.items() if place.graph is not None]
        assert len(made) <= len(known) + 1
        missing.append(len(unrooted(state.progress)))
        assert robot.posterior(state).sum() == pytest.approx(1)
        assert robot.advise(state, Situation()) is not None
    assert missing == [0, 0, 1, 1]  # of two goals that have left their graphs
