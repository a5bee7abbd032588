"""Variants that a study compares: robots that may wait or not, and other readings of the paper."""

import pytest

from hrcplan.assistance.expected_help import ExpectedHelp, SwitchingHelp
from hrcplan.assistance.field_similarity import FieldSimilarity
from hrcplan.assistance.oracle import Oracle
from hrcplan.assistance.rhp.assistant import RecedingHorizonPlanner
from hrcplan.assistance.waiting import MayWait, may_wait
from hrcplan.bank import build
from hrcplan.errors import UsageError
from hrcplan.inference.adaptive import AdaptiveBelief
from hrcplan.inference.switching import SwitchingBelief
from hrcplan.studies.changed_mind import scenario
from hrcplan.testing import check_assistant
from tests.episodes.test_choosers import CANTEEN, LUNCH, MEALS
from tests.worlds import world


def step_of(bank, *words):
    step = bank.table.find(words)
    assert step is not None
    return step


def test_the_filters_of_hrcplan_now_and_first(workshop):
    assert isinstance(ExpectedHelp(workshop).belief, AdaptiveBelief)
    assert isinstance(SwitchingHelp(workshop).belief, SwitchingBelief)


@pytest.mark.parametrize("name", ["workshop", "hall"])
def test_a_robot_that_may_wait_keeps_the_laws(request, walk, name):
    bank = request.getfixturevalue(name)
    check_assistant(
        MayWait(FieldSimilarity(bank)), bank, [walk(bank, seed, 5) for seed in range(3)]
    )


def test_a_robot_waits_where_its_own_choice_is_probably_useless(desk):
    """At first each own step of a goal is needed by one of four; later the goal is known."""
    eager = FieldSimilarity(desk)
    cautious, careless = MayWait(eager), MayWait(eager, waste_price=0.0)
    special = step_of(desk, "work", "s1")
    for robot in (cautious, careless):
        state = robot.start()
        assert robot.posterior(state).tolist() == eager.posterior(eager.start()).tolist()
        state = robot.observe(state, special)
        choice = robot.inner.options(state).best
        assert choice is not None
        helped = robot._helped(state.progress, choice)
        share = robot.posterior(state)[helped].sum()
        waits = share <= robot.waste_price * (1 - share)
        assert robot.choose(state) == (None if waits else choice)
    assert careless.choose(careless.start()) is not None
    assert may_wait(Oracle(desk)).choose(Oracle(desk).start()) is None


def test_hrcplan_may_be_forbidden_to_wait(desk):
    patient, eager = (
        ExpectedHelp(desk, waste_price=50),
        ExpectedHelp(desk, waste_price=50, may_wait=False),
    )
    state = patient.start()
    for words in (("unlock",), ("work", "all"), ("fetch", "one"), ("fetch", "two")):
        state = patient.observe(state, step_of(desk, *words), robot=True)
    assert patient.choose(state) is None
    assert eager.choose(state) is not None


def test_a_change_may_be_declared_once_the_last_guess_fits_no_more(desk):
    """``all`` is for three goals; then ``s2`` fits some goal, but not the first of them."""
    steps = [step_of(desk, "work", "all"), step_of(desk, "work", "s2")]
    declared = {}
    for rule in ("unfit", "not-the-guess"):
        robot = RecedingHorizonPlanner(desk, "presence", declares=rule)
        state = robot.start()
        for step in steps:
            state = robot.observe(state, step)
        declared[rule] = state.n_declared
    assert declared == {"unfit": 0, "not-the-guess": 1}
    with pytest.raises(UsageError, match="declared 'never'"):
        RecedingHorizonPlanner(desk, "presence", declares="never")


def test_a_step_that_fits_no_goal_may_be_set_aside():
    canteen = build(world(CANTEEN, LUNCH, MEALS))
    odd = step_of(canteen, "serve", "mug")
    for rule, n in (("change", 1), ("aside", 0)):
        robot = RecedingHorizonPlanner(canteen, "presence", odd_steps=rule)
        state = robot.observe(robot.start(), odd)
        assert state.n_declared == n
        assert state.human == (odd,)
    with pytest.raises(UsageError, match="cannot be 'kept'"):
        RecedingHorizonPlanner(canteen, "presence", odd_steps="kept")


@pytest.mark.parametrize(
    "name", ["rhp, exact belief", "rhp, our belief", "clips", "recursive-best, may wait"]
)
def test_every_method_of_the_study_can_be_made(name):
    robot = scenario.robot(name, "tests/studies/workshop/domain.pddl", "tests/studies/workshop")
    assert robot.posterior(robot.start()).sum() == pytest.approx(1)
