"""What people say reaches the machine as actions, questions, or nothing."""

import pytest

from hrcplan.collaboration.events import ACT, ASK, NONE
from hrcplan.collaboration.reading import Reader, StepReading, reader_of
from hrcplan.pddl.inputs import read

STEPS = [
    ("pour", "human", "oats", "pan"),
    ("pour", "human", "oats", "glass"),
    ("get", "human", "nuts"),
    ("turn_on", "human", "stove"),
]


@pytest.fixture(scope="module")
def reader() -> Reader:
    return reader_of(read("kitchen", "oatmeal-berry"))


def test_an_action_as_the_plan_writes_it_is_itself(reader: Reader) -> None:
    assert reader("(turn_on human stove)", STEPS, {}) == StepReading(ACT, (STEPS[3],))
    assert reader("get nuts", STEPS, {}) == StepReading(ACT, (STEPS[2],))


def test_the_belief_answers_what_words_leave_open(reader: Reader) -> None:
    assert reader("adding the oats", STEPS, {}) == StepReading(ASK, tuple(STEPS[:2]))
    likely = {STEPS[0]: 0.9, STEPS[2]: 0.1}
    assert reader("adding the oats", STEPS, likely) == StepReading(ACT, (STEPS[0],))
    assert reader("switch the stove on", STEPS, likely) == StepReading(ACT, (STEPS[3],))


def test_other_talk_is_nothing(reader: Reader) -> None:
    assert reader("nice weather", STEPS, {}) == StepReading(NONE)
    assert reader("don't turn on the stove", STEPS, {}) == StepReading(NONE)
