"""Agent state as data of the PDDL, profiles as data of a file, and what failures teach."""

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from hrcplan.agents import AgentModel, load_profile
from hrcplan.agents import profile as old_profile
from hrcplan.agents.memory import Memory
from hrcplan.agents.state import failure_probability, sensed_value
from hrcplan.errors import InputError, UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Note

MOTIVATION = ("motivation", "human")
CAPACITY = ("capacity", "human", "wp4")
KNOWLEDGE = ("knowledge", "human")


@pytest.fixture(scope="module")
def agents() -> AgentModel:
    return AgentModel(read("transport", "two-boxes"))


def test_elements_come_from_the_costs(agents: AgentModel) -> None:
    assert agents.robots == {"robot"}
    assert len(agents.elements("human")) == 8  # knowledge, motivation, capacity at six waypoints
    assert set(agents.touching("move", ("human", "wp1", "wp4"))) == {
        KNOWLEDGE, MOTIVATION, CAPACITY,
    }  # fmt: skip


def test_kitchen_binds_the_same_elements_to_other_actions() -> None:
    agents = AgentModel(read("kitchen", "salad-greek"))
    assert set(agents.touching("serve", ("human",))) == {KNOWLEDGE, MOTIVATION}
    assert ("capacity", "human", "bowl") in agents.touching("mix", ("human", "oil", "bowl"))


@pytest.mark.parametrize(
    ("value", "p"), [(0, 0), (1, 0), (Fraction(3, 2), 0.15), (8, 0.8), (10, 1)]
)
def test_failure_probability(value: Fraction, p: float) -> None:
    assert failure_probability(value, 1) == pytest.approx(p)


@pytest.mark.parametrize("value", [-0.1, 10.1, math.nan, math.inf])
def test_values_outside_the_scale_are_refused(value: float) -> None:
    with pytest.raises(UsageError, match=r"no value in \[0, 10\]"):
        sensed_value(value)


def test_a_note_of_the_domain_changes_the_range(agents: AgentModel) -> None:
    key = ("motivation", "human")
    with pytest.raises(UsageError, match=r"no value in \[0, 10\]") as refusal:
        agents.check(key, 12)
    assert ";; hrcplan: range motivation 0 12" in str(refusal.value.hint)
    note = Note("range", "motivation", (-2, 12))
    domain = replace(agents.problem.domain, notes=(note,))
    wide = AgentModel(replace(agents.problem, domain=domain).with_values({key: -2}))
    assert [wide.check(key, value) for value in (-2, 12)] == [-2, 12]
    assert (wide.clamp(key, 20), wide.clamp(key, -5)) == (12, -2)
    assert [wide.failure_probability(key, {key: value}) for value in (-1, 12)] == [0, 1]


def test_unknown_element_is_refused(agents: AgentModel) -> None:
    with pytest.raises(UsageError, match="no agent state"):
        agents.check(("mood", "human"), 3)


def test_replan_always_gives_the_planner_the_sensed_values(agents: AgentModel) -> None:
    told = load_profile("replan-always").planner_values(
        agents, {MOTIVATION: 9}, Memory().failed([KNOWLEDGE])
    )
    assert told[MOTIVATION] == 9
    assert told[KNOWLEDGE] == 1
    assert set(told) == set(agents.low)


def test_hrcplan_tells_log_losses_and_what_failed(agents: AgentModel) -> None:
    own = load_profile("hrcplan")
    told = own.planner_values(agents, {MOTIVATION: 5, CAPACITY: 10}, Memory())
    assert float(told[MOTIVATION]) == pytest.approx(1 - 10 * math.log(0.5), abs=0.01)
    assert told[CAPACITY] == 61  # low + cap
    assert (
        own.planner_values(agents, {MOTIVATION: 5}, Memory().failed([MOTIVATION]))[MOTIVATION] == 61
    )


def test_memory_narrows_the_cause_down() -> None:
    memory = Memory().failed([KNOWLEDGE, MOTIVATION])
    assert memory.blame() == {KNOWLEDGE: 0.5, MOTIVATION: 0.5}
    assert memory.went_well([KNOWLEDGE]).blame() == {MOTIVATION: 1.0}
    assert memory.failed([MOTIVATION, CAPACITY]).blame() == {MOTIVATION: 1.0}
    assert memory.sensed(MOTIVATION).blame() == {KNOWLEDGE: 1.0}


def test_success_before_a_failure_clears_nobody() -> None:
    assert Memory().went_well([MOTIVATION]).failed([MOTIVATION]).blame() == {MOTIVATION: 1.0}


def test_profile_of_the_user(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('[mine]\nvalues = "log"\nreplan_limit = 2\n')
    assert (load_profile(str(path)).name, load_profile(str(path)).replan_limit) == ("mine", 2)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[a]\nvalue = "log"', "has no 'value'"),
        ('[a]\nvalues = "cubic"', "values must be sensed or log"),
        ('[a]\nreplan_limit = "many"', "a whole number"),
        ("[a]\nreplan_limit = -1", "positive"),
        ("nonsense", "is no TOML"),
        ("", "no table"),
    ],
)
def test_bad_profiles_are_named(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        load_profile(str(path))


def test_unknown_profile_lists_the_shipped_ones() -> None:
    with pytest.raises(UsageError) as error:
        load_profile("nature")
    assert "replan-always" in str(error.value.hint)


def test_the_name_of_an_earlier_version_still_works_and_says_so() -> None:
    with pytest.warns(DeprecationWarning, match="profile 'paper'.*'replan-always'"):
        assert load_profile("paper") == load_profile("replan-always")
    with pytest.warns(DeprecationWarning, match="load_profile"):
        assert old_profile("hrcplan") == load_profile("hrcplan")
