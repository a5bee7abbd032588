"""Studies with participants, from consent to the report."""

import csv
import http.client
import io
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlencode

import pytest

from hrcplan.errors import InputError, UsageError
from hrcplan.inference.traces import read_trace
from hrcplan.studies import report_study
from hrcplan.web.server import PageService, ServerOptions
from hrcplan.web.trials.collect import collect
from hrcplan.web.trials.participants import Participants
from hrcplan.web.trials.rehearsal import SimulatedParticipant, rehearse
from hrcplan.web.trials.study_file import TrialStudy, read_study_file

STUDY = """
title = "Boxes & <robots>"
domain = "transport"
goals = "transport-goals"
conditions = ["hrcplan", "recursive"]
trials = 2
participants = 30
instructions = "Carry boxes together."
[consent]
text = "Ask <lab>."
keep_days = 30
[[tasks]]
goal = "swap"
change_to = "together"
after = 2
[[tasks]]
goal = "door"
[[questions]]
name = "age"
text = "How old?"
when = "before"
kind = "choice"
options = ["young", "old"]
[[questions]]
name = "fluent"
text = "Was it fluent?"
when = "trial"
kind = "scale"
options = ["no", "yes"]
[[questions]]
name = "remarks"
text = "What else?"
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> TrialStudy:
    path = tmp_path_factory.mktemp("study") / "study.toml"
    path.write_text(STUDY)
    return read_study_file(path)


@pytest.fixture(scope="module")
def service(study: TrialStudy, tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageService]:
    folder = tmp_path_factory.mktemp("served")
    with PageService(ServerOptions(folder, study=study)) as service:
        thread = threading.Thread(target=service.run)
        thread.start()
        yield service
        service.board.close()
        service._server.should_exit = True
        thread.join()


def ask(
    service: PageService, method: str, path: str, form: dict[str, str] | None = None
) -> tuple[int, str, str]:
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
    connection.request(method, path, None if form is None else urlencode(form))
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer.status, text, answer.getheader("Location") or ""


def arrive(service: PageService) -> str:
    assert service.desk is not None
    return ask(service, "POST", f"/p/{service.desk.invitation}", {"agree": "yes"})[2]


def test_orders_follow_from_the_seed_and_conditions_rotate(study: TrialStudy) -> None:
    plans = [study.plan(number) for number in range(4)]
    assert plans == [study.plan(number) for number in range(4)]
    assert [[trial.method for trial in plan] for plan in plans] == [
        ["hrcplan", "recursive"], ["recursive", "hrcplan"],
    ] * 2  # fmt: skip
    assert all({t.task.goal for t in plan} == {"swap", "door"} for plan in plans)
    assert [t.task for t in plans[0]] == [t.task for t in plans[1]], "tasks and robots are crossed"


@pytest.mark.parametrize(
    ("old", "new"),
    [("swap", "nothing"), ('conditions = ["hrcplan", "recursive"]', 'conditions = ["oracle"]'),
     ("keep_days = 30", ""), ("keep_days = 30", "keep_days = 0"), ("trials = 2", "trials = true"),
     ("after = 2", ""), ('kind = "scale"', 'kind = "slider"'), ('name = "fluent"', 'name = "age"'),
     ('options = ["no", "yes"]', 'options = ["no"]'), ("title =", "titel ="),
     ('name = "age"', 'name = "a b"'), ("[consent]", "[consent")],
)  # fmt: skip
def test_a_study_file_that_makes_no_sense_is_refused(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "study.toml"
    path.write_text(STUDY.replace(old, new))
    with pytest.raises((InputError, UsageError)) as caught:
        PageService(ServerOptions(tmp_path / "data", study=read_study_file(path)))
    assert caught.value.message


def test_simulated_participants_go_from_consent_to_the_report(
    service: PageService, tmp_path: Path
) -> None:
    desk = service.desk
    assert desk is not None
    path = f"/p/{desk.invitation}"
    outcome = rehearse(desk.bank, ("127.0.0.1", service.port), path, 2)
    assert outcome.finished == 2
    assert len(outcome.answers_s) > 8
    done = collect(desk, tmp_path)
    assert (done.complete, done.trials) == (2, 4)
    answers = list(csv.DictReader(io.StringIO((tmp_path / "answers.csv").read_text())))
    assert {"age", "fluent.1", "fluent.2", "remarks"} <= answers[0].keys()
    report = report_study(tmp_path)
    assert {row["cell"]["method"]: row["n"] for row in report["rows"]} == {
        "hrcplan": 2, "recursive": 2,
    }  # fmt: skip
    assert all(row["measures"]["reached_pct"]["mean"] == 100 for row in report["rows"])
    trace = read_trace(sorted((tmp_path / "traces").iterdir())[0].read_text())
    assert len(trace.actions) > 4
    assert "Boxes &amp; &lt;robots&gt;" in (tmp_path / "report.html").read_text()


def test_rows_are_the_same_when_they_are_collected_again(
    service: PageService, tmp_path: Path
) -> None:
    assert service.desk is not None
    collect(service.desk, tmp_path / "a")
    collect(service.desk, tmp_path / "b")
    for name in ("trials.csv", "answers.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_without_consent_there_is_no_participant(service: PageService) -> None:
    assert service.desk is not None
    path = f"/p/{service.desk.invitation}"
    n = len(service.desk.participants.all())
    assert ask(service, "POST", path, {})[0] == 400
    text = ask(service, "GET", path)[1]
    assert "30 days" in text
    assert "Ask &lt;lab&gt;." in text
    assert len(service.desk.participants.all()) == n


def test_a_participant_goes_on_where_they_were(service: PageService) -> None:
    path = arrive(service)
    assert "your own link" in ask(service, "GET", path)[1]
    ask(service, "POST", path, {})
    assert ask(service, "POST", path, {"age": "ancient"})[0] == 400, "no such option"
    ask(service, "POST", path, {"age": "old"})
    assert "Carry boxes together." in ask(service, "GET", path)[1]
    ask(service, "POST", path, {})
    first, again = ask(service, "GET", path)[1], ask(service, "GET", path)[1]
    assert first == again
    assert "Task 1 of 2" in first
    assert ask(service, "POST", path, {})[0] == 409, "the task goes on"


def test_participants_do_not_see_the_robot_or_its_belief(service: PageService) -> None:
    desk = service.desk
    assert desk is not None
    path = arrive(service)
    for form in ({}, {"age": "old"}, {}):
        ask(service, "POST", path, form)
    ask(service, "GET", path)
    person = desk.participants.get(path.rpartition("/")[2])
    assert person is not None
    assert person.session is not None
    simulated = SimulatedParticipant(desk.bank, ("127.0.0.1", service.port), path, 1)
    steps = 0
    for news in simulated._news(person.session):
        text = json.dumps(news)
        assert "belief" not in text
        assert "recursive" not in text
        assert not {"method", "spec", "goals"} & news.get("head", {}).keys()
        assert all(note["kind"] != "reason" for e in news["entries"] for note in e["notes"])
        if news["now"]["phase"] != "waiting":
            continue
        assert news["now"]["task"].split()[-1] in ("swap", "door", "together")
        if steps == 3:
            break
        steps += 1
        event = {"kind": "begun", "action": news["now"]["steps"][0]["action"]}
        simulated._ask("POST", f"{path}/sessions/{person.session}/events", json.dumps(event))


def test_the_scripted_change_is_shown_after_so_many_steps(service: PageService) -> None:
    desk = service.desk
    assert desk is not None
    for _ in range(4):  # one of them begins with the goal that changes
        arrive(service)
    person = next(p for p in desk.participants.all() if desk.study.plan(p.number)[0].task.change_to)
    tasks = [
        desk.news(person, {"now": {"round": n}, "entries": []})["now"]["task"] for n in range(4)
    ]
    assert [task.split()[-1] for task in tasks] == ["swap", "swap", "together", "together"]


def test_a_participant_deletes_everything(service: PageService) -> None:
    desk = service.desk
    assert desk is not None
    path = arrive(service)
    for form in ({}, {"age": "old"}, {}):
        ask(service, "POST", path, form)
    ask(service, "GET", path)
    person = desk.participants.get(path.rpartition("/")[2])
    assert person is not None
    assert person.session is not None
    assert "cannot be undone" in ask(service, "GET", f"{path}/delete")[1]
    assert ask(service, "POST", f"{path}/delete", {})[0] == 200
    assert ask(service, "GET", path)[0] == 404
    names = [p.name for p in service.options.folder.rglob("*")]
    assert not [n for n in names if person.code in n or person.session in n]


@pytest.mark.parametrize("code", ["x" * 24, "..", "study", "%2e%2e%2fserve-token"])
def test_an_unknown_link_says_nothing(service: PageService, code: str) -> None:
    assert ask(service, "GET", f"/p/{code}")[0] == 404


def test_a_participant_reaches_no_other_session(service: PageService) -> None:
    assert service.desk is not None
    other = arrive(service)
    for form in ({}, {"age": "old"}, {}):
        ask(service, "POST", other, form)
    ask(service, "GET", other)
    person = service.desk.participants.get(other.rpartition("/")[2])
    assert person is not None
    path = arrive(service)
    assert ask(service, "GET", f"{path}/stream?sessions={person.sessions[0]}")[0] == 404
    assert ask(service, "POST", f"{path}/sessions/{person.sessions[0]}/events", {})[0] == 404
    assert ask(service, "GET", "/")[0] == 403


def test_a_study_has_its_number_of_participants(study: TrialStudy, tmp_path: Path) -> None:
    participants = Participants(study, tmp_path)
    assert participants.invitation == participants.invitation
    numbers = [participants.arrive().number for _ in range(study.participants)]
    assert numbers == list(range(30))
    with pytest.raises(UsageError):
        participants.arrive()


def test_a_folder_is_of_one_version_of_a_study_file(study: TrialStudy, tmp_path: Path) -> None:
    assert Participants(study, tmp_path).invitation
    (tmp_path / "other.toml").write_text(STUDY + "\n")
    other = read_study_file(tmp_path / "other.toml")
    with pytest.raises(UsageError, match="another version"):
        assert Participants(other, tmp_path).invitation
