"""What a notebook or a terminal shows: short texts, pictures without markup of others, tables."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import pytest

import hrcplan
from hrcplan.core.svg import MAX_BARS, LaneBar, gantt, lines

HOSTILE = "<script>alert('&')</script>"


@pytest.fixture(scope="module")
def problem() -> hrcplan.Problem:
    return hrcplan.read("transport/two-boxes")


@pytest.fixture(scope="module")
def inference() -> hrcplan.Inference:
    bank = hrcplan.build_bank("kitchen", only=["oatmeal-apple", "oatmeal-berry"])
    return hrcplan.infer(bank, [("get", "oats"), ("get", "berries"), ("fly", "away")])


def text_of(svg: str) -> str:
    """Return the text of a picture; malformed XML is an error."""
    return " ".join(ET.fromstring(svg).itertext())


def test_problems_and_domains_are_short(problem: hrcplan.Problem) -> None:
    assert repr(problem) == "<Problem transport/two-boxes: 10 objects, 53 facts>"
    assert repr(problem.domain) == "<Domain transport: 4 actions>"
    assert len(repr(replace(problem, name="x" * 500))) <= 200
    assert len(repr(replace(problem.domain, name="x" * 500))) <= 200


def test_reports_are_short(problem: hrcplan.Problem) -> None:
    found = hrcplan.plan(problem)
    report = hrcplan.validate(problem, found.plan)
    assert repr(report) == "<Report: valid, cost 24, metric 58.00051, makespan_s 200.003>"
    assert repr(hrcplan.validate(problem, "")).startswith("<Report: invalid: the goal (box-at")
    assert repr(hrcplan.validate(problem, "(go)")).startswith("<Report: invalid at step 0: there")
    assert len(repr(replace(report, valid=False, reason="x" * 500))) <= 200
    assert len(repr(replace(report, cost=7**500))) <= 200


def test_inferences_are_short(inference: hrcplan.Inference) -> None:
    assert repr(inference).startswith("<Inference by switching: 3 actions, 0 changes, now 9")
    long = replace(inference, goals=tuple(goal * 50 for goal in inference.goals))
    assert len(repr(long)) <= 200


def test_inferences_are_drawn(inference: hrcplan.Inference) -> None:
    assert "oatmeal-berry" in text_of(inference._repr_html_())
    hostile = replace(inference, goals=(HOSTILE, *inference.goals[1:]))
    assert "<script>" not in hostile._repr_html_()
    assert "<script>" in text_of(hostile._repr_html_())


def test_inferences_are_tables(inference: hrcplan.Inference) -> None:
    rows = inference.rows()
    assert len(rows) == 4 * len(inference.goals)
    assert rows[0] == {"observation": 0, "action": None, "goal": "oatmeal-apple",
                       "probability": 0.5, "ignored": False}  # fmt: skip
    assert [row["ignored"] for row in rows[::2]] == [False, False, False, True]
    check_table(rows)


def test_plans_and_results_are_short_tables_and_pictures(problem: hrcplan.Problem) -> None:
    result = hrcplan.plan(problem)
    assert repr(result.plan) == "<Plan: 8 actions, makespan 200.003 s>"
    assert repr(result.plan.actions[0]) == "<PlannedAction (move robot wp0 wp3) at 0 s>"
    assert repr(result).startswith("<Result: solved-optimally by exact: <Plan: 8 actions,")
    assert len(repr(result)) <= 200
    assert result.rows()[0] == {"start_s": 0.0, "duration_s": 50.0, "agent": "robot",
                                "action": "move", "args": "robot wp0 wp3", "cost": 3.0}  # fmt: skip
    check_table(result.rows())
    check_table(result.plan.rows())
    assert "grasp blue wp4, 50.001 to 100.001 s" in text_of(result.plan._repr_html_())
    assert "solved-optimally" in text_of(f"<div>{result._repr_html_()}</div>")


def test_the_agent_of_an_action_need_not_be_its_first_argument() -> None:
    """Every planner's result says who acts; an action without an agent has none."""
    domain = """(define (domain lift) (:requirements :typing) (:types agent box - object)
      (:predicates (on ?b - box) (lit))
      (:action lift :parameters (?b - box ?a - agent) :precondition (lit) :effect (on ?b))
      (:action light :parameters () :precondition (and) :effect (lit)))"""
    problem = """(define (problem one) (:domain lift) (:objects ann - agent red - box)
      (:init) (:goal (on red)))"""
    for planner in ("auto", "fast-downward"):
        result = hrcplan.plan(domain, problem, planner)
        assert [(row["action"], row["agent"]) for row in result.rows()] == [
            ("light", None), ("lift", "ann"),
        ]  # fmt: skip
        assert "ann" in text_of(f"<div>{result._repr_html_()}</div>")
        check_table(result.rows())


def test_a_result_without_a_plan_is_shown_too(problem: hrcplan.Problem) -> None:
    nothing = hrcplan.Result(hrcplan.Status.UNSOLVED, "auto", None, None, 0.1, HOSTILE)
    assert repr(nothing) == "<Result: unsolved by auto: None>"
    assert nothing.rows() == []
    text_of(f"<div>{nothing._repr_html_()}</div>")


def test_sequential_and_empty_plans_are_drawn() -> None:
    plan = hrcplan.Plan((hrcplan.PlannedAction(HOSTILE, ()), hrcplan.PlannedAction("b", ("x",))))
    assert repr(plan) == "<Plan: 2 actions>"
    assert "<script>" not in plan._repr_html_()
    assert "2 steps" in text_of(plan._repr_html_())
    text_of(hrcplan.Plan()._repr_html_())


def test_runs_are_tables_and_pictures(problem: hrcplan.Problem) -> None:
    run = hrcplan.execute(problem, human="uncooperative", seed=3)
    check_table(run.rows())
    assert len(repr(run)) <= 200
    failed = [row for row in run.rows() if row["outcome"] == "failed"]
    assert run._repr_html_().count("stroke-dasharray") == len(failed)
    text_of(f"<div>{run._repr_html_()}</div>")


def check_table(rows: list[dict[str, Any]]) -> None:
    """Hold rows to what a table needs: the same keys in the same order, and plain values."""
    assert rows
    assert all(list(row) == list(rows[0]) for row in rows)
    plain = (str, int, float, bool, type(None))
    assert all(type(value) in plain for row in rows for value in row.values())
    if find_spec("pandas") is not None:
        import pandas as pd

        assert pd.DataFrame(rows).shape == (len(rows), len(rows[0]))


def test_bars_are_drawn_with_their_texts() -> None:
    bars = [LaneBar("robot", HOSTILE, 0, 2, failed=True), LaneBar("human", "move a b", 1, 4)]
    picture = gantt(bars)
    assert "<script>" not in picture
    assert "move a b, 1 to 4 s" in text_of(picture)
    assert "failed" in text_of(picture)


@pytest.mark.parametrize("bars", [[], [LaneBar("", "", 0, 0)], [LaneBar("a", "b", 0, 1)] * 9000])
def test_odd_bars_are_drawn_too(bars: list[LaneBar]) -> None:
    assert gantt(bars).count("<rect") == min(MAX_BARS, len(bars))
    text_of(gantt(bars))


@pytest.mark.parametrize("series", [[], [("a", [])], [("a", [1.0])], [("a", [0.1, 0.9])] * 40])
def test_odd_lines_are_drawn_too(series: list[tuple[str, list[float]]]) -> None:
    assert lines(series, [0.5]).count("<polyline") == len(series)
    text_of(lines(series, [0.5]))
