"""How costs grow with the task: a family of delivery tasks, and plans of growing length."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from math import log

import numpy as np
from rows import Row, milliseconds, worked

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TRUE, Problem
from hrcplan.plans import Plan, PlannedAction
from hrcplan.task import Task
from hrcplan.task.batch import BatchSimulator
from hrcplan.validation import validate

MOST_GROUND_S, N_STEPS, N_WALKS, N_BATCH_STEPS = 30, 200, 256, 5
SIZES = [(5, 4, 20), (10, 5, 60), (15, 7, 150), (15, 7, 330)]  # cities, places in each, packages
LENGTHS = [100, 400, 1600]
DOMAIN = """
(define (domain delivery) (:requirements :strips :typing)
  (:types thing place city - object package vehicle - thing truck plane - vehicle airport - place)
  (:predicates (inside ?p - place ?c - city) (at ?t - thing ?p - place)
    (in ?k - package ?v - vehicle))
  (:action drive :parameters (?t - truck ?from ?to - place ?c - city)
    :precondition (and (at ?t ?from) (inside ?from ?c) (inside ?to ?c))
    :effect (and (not (at ?t ?from)) (at ?t ?to)))
  (:action fly :parameters (?p - plane ?from ?to - airport) :precondition (at ?p ?from)
    :effect (and (not (at ?p ?from)) (at ?p ?to)))
  (:action load :parameters (?v - vehicle ?k - package ?p - place)
    :precondition (and (at ?v ?p) (at ?k ?p)) :effect (and (not (at ?k ?p)) (in ?k ?v)))
  (:action unload :parameters (?v - vehicle ?k - package ?p - place)
    :precondition (and (at ?v ?p) (in ?k ?v)) :effect (and (at ?k ?p) (not (in ?k ?v)))))
"""


def rows() -> Iterator[Row]:
    """Yield times by size, with the exponent of the growth since the size before."""
    yield from _tasks()
    yield from _plans()


def _tasks() -> Iterator[Row]:
    """Grounding, walks, many walks at once, and validation, on tasks of growing size."""
    before: dict[str, tuple[int, float]] = {}
    for problem in _deliveries():
        tasks: list[Task] = []
        ground = worked(partial(_ground, problem, tasks))
        task = tasks[0]
        n = len(task.actions)
        over = problem.name == "largest" and ground > MOST_GROUND_S
        for what, seconds, unit_s in (("grounded", ground, 1.0), *_steps(task)):
            yield Row(
                f"delivery, {n:,} ground actions, {len(task.facts):,} facts: {what}",
                milliseconds(seconds) if unit_s == 1 else f"{seconds / unit_s:,.1f} µs",
                _exponent(before.get(what), n, seconds).removeprefix(", "),
                f"<= {MOST_GROUND_S} s" if problem.name == "largest" and seconds is ground else "",
                over and seconds is ground,
            )
            before[what] = n, seconds


def _steps(task: Task) -> Iterator[tuple[str, float, float]]:
    """Yield what is done with a task, the seconds that it takes, and their unit."""
    task.applicable(task.initial)  # lays the actions out
    yield "a step of a walk", worked(partial(_walk, task, N_STEPS)) / N_STEPS, 1e-6
    simulators: list[BatchSimulator] = []
    yield "made ready for many walks", worked(lambda: simulators.append(BatchSimulator(task))), 1
    states, rng = simulators[0].initial(N_WALKS), np.random.default_rng(1)
    walk = worked(lambda: simulators[0].walk(states, N_BATCH_STEPS, rng))
    yield f"a step of {N_WALKS} walks at once", walk / N_WALKS / N_BATCH_STEPS, 1e-6
    plan = Plan(tuple(_walk(task, N_STEPS)))
    open_goal = replace(task.problem, goal=TRUE)
    yield f"validated {N_STEPS} actions", worked(partial(validate, open_goal, plan)), 1


def _ground(problem: Problem, tasks: list[Task]) -> None:
    tasks.append(Task(problem))


def _deliveries() -> Iterator[Problem]:
    for size in SIZES:
        name = "largest" if size == SIZES[-1] else "delivery"
        yield replace(read(DOMAIN, _delivery(*size)), name=name)


def _delivery(n_cities: int, n_places: int, n_packages: int) -> str:
    objects, init = ["p0 p1 - plane"], ["(at p0 airport0) (at p1 airport0)"]
    for c in range(n_cities):
        places = [f"place{c}-{i}" for i in range(n_places)]
        objects.append(f"city{c} - city t{c} - truck airport{c} - airport")
        objects.append(f"{' '.join(places)} - place")
        init.append(f"(at t{c} airport{c})")
        init += [f"(inside {place} city{c})" for place in (f"airport{c}", *places)]
    for k in range(n_packages):
        objects.append(f"k{k} - package")
        init.append(f"(at k{k} place{k % n_cities}-{k % n_places})")
    return f"""(define (problem p) (:domain delivery) (:objects {" ".join(objects)})
      (:init {" ".join(init)}) (:goal (at k0 place1-0)))"""


def _plans() -> Iterator[Row]:
    """Validation of random walks; their goal is met by anything."""
    problem = replace(read("transport", "boxes-4"), goal=TRUE)
    task = Task(problem)
    last: tuple[int, float] | None = None
    for length in LENGTHS:
        plan = Plan(tuple(_walk(task, length)))
        seconds = worked(partial(validate, problem, plan))
        growth = _exponent(last, length, seconds).removeprefix(", ")
        yield Row(f"validate {length:,} actions", milliseconds(seconds), growth)
        last = length, seconds


def _walk(task: Task, n_steps: int) -> list[PlannedAction]:
    state, chance, found = task.initial, random.Random(1), list[PlannedAction]()
    for _ in range(n_steps):
        action = task.actions[chance.choice(task.applicable(state))]
        state = task.successor(state, action.index)
        found.append(PlannedAction(action.name, action.args))
    return found


def exponent(last: tuple[int, float], n: int, seconds: float) -> float:
    """Return the power of ``n`` by which seconds have grown since the size before."""
    return log(seconds / last[1]) / log(n / last[0])


def _exponent(last: tuple[int, float] | None, n: int, seconds: float) -> str:
    return "" if last is None else f", grows as n^{exponent(last, n, seconds):.1f}"
