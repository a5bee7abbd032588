"""Planners that do what a test wants; those at module level can go to another process."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from hrcplan.errors import UsageError
from hrcplan.pddl.model import Problem
from hrcplan.planners import registry
from hrcplan.planners.contract import Answer, Capabilities, Planner, Request, Status
from hrcplan.planners.process import ProcessLimits, run
from hrcplan.plans import parse_plan
from tests.worlds import problem_from

WALK = """(define (domain walk) (:requirements :strips :numeric-fluents)
  (:predicates (at ?p) (link ?p ?q)) (:functions (views))
  (:action go :parameters (?p ?q) :precondition (and (at ?p) (link ?p ?q) (< (views) 99))
    :effect (and (at ?q) (not (at ?p)) (increase (views) 1))))"""
ABC = """(define (problem p) (:domain walk) (:objects a b c)
  (:init (at a) (link a b) (link b c) (link a c) (= (views) 0)) (:goal (at c)) METRIC)"""
SHORT, LONG = "(go a c)", "(go a b) (go b c)"


@dataclass
class Actor:
    """A planner that does what it was told to."""

    name: str
    act: Callable[[Request], Answer]
    card: Capabilities = field(init=False)

    def __post_init__(self) -> None:
        self.card = Capabilities(self.name, "acts", numeric=True, proves=True)

    def missing(self) -> str | None:
        return None

    def solve(self, request: Request) -> Answer:
        return self.act(request)


def only(monkeypatch: pytest.MonkeyPatch, planners: Mapping[str, Planner]) -> None:
    """Let there be no planners but these."""

    def make(name: str) -> Planner:
        if name not in planners:
            raise UsageError(f"there is no planner '{name}'")
        return planners[name]

    monkeypatch.setattr(registry, "names", lambda: tuple(planners))
    monkeypatch.setattr(registry, "make", make)


def walk(metric: str = "") -> Problem:
    """Return a task with a plan of one action and one of two."""
    return problem_from(WALK, ABC.replace("METRIC", metric))


def improves(request: Request) -> Answer:
    """Show a plan, then end with a better one."""
    request.on_plan(parse_plan(LONG))
    return Answer(Status.SOLVED, parse_plan(SHORT))


def dies(request: Request) -> Answer:
    """Kill this copy, and the process that made it."""
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(60)
    raise AssertionError


def refuses_to_end(request: Request) -> Answer:
    """Ignore all requests to end, for a minute."""
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    until = time.monotonic() + 60
    while time.monotonic() < until:
        time.sleep(1)
    raise AssertionError


def runs_a_program(request: Request) -> Answer:
    """Run a program that never ends."""
    run(["sleep", "60"], cwd=Path("/"), limits=ProcessLimits(60))
    raise AssertionError


def main() -> None:
    """Solve in the main thread or in another one, with planners that do not end."""
    from concurrent.futures import ThreadPoolExecutor

    from hrcplan.planners.solve import solve

    acts = {"one": refuses_to_end, "two": runs_a_program}
    only(pytest.MonkeyPatch(), {name: Actor(name, act) for name, act in acts.items()})
    if sys.argv[1] == "main":
        solve(walk(), timeout_s=60)
    with ThreadPoolExecutor() as threads:
        threads.submit(solve, walk(), timeout_s=60).result()
