"""How long beliefs take, and how near the forest comes to the exact ceiling.

The forest is looked at only if the environment variable ``HRCPLAN_BENCH_FOREST`` is set: unless the
user's cache folder has it, it is trained (minutes).
"""

from __future__ import annotations

import os
import random
import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from rows import Row, milliseconds

from hrcplan.assistance.rhp.set_posterior import PrefixPosterior
from hrcplan.bank import Bank, build, build_bank, from_problems
from hrcplan.core.arrays import Rows
from hrcplan.inference.adaptive import AdaptiveBelief
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.exact import ExactBelief
from hrcplan.inference.recursive import RecursiveBelief
from hrcplan.inference.switching import SwitchingBelief
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText

FEW_US, MANY_US = 20, 5_000
FOREST_POINTS, FOREST_ROWS = 0.5, 200
FOREST_MS = ((), 0.3), ((5, 5), 1), ((5, 5, 4), 3)  # steps looked at, one after the other
N_ITEMS, N_WANTED, N_MANY = 40, 4, 10_000
N_ROUNDS = 10

DOMAIN = """
(define (domain many) (:requirements :strips :typing)
  (:types agent item - object) (:predicates (able ?a - agent) (got ?i - item) (made ?i - item))
  (:action fetch :parameters (?a - agent ?i - item) :precondition (able ?a) :effect (got ?i))
  (:action make :parameters (?a - agent ?i - item) :precondition (and (able ?a) (got ?i))
    :effect (made ?i)))
"""
PROBLEM = """
(define (problem p{number}) (:domain many)
  (:objects robot human - agent {items} - item) (:init (able robot) (able human))
  (:goal (and {goal})))
"""


def rows() -> Iterator[Row]:
    """Yield the time of each belief's update, for few and for many goals."""
    kitchen = build_bank("kitchen")
    yield from _speed(kitchen, 150, "kitchen, 30 goals", FEW_US)
    yield from _speed(
        many_goals(N_MANY, N_ITEMS, N_WANTED), 5, f"{N_MANY:,} generated goals", MANY_US
    )
    if os.environ.get("HRCPLAN_BENCH_FOREST"):
        yield from _forest(kitchen)


def many_goals(n: int, n_items: int, n_wanted: int) -> Bank:
    """Return a bank of generated goals; each wants a few items, fetched and made."""
    rng = random.Random(0)
    items = [f"i{i}" for i in range(n_items)]
    chosen: set[tuple[str, ...]] = set()
    while len(chosen) < n:
        chosen.add(tuple(sorted(rng.sample(items, n_wanted))))
    domain = domain_in(SourceText("many", DOMAIN))
    problems = [
        problem_in(domain, SourceText("p", PROBLEM.format(
            number=number, items=" ".join(items), goal=" ".join(f"(made {i})" for i in wanted))))
        for number, wanted in enumerate(sorted(chosen))
    ]  # fmt: skip
    return build(from_problems(problems))


def _speed(bank: Bank, n_runs: int, what: str, goal_us: float) -> Iterator[Row]:
    rng = np.random.default_rng(0)
    goals = rng.integers(len(bank.names), size=n_runs)
    runs = [bank.sample(int(goal), 1, rng)[0] for goal in goals]
    for kind in (ExactBelief, SwitchingBelief, AdaptiveBelief, RecursiveBelief):
        began = time.process_time()
        belief = kind(bank)
        made_s = time.process_time() - began
        update, posterior = _per_step_us(belief, runs)
        promised = kind is ExactBelief
        yield Row(
            f"{what}, {kind.__name__.lower()}",
            f"{update:,.1f} µs per observation",
            f"{posterior:,.1f} µs per posterior, made in {milliseconds(made_s)}",
            f"<= {goal_us:,} µs" if promised else "",
            promised and update > goal_us,
        )


def _per_step_us(belief: Any, runs: Sequence[Sequence[int]]) -> tuple[float, float]:
    """Return microseconds of processor time per observation, and per posterior: the best of ten."""
    n = sum(map(len, runs))
    times, states = [], []
    for _ in range(N_ROUNDS):
        began = time.process_time()
        for run in runs:
            state = belief.start()
            for step in run:
                state = belief.observe(state, step)
            states.append(state)
        times.append((time.process_time() - began) / n)
    began = time.process_time()
    for state in states[: len(runs)]:
        belief.posterior(state)
    return min(times) * 1e6, (time.process_time() - began) / len(runs) * 1e6


def _forest(bank: Bank) -> Iterator[Row]:
    """Yield the forest's accuracy on uniform prefixes beside the ceiling, and a row's time."""
    rng = np.random.default_rng(5)
    prefixes, goals = [], []
    for goal in range(len(bank.names)):
        for plan in bank.sample(goal, 700, rng):
            prefixes.append(plan[: rng.integers(1, len(plan) + 1)])
            goals.append(goal)
    ceiling = PrefixPosterior(bank).accuracy(prefixes, goals)
    began = time.monotonic()
    belief = ForestBelief(bank, n_jobs=2)
    ready_s = time.monotonic() - began
    column = np.array(bank.table.labels)
    table = np.zeros((len(prefixes), belief.n_labels), dtype=np.uint8)
    for row, steps in zip(table, prefixes, strict=True):
        row[column[list(steps)]] = 1
    right = (belief.many(table).argmax(axis=1) == np.array(goals)).mean()
    points = (ceiling - right) * 100
    compared = f"exact: {ceiling:.2%}; {belief.note}"
    limit = f"within {FOREST_POINTS} points"
    what = "forest, uniform prefixes"
    yield Row(what, f"{right:.2%} right", compared, limit, points > FOREST_POINTS)
    yield Row("forest, made or found", milliseconds(ready_s), belief.note)
    some = rng.choice(len(prefixes), FOREST_ROWS)
    for widths, limit_ms in FOREST_MS:
        asked = [(table[i], _ahead(bank, prefixes[i], widths, rng)) for i in some]
        n_rows = int(np.prod(widths, dtype=int))
        what = f"forest, {n_rows} extensions by {len(widths)}" if widths else "forest, one row"
        ms = _extensions_ms(bank, asked)
        yield Row(what, f"{ms:.2f} ms", "none seen before", f"<= {limit_ms} ms", ms > limit_ms)


def _extensions_ms(bank: Bank, asked: Sequence[tuple[Rows, list[tuple[int, ...]]]]) -> float:
    """Return milliseconds of processor time of a forest that remembers nothing: the best of 3."""
    times = []
    for _ in range(3):
        belief = ForestBelief(bank)
        began = time.process_time()
        for row, extensions in asked:
            belief.extended(row, extensions)
        times.append((time.process_time() - began) / len(asked) * 1e3)
    return min(times)


def _ahead(
    bank: Bank, done: Sequence[int], widths: Sequence[int], rng: np.random.Generator
) -> list[tuple[int, ...]]:
    """Return the leaves of a tree of steps that can be done next."""
    if not widths:
        return [()]
    state: int | None = bank.initial
    for step in done:
        assert state is not None
        state = bank.table.successor(state, step)
    assert state is not None
    options = rng.permutation(bank.table.applicable(state))[: widths[0]].tolist()
    return [
        (step, *more) for step in options for more in _ahead(bank, (*done, step), widths[1:], rng)
    ]
