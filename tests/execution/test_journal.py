"""Nothing is lost: a run that is killed anywhere goes on to the same end, and can be replayed."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.errors import InputError, UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.codec import from_json, to_json
from hrcplan.execution.execute import Execution, carry_out, execute, prepare_run
from hrcplan.execution.journal import RunSetup, read_journal, setup_from_json
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.replay import replay
from hrcplan.execution.worlds.simulated import FactChange, Nature, StateChange
from hrcplan.pddl.inputs import read
from hrcplan.plans import parse_plan

# A change that is sensed, failures, a deviation and several replans.
CHANGES = (
    StateChange(0.0, {("motivation", "human"): 9}),
    FactChange(
        120.0, frozenset({("box-at", "blue", "wp0")}), frozenset({("box-at", "blue", "wp4")})
    ),
)


def eventful(journal: Path, resume: bool = False) -> Execution:
    problem = read("transport", "two-boxes")
    prepared = prepare_run(problem, profile="replan-always", changes=CHANGES, seed=5,
                           provider=shared_planner())  # fmt: skip
    return carry_out(prepared, journal=journal, resume=resume)


@lru_cache
def shared_planner() -> Replanner:
    """Plans are the same every time, so one planner with its memory serves all runs."""
    return Replanner(ExecutionModel(read("transport", "two-boxes")))


def content(path: Path) -> list[dict[str, object]]:
    """Return the lines of a journal, without what the wall clock says."""
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    for line in lines:
        line.get("event", {}).pop("wall_s", None)
    return lines


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Execution]:
    path = tmp_path_factory.mktemp("journal") / "run.jsonl"
    return path, eventful(path)


def test_the_run_has_something_in_it(whole: tuple[Path, Execution]) -> None:
    row = whole[1].outcome
    assert row.success
    assert row.replans_deviation + row.replans_failure + row.replans_change >= 2


def test_a_run_killed_at_any_position_goes_on_to_the_same_end(
    whole: tuple[Path, Execution], tmp_path: Path
) -> None:
    path, done = whole
    lines = path.read_bytes().splitlines(keepends=True)
    for n in range(len(lines) + 1):
        torn = [*lines, b'{"seq'][n][: 40 * (n % 2)]  # half of the time in the middle of a line
        killed = tmp_path / "killed.jsonl"
        killed.write_bytes(b"".join(lines[:n]) + torn)
        again = eventful(killed, resume=True)
        assert (again.outcome, again.run.state) == (done.outcome, done.run.state), n
        assert again.timeline == done.timeline, n
        assert content(killed) == content(path), n


def test_a_killed_process_is_resumed(tmp_path: Path) -> None:
    """The real thing: kill -9 in the middle, then --resume; compared with an undisturbed run."""
    command = [sys.executable, "-m", "hrcplan", "execute", "transport/two-boxes", "--profile",
               "replan-always", "--human", "partly-cooperative", "--seed", "4",
               "--json"]  # fmt: skip
    path = tmp_path / "killed.jsonl"
    arguments = ["--journal", str(path)]
    running = subprocess.Popen([*command[:-1], *arguments, "--speed", "150"],
                               stdout=subprocess.DEVNULL)  # fmt: skip
    until = time.monotonic() + 30
    while time.monotonic() < until and (not path.exists() or path.read_bytes().count(b"\n") < 9):
        time.sleep(0.01)
    os.kill(running.pid, signal.SIGKILL)
    assert running.wait() == -signal.SIGKILL
    assert "row" not in read_journal(path).lines[-1]
    resumed = subprocess.run([*command, *arguments, "--resume"], capture_output=True, check=False)
    whole = subprocess.run(command, capture_output=True, check=False)
    assert json.loads(resumed.stdout) == json.loads(whole.stdout)
    assert replay(read_journal(path)).difference is None


def test_resuming_a_finished_run_changes_nothing(whole: tuple[Path, Execution]) -> None:
    path, done = whole
    before = path.read_bytes()
    assert eventful(path, resume=True).outcome == done.outcome
    assert path.read_bytes() == before


def test_resume_without_a_journal_begins_anew(tmp_path: Path) -> None:
    assert eventful(tmp_path / "new.jsonl", resume=True).n_resumed == 0


def test_a_journal_is_never_overwritten(whole: tuple[Path, Execution]) -> None:
    with pytest.raises(UsageError, match="exists"):
        eventful(whole[0])


def test_a_journal_of_another_problem_is_refused(whole: tuple[Path, Execution]) -> None:
    with pytest.raises(UsageError, match="transport/two-boxes"):
        execute("transport", "handover", journal=whole[0], resume=True)


def test_every_decision_follows(whole: tuple[Path, Execution]) -> None:
    found = replay(read_journal(whole[0]))
    assert found.difference is None
    assert found.row == whole[1].outcome
    assert found.n_events == found.n_decisions


def tampered(path: Path, old: str, new: str, to: Path) -> Path:
    text = path.read_text()
    assert old in text
    to.write_text(text.replace(old, new, 1))
    return to


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"kind":"dispatch","t":0.0,"number":0', '"kind":"dispatch","t":0.0,"number":3'),
        ('"outcome":"done"', '"outcome":"failed"'),
        ('"success":true', '"success":false'),
        ("(move human wp1 wp4)", "(move human wp1 wp5)"),
        ('"kind":"ended"', '"kind":"exploded"'),
    ],
    ids=["decision", "event", "row", "plan", "kind"],
)
def test_what_does_not_follow_is_found(
    whole: tuple[Path, Execution], tmp_path: Path, old: str, new: str
) -> None:
    path = tampered(whole[0], old, new, tmp_path / "tampered.jsonl")
    difference = replay(read_journal(path)).difference
    assert difference is not None
    assert difference.line > 1


def test_a_run_does_not_go_on_from_a_tampered_journal(
    whole: tuple[Path, Execution], tmp_path: Path
) -> None:
    path = tampered(whole[0], '"outcome":"done"', '"outcome":"failed"', tmp_path / "bad.jsonl")
    with pytest.raises(InputError, match="another way"):
        eventful(path, resume=True)


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda lines: [lines[0], b"{nonsense}\n", *lines[1:]], "line 2 .* damaged"),
        (lambda lines: [lines[0], *lines[2:]], "line 2 .* not 1"),
        (lambda lines: [*lines[:3], lines[1], *lines[3:]], "line 4 .* not 3"),
    ],
    ids=["damaged", "missing", "repeated"],
)
def test_damage_inside_is_named(
    whole: tuple[Path, Execution], tmp_path: Path, words: str,
    damage: Callable[[list[bytes]], list[bytes]],
) -> None:  # fmt: skip
    path = tmp_path / "damaged.jsonl"
    path.write_bytes(b"".join(damage(whole[0].read_bytes().splitlines(keepends=True))))
    with pytest.raises(InputError, match=words):
        read_journal(path)


@given(st.integers(1, 10_000), st.integers(0, 10_000), st.sampled_from(list('x"0{[-')))
def test_damage_anywhere_is_found_or_harmless(
    whole: tuple[Path, Execution], line: int, column: int, character: str
) -> None:
    """One character of one line is overwritten: bad input, a difference, or no matter."""
    lines = whole[0].read_text().splitlines()
    line = 1 + line % (len(lines) - 1)
    column %= len(lines[line])
    lines[line] = lines[line][:column] + character + lines[line][column + 1 :]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "damaged.jsonl")
        path.write_text("\n".join(lines) + "\n")
        with suppress(InputError):
            replay(read_journal(path))


def test_not_a_journal(tmp_path: Path) -> None:
    path = tmp_path / "other.jsonl"
    path.write_text('{"seq": 0, "a": 1}\n')
    with pytest.raises(InputError, match="no journal"):
        replay(read_journal(path))
    with pytest.raises(InputError, match="there is no file"):
        read_journal(tmp_path / "missing.jsonl")


def test_settings_survive_the_journal() -> None:
    problem = read("kitchen", "salad-greek")
    nature = Nature("a/1", CHANGES[:1], CHANGES[1:], "after", "attempt", frozenset({"mix"}))
    setup = prepare_run(problem, profile="hrcplan", seed="x").setup
    setup = RunSetup(setup.problem, setup.profile, False, nature, ("kairos",))
    table = json.loads(json.dumps(setup.to_json()))
    found = setup_from_json(table, "test")
    assert found.to_json() == setup.to_json()
    assert (found.profile, found.nature.can_fail) == (setup.profile, nature.can_fail)


def test_events_survive_the_journal() -> None:
    plan = parse_plan("0.001: (move human wp1 wp4) [50.25]")
    for event in (
        ev.Ended(1.5, 3, ev.FAILED),
        ev.Observed(2.0, frozenset({("at", "human", "wp1")}), {("fuel", "truck"): 3}),
        ev.Sensed(25.0, {("motivation", "human"): 9}),
        ev.Planned(0.0, plan, 58, "exact", "", 0.25),
        ev.Planned(0.0, None, note="no plan in time"),
        ev.AskPlan(0.0, frozenset({("free", "human")}), {}, {("a", "b"): 1}, ("failure: x",)),
    ):
        assert from_json(json.loads(json.dumps(to_json(event)))) == event


def test_a_value_that_json_cannot_hold_survives_too() -> None:
    text = json.dumps(to_json(ev.Sensed(0.0, {("motivation", "human"): float("nan")})))
    assert "NaN" not in text
    (value,) = from_json(json.loads(text)).values.values()
    assert value != value


def test_a_journal_of_an_earlier_version_is_replayed_and_resumed(tmp_path: Path) -> None:
    old = Path(__file__).parents[1] / "data" / "journals" / "version-0.1.jsonl"
    found = replay(read_journal(old))
    assert found.difference is None
    row = found.row
    assert min(row.replans_failure, row.replans_deviation) > 0
    begun = tmp_path / "run.jsonl"
    begun.write_bytes(b"".join(old.read_bytes().splitlines(keepends=True)[:12]))
    again = execute("transport", "two-boxes", journal=begun, resume=True)
    assert again.outcome == found.row


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("", {"planners": [["auto"]]}),
        ("", {"planners": [False]}),
        ("", {"nature": {"stretch": []}}),
        ("planned", [1]),
        ("planned", "planned"),
        ("planned", {"kind": "planned", "t": "x"}),
        ("planned", {"kind": "planned", "t": 0, "plan": ["(move  wp4 wp5"]}),
        ("ended", {"kind": "ended", "t": None, "number": 1, "outcome": "done"}),
        ("ended", {"kind": "ended", "t": 10**400, "number": 1, "outcome": "done"}),
        ("ended", {"kind": "ended", "t": float("inf"), "number": 1, "outcome": "done"}),
    ],
)
def test_a_line_that_holds_something_else_is_an_input_error(
    whole: tuple[Path, Execution], tmp_path: Path, kind: str, change: object
) -> None:
    lines = [json.loads(line) for line in whole[0].read_bytes().splitlines()]
    if kind:
        line = next(line for line in lines if line.get("event", {}).get("kind") == kind)
        line["event"] = change
    else:
        assert isinstance(change, dict)
        change = {k: {**lines[0][k], **v} if isinstance(v, dict) else v for k, v in change.items()}
        lines[0] |= change
    path = tmp_path / "damaged.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    with pytest.raises(InputError, match="journal"):
        eventful(path, resume=True)


def test_a_table_in_place_of_a_value_is_no_event():
    with pytest.raises(ValueError, match="a table stands for a value"):
        from_json({"kind": "ended", "t": 0.0, "number": 1, "outcome": {"done": {}}})


def test_values_that_no_file_can_hold_are_in_the_journal(tmp_path: Path) -> None:
    third = {("motivation", "human"): Fraction(1, 3)}
    problem = read("transport", "two-boxes").with_values(third)
    path = tmp_path / "run.jsonl"
    done = execute(problem, journal=path)
    assert replay(read_journal(path)).difference is None
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[: len(lines) // 2]))
    assert execute(problem, journal=path, resume=True).outcome == done.outcome
