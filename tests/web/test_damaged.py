"""What the server stores may be damaged, and what pages send may be anything: it answers."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hrcplan.errors import InputError, UsageError
from hrcplan.web.looks import look_files
from hrcplan.web.server import PageService, ServerOptions
from hrcplan.web.trials.participants import Participants
from hrcplan.web.trials.study_file import TrialStudy, read_study_file
from tests.web.conftest import Client

DEEP = "[" * 100_000
STUDY = """title = "t"
domain = "transport"
goals = "transport-goals"
conditions = ["hrcplan"]
instructions = "i"
consent = {text = "c", keep_days = 1}
tasks = [{goal = "door"}]
"""


@pytest.mark.parametrize("text", [DEEP, "{}", "\0", '{"domain": 3}', ""])
def test_a_damaged_session_is_listed_as_such(client: Client, text: str) -> None:
    client.sessions.folder.mkdir(parents=True, exist_ok=True)
    path = client.sessions.folder / "aaaa.json"
    path.write_text(text)
    status, page, _ = client.ask("GET", "/")
    assert status == 200
    assert "damaged" in page
    assert client.ask("GET", "/c/aaaa")[0] == 400
    path.unlink()


def test_a_session_that_is_a_folder_or_a_lost_link_harms_no_other(client: Client) -> None:
    (client.sessions.folder / "bbbb.json").mkdir(parents=True)
    (client.sessions.folder / "cccc.json").symlink_to("nowhere")
    assert client.ask("GET", "/")[0] == 200
    (client.sessions.folder / "bbbb.json").rmdir()
    (client.sessions.folder / "cccc.json").unlink()


@pytest.mark.parametrize("number", ["9" * 5000, "-1", "x", "1e3", "٣"])
def test_a_file_of_no_number_is_not_there(client: Client, number: str) -> None:
    path = f"/look/{number}".encode().decode("latin-1")
    assert client.ask("GET", path.replace("Ù", "%D9").replace("£", "%A3"))[0] == 404


@pytest.mark.parametrize("value", ["1" + "0" * 400, "NaN", "1e999", "true", "-1", '"3"', "[3]"])
def test_a_state_is_a_number_in_its_range(client: Client, value: str) -> None:
    name = client.begin(world="transport/two-boxes ")
    body = f'{{"kind": "state", "key": ["motivation", "human"], "value": {value}}}'
    assert client.ask("POST", f"/api/sessions/{name}/events", body.encode())[0] == 400


def test_half_of_a_character_reaches_all_pages_as_its_escape(client: Client) -> None:
    name = client.begin()
    client.send(name, kind="begun", agent="human", action=["\ud800", "x"])
    assert "\\ud800" in json.dumps(client.news(name)[0], ensure_ascii=False)


@pytest.mark.parametrize("text", ["", "short\n"])
def test_a_cut_secret_is_no_secret(tmp_path: Path, text: str) -> None:
    (tmp_path / "serve-token").write_text(text)
    with pytest.raises(UsageError, match="no secret"):
        PageService(ServerOptions(tmp_path))


@pytest.mark.parametrize("host", ["x" * 100, "a..b", "256.1.1.1", "\udcff", "::g"])
def test_an_address_that_is_none_is_named(tmp_path: Path, host: str) -> None:
    with pytest.raises(UsageError, match="cannot listen"):
        PageService(ServerOptions(tmp_path, host))


def test_a_first_line_that_is_nested_too_deep_is_no_journal(tmp_path: Path) -> None:
    (tmp_path / "x.plan").write_text(DEEP)
    assert look_files([tmp_path])[0].kind == "plan"


@pytest.mark.parametrize(
    "changed",
    [
        ('tasks = [{goal = "door"}]', "tasks = [1]"),
        ('tasks = [{goal = "door"}]', 'tasks = [{goal = "door", after = -1}]'),
        ('conditions = ["hrcplan"]', 'conditions = ["antigravity:x"]'),
        ('conditions = ["hrcplan"]', 'conditions = ["cmd:touch ran"]'),
        ('instructions = "i"', "instructions = 1979-05-27"),
        ('instructions = "i"', 'instructions = "i"\nquestions = [[]]'),
    ],
)
def test_a_study_file_is_checked_and_chooses_no_code(
    tmp_path: Path, changed: tuple[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(STUDY.replace(*changed))
    with pytest.raises(InputError):
        read_study_file(tmp_path / "s.toml")
    assert not (tmp_path / "ran").exists()


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> TrialStudy:
    path = tmp_path_factory.mktemp("study") / "s.toml"
    path.write_text(STUDY)
    return read_study_file(path)


RECORDS = [
    {"sessions": None}, {"stage": "lost"}, {"stage": "run", "sessions": [1]}, {"trial": 10**9},
    {"trial": -1}, {"number": None}, {"answers": 3}, {"answers": {"age": []}}, {"more": 1},
    {"code": "x" * 24},
]  # fmt: skip


@pytest.mark.parametrize("change", RECORDS, ids=str)
def test_a_damaged_record_of_a_participant_is_named(
    tmp_path: Path, study: TrialStudy, change: dict[str, object]
) -> None:
    people = Participants(study, tmp_path)
    assert people.invitation
    code = people.arrive().code
    path = tmp_path / f"{code}.json"
    record = json.loads(path.read_text())
    for text in (json.dumps({**record, **change}), DEEP, "[]", "{}"):
        path.write_text(text)
        with pytest.raises(InputError, match="damaged"):
            people.get(code)


@pytest.mark.parametrize("text", [DEEP, "{}", '{"invitation": 1, "n": 1}'])
def test_a_damaged_record_of_the_study_is_named(
    tmp_path: Path, study: TrialStudy, text: str
) -> None:
    (tmp_path / "study.json").write_text(text)
    with pytest.raises(InputError, match="damaged"):
        _ = Participants(study, tmp_path).invitation
