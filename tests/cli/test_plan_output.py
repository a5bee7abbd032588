"""What ``plan`` and ``validate`` print: all actions, the sense of the metric, places of faults."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import pytest

from hrcplan.cli import output
from hrcplan.cli.lanes import as_json, as_text
from hrcplan.cli.main import main
from hrcplan.cli.plan import Improvements
from hrcplan.planners.contract import Answer, Capabilities, Status
from hrcplan.planners.result import check_answer
from hrcplan.plans import parse_plan
from tests.worlds import problem_from

JOBS = """(define (domain jobs) (:requirements :strips :numeric-fluents)
  (:predicates (done ?j)) (:functions (gain))
  (:action do :parameters (?j) :precondition ()
    :effect (and (done ?j) (increase (gain) 2))))"""
TWO = """(define (problem p) (:domain jobs) (:objects a b) (:init (= (gain) 0))
  (:goal (and (done a) (done b))) (:metric maximize (gain)))"""


@pytest.mark.parametrize("text", ["(do a)(do b)", "0: (do a)\n0: (do b)\n0: (do a)"])
def test_every_action_is_in_the_table(text: str) -> None:
    problem = problem_from(JOBS, TWO)
    answer = Answer(Status.SOLVED, parse_plan(text))
    found = check_answer(Capabilities("by hand", ""), problem, answer, False, "")
    assert as_text(problem, found).count("do ") == text.count("do ")


def test_the_sense_of_the_metric_is_its_own() -> None:
    problem = problem_from(JOBS, TWO)
    answer = Answer(Status.SOLVED, parse_plan("(do a) (do b)"), bound=8)
    found = check_answer(Capabilities("by hand", ""), problem, answer, False, "")
    document = as_json(problem, found)
    assert (document["sense"], document["bound"], document["gap"]) == ("maximize", 8, 0.5)
    text = as_text(problem, found)
    assert "maximize (gain)" in text
    assert "at most 50 % below the optimum" in text


def test_a_large_gap_is_a_whole_number() -> None:
    problem = problem_from(JOBS, TWO.replace("maximize", "minimize"))
    answer = Answer(Status.SOLVED, parse_plan("(do a) (do b)"), bound=Fraction(1, 3))
    found = check_answer(Capabilities("by hand", ""), problem, answer, False, "")
    assert "at most 1,100 % above the optimum" in as_text(problem, found)


def test_better_plans_are_told_once_a_second(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = problem_from(JOBS, TWO)
    answer = Answer(Status.SOLVED, parse_plan("(do a) (do b)"))
    found = check_answer(Capabilities("by hand", ""), problem, answer, False, "")
    now = iter([0.0, 0.5, 1.2, 1.3, 1.9, 2.5])
    monkeypatch.setattr("hrcplan.cli.plan.time", SimpleNamespace(monotonic=lambda: next(now)))
    tell = Improvements()
    for _ in range(5):
        tell(found)
    assert capsys.readouterr().err.splitlines() == [
        "after 1 s: 4 (by hand)",
        "after 2 s: 4 (by hand)",
    ]


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    for name, text in (("d.pddl", JOBS), ("p.pddl", TWO), ("plan", "(do a)\n  do b\n")):
        (tmp_path / name).write_text(text)
    return [str(tmp_path / name) for name in ("d.pddl", "p.pddl", "plan")]


def run(*words: str) -> object:
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    output.JSON = False
    return ended.value.code


def test_a_fault_of_a_plan_has_its_place(
    files: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("validate", *files) == 3
    assert f"{files[2]}:2:3: 'do b' is not an action" in capsys.readouterr().err
    assert run("validate", *files, "--json") == 3
    error = json.loads(capsys.readouterr().out)["error"]
    assert (error["line"], error["column"]) == (2, 3)


@pytest.mark.parametrize("epsilon", ["0", "-1", "nan", "x"])
def test_epsilon_is_above_zero(epsilon: str, files: list[str]) -> None:
    assert run("validate", *files, "--epsilon", epsilon) == 2
