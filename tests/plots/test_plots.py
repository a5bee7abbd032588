"""Plots: legible at any size, and without any trace in the caller's matplotlib."""

from __future__ import annotations

import io
import re
import subprocess
import sys
from dataclasses import replace

import matplotlib as mpl
import pytest
from PIL import Image

import hrcplan
from hrcplan.inference.changes import GoalChange
from hrcplan.inference.run import Ignored, Inference
from hrcplan.pddl.model import Problem
from hrcplan.plans import Plan, PlannedAction
from hrcplan.plots import gantt, lanes, posterior, style

FORMS = ["png", "svg"]
INFERENCE = Inference(
    ("a", "b"), ("(x)",), ((0.5, 0.5), (0.9, 0.1)), (GoalChange(0, 0.9),),
    (Ignored(0, "(x)", "no step"),), "exact",
)  # fmt: skip


@pytest.fixture(scope="module")
def problem() -> Problem:
    text = """(define (domain workshop) (:requirements :typing :durative-actions)
      (:types agent thing)
      (:predicates (controllable ?a - agent) (done ?x - thing) (free ?a - agent))
      (:durative-action assemble-with-care :parameters (?a - agent ?x - thing)
        :duration (= ?duration 30) :condition (and) :effect (at end (done ?x)))
      (:durative-action hand-over :parameters (?a ?b - agent ?x - thing) :duration (= ?duration 2)
        :condition (and) :effect (and (at start (not (free ?b))) (at end (done ?x)))))"""
    task = """(define (problem many-steps) (:domain workshop)
      (:objects anna carl robot - agent left-front-wheel gearbox - thing)
      (:init (controllable robot)) (:goal (and (done gearbox))))"""
    return hrcplan.read(text, task)


def plan_of(n: int, agents: tuple[str, ...] = ("anna", "robot")) -> Plan:
    """Return a plan of n actions, long and very short ones by turns."""
    clock, actions = dict.fromkeys(agents, 0), []
    for i in range(n):
        agent = agents[i % len(agents)]
        name, length = [("assemble-with-care", 30), ("hand-over", 2)][i // len(agents) % 2]
        args = (agent, "gearbox") if length == 30 else (agent, "carl", "left-front-wheel")
        actions.append(PlannedAction(name, args, start_s=clock[agent], duration_s=length))
        clock[agent] += length
    return Plan(tuple(actions))


def texts(svg: bytes) -> str:
    """Return the words of an SVG file, whose letters matplotlib keeps as comments."""
    return "\n".join(re.findall(r"<!-- (.*?) -->", svg.decode(), re.DOTALL))


@pytest.mark.parametrize("form", FORMS)
def test_settings_and_backend_of_the_caller_stay(problem: Problem, form: str) -> None:
    before, backend = dict(mpl.rcParams), mpl.rcParams._get("backend")  # reading it would set it
    gantt.draw(problem, plan_of(5), form)
    posterior.draw(INFERENCE, form)
    assert dict(mpl.rcParams) == before
    assert mpl.rcParams._get("backend") == backend


def test_no_module_of_the_package_chooses_a_backend() -> None:
    code = (
        "import matplotlib; before = dict.copy(matplotlib.rcParams)\n"
        "import hrcplan.plots.gantt, hrcplan.plots.posterior\n"
        "import hrcplan.studies.changed_mind.figures\n"
        "assert dict.copy(matplotlib.rcParams) == before"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("n", [1, 8, 29, 120])
def test_a_gantt_chart_is_at_most_2400_pixels_wide(problem: Problem, n: int) -> None:
    image = Image.open(io.BytesIO(gantt.draw(problem, plan_of(n), "png")))
    assert 600 <= image.width <= 2400
    assert image.height < 2000


def test_idle_agents_makespan_and_units_are_shown(problem: Problem) -> None:
    words = texts(gantt.draw(problem, plan_of(2), "svg"))
    assert {"anna", "carl", "robot", "time (s)"} <= set(words.splitlines())
    assert "workshop/many-steps, makespan 30 s" in words


def test_what_does_not_fit_is_numbered_and_explained(problem: Problem) -> None:
    words = texts(gantt.draw(problem, plan_of(29), "svg")).splitlines()
    assert "1  hand-over carl left-front-wheel" in words
    assert "1" in words
    assert not any(line.startswith("2  ") for line in words), "equal texts have one number"


def test_no_label_is_longer_than_its_bar(problem: Problem) -> None:
    for length in range(1, 400, 7):
        bar = lanes.GanttBar(0, 0.0, 1.0, "assemble-with-care", "gearbox left-front-wheel")
        layout = lanes.fitting(bar, float(length), 40.0)
        if layout is not None:
            text, is_rotated = layout
            along = max(map(lanes.width_pt, text.split("\n")))
            assert along <= (40.0 if is_rotated else length)
    assert lanes.fitting(bar, 400.0, 40.0) == (
        "assemble-with-care\ngearbox left-front-wheel",
        False,
    )


@pytest.mark.parametrize("form", FORMS)
def test_equal_plots_are_equal_bytes(problem: Problem, form: str) -> None:
    assert gantt.draw(problem, plan_of(9), form) == gantt.draw(problem, plan_of(9), form)
    assert posterior.draw(INFERENCE, form) == posterior.draw(INFERENCE, form)


def test_colors_of_a_plot_differ() -> None:
    for colors in (style.LINES, style.FILLS):
        assert len(set(colors)) == len(colors) == 8


def test_dollars_in_names_are_no_formulas() -> None:
    names = ("$a^", "b$$")
    picture = posterior.draw(replace(INFERENCE, goals=names), "svg")
    assert all(name.encode() in picture for name in names)
