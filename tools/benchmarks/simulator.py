"""Random walks with enumeration of all applicable actions: steps per second."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rows import Row, interleaved

from hrcplan.episodes.pddlgym_world import environment
from hrcplan.pddl.classical import classical, classical_texts
from hrcplan.pddl.inputs import read
from hrcplan.pddl.model import Problem
from hrcplan.task import Task
from hrcplan.task.batch import BatchSimulator

EPISODE = 50  # steps until the walk starts anew
RATE, OVER_UP, OVER_GYM = 150_000, 100, 10
BATCH_RATE, BATCH_SIZES = 1_000_000, (1_000, 10_000)
N_ROUNDS, OURS_N, THEIRS_S = 5, 10_000, 0.5
BLOCKS = """
(define (domain blocks) (:requirements :strips :typing) (:types block)
  (:predicates (on ?x ?y - block) (ontable ?x - block) (clear ?x - block) (handempty)
    (holding ?x - block))
  (:action pick-up :parameters (?x - block) :precondition (and (clear ?x) (ontable ?x) (handempty))
    :effect (and (not (ontable ?x)) (not (clear ?x)) (not (handempty)) (holding ?x)))
  (:action put-down :parameters (?x - block) :precondition (holding ?x)
    :effect (and (not (holding ?x)) (clear ?x) (handempty) (ontable ?x)))
  (:action stack :parameters (?x ?y - block) :precondition (and (holding ?x) (clear ?y))
    :effect (and (not (holding ?x)) (not (clear ?y)) (clear ?x) (handempty) (on ?x ?y)))
  (:action unstack :parameters (?x ?y - block) :precondition (and (on ?x ?y) (clear ?x) (handempty))
    :effect (and (holding ?x) (clear ?y) (not (clear ?x)) (not (handempty)) (not (on ?x ?y)))))
"""
TOWERS = """
(define (problem towers) (:domain blocks) (:objects a b c d e f g h - block)
  (:init (handempty) (ontable a) (ontable d) (on b a) (on c b) (clear c) (on e d) (clear e)
    (ontable f) (clear f) (ontable g) (on h g) (clear h))
  (:goal (and (on a b) (on d h))))
"""


def rows() -> Iterator[Row]:
    """Yield our rate on each task, and how many times as fast as the other simulators it is."""
    for domain, name in (
        ("transport", "two-boxes"),
        ("transport", "boxes-6"),
        ("kitchen", "stew-lentil"),
    ):
        problem = read(domain, name)
        rate = max(interleaved({"ours": partial(_walk, Task(problem))}, 3 * N_ROUNDS, max).values())
        goal = f">= {RATE:,} steps/s"
        yield Row(f"{domain}/{name}", f"{rate:,.0f} steps/s", "", goal, rate < RATE)
        yield from _batches(f"{domain}/{name}", Task(problem))
    for title, problem in _classical():
        yield from _compare(title, problem)


def _batches(title: str, task: Task) -> Iterator[Row]:
    """Yield the rates of many walks at once, on tasks that the rates of one walk are of."""
    for size in BATCH_SIZES:
        walk = partial(_walk_batch, BatchSimulator(task), size)
        rate = max(interleaved({"ours": walk}, N_ROUNDS, max).values())
        yield Row(
            f"{title}, {size:,} walks at once",
            f"{rate:,.0f} steps/s",
            "",
            f">= {BATCH_RATE:,} steps/s",
            rate < BATCH_RATE,
        )


def _classical() -> Iterator[tuple[str, Problem]]:
    """Yield tasks that all three can hold: at one instant, without costs."""
    yield "kitchen/stew-lentil", read("kitchen", "stew-lentil")
    yield "transport/two-boxes, at one instant", read("transport", "two-boxes")
    with TemporaryDirectory() as folder:
        domain, problem = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        domain.write_text(BLOCKS)
        problem.write_text(TOWERS)
        yield "blocks, 8 blocks", read(domain, problem)


def _compare(title: str, problem: Problem) -> Iterator[Row]:
    bare = classical(problem)
    task = Task(bare)
    runs: dict[str, Callable[[], float]] = {
        "ours": partial(_walk, task),
        "ours at once": partial(_walk_batch, BatchSimulator(task), BATCH_SIZES[0]),
        "unified-planning": _unified_planning(*classical_texts(problem)),
    }
    gym = _pddlgym(problem)
    if gym is not None:
        runs["pddlgym"] = gym
    rates = interleaved(runs, N_ROUNDS)
    for name, least in (("unified-planning", OVER_UP), ("pddlgym", OVER_GYM)):
        if name in rates:
            ratio = rates["ours"] / rates[name]
            yield Row(
                title,
                f"{rates['ours']:,.0f} steps/s",
                f"{name}: {rates[name]:,.0f} steps/s, ratio {ratio:,.0f}",
                f">= {least} x",
                ratio < least,
            )
            at_once = rates["ours at once"]
            yield Row(
                f"{title}, {BATCH_SIZES[0]:,} walks at once",
                f"{at_once:,.0f} steps/s",
                f"{name}: {rates[name]:,.0f} steps/s, ratio {at_once / rates[name]:,.0f}",
            )


def _walk(task: Task) -> float:
    chance = random.Random(1)
    draw, applicable, successor = chance.random, task.applicable, task.successor
    start = time.process_time()
    for step in range(OURS_N):
        if step % EPISODE == 0:
            state = task.initial
        actions = applicable(state)
        state = successor(state, actions[int(draw() * len(actions))])
    return OURS_N / (time.process_time() - start)


def _walk_batch(simulator: BatchSimulator, n_states: int) -> float:
    states, rng = simulator.initial(n_states), np.random.default_rng(1)
    start = time.process_time()
    simulator.walk(states, EPISODE, rng)
    return n_states * EPISODE / (time.process_time() - start)


def _unified_planning(domain: str, problem: str) -> Callable[[], float]:
    from unified_planning.engines.sequential_simulator import UPSequentialSimulator
    from unified_planning.io import PDDLReader
    from unified_planning.shortcuts import get_environment

    get_environment().credits_stream = None
    simulator = UPSequentialSimulator(PDDLReader().parse_problem_string(domain, problem))

    def begin() -> Any:
        return simulator.get_initial_state()

    def move(state: Any, chance: random.Random) -> Any:
        return simulator.apply(state, *chance.choice(list(simulator.get_applicable_actions(state))))

    list(simulator.get_applicable_actions(begin()))  # grounds
    return partial(_their_walk, begin, move)


def _pddlgym(problem: Problem) -> Callable[[], float] | None:
    if find_spec("pddlgym") is None:
        return None  # no wheels of what it needs for this Python
    world = environment(problem)

    def begin() -> Any:
        return world.reset()[0]

    def move(state: Any, chance: random.Random) -> Any:
        choices = sorted(world.action_space.all_ground_literals(state))
        return world.step(chance.choice(choices))[0]

    return partial(_their_walk, begin, move)


def _their_walk(begin: Callable[[], Any], move: Callable[[Any, random.Random], Any]) -> float:
    chance, step = random.Random(1), 0
    start = time.process_time()
    while time.process_time() < start + THEIRS_S:
        if step % EPISODE == 0:
            state = begin()
        state = move(state, chance)
        step += 1
    return step / (time.process_time() - start)
