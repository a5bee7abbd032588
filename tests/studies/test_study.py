"""Studies run, stop, go on and report; on a task that no Python names, because it is quick."""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hrcplan.errors import InputError, UsageError
from hrcplan.studies import report_study, run_study
from hrcplan.studies.run import _parts
from hrcplan.studies.store import Store
from hrcplan.studies.study import Episode, episodes, find

NAME = "failure-anticipation"
FETCH = Path(__file__).parent / "fetch"
TASK = {"domain": str(FETCH / "domain.pddl"), "problem": str(FETCH / "four-items.pddl")}
METHODS = [
    "replan-always",
    "hrcplan",
    "memory",
    "interaction",
    "estimated",
    "random-time",
    "all-fail",
]
MEASURES = {"success_pct", "replans", "failed_pct", "assigned_human_pct", "successful_human_pct",
            "makespan_s"}  # fmt: skip
TABLES = ("rows", "variants", "sweeps", "allocation", "example")


def run(folder: Path, **options: Any) -> int:
    return run_study(NAME, folder, **{"runs": 2, "options": TASK, **options})


def rows(folder: Path) -> dict[str, list[tuple[Any, ...]]]:
    with sqlite3.connect(folder / "rows.sqlite") as found:
        return {name: found.execute(f"select * from {name}").fetchall() for name in TABLES}


def test_same_bytes_whatever_the_jobs(tmp_path: Path) -> None:
    for jobs in (1, 2):
        run(tmp_path / str(jobs), jobs=jobs)
        report_study(tmp_path / str(jobs))
    for name in ("rows.sqlite", "report.html", "report.json"):
        assert (tmp_path / "1" / name).read_bytes() == (tmp_path / "2" / name).read_bytes(), name


def test_another_seed_gives_other_rows(tmp_path: Path) -> None:
    for seed in (0, 1):
        run(tmp_path / str(seed), seed=seed)
    assert rows(tmp_path / "0")["rows"] != rows(tmp_path / "1")["rows"]


def test_a_limit_is_spread_evenly_and_a_larger_one_extends_it(tmp_path: Path) -> None:
    study = find(NAME)
    n_cells = len(study.tables[0].cells(TASK))
    small, large = n_cells + 10, 2 * n_cells + 1
    run(tmp_path / "grown", runs=9, limit=small)
    before = rows(tmp_path / "grown")
    assert sum(map(len, before.values())) == small
    assert len(before["rows"]) == n_cells + 5
    per_cell = [
        sum(row[:2] == cell for row in before["rows"]) for cell in study.tables[0].cells(TASK)
    ]
    assert max(per_cell) - min(per_cell) == 1
    run(tmp_path / "grown", runs=9, limit=large)
    run(tmp_path / "at-once", runs=9, limit=large)
    after = rows(tmp_path / "grown")
    assert sum(map(len, after.values())) == large
    assert all(set(before[name]) <= set(after[name]) for name in TABLES)
    assert after == rows(tmp_path / "at-once")


def test_more_runs_extend_fewer(tmp_path: Path) -> None:
    run(tmp_path / "grown", runs=2)
    n_new = run(tmp_path / "grown", runs=3)
    run(tmp_path / "at-once", runs=3)
    assert n_new > 0
    assert run(tmp_path / "grown", runs=3) == 0
    grown, at_once = tmp_path / "grown" / "rows.sqlite", tmp_path / "at-once" / "rows.sqlite"
    assert grown.read_bytes() == at_once.read_bytes()


def test_every_promised_method_is_there_on_the_papers_task() -> None:
    study = find(NAME)
    cells = study.tables[0].cells(study.options)
    assert {method for _, method in cells} == set(METHODS)
    assert [method for case, method in cells if case == "2a"] == ["replan-always", "memory"]


def test_cells_are_paired() -> None:
    """Every cell gets the same runs, so the same human."""
    found: dict[Any, list[int]] = {}
    for episode in episodes(find(NAME), TASK, runs=3):
        if episode.table == "rows":
            found.setdefault(episode.cell, []).append(episode.run)
    assert set(map(tuple, found.values())) == {(0, 1, 2)}


@pytest.mark.parametrize("jobs", [1, 2])
def test_killed_in_the_middle_it_goes_on_to_the_same_rows(tmp_path: Path, jobs: int) -> None:
    command = [sys.executable, "-m", "hrcplan", "study", "run", NAME, "--runs", "20",
               "--domain", TASK["domain"], "--problem", TASK["problem"], "--jobs", str(jobs),
               "-o", str(tmp_path / "killed")]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
    try:
        n_before = _wait_for_rows(tmp_path / "killed", 33)
    finally:
        process.kill()
        process.wait()
    _wait_for_end_of_group(process.pid)
    wanted = len(list(episodes(find(NAME), TASK, 20)))
    assert 0 < n_before < wanted
    assert run(tmp_path / "killed", runs=20, jobs=jobs) < wanted
    run(tmp_path / "whole", runs=20)
    killed, whole = tmp_path / "killed" / "rows.sqlite", tmp_path / "whole" / "rows.sqlite"
    assert killed.read_bytes() == whole.read_bytes()


def _wait_for_end_of_group(group: int) -> None:
    """The workers end too, though nobody told them."""
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.1)
    os.killpg(group, signal.SIGKILL)
    raise AssertionError("workers outlived the study")


def _wait_for_rows(folder: Path, n: int) -> int:
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            with sqlite3.connect(f"file:{folder}/rows.sqlite?mode=ro", uri=True) as found:
                count = int(found.execute("select count(*) from rows").fetchone()[0])
        except sqlite3.Error:
            count = 0
        if count >= n:
            return count
        time.sleep(0.01)
    raise AssertionError("no rows came")


def test_the_keys_of_the_report(tmp_path: Path) -> None:
    run(tmp_path, runs=2)
    returned = report_study(tmp_path)
    document = json.loads((tmp_path / "report.json").read_text())
    assert document == returned
    assert document["study"] == NAME
    assert (
        document["n_rows"] == len(rows(tmp_path)["rows"]) == sum(r["n"] for r in document["rows"])
    )
    for row in document["rows"]:
        assert set(row["cell"]) == {"case", "method"}
        assert row["cell"]["method"] in METHODS
        assert set(row["measures"]) == MEASURES
        assert all(set(figure) == {"mean", "se"} for figure in row["measures"].values())
    cases = [row["cell"]["case"] for row in document["rows"]]
    assert sorted(set(cases)) == ["1a", "1b", "2a", "2b"]
    first = {case: document["rows"][cases.index(case)]["cell"]["method"] for case in cases}
    assert set(first.values()) == {"replan-always"}
    for claim in document["claims"]:
        assert set(claim) == {"claim", "verdict", "holds", "evidence"}
        assert claim["verdict"] == {True: "holds", False: "fails", None: "too-few"}[claim["holds"]]
        assert claim["evidence"]


def test_rows_of_an_earlier_version_are_reported_by_the_names_of_this_one(tmp_path: Path) -> None:
    run(tmp_path, runs=2)
    documents = []
    for _ in range(2):
        report_study(tmp_path)
        documents.append([(tmp_path / name).read_text() for name in ("report.json", "report.html")])
        with sqlite3.connect(tmp_path / "rows.sqlite") as file:
            for table, key in (
                ("rows", "method"),
                ("variants", "method"),
                ("allocation", "profile"),
            ):
                statement = f"update {table} set {key} = replace({key}, 'replan-always', 'paper')"
                assert file.execute(statement).rowcount > 0
            assert file.execute(
                "select * from variants where method = 'paper, random time'"
            ).fetchall()
    assert documents[0] == documents[1]
    assert "replan-always, random time" in documents[0][1]


def test_the_page_needs_nothing_but_itself(tmp_path: Path) -> None:
    run(tmp_path, runs=2)
    report_study(tmp_path)
    page = (tmp_path / "report.html").read_text()
    assert page.count("<svg ") >= 5
    for outside in ("<script", "src=", "@import", "<link", 'href="http'):
        assert outside not in page, outside


def test_names_in_the_page_are_unique(tmp_path: Path) -> None:
    run(tmp_path, runs=2)
    report_study(tmp_path)
    words = (tmp_path / "report.html").read_text().split(' id="')[1:]
    names = [word.split('"')[0] for word in words]
    assert len(names) == len(set(names))


def test_rows_of_something_else_are_not_added_to(tmp_path: Path) -> None:
    run(tmp_path, runs=1)
    with pytest.raises(UsageError, match="seed 0, not 3"):
        run(tmp_path, runs=1, seed=3)


def test_rows_of_a_file_that_has_changed_are_not_added_to(tmp_path: Path) -> None:
    problem = tmp_path / "mine.pddl"
    text = (FETCH / "four-items.pddl").read_text()
    problem.write_text(text)
    task = {**TASK, "problem": str(problem)}
    run(tmp_path / "out", runs=1, options=task)
    problem.write_text(text.replace("(tiredness worker) 1", "(tiredness worker) 2"))
    with pytest.raises(UsageError, match="inputs_sha256"):
        run(tmp_path / "out", runs=1, options=task)


def test_two_processes_do_not_write_to_one_folder(tmp_path: Path) -> None:
    about = {"study": NAME}
    with Store.to_write(tmp_path, about, ()), pytest.raises(UsageError, match="another process"):
        Store.to_write(tmp_path, about, ())
    Store.to_write(tmp_path, about, ()).close()


def test_stopped_before_its_last_act_it_still_ends_with_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All rows are there, more than once extended, but the file was not yet written anew."""
    run(tmp_path / "whole", runs=3)
    with monkeypatch.context() as stopping:
        stopping.setattr(Store, "compact", lambda store: None)
        for runs in (1, 3):
            run(tmp_path / "stopped", runs=runs)
    whole, stopped = (tmp_path / name / "rows.sqlite" for name in ("whole", "stopped"))
    assert stopped.read_bytes() != whole.read_bytes()
    stray = tmp_path / "stopped" / "rows.sqlite-mj0123ABCD9"
    stray.touch()
    assert run(tmp_path / "stopped", runs=3) == 0
    assert stopped.read_bytes() == whole.read_bytes()
    assert not stray.exists()


def test_rows_that_are_damaged_or_out_of_reach_are_told_apart(tmp_path: Path) -> None:
    run(tmp_path / "cut", runs=2)
    with (tmp_path / "cut" / "rows.sqlite").open("r+b") as file:
        file.truncate(20_000)
    (tmp_path / "odd" / "rows.sqlite").mkdir(parents=True)
    for again in (lambda: report_study(tmp_path / "cut"), lambda: run(tmp_path / "cut", runs=2)):
        with pytest.raises(InputError, match="malformed"):
            again()
    with pytest.raises(UsageError, match="unable to open"):
        run(tmp_path / "odd")
    run(tmp_path / "out", runs=1)
    (tmp_path / "out" / "report.json").mkdir()
    with pytest.raises(UsageError, match="cannot write"):
        report_study(tmp_path / "out")


def test_an_unknown_study_and_an_empty_folder_are_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no study 'failure-anticpation'"):
        run_study("failure-anticpation", tmp_path)
    with pytest.raises(UsageError, match="no module 'nowhere'"):
        run_study("nowhere:STUDY", tmp_path)
    with pytest.raises(InputError, match=r"no rows\.sqlite"):
        report_study(tmp_path / "empty")
    (tmp_path / "rows.sqlite").write_text("these are no rows")
    with pytest.raises(InputError, match="not a file of rows"):
        report_study(tmp_path)


def test_a_failing_episode_is_named_and_the_rows_before_it_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody's own study joins by ``module:NAME``; this one breaks in its 40th run."""
    (tmp_path / "breaking.py").write_text(
        "from hrcplan.studies.study import Findings, Study, StudyTable\n"
        "def episode(options, cell, seed):\n"
        "    if seed == '0/40':\n"
        "        raise ZeroDivisionError('broken')\n"
        "    return {'x': 1}\n"
        "TABLE = StudyTable('rows', ('cell',), ('x',), lambda options: [('only',)], episode)\n"
        "STUDY = Study('breaking', 'Breaking', (TABLE,), ('x',),\n"
        "              lambda options, rows: Findings('', (), ()), lambda options: '')\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ZeroDivisionError) as error:
        run_study("breaking:STUDY", tmp_path / "out", runs=50)
    assert "run 40" in "".join(error.value.__notes__)
    document = report_study(tmp_path / "out", "breaking:STUDY")
    assert document["n_rows"] == 26  # the first ten runs, and then whole chunks: 1, 1, 2, 4, 8
    assert document["rows"][0]["measures"]["x"] == {"mean": 1.0, "se": 0.0}


@pytest.mark.parametrize("name", ["changed-mind", "failure-anticipation"])
def test_a_limit_bounds_all_tables_together(name: str) -> None:
    """Also sweeps and variants; a larger limit holds all that a smaller one does."""
    study, smaller = find(name), set()
    main, n_cells = study.tables[0].name, len(study.tables[0].cells(study.options))
    for limit in sorted((1, 8, 40, n_cells, n_cells + 7, 3 * n_cells, 900)):
        wanted = list(episodes(study, study.options, 1000, limit))
        assert len(wanted) == len(set(wanted)) == limit
        n_main = sum(one.table == main for one in wanted)
        assert [one.table == main for one in wanted] == [True] * n_main + [False] * (limit - n_main)
        assert n_main >= min(limit, n_cells + (limit - n_cells) // 2)
        assert max((one.run for one in wanted[n_main:]), default=0) <= n_main // n_cells
        assert smaller <= set(wanted)
        smaller = set(wanted)


def test_a_limit_beyond_all_episodes_is_none() -> None:
    study = find(NAME)
    everything = list(episodes(study, TASK, 2))
    for limit in (len(everything), len(everything) + 1, 10**6):
        assert list(episodes(study, TASK, 2, limit)) == everything
    assert set(episodes(study, TASK, 2, len(everything) - 1)) < set(everything)


def test_a_limit_of_one_table_is_its_own() -> None:
    study = find(NAME)
    wanted = list(episodes(study, TASK, 9, 7, ["variants"]))
    assert [one.table for one in wanted] == ["variants"] * 7


def test_progress_is_told_from_the_start(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    run(tmp_path, limit=3, progress=lambda done, wanted: told.append((done, wanted)))
    assert told[0] == (0, told[-1][1])
    assert told[1][0] == 1
    assert told[-1][0] == told[-1][1]


@pytest.mark.parametrize("one_in", [1, 2, 3])
def test_a_folder_of_a_stopped_run_is_reported(tmp_path: Path, one_in: int) -> None:
    """Whatever rows are missing: there are too few to tell, and nothing else goes wrong."""
    run(tmp_path, limit=8)
    with sqlite3.connect(tmp_path / "rows.sqlite") as stopped:
        for table in find(NAME).tables:
            first = table.keys[0]
            names = stopped.execute(f'select distinct "{first}" from {table.name} order by 1')
            for (name,) in names.fetchall()[::one_in]:
                stopped.execute(f'delete from {table.name} where "{first}" = ?', (name,))
    found = report_study(tmp_path)
    assert {claim["verdict"] for claim in found["claims"]} <= {"fails", "too-few"}
    assert (tmp_path / "report.html").is_file()


def test_cells_that_need_nothing_prepared_come_first():
    """So there is a page to look at before a forest is trained."""
    missing = [Episode("rows", ("one", name), run) for run in range(2) for name in ("a", "b")]
    study = replace(find("changed-mind"), is_ready=lambda cell: cell[1] == "a")
    (first, before), (rest, after) = _parts(study, missing)
    assert [episode.cell[1] for episode in first] == ["a", "a"]
    assert (before, after) == (False, True)
    assert set(first) | set(rest) == set(missing)
    ready = replace(study, is_ready=lambda cell: True)
    assert list(_parts(ready, missing)) == [(missing, False)]
