"""How long beliefs take, and how near the forest comes to the exact ceiling.

tools/bench_beliefs.py [--forest]
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from hrcplan.bank import Bank, build, build_bank, from_problems
from hrcplan.inference.ceiling import Ceiling
from hrcplan.inference.exact import Exact
from hrcplan.inference.forest import Forest
from hrcplan.inference.recursive import Recursive
from hrcplan.inference.switching import Switching
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import Source

N_ITEMS, N_WANTED, N_MANY = 40, 4, 10_000

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


def many_goals() -> Bank:
    """Return a bank of 10,000 generated goals, each of four items out of forty."""
    rng = random.Random(0)
    items = [f"i{i}" for i in range(N_ITEMS)]
    chosen: set[tuple[str, ...]] = set()
    while len(chosen) < N_MANY:
        chosen.add(tuple(sorted(rng.sample(items, N_WANTED))))
    domain = domain_in(Source("many", DOMAIN))
    problems = [
        problem_in(domain, Source("p", PROBLEM.format(
            number=number, items=" ".join(items), goal=" ".join(f"(made {i})" for i in wanted))))
        for number, wanted in enumerate(sorted(chosen))
    ]  # fmt: skip
    return build(from_problems(problems))


def per_step_us(belief: Any, runs: Sequence[Sequence[int]]) -> tuple[float, float]:
    """Return microseconds of processor time per observation, and per posterior: the best of ten."""
    n = sum(map(len, runs))
    times, states = [], []
    for _ in range(10):
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


def speed(bank: Bank, n_runs: int, what: str) -> None:
    rng = np.random.default_rng(0)
    goals = rng.integers(len(bank.names), size=n_runs)
    runs = [bank.sample(int(goal), 1, rng)[0] for goal in goals]
    for kind in (Exact, Switching, Recursive):
        began = time.perf_counter()
        belief = kind(bank)
        made_s = time.perf_counter() - began
        update, posterior = per_step_us(belief, runs)
        name = f"{what:<14}{kind.__name__:<11} made in {made_s:6.2f} s"
        print(f"{name}  {update:8.1f} us per observation  {posterior:8.1f} us per posterior")


def forest(bank: Bank) -> None:
    rng = np.random.default_rng(5)
    prefixes, goals = [], []
    for goal in range(len(bank.names)):
        for plan in bank.sample(goal, 700, rng):
            prefixes.append(plan[: rng.integers(1, len(plan) + 1)])
            goals.append(goal)
    ceiling = Ceiling(bank).accuracy(prefixes, goals)
    belief = Forest(bank, n_jobs=2)
    rows = np.zeros((len(prefixes), belief.n_labels), dtype=np.uint8)
    for row, steps in zip(rows, prefixes, strict=True):
        row[belief._label[list(steps)]] = 1
    right = (belief._classes[belief.predict(rows).argmax(axis=1)] == np.array(goals)).mean()
    began = time.process_time()
    for row in rows[:500]:
        belief._flat.predict(row)  # type: ignore[union-attr]
    row_ms = (time.process_time() - began) / 500 * 1e3
    print(f"forest: {belief.training}")
    print(f"uniform prefixes: forest {right:.4f}, exact {ceiling:.4f}; one row {row_ms:.2f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--forest", action="store_true", help="also train the forest (minutes)")
    args = parser.parse_args()
    kitchen = build_bank("kitchen")
    speed(kitchen, 150, "30 goals")
    speed(many_goals(), 5, "10,000 goals")
    if args.forest:
        forest(kitchen)


if __name__ == "__main__":
    main()
