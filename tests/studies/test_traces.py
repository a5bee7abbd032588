"""Studies write a trace of every episode, which inference reads."""

import json
from pathlib import Path
from typing import Any

import pytest

from hrcplan.bank import build_bank
from hrcplan.errors import InputError, UsageError
from hrcplan.inference import infer
from hrcplan.inference.traces import read_trace, world_sha256
from hrcplan.studies import run_study
from hrcplan.studies.store import Store
from hrcplan.studies.study import find

WORKSHOP = Path(__file__).parent / "workshop"
TASK = {"domain": str(WORKSHOP / "domain.pddl"), "goals": str(WORKSHOP)}
OPTIONS = {
    "changed-mind": {**TASK, "methods": "recursive,oracle"},
    "collaboration": {**TASK, "methods": "joint"},
}
FETCH = Path(__file__).parent / "fetch"


def run(study: str, folder: Path, **options: Any) -> int:
    main = find(study).tables[0].name
    wanted = {"runs": 2, "options": OPTIONS[study], "tables": [main], **options}
    return run_study(study, folder / "rows", traces=folder / "traces", **wanted)


def files(folder: Path) -> dict[str, str]:
    found = sorted((folder / "traces").rglob("*.jsonl"))
    return {str(path.relative_to(folder)): path.read_text("utf-8") for path in found}


@pytest.mark.parametrize("study", OPTIONS)
def test_every_row_has_a_trace_and_is_what_it_is_without(study: str, tmp_path: Path) -> None:
    n = run(study, tmp_path / "traced")
    assert len(files(tmp_path / "traced")) == n
    run_study(study, tmp_path / "rows", runs=2, options=OPTIONS[study],
              tables=[find(study).tables[0].name])  # fmt: skip
    bytes_of = [
        (p / "rows.sqlite").read_bytes() for p in (tmp_path / "traced/rows", tmp_path / "rows")
    ]
    assert bytes_of[0] == bytes_of[1]


@pytest.mark.parametrize("study", OPTIONS)
def test_inference_reads_the_traces_of_a_study(study: str, tmp_path: Path) -> None:
    run(study, tmp_path, runs=1)
    bank = build_bank(TASK["domain"], TASK["goals"])
    for text in files(tmp_path).values():
        trace = read_trace(text)
        assert trace.pddl_sha256 == world_sha256(bank.goals.problem)
        assert trace.episode is not None
        assert trace.episode.study == study
        assert trace.episode.goals == bank.names
        answer = trace.episode.answers["all"]
        assert len(answer.goals) == len(answer.turns) + 1
        inference = infer(bank, text)
        assert len(inference.actions) == sum(one.outcome == "done" for one in trace.actions)
        assert not inference.ignored
        by_human = [one for one in trace.actions if one.agent == bank.humans[0]]
        assert by_human
        assert all(len(one.posterior or ()) == len(bank.names) for one in by_human)


def test_two_runs_write_the_same_bytes_and_one_goes_on(tmp_path: Path) -> None:
    for name in ("one", "two"):
        run("changed-mind", tmp_path / name, jobs=1, runs=3)
    assert files(tmp_path / "one") == files(tmp_path / "two")
    first, *_ = (tmp_path / "two" / "traces").rglob("*.jsonl")
    first.unlink()
    assert run("changed-mind", tmp_path / "two", runs=3) == 1
    assert files(tmp_path / "one") == files(tmp_path / "two")


def test_a_trace_says_how_long_the_episode_was(tmp_path: Path) -> None:
    run("changed-mind", tmp_path)
    study = find("changed-mind")
    with Store.to_read(tmp_path / "rows") as store:
        rows = {(r["human"], r["method"], r["run"]): r for r in store.rows(study.tables[0])}
    for text in files(tmp_path).values():
        episode = read_trace(text).episode
        assert episode is not None
        row = rows[(*episode.cell, episode.run)]
        assert episode.timesteps == row["played_steps"]
        assert " ".join(episode.answers["all"].goals) == row["goals"]


def test_an_action_that_was_changed_is_noticed(tmp_path: Path) -> None:
    run("changed-mind", tmp_path, runs=1)
    text = next(iter(files(tmp_path).values()))
    head, *lines = text.splitlines()
    edited = json.dumps({**json.loads(lines[0]), "t": 0.5})
    for body in ([lines[1], lines[0], *lines[2:]], lines[:-1], [edited, *lines[1:]]):
        with pytest.raises(InputError, match="changed after the trace was written"):
            read_trace("\n".join([head, *body, ""]))


@pytest.mark.parametrize(
    "episode", [{"run": "1"}, {"answers": []}, {"goals": None}, {"timesteps": 1.5}, {"cell": 3}]
)
def test_a_damaged_episode_is_refused(tmp_path: Path, episode: dict[str, Any]) -> None:
    run("changed-mind", tmp_path, runs=1)
    head, _, body = next(iter(files(tmp_path).values())).partition("\n")
    table = json.loads(head)
    table["episode"] |= episode
    with pytest.raises(InputError) as caught:
        read_trace(json.dumps(table) + "\n" + body)
    assert caught.value.line == 1


def test_a_study_without_traces_says_so(tmp_path: Path) -> None:
    task = {"domain": str(FETCH / "domain.pddl"), "problem": str(FETCH / "four-items.pddl")}
    with pytest.raises(UsageError, match="no traces of its table"):
        run_study("failure-anticipation", tmp_path, traces=tmp_path / "t", runs=1, options=task)
    assert not (tmp_path / "t").exists()
