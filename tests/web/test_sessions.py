"""Collaborations behind a page: the same machine as at the terminal, one journal each."""

import json

import pytest

from hrcplan.collaboration.journal import replay_collaboration
from hrcplan.execution.journal import read_journal
from hrcplan.web import sessions as module
from tests.web.conftest import Client, form


@pytest.fixture(scope="module")
def name(client: Client) -> str:
    return client.begin()


def test_a_step_by_click_is_answered_by_the_robot(client: Client) -> None:
    name = client.begin()
    now = client.wait(name)
    assert [step["action"] for step in now["steps"]]
    answer = client.send(name, kind="begun", action=now["steps"][0]["action"], after=now["n"])
    assert answer["n"] > now["n"]
    entries = client.news(name)[0]["entries"]
    agents = [bar["agent"] for entry in entries for bar in entry.get("bars", [])]
    assert agents[0] == "human"
    assert "robot" in agents
    assert any("belief" in entry for entry in entries)


def test_words_are_read_as_at_the_terminal(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="said", text="I walk to wp4")
    bars = [b for e in client.news(name)[0]["entries"] for b in e.get("bars", [])]
    assert (bars[0]["action"], bars[0]["args"]) == ("move", ["wp1", "wp4"])


def test_undo_takes_the_bar_away(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="said", text="go to wp4")
    client.send(name, kind="undone")
    entries = client.news(name)[0]["entries"]
    number = next(b["number"] for e in entries for b in e.get("bars", []) if b["agent"] == "human")
    assert number in [entry.get("undone") for entry in entries]


def test_a_page_that_comes_back_gets_what_it_has_missed(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="said", text="go to wp4")
    first = client.news(name)[0]
    assert first["number"] == f"{name}:{first['entries'][-1]['n']}"
    client.send(name, kind="said", text="grasp blue wp4")
    missed = client.news(name, last=first["number"])[0]["entries"]
    everything = client.news(name)[0]["entries"]
    assert [*first["entries"], *missed] == everything
    lines = read_journal(client.sessions.folder / f"{name}.jsonl").lines
    assert everything[-1]["n"] <= lines[-1]["seq"]


def test_two_pages_see_the_same(client: Client, name: str) -> None:
    assert client.news(name) == client.news(name)


def test_a_request_for_a_situation_that_is_over_is_refused(client: Client) -> None:
    name = client.begin()
    now = client.wait(name)
    event = {"kind": "passed", "after": now["n"]}
    path = f"/api/sessions/{name}/events"
    assert client.ask("POST", path, event)[0] == 200
    assert client.ask("POST", path, event)[0] == 409


def test_why_lists_what_the_robot_weighs(client: Client, name: str) -> None:
    why = client.json("GET", f"/api/sessions/{name}/why")
    assert why["candidates"]
    assert {"action", "value", "saves", "helps"} == set(why["candidates"][0])


@pytest.mark.parametrize(
    "event",
    [{}, {"kind": "begun"}, {"kind": "begun", "action": "move"}, {"kind": "begun", "action": []},
     {"kind": "begun", "action": [1]}, {"kind": "said", "text": "x" * 2001},
     {"kind": "said", "text": 5}, {"kind": "said", "text": " \u0007 "}, {"kind": "answered"},
     {"kind": "said \ud800"},
     {"kind": "passed", "agent": "nobody"}, {"kind": "state", "key": ["motivation", "human"]},
     {"kind": "state", "key": ["motivation", "human"], "value": 99},
     {"kind": "state", "key": ["nothing"], "value": 1}, {"kind": "passed", "after": "x"}],
)  # fmt: skip
def test_an_event_that_makes_no_sense_is_refused(
    client: Client, name: str, event: dict[str, object]
) -> None:
    before = client.wait(name)["n"]
    assert client.ask("POST", f"/api/sessions/{name}/events", event)[0] == 400
    assert client.wait(name)["n"] == before


def test_what_is_impossible_is_said_in_words(client: Client, name: str) -> None:
    client.send(name, kind="begun", action=["place", "human", "red", "wp0"])
    notes = [n for e in client.news(name)[0]["entries"] for n in e.get("notes", [])]
    assert "needs" in notes[-1]["text"]


def test_how_an_agent_is_can_be_told(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="state", key=["motivation", "human"], value=8)
    assert {"motivation human": 8.0} in [e.get("values") for e in client.news(name)[0]["entries"]]


def test_names_of_pddl_are_text() -> None:
    """The front end never makes markup of text."""
    from hrcplan.web.frontend import FRONTEND

    scripts = "".join(text for name, text in FRONTEND.items() if name.endswith(".js"))
    for word in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval("):
        assert word not in scripts


def test_the_front_end_is_small_and_names_no_other_machine() -> None:
    from hrcplan.web.frontend import FRONTEND

    assert sum(len(text.encode()) for text in FRONTEND.values()) <= 40_000
    for text in FRONTEND.values():
        assert "://" not in text.replace("http://www.w3.org/2000/svg", "")


def test_a_simulated_human_plays_alone(client: Client) -> None:
    name = client.begin(human="frontier", seed=3)
    assert client.wait(name, "over")["outcome"]["ending"]


def test_the_journal_of_a_page_can_be_derived_again(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="said", text="go to wp4")
    client.send(name, kind="stop")
    client.wait(name, "over")
    journal = read_journal(client.sessions.folder / f"{name}.jsonl")
    check = replay_collaboration(journal)
    assert check.difference is None
    assert check.row.ending == "stopped"


def test_an_ended_session_takes_no_event(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="stop")
    client.wait(name, "over")
    assert client.send(name, kind="passed")["error"]["code"] == "over"


def test_a_session_is_found_again_by_its_journal(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="said", text="go to wp4")
    before = client.news(name)[0]
    session = client.sessions._live.pop(name)
    session.stop()
    client.ask("GET", f"/api/sessions/{name}/why")
    client.wait(name)
    after = client.news(name)[0]
    assert after["entries"] == before["entries"]
    assert after["now"]["steps"] == before["now"]["steps"] or after["now"]["steps"]


def test_a_deleted_session_leaves_nothing(client: Client) -> None:
    name = client.begin()
    assert client.ask("DELETE", f"/api/sessions/{name}")[0] == 200
    assert not [p for p in client.sessions.folder.iterdir() if p.stem == name]
    assert client.ask("GET", f"/api/sessions/{name}/why")[0] == 404


def test_there_is_a_limit_of_sessions(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_LIVE", 0)
    assert client.ask("POST", "/begin", form())[0] == 429


def test_a_damaged_file_next_to_a_journal_is_named(client: Client) -> None:
    (client.sessions.folder / "damaged.json").write_text("[")
    answer = client.ask("GET", "/api/sessions/damaged/why")
    assert answer[0] == 400
    assert json.loads(answer[1])["error"]["code"] == "bad-session"
    (client.sessions.folder / "damaged.json").unlink()
