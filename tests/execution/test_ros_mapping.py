"""Mapping files of ROS robots: what they say, and what is wrong with them. No ROS is needed."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrcplan.core.toml import line_of
from hrcplan.errors import InputError
from hrcplan.execution.links import LINKS, make_link
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.ros.filling import FilledMapping
from hrcplan.execution.links.ros.link import PlanSys2Link, ros_environment
from hrcplan.execution.links.ros.mapping import RosMapping, read_mapping
from hrcplan.pddl.inputs import read

SHOP = Path(__file__).parent / "robots" / "shop.toml"
TEXT = SHOP.read_text()


@pytest.fixture(scope="module")
def shop() -> FilledMapping:
    return FilledMapping(read_mapping(SHOP), read("transport/two-boxes"))


def topic(shop: FilledMapping, name: str) -> int:
    return [topic.name for topic in shop.mapping.topics].index(name)


def test_goals_have_the_objects_of_an_action(shop: FilledMapping) -> None:
    order = shop.order("move", ("robot", "wp0", "wp3"))
    assert order["name"] == "/robot/navigate_to_pose"
    goal = {"header": {"frame_id": "map"}, "pose": {"position": {"x": 3, "y": 0}}}
    assert order["goal"] == {"pose": goal}
    assert order["done"] == {"error_code": 0}
    assert shop.order("grasp", ("robot", "blue", "wp4"))["goal"] == {"order": 1}


def test_a_placeholder_inside_a_text(shop: FilledMapping) -> None:
    assert shop._fill("to {to}, from {from}", {"to": "wp1", "from": "wp0"}) == "to wp1, from wp0"
    assert shop._fill(["{to}", 3], {"to": "wp1"}) == ["wp1", 3]


def test_a_fact_excludes_others_of_its_kind(shop: FilledMapping) -> None:
    seen = shop.read(topic(shop, "/robot/place"), {"data": "wp2"})
    assert isinstance(seen, msg.FactsObserved)
    assert seen.facts == {("at", "robot", "wp2")}
    assert ("at", "robot", "wp0") in seen.absent
    assert ("at", "human", "wp1") not in seen.absent
    assert len(seen.absent) == 5


def test_a_place_by_position(shop: FilledMapping) -> None:
    n = topic(shop, "/robot/pose")
    near = shop.read(n, {"pose.position": {"x": 1.1, "y": 0.2, "z": 0.0}})
    far = shop.read(n, {"pose.position": {"x": 1.5, "y": 0.0, "z": 0.0}})
    assert isinstance(near, msg.FactsObserved)
    assert near.facts == {("at", "robot", "wp1")}
    assert isinstance(far, msg.FactsObserved)
    assert (far.facts, len(far.absent)) == (frozenset(), 6)  # between two of them


def test_a_fact_that_a_field_affirms_or_denies(shop: FilledMapping) -> None:
    n, fact = topic(shop, "/human/holds_blue"), frozenset({("holding", "human", "blue")})
    assert shop.read(n, {"data": True}) == msg.FactsObserved(fact, frozenset())
    assert shop.read(n, {"data": False}) == msg.FactsObserved(frozenset(), fact)


def test_values_words_actions_and_the_stop(shop: FilledMapping) -> None:
    def said(name: str, data: object) -> object:
        return shop.read(topic(shop, name), {"data": data})  # type: ignore[dict-item]

    assert said("/human/motivation", 7.5) == msg.ValuesSensed({("motivation", "human"): 7.5})
    assert isinstance(said("/human/motivation", float("nan")), msg.BadLine)
    assert said("/human/speech", "I go") == msg.PersonSaid("human", "I go")
    assert said("/human/speech", " ") is None
    begun = msg.PersonBegun("human", "move", ("human", "wp1", "wp4"))
    assert said("/human/begins", "(move human wp1 wp4)") == begun
    assert said("/stop", True) == msg.StopPressed("topic /stop")
    assert said("/stop", False) == msg.StopReleased()


def fault_of(tmp_path: Path, text: str) -> InputError:
    path = tmp_path / "shop.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        make_link(f"ros:{path}", read("transport/two-boxes"))
    return caught.value


@pytest.mark.parametrize(
    ("old", "new", "message", "hint"),
    [
        ("[actions.grasp]", "[actions.grap]", "no such action", "did you mean 'grasp'?"),
        ("goal.order = 1", 'goal.order = "{boxx}"', "no parameter 'boxx'", "parameters: a, b, w"),
        ('"{places.to}"', '"{place.to}"', "no table 'place'", "did you mean 'places'?"),
        ("wp5 = {", "wp6 = {", "no entry for wp5", "add wp5"),
        ("nav2_msgs/action/", "nav2_msgs/msg/", "is no action type", "NavigateToPose"),
        ("done = {", "dome = {", "no such key", "did you mean 'done'?"),
        ('"at robot {data}"', '"att robot {data}"', "no predicate 'att'", "did you mean 'at'?"),
        ('"at robot {data}"', '"at robott {data}"', "no object 'robott'", "did you mean 'robot'?"),
        ('"at robot {data}"', '"at {data}"', "takes 2 objects, not 1", ""),
        ('"motivation human"', '"motivaton human"', "no function", "did you mean 'motivation'?"),
        ('stop = "data"', 'halt = "data"', "a topic says one of", "at robot"),
        ('agent = "human"', 'agent = "humn"', "no agent 'humn'", "did you mean 'human'?"),
        ("domain_id = 77", 'domain_id = "a"', "a whole number", ""),
        ("domain_id = 77", 'discovery = "all"', "one of localhost, subnet", ""),
        ("domain_id = 77", 'agents = ["human"]', "takes no commands", "robots: robot"),
        ("wp5 = { position = { x = 5, y = 0 } }", "wp5 = 3", "no position", ""),
        ('table = "places", ', "", "a text 'table' is needed", ""),
        ("{near}", "{wp}", "belong together", "near"),
    ],
)
def test_faults_have_a_place_and_a_hint(
    tmp_path: Path, old: str, new: str, message: str, hint: str
) -> None:
    text = TEXT.replace(old, new, 1)
    fault = fault_of(tmp_path, text)
    assert message in fault.message
    assert hint in (fault.hint or "")
    assert fault.exit_code == 3
    assert fault.path
    assert fault.line is not None
    line = text.splitlines()[fault.line - 1]
    assert (new and new in line) or line.startswith(("[", "wp5", "near"))


def test_the_line_of_a_fault(tmp_path: Path) -> None:
    text = TEXT.replace('value = "motivation human"', 'value = "motivaton human"')
    line = next(n for n, one in enumerate(text.splitlines(), 1) if "motivaton" in one)
    assert fault_of(tmp_path, text).line == line


def test_an_action_of_a_robot_needs_an_entry(tmp_path: Path) -> None:
    text = TEXT.replace("[actions.take]", "[actions.extra]").replace("extra", "take", 0)
    assert "no such action" in fault_of(tmp_path, text).message
    i, j = text.index("[actions.extra]"), text.index("[tables.places]")
    fault = fault_of(tmp_path, text[:i] + text[j:])
    assert "no entry for 'take'" in fault.message
    assert "[actions.take]" in (fault.hint or "")


def test_a_file_that_is_no_toml_or_no_file(tmp_path: Path) -> None:
    fault = fault_of(tmp_path, TEXT + "\nx = = 3\n")
    assert "is no TOML" in fault.message
    assert fault.line == len(TEXT.splitlines()) + 2
    with pytest.raises(InputError, match="there is no file"):
        LINKS.make("ros:no-such.toml")


def test_performers_of_plansys2_need_no_actions() -> None:
    link = make_link("plansys2", read("transport/two-boxes"))
    assert isinstance(link, PlanSys2Link)
    with pytest.raises(InputError, match="take actions by their names"):
        PlanSys2Link(str(SHOP))


def test_discovery_stays_on_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    key = "ROS_AUTOMATIC_DISCOVERY_RANGE"
    assert ros_environment(RosMapping(Path()))[key] == "LOCALHOST"
    assert ros_environment(RosMapping(Path(), discovery="subnet"))[key] == "SUBNET"
    assert ros_environment(read_mapping(SHOP))["ROS_DOMAIN_ID"] == "77"
    monkeypatch.setenv(key, "SUBNET")
    assert ros_environment(RosMapping(Path()))[key] == "SUBNET"


def test_the_lines_of_values() -> None:
    text = '[a]\nb = 1\n[a.c]\nd.e = 2\n[["t"]]\nx = 1\n[["t"]]\nx = { y = 2 }\n'
    assert line_of(text, ["a", "b"]) == 2
    assert line_of(text, ["a", "c", "d", "e"]) == 4
    assert line_of(text, ["t", 1, "x", "y"]) == 8
    assert line_of(text, ["no"]) == 1
