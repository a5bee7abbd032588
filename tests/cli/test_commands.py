"""Commands as a user calls them: exit codes, stdout and stderr, JSON keys, files."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from hrcplan.cli import main
from hrcplan.testing import check_plan

TWO_BOXES = """\
0.000: (move human wp1 wp4) [50.000]
0.000: (move robot wp0 wp3) [50.000]
50.001: (grasp human blue wp4) [50.000]
50.001: (grasp robot green wp3) [50.000]
100.002: (move human wp4 wp5) [50.000]
100.002: (move robot wp3 wp2) [50.000]
150.003: (place human blue wp5) [50.000]
150.003: (place robot green wp2) [50.000]
"""
PLAN_KEYS = {"status", "planner", "cost", "makespan_s", "metric", "valid", "steps", "wall_s"}


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def document(*words: str, code: int = 0) -> dict[str, Any]:
    """Return the one JSON document that a command prints, and hold it to its exit code."""
    found = run(*words, "--json")
    assert found.exit_code == code, found.output
    value: dict[str, Any] = json.loads(found.stdout)
    return value


# plan


def test_plan_prints_lanes_cost_and_whether_it_is_proven() -> None:
    found = run("plan", "transport/two-boxes")
    assert found.exit_code == 0
    first, *rest = found.stdout.splitlines()
    assert first.startswith("transport/two-boxes: proven optimal (exact, ")
    body = "\n".join(rest)
    assert "move wp1 wp4" in body
    assert "metric    58.00051" in body
    assert "makespan  200.003 s" in body
    assert "valid     yes" in body
    # A slow machine also sees who is at work, after five seconds.
    assert not [line for line in found.stderr.splitlines() if "at work" not in line]


def test_plan_json_has_the_promised_keys() -> None:
    value = document("plan", "transport", "two-boxes")
    assert value.keys() >= PLAN_KEYS
    assert value["status"] == "solved-optimally"
    assert value["valid"] is True
    assert (value["cost"], value["makespan_s"]) == (24, 200.003)
    step = value["steps"][0]
    assert step.keys() == {"start_s", "duration_s", "agent", "action", "args", "cost"}
    assert step["agent"] == step["args"][0]


def test_set_moves_all_work_to_the_robot() -> None:
    value = document("plan", "transport/two-boxes", "--set", "motivation human=10")
    assert {step["agent"] for step in value["steps"]} == {"robot"}
    assert value["cost"] == 24


def test_classical_plans_have_no_times_unless_lanes_are_asked_for() -> None:
    plain = document("plan", "kitchen/parfait-fruit")
    assert plain["makespan_s"] is None
    assert plain["steps"][0]["start_s"] is None
    laid = document("plan", "kitchen/parfait-fruit", "--lanes")
    assert laid["cost"] == plain["cost"]
    assert {step["duration_s"] for step in laid["steps"]} == {1}
    assert {step["agent"] for step in laid["steps"]} == {"human", "robot"}
    assert laid["makespan_s"] < len(laid["steps"])


def test_output_is_a_plan_that_validates(tmp_path: Path) -> None:
    target = tmp_path / "out.plan"
    assert run("plan", "transport/handover", "-o", str(target)).exit_code == 0
    check_plan("transport", "handover", str(target))
    assert document("validate", "transport/handover", str(target))["valid"] is True


@pytest.mark.parametrize(("suffix", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml")])
def test_gantt_writes_a_picture(tmp_path: Path, suffix: str, magic: bytes) -> None:
    target = tmp_path / f"plan.{suffix}"
    assert run("plan", "transport/two-boxes", "--gantt", str(target)).exit_code == 0
    assert target.read_bytes().startswith(magic)


def test_a_gantt_chart_is_the_same_bytes_every_time(tmp_path: Path) -> None:
    for name in ("a.svg", "b.svg"):
        assert run("plan", "transport/two-boxes", "--gantt", str(tmp_path / name)).exit_code == 0
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_an_unsolvable_task_is_answered_no(tmp_path: Path) -> None:
    problem = tmp_path / "p.pddl"
    args = ["new-problem", "transport", "--from", "handover", "--name", "p", "-o", str(problem)]
    assert run(*args, "--goal", "(at human wp5)").exit_code == 0
    value = document("plan", "transport", str(problem), code=1)
    assert value["status"] == "unsolvable"
    assert value["steps"] == []


def test_what_is_beyond_the_limits_is_unsolved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hrcplan.planners.exact.search.MAX_NODES", 50)
    value = document("plan", "transport/boxes-6", "--planner", "exact", code=4)
    assert value["status"] == "unsolved"
    assert value["bound"] > 100


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["plan", "transport"], 2, "a domain and a problem are needed"),
        (["plan", "transport/two-boxs"], 3, "did you mean 'two-boxes'?"),
        (["plan", "transpot/two-boxes"], 3, "did you mean 'transport'?"),
        (["plan", "transport/two-boxes", "--planner", "exat"], 2, "did you mean 'exact'?"),
        (["plan", "transport/two-boxes", "--set", "motivatio human=1"], 2, "did you mean"),
        (["plan", "transport/two-boxes", "--set", "motivation humam=1"], 2, "mean 'human'?"),
        (["plan", "transport/two-boxes", "--set", "motivation=1"], 2, "takes 1 objects, not 0"),
        (["plan", "transport/two-boxes", "--set", "motivation human=nan"], 2, "is not FUNCTION"),
        (["plan", "transport/two-boxes", "--gantt", "x.gif"], 2, ".png or .svg"),
        (["plan", "transport/two-boxes", "-o", "/nowhere/at/all"], 2, "cannot write"),
        (["plan", "transport/two-boxes", "--timeout", "0"], 2, "--timeout"),
        (["plan", "kitchen/parfait-fruit", "--planner", "up:nonsense"], 5, "nonsense"),
        (["plan", "kitchen/parfait-fruit", "--planner", "cmd:no-such-program {domain} {problem}"],
         5, "no-such-program"),
        (["validate", "transport/two-boxes", "missing.plan"], 3, "there is no file missing.plan"),
        (["check", "missing.pddl"], 3, "there is no file missing.pddl"),
        (["nonsense"], 2, "nonsense"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else None,
)  # fmt: skip
def test_wrong_use_says_why(words: list[str], code: int, says: str) -> None:
    found = run(*words)
    assert found.exit_code == code, found.output
    assert says in found.output.replace("\n", " ")
    assert "Traceback" not in found.output


def test_an_error_is_one_json_document() -> None:
    value = document("plan", "transport/two-boxs", code=3)
    assert value["error"].keys() == {"code", "message", "path", "line", "hint"}


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    found = run("plan", str(tmp_path), "two-boxes")
    assert found.exit_code == 3
    assert "is a folder" in found.stderr


def test_a_failing_call_writes_nothing(tmp_path: Path) -> None:
    target = tmp_path / "out.plan"
    run(
        "plan",
        "transport/two-boxes",
        "--planner",
        "cmd:false {domain} {problem}",
        "-o",
        str(target),
    )
    assert list(tmp_path.iterdir()) == []


# validate


@pytest.fixture
def plan_file(tmp_path: Path) -> Path:
    path = tmp_path / "two.plan"
    path.write_text(TWO_BOXES)
    return path


def test_validate_says_yes_with_figures(plan_file: Path) -> None:
    assert document("validate", "transport", "two-boxes", str(plan_file)) == {
        "valid": True, "cost": 24, "makespan_s": 200.003, "metric": 58.00051,
        "failed_step": None, "reason": None,
    }  # fmt: skip


def test_validate_names_the_first_wrong_step(plan_file: Path) -> None:
    plan_file.write_text(TWO_BOXES.replace("50.001: (grasp human", "49.000: (grasp human"))
    value = document("validate", "transport/two-boxes", str(plan_file), code=1)
    assert value["failed_step"] == 2
    assert value["reason"].startswith("(grasp human blue wp4) needs (idle human)")
    found = run("validate", "transport/two-boxes", str(plan_file))
    assert "step 3: (grasp human blue wp4) needs (idle human)" in found.stdout
    assert "state there: (box-at blue wp4) (box-at green wp3) (free human)" in found.stdout


def test_validate_names_an_unknown_action(plan_file: Path) -> None:
    plan_file.write_text("(fly human wp1)")
    found = run("validate", "transport/two-boxes", str(plan_file))
    assert found.exit_code == 1
    assert "step 1: there is no action 'fly'" in found.stdout


def test_a_text_that_is_no_plan(plan_file: Path) -> None:
    plan_file.write_text("(move human wp1 wp4)\nhello\n")
    found = run("validate", "transport/two-boxes", str(plan_file))
    assert found.exit_code == 3
    assert "two.plan:2:1: 'hello' is not an action of a plan" in found.stderr


# check, new-problem, planners, doctor


def test_check_passes_everything_that_ships() -> None:
    from hrcplan.pddl import library

    files = [str(path) for path in sorted(library.root().glob("*/**/*.pddl"))
             if path.parts[-2] in ("domains", "transport", "kitchen")]  # fmt: skip
    value = document("check", *files)
    assert value == {"files": len(files), "diagnostics": []}


def test_new_problem_is_checked_before_it_is_written(tmp_path: Path) -> None:
    target = tmp_path / "new.pddl"
    words = ["new-problem", "transport", "--from", "two-boxes", "--name", "new", "-o", str(target)]
    found = run(*words, "--goal", "(and (box-at green wp9) (box-at blu wp2))")
    assert found.exit_code == 3
    assert "<goal>:1:20: error[unknown-object]" in found.stderr
    assert "did you mean 'blue'?" in found.stderr
    assert not target.exists()
    words += ["--goal", "(box-at green wp5)", "--set", "motivation human=4"]
    assert run(*words).exit_code == 0
    assert "(= (motivation human) 4)" in target.read_text()
    assert document("plan", "transport", str(target))["status"] == "solved-optimally"


def test_planners_and_doctor_know_all_planners() -> None:
    cards = document("planners")["planners"]
    assert {card["name"] for card in cards} >= {"exact", "fast-downward", "kairos", "enhsp"}
    health = document("doctor")
    assert all(state["present"] for state in health["planners"].values()), health


def test_doctor_clears_what_hrcplan_keeps_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path))
    (tmp_path / "banks").mkdir()
    ours = [tmp_path / "banks" / "a.bank", tmp_path / "b.forest"]
    other = tmp_path / "notes.txt"
    for path in (*ours, other):
        path.write_text("x")
    assert document("doctor", "--clear-cache")["cache"]["bytes"] == 1
    assert other.exists()
    assert not any(path.exists() for path in ours)


# study


def test_a_study_says_in_which_episode_somebodys_own_robot_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "failing.py").write_text(
        "from hrcplan.assistance.oracle import Oracle\n"
        "class Breaks(Oracle):\n"
        "    def choose(self, state):\n"
        "        raise RuntimeError('broken')\n"
        "class Wrong(Oracle):\n"
        "    def choose(self, state):\n"
        "        return -1\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    workshop = Path(__file__).parents[1] / "studies" / "workshop"
    task = ("--domain", str(workshop / "domain.pddl"), "--goals", str(workshop))
    for name, code, message in (("Breaks", 5, "broken"), ("Wrong", 2, "-1 is no step")):
        words = ("study", "run", "changed-mind", *task, "--runs", "1", "--jobs", "1",
                 "--method", "oracle", "--method", f"failing:{name}",
                 "-o", str(tmp_path / "out"))  # fmt: skip
        error = document(*words, code=code)["error"]["message"]
        assert f"{message} (in rows, cell ('fixed', 'failing:{name}'), run 0)" in error
        shutil.rmtree(tmp_path / "out")
