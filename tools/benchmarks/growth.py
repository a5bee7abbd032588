"""How costs grow with the task: a family of delivery tasks, and plans of growing length."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from math import log

from rows import Row, milliseconds, worked

from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import TRUE, Problem
from hrcplan.plans import Plan, PlannedAction
from hrcplan.task import Task
from hrcplan.validation import validate

MOST_GROUND_S, N_STEPS = 30, 200
SIZES = [(5, 4, 20), (10, 5, 60), (15, 7, 150)]  # cities, places in each, packages
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
    last: tuple[int, float] | None = None
    for problem in _deliveries():
        made: list[Task] = []
        ground = worked(partial(_ground, problem, made))
        task = made[0]
        walk = worked(partial(_walk, task, N_STEPS)) / N_STEPS
        n = len(task.actions)
        yield Row(
            f"delivery, {n:,} ground actions, {len(task.facts):,} facts",
            f"grounded in {milliseconds(ground)}",
            f"{walk * 1e6:,.0f} µs a step{_exponent(last, n, ground)}",
            f"<= {MOST_GROUND_S} s" if problem.name == "largest" else "",
            ground > MOST_GROUND_S,
        )
        last = n, ground


def _ground(problem: Problem, made: list[Task]) -> None:
    made.append(Task(problem))


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
