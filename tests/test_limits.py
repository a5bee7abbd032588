"""What would never end, ends: grounding, quantifiers, files; and names beside folders."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from hrcplan.errors import InputError, LimitError, UsageError
from hrcplan.pddl.inputs import read
from hrcplan.pddl.source import read_source
from hrcplan.planners import registry
from hrcplan.planners.contract import Request, Status
from hrcplan.planners.solve import solve
from hrcplan.task import Task

# Every action of six parameters over thirty objects: 7e8 ground actions.
WIDE = """
(define (domain wide) (:requirements :strips)
  (:predicates (p ?a ?b ?c ?d ?e ?f) (q))
  (:action a :parameters (?a ?b ?c ?d ?e ?f) :precondition () :effect (p ?a ?b ?c ?d ?e ?f))
  (:action b :parameters () :precondition {condition} :effect (q)))
"""


def write(folder: Path, condition: str) -> tuple[str, str]:
    objects = " ".join(f"o{i}" for i in range(30))
    (folder / "d.pddl").write_text(WIDE.format(condition=condition))
    (folder / "p.pddl").write_text(
        f"(define (problem p) (:domain wide) (:objects {objects}) (:init) (:goal (q)))"
    )
    return str(folder / "d.pddl"), str(folder / "p.pddl")


def test_grounding_ends_at_the_deadline(tmp_path: Path) -> None:
    problem = read(*write(tmp_path, "()"))
    with pytest.raises(LimitError, match="no time for more than"):
        Task(problem, time.monotonic())
    request = Request(problem, time.monotonic())
    for _ in range(2):  # what failed once is not tried again
        with pytest.raises(LimitError):
            _ = request.task
    begun = time.process_time()
    with pytest.raises(LimitError):
        _ = request.until(time.monotonic() + 60).task
    assert time.process_time() - begun < 5


def test_a_quantifier_over_everything_is_refused(tmp_path: Path) -> None:
    condition = "(forall (?a ?b ?c ?d ?e) (not (p ?a ?b ?c ?d ?e ?e)))"
    paths = write(tmp_path, condition)
    text = (
        Path(paths[0])
        .read_text()
        .replace("(p ?a ?b ?c ?d ?e ?f))\n  (:action b", "(q))\n  (:action b")
    )
    Path(paths[0]).write_text(text.replace(":parameters (?a ?b ?c ?d ?e ?f)", ":parameters ()"))
    problem = read(*paths)
    with pytest.raises(LimitError, match="over 1,000,000 instances"):
        Task(problem, time.monotonic() + 5)


def test_a_file_without_end_is_too_large() -> None:
    with pytest.raises(InputError, match="more than 64 MiB"):
        read_source("/dev/zero")


def test_a_folder_does_not_hide_a_shipped_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "transport").mkdir()
    (tmp_path / "two-boxes").mkdir()
    monkeypatch.chdir(tmp_path)
    assert read("transport", "two-boxes").name == "two-boxes"


def test_a_class_that_is_no_planner() -> None:
    with pytest.raises(UsageError, match="is no planner"):
        registry.make("hrcplan.plans:Plan")


def test_a_task_without_facts_or_actions_is_solved_by_doing_nothing(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").write_text(
        "(define (domain d) (:requirements :strips :typing) (:types agent) (:predicates (q))"
        "(:action b :parameters (?a - agent) :precondition () :effect (q)))"
    )
    (tmp_path / "p.pddl").write_text("(define (problem p) (:domain d) (:init) (:goal (and)))")
    problem = read(str(tmp_path / "d.pddl"), str(tmp_path / "p.pddl"))
    found = solve(problem, "fast-downward")
    assert found.status is Status.OPTIMAL
    assert found.plan is not None
    assert found.plan.actions == ()
