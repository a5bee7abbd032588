"""The benchmark: its instances, its study, and scores that follow from traces alone."""

import json
import random
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from hrcplan.bank import build_bank
from hrcplan.cli.main import main
from hrcplan.episodes.episode import EpisodeRecord, EpisodeTurn
from hrcplan.errors import InputError, UsageError
from hrcplan.inference import infer
from hrcplan.inference.traces import read_trace, text_sha256
from hrcplan.studies import report_study, run_study
from hrcplan.studies.store import Store
from hrcplan.studies.study import StudyRow, find
from hrcplan.studies.switch import instances, methods, tasks
from hrcplan.studies.switch.episodes import GUESSES, KEYS, played_oracle_steps, row_of
from hrcplan.studies.switch.instances import SwitchInstance, all_instances, listed
from hrcplan.studies.switch.score import score

OURS = "hrcplan,recursive"


@contextmanager
def small_benchmark(folder: Path) -> Iterator[None]:
    """Let the benchmark have one task, two humans and two runs; its instances are listed ones."""
    text = tasks.BENCHMARK.read_text("utf-8")
    head, _, rest = text.partition("[tasks.kitchen]")
    head = head.replace("runs = 10", "runs = 2").replace('"fixed", "optimal", ', "")
    path = folder / "benchmark.toml"
    path.write_text(head + rest[rest.index("[tasks.yard]") :])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tasks, "BENCHMARK", path)
        tasks.definition.cache_clear()
        yield
    tasks.definition.cache_clear()


@pytest.fixture
def small(tmp_path: Path) -> Iterator[None]:
    with small_benchmark(tmp_path):
        yield


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with rows and traces of two methods, in both tables of the small benchmark."""
    folder = tmp_path_factory.mktemp("switch")
    with small_benchmark(folder):
        run_study("switch", folder / "rows", options={"methods": OURS}, traces=folder / "traces")
    return folder


@pytest.fixture
def folder(tmp_path: Path, whole: Path, small: None) -> Path:
    """A copy of it, to be damaged."""
    for name in ("rows", "traces"):
        shutil.copytree(whole / name, tmp_path / name)
    return tmp_path


def trace_files(folder: Path) -> list[Path]:
    return sorted((folder / "traces").rglob("*.jsonl"))


def own_rows(folder: Path) -> dict[str, list[StudyRow]]:
    with Store.to_read(folder / "rows") as store:
        return {table.name: store.rows(table) for table in find("switch").tables}


def test_scores_of_traces_are_the_measures_of_the_study(folder: Path) -> None:
    result = score(folder / "traces")
    assert result.faults == ()
    assert result.n_traces == 2 * 2 * 2 * 2
    by_place = lambda row: [str(row[key]) for key in (*KEYS, "run")]  # noqa: E731
    for table, rows in own_rows(folder).items():
        assert sorted(result.rows[table], key=by_place) == sorted(rows, key=by_place)


def test_scores_do_not_depend_on_names_and_places_of_files(folder: Path, tmp_path: Path) -> None:
    before = json.dumps(score(folder / "traces").as_json(), sort_keys=True)
    flat = tmp_path / "flat"
    flat.mkdir()
    for number, path in enumerate(trace_files(folder)):
        path.rename(flat / f"{number}.jsonl")
    assert json.dumps(score(flat).as_json(), sort_keys=True) == before


def test_two_runs_write_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    run_study("switch", tmp_path / "r2", options={"methods": OURS}, traces=tmp_path / "t2")
    for path in trace_files(folder):
        other = tmp_path / "t2" / path.relative_to(folder / "traces")
        assert path.read_bytes() == other.read_bytes()


def refusals(folder: Path) -> set[str]:
    result = score(folder / "traces")
    assert result.rows == {}
    return {fault.code for fault in result.faults}


def resealed(head: dict[str, Any], lines: list[str]) -> str:
    """Return a trace whose hash fits its actions, as a careful forger would write it."""
    body = "".join(f"{line}\n" for line in lines)
    return json.dumps({**head, "actions_sha256": text_sha256(body)}) + "\n" + body


def change(path: Path, how: Callable[[dict[str, Any], list[str]], None], seals: bool) -> None:
    first, *lines = path.read_text("utf-8").splitlines()
    head = json.loads(first)
    how(head, lines)
    text = resealed(head, lines) if seals else "\n".join([json.dumps(head), *lines, ""])
    path.write_text(text)


def swapped(head: dict[str, Any], lines: list[str]) -> None:
    lines[0], lines[1] = lines[1], lines[0]


def cut_short(head: dict[str, Any], lines: list[str]) -> None:
    head["episode"]["timesteps"] = int(json.loads(lines[-1])["t"])
    del lines[-1]


def robot_waits(head: dict[str, Any], lines: list[str]) -> None:
    place = next(i for i, line in enumerate(lines) if json.loads(line)["agent"] == "robot")
    del lines[place]


def another_human_step(head: dict[str, Any], lines: list[str]) -> None:
    first = json.loads(lines[0])
    lines[0] = json.dumps({**first, "args": [first["args"][0], "hall", "gate"], "action": "walk"})


def unknown_action(head: dict[str, Any], lines: list[str]) -> None:
    place = next(i for i, line in enumerate(lines) if json.loads(line)["agent"] == "robot")
    lines[place] = json.dumps({**json.loads(lines[place]), "action": "fly"})


def no_posterior(head: dict[str, Any], lines: list[str]) -> None:
    first = json.loads(lines[0])
    lines[0] = json.dumps({key: value for key, value in first.items() if key != "posterior"})


def too_sure(head: dict[str, Any], lines: list[str]) -> None:
    first = json.loads(lines[0])
    lines[0] = json.dumps({**first, "posterior": [1.0] * len(first["posterior"])})


EDITS = [swapped, cut_short, robot_waits, another_human_step, unknown_action, no_posterior]


@pytest.mark.parametrize("how", [*EDITS, too_sure])
def test_an_edited_trace_is_refused_by_name(folder: Path, how: Any) -> None:
    path = folder / "traces" / "assistance" / "yard" / "2 changes" / "hrcplan" / "00000.jsonl"
    text = path.read_text("utf-8")
    for seals in (False, True):
        path.write_text(text)
        change(path, how, seals)
        (fault,) = score(folder / "traces").faults
        assert fault.path == str(path)
        assert fault.code != "bad-trace" or not seals


def test_a_step_edited_with_its_hash_is_replayed(folder: Path) -> None:
    """Either the episode cannot have been so, or it is a valid one of another robot."""
    rng = random.Random(0)
    n_refused = n_edits = 0
    for path in trace_files(folder)[:2]:
        text = path.read_text("utf-8")
        first, *lines = text.splitlines()
        for _ in range(5):
            at, other = rng.randrange(len(lines)), json.loads(rng.choice(lines))
            own = json.loads(lines[at])
            edited = json.dumps({**own, "action": other["action"], "args": other["args"]})
            path.write_text(resealed(json.loads(first), [*lines[:at], edited, *lines[at + 1 :]]))
            faults = score(folder / "traces").faults
            assert {fault.path for fault in faults} <= {str(path)}
            is_same = json.loads(edited) == own
            assert not (is_same and faults)
            n_edits, n_refused = n_edits + (not is_same), n_refused + bool(faults)
        path.write_text(text)
    assert n_refused > n_edits / 2


HEADS = {
    "foreign-trace": {"study": "changed-mind"},
    "other-version": {"version": "0"},
    "other-seed": {"seed": 7},
    "other-answers": {"answers": {"all": {"goals": ["goal-01"], "turns": []}}},
    "other-pddl": {"goals": ["a", "b"]},
}


@pytest.mark.parametrize("code", HEADS)
def test_a_foreign_trace_is_refused(folder: Path, code: str) -> None:
    path = trace_files(folder)[0]
    change(path, lambda head, lines: head["episode"].update(HEADS[code]), seals=True)
    assert refusals(folder) == {code}


def test_traces_of_other_pddl_are_refused(folder: Path) -> None:
    path = trace_files(folder)[0]
    change(path, lambda head, lines: head.update(pddl_sha256="0"), seals=True)
    assert refusals(folder) == {"other-pddl"}


def test_the_recording_must_be_that_of_the_instance(folder: Path) -> None:
    path = next((folder / "traces" / "inference").rglob("*.jsonl"))
    change(path, robot_waits, seals=True)
    assert refusals(folder) == {"other-recording"}


def test_missing_and_double_instances_are_named(folder: Path) -> None:
    first, second, *_ = trace_files(folder)
    second.with_name("copy.jsonl").write_text(second.read_text("utf-8"))
    assert refusals(folder) == {"same-instance"}
    second.with_name("copy.jsonl").unlink()
    first.unlink()
    (fault,) = score(folder / "traces").faults
    assert fault.code == "incomplete"
    assert "assistance, hrcplan: 1 instance missing: yard/2 changes/0" in fault.message


def test_no_traces_at_all(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no traces in"):
        score(tmp_path)
    with pytest.raises(InputError, match="there is no file"):
        score(tmp_path / "none")


def test_the_command_prints_tables_or_faults(folder: Path) -> None:
    done = CliRunner().invoke(main, ["score", str(folder / "traces")], standalone_mode=False)
    assert "assistance: 4 episodes" in done.stdout
    assert "inference: 4 episodes" in done.stdout
    trace_files(folder)[0].write_text("{")
    done = CliRunner().invoke(main, ["score", str(folder / "traces")], standalone_mode=False)
    assert "error[bad-trace]" in done.stdout
    assert "nothing is scored" in done.stdout


def test_the_pddl_lies_with_the_traces_and_inference_reads_both(folder: Path, whole: Path) -> None:
    place = whole / "traces" / "pddl" / "yard"
    bank = build_bank(place / "domain.pddl", place, only=["goal-01", "goal-02"])
    path = trace_files(folder)[0]
    inference = infer(bank, path)
    assert not inference.ignored
    assert len(inference.actions) == len(read_trace(path.read_text("utf-8")).actions)


def test_the_study_has_a_report(folder: Path) -> None:
    summary = report_study(folder / "rows")
    assert {row["cell"]["method"] for row in summary["rows"]} == set(OURS.split(","))
    page = (folder / "rows" / "report.html").read_text("utf-8")
    assert "Assistance" in page
    assert "Inference" in page


def test_the_pddl_of_every_task_is_that_of_the_list() -> None:
    assert {task: tasks.hashes_of(task) for task in tasks.task_names()} == {
        **instances.listed_hashes()
    }


def test_every_instance_is_listed() -> None:
    names = json.loads(instances.LIST.read_text("utf-8"))["instances"]
    assert list(names) == [one.name for one in all_instances()]


@pytest.mark.parametrize("task", ["yard", "transport"])
def test_instances_are_as_listed(task: str) -> None:
    instance = SwitchInstance(task, "suboptimal", 1)
    known = listed(instance)
    assert known is not None
    names = tasks.bank_of(task).names
    assert known.goals == tuple(names[goal] for goal in instance.course.goals)
    assert known.turns == instance.course.turns
    assert known.oracle_steps == played_oracle_steps(instance)


def test_an_episode_without_guesses_has_no_measures_of_them() -> None:
    instance = SwitchInstance("yard", "fixed", 0)
    waiting = EpisodeTurn(0, True, None, 0, False)
    row = row_of("assistance", instance, EpisodeRecord(instance.course, (waiting,), "stuck"), {})
    assert {row[name] for name in GUESSES} == {None}
    assert row["reached_pct"] == 0.0


def test_generated_goals_depend_on_the_seed_alone() -> None:
    before = tasks.pddl_files("yard")
    tasks.goals_of.cache_clear()
    assert tasks.pddl_files("yard") == before


def test_methods_take_part_where_they_can(small: None) -> None:
    def named(table: str, names: str) -> set[str]:
        return {str(cell[2]) for cell in methods.cells(table, {"methods": names})}

    assert named("assistance", "oracle,hrcplan,switching") == {"oracle", "hrcplan"}
    assert named("inference", "oracle,hrcplan,switching") == {"hrcplan", "switching"}
    assert named("inference", "hrcplan.inference.exact:ExactBelief")
    assert not named("assistance", "hrcplan.inference.exact:ExactBelief")
    assert named("assistance", "hrcplan.assistance.rhp.assistant:RecedingHorizonPlanner")


def test_an_unknown_method_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there is no method 'hrcplam'") as caught:
        run_study("switch", tmp_path, options={"methods": "hrcplam"})
    assert "hrcplan" in (caught.value.hint or "")


def test_another_seed_is_a_practice_run(tmp_path: Path, small: None) -> None:
    options = {"methods": "recursive"}
    run_study("switch", tmp_path / "r", options=options, seed=5, traces=tmp_path / "traces",
              tables=["assistance"])  # fmt: skip
    assert refusals(tmp_path) == {"other-seed"}
