"""Any program as a planner: real ones, bad ones, and what planners print."""

import shutil
import sys
import time
from pathlib import Path

import pytest

from hrcplan.errors import MissingPlannerError, PlannerError, UsageError
from hrcplan.pddl.generate import with_goal
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.planners.command import CommandPlanner, best_of
from hrcplan.planners.contract import Answer, Request, Status
from hrcplan.planners.enhsp import _JAR, _inside, find_java
from hrcplan.plans import find_plans
from hrcplan.validation import validate

KAIROS = str(Path(sys.executable).with_name("kairos"))
GOOD = """0.0: (move human wp1 wp4) [50]
0.0: (move robot wp0 wp3) [50]
50.001: (grasp human blue wp4) [50]
50.001: (grasp robot green wp3) [50]
100.002: (move robot wp3 wp2) [50]
100.002: (move human wp4 wp5) [50]
150.003: (place robot green wp2) [50]
150.003: (place human blue wp5) [50]
"""
SLOW = GOOD.replace("150.003: (place human", "950.003: (place human")
WRONG = GOOD.replace("wp5) [50]\n150", "wp1) [50]\n150")


@pytest.fixture
def boxes() -> Problem:
    return read("transport", "two-boxes")


def solve(command: str, problem: Problem, seconds: float = 20) -> Answer:
    return CommandPlanner(command).solve(Request(problem, time.monotonic() + seconds))


def printing(folder: Path, text: str, after: str = "") -> str:
    """Return a command line of a program that prints ``text`` and then runs some Python."""
    script = folder / "planner.py"
    script.write_text(f"import os, sys, time\nprint({text!r}, flush=True)\n{after}\n")
    return f"{sys.executable} {script} {{domain}} {{problem}}"


def metric(problem: Problem, answer: Answer) -> float:
    assert answer.plan is not None
    report = validate(problem, answer.plan)
    assert report.valid, report.reason
    assert report.metric is not None
    return float(report.metric)


@pytest.mark.parametrize("layout", ["ipc", "popf"])
def test_kairos_on_the_command_line(layout: str, boxes: Problem) -> None:
    command = f"{KAIROS} {{domain}} {{problem}} --format {layout} --timeout {{timeout}}"
    answer = solve(command, boxes)
    assert answer.status is Status.SOLVED
    assert metric(boxes, answer) == pytest.approx(58.0, abs=0.01)


def test_enhsp_on_the_command_line_with_a_plan_file() -> None:
    problem = read("kitchen", "parfait-nut")
    jar = _inside("up_enhsp", _JAR)
    command = f"{find_java()} -jar {jar} -o {{domain}} -f {{problem}} -sp {{plan}} -s gbfs -h hadd"
    answer = solve(command, problem)
    assert answer.plan is not None
    assert not answer.plan.is_schedule
    assert metric(problem, answer) >= 50


def test_the_best_valid_plan_counts(boxes: Problem, tmp_path: Path) -> None:
    text = f"; first\n{SLOW}\n;;;; better\n{GOOD}\n; broken\n{WRONG}"
    answer = solve(printing(tmp_path, text), boxes)
    assert metric(boxes, answer) == pytest.approx(58.0, abs=0.01)


def test_a_timeout_returns_the_best_so_far(boxes: Problem, tmp_path: Path) -> None:
    begun = time.monotonic()
    answer = solve(printing(tmp_path, SLOW, "time.sleep(60)"), boxes, 1)
    assert time.monotonic() - begun < 5
    assert metric(boxes, answer) > 58.01


def test_without_a_plan_the_limit_is_named(boxes: Problem, tmp_path: Path) -> None:
    answer = solve(printing(tmp_path, "thinking", "time.sleep(60)"), boxes, 0.5)
    assert (answer.status, answer.note) == (Status.UNSOLVED, "stopped: timeout")


def test_a_plan_file_counts_too(boxes: Problem, tmp_path: Path) -> None:
    code = f"open(sys.argv[3] + '.2', 'w').write({GOOD!r})"
    answer = solve(printing(tmp_path, "", code) + " {plan}", boxes)
    assert metric(boxes, answer) == pytest.approx(58.0, abs=0.01)


def test_an_invalid_plan_is_handed_on_to_be_refused(boxes: Problem, tmp_path: Path) -> None:
    answer = solve(printing(tmp_path, WRONG), boxes)
    assert answer.plan is not None
    assert not validate(boxes, answer.plan).valid


@pytest.mark.parametrize("code", ["sys.exit(1)", "sys.exit(139)", "os.kill(os.getpid(), 11)",
                                  "raise OSError"])  # fmt: skip
def test_a_crash_is_an_error(code: str, boxes: Problem, tmp_path: Path) -> None:
    with pytest.raises(PlannerError, match="exit code"):
        solve(printing(tmp_path, "hello", code), boxes)


def test_another_exit_code_is_no_crash(boxes: Problem, tmp_path: Path) -> None:
    answer = solve(printing(tmp_path, "no plan exists", "sys.exit(10)"), boxes)
    assert answer.status is Status.UNSOLVED
    assert "exit code 10" in answer.note
    assert "no plan exists" in answer.note


def test_a_goal_that_holds_already_needs_no_lines(tmp_path: Path) -> None:
    problem = with_goal(read("transport", "two-boxes"), "(free human)", "idle")
    answer = solve(printing(tmp_path, "nothing to do"), problem)
    assert answer.plan is not None
    assert answer.plan.actions == ()


def test_ff_says_that_the_goal_is_true_already(tmp_path: Path) -> None:
    problem = with_goal(read("transport", "two-boxes"), "(free human)", "idle")
    words = "ff: goal can be simplified to TRUE. The empty plan solves it"
    answer = solve(printing(tmp_path, words, "sys.exit(1)"), problem)
    assert answer.status is Status.SOLVED
    assert answer.plan is not None
    assert not answer.plan.actions
    with pytest.raises(PlannerError, match="exit code 1"):  # what it says is not true here
        solve(printing(tmp_path, words, "sys.exit(1)"), read("transport", "two-boxes"))


def test_a_program_that_is_not_there(boxes: Problem) -> None:
    planner = CommandPlanner("no-such-planner {domain} {problem}")
    assert "no-such-planner" in (planner.missing() or "")
    with pytest.raises(MissingPlannerError):
        planner.solve(Request(boxes))


@pytest.mark.parametrize("command", ["popf", "popf {domain}", "popf '{domain} {problem}"])
def test_a_command_without_files_is_refused(command: str) -> None:
    with pytest.raises(UsageError):
        CommandPlanner(command)


def test_files_of_the_callers_folder_are_found(
    boxes: Problem, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    printing(tmp_path, GOOD)
    monkeypatch.chdir(tmp_path)
    answer = solve(f"{shutil.which(sys.executable)} planner.py {{domain}} {{problem}}", boxes)
    assert metric(boxes, answer) == pytest.approx(58.0, abs=0.01)


@pytest.mark.parametrize(
    "line",
    [
        "0.0003:   (MOVE HUMAN WP1 WP4) [D:50.00; C:0.10]",
        "0.0003: (MOVE HUMAN WP1 WP4) [50.0000])",
        "  0.000: ( move human wp1 wp4 )  [50.000] ; note",
    ],
)
def test_ways_to_print_an_action(line: str, boxes: Problem) -> None:
    [plan] = find_plans(f"; Time 0.1\n(states 12)\n{line}\nPlan found.", boxes)
    [action] = plan.actions
    assert (str(action), action.duration_s) == ("(move human wp1 wp4)", 50)


def test_of_no_valid_plans_the_last(boxes: Problem) -> None:
    plans = list(find_plans(f"{WRONG}\n{WRONG.replace('wp1)', 'wp2)')}", boxes))
    assert len(plans) == 2
    assert best_of(boxes, plans) == plans[1]


@pytest.mark.parametrize(
    "trick", ["mkdir plan", "mkfifo plan", "truncate -s 100G plan", "ln -s /dev/zero plan"]
)
def test_a_plan_that_is_no_ordinary_file_is_left_out(trick: str, boxes: Problem) -> None:
    with pytest.raises(PlannerError) as error:
        solve(f"sh -c '{trick}' {{domain}} {{problem}} {{plan}}", boxes)
    assert error.value.code == "plan-not-read"
