"""The task against unified-planning's simulator, and validation against its validators.

The only module of these tests that imports unified-planning: that alone takes seconds.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import root
from hrcplan.plans import format_plan, parse_plan
from hrcplan.task import Task
from hrcplan.validation import validate

pytestmark = pytest.mark.filterwarnings("ignore")  # of its own reader and grounder
TESTS = Path(__file__).parents[1]
COST_ONLY = "(:metric minimize (total-cost)))"


def text(*parts: str) -> str:
    return re.sub(r";.*", "", Path(root(), *parts).read_text())


def at_one_instant(domain: str) -> str:
    """Return a durative domain as a classical one: what happens at start or end happens at once."""
    domain = domain.replace(":durative-action ", ":action ").replace(":condition", ":precondition")
    domain = re.sub(r":duration \(.*\)", "", domain.replace(" :durative-actions", ""))
    while opening := re.search(r"\((?:at start|at end|over all) ", domain):
        depth, place = 1, opening.end()
        while depth:
            depth += {"(": 1, ")": -1}.get(domain[place], 0)
            place += 1
        body = domain[opening.end() : place - 1]
        domain = domain[: opening.start()] + body + domain[place:]
    return domain


def cases() -> Iterator[tuple[str, str, str]]:
    """Yield name, domain and problem text: all that both simulators can hold."""
    transport = at_one_instant(text("domains", "transport.pddl"))
    for name in ("two-boxes", "handover", "boxes-4"):
        problem = text("problems", "transport", f"{name}.pddl")
        yield name, transport, re.sub(r"\(:metric.*", COST_ONLY, problem)
    for name in ("stew-lentil", "smoothie-oat"):
        yield name, text("domains", "kitchen.pddl"), text("problems", "kitchen", f"{name}.pddl")
    for name in ("logic", "effects", "untyped"):
        problem = text(str(TESTS / "data" / "task" / f"{name}-problem.pddl"))
        domain = text(str(TESTS / "data" / "task" / f"{name}.pddl"))
        # unified-planning reads no (either …) here; its two types are all below this one.
        yield name, domain.replace("(either lamp door)", "thing"), problem


CASES = list(cases())


@pytest.fixture(scope="module")
def reader() -> Any:
    from unified_planning.io import PDDLReader
    from unified_planning.shortcuts import get_environment

    get_environment().credits_stream = None
    return PDDLReader()


@pytest.mark.parametrize(("name", "domain", "problem"), CASES, ids=[c[0] for c in CASES])
def test_random_walk(name: str, domain: str, problem: str, reader: Any, tmp_path: Path) -> None:
    """Same actions, same facts after each, same cost of the whole walk."""
    from unified_planning.engines.sequential_simulator import UPSequentialSimulator
    from unified_planning.engines.sequential_simulator import evaluate_quality_metric as more_cost
    from unified_planning.engines.sequential_simulator import (
        evaluate_quality_metric_in_initial_state as first_cost,
    )

    theirs = reader.parse_problem_string(domain, problem)
    simulator = UPSequentialSimulator(theirs, error_on_failed_checks=False)
    (tmp_path / "domain.pddl").write_text(domain)
    (tmp_path / "problem.pddl").write_text(problem)
    task = Task(read(tmp_path / "domain.pddl", tmp_path / "problem.pddl"))
    metric = theirs.quality_metrics[0] if theirs.quality_metrics else None
    state, here = simulator.get_initial_state(), task.initial
    paid: Any = 0
    cost = None if metric is None else first_cost(simulator, metric)
    chance = random.Random(name)
    for _ in range(12):
        offered = {
            (action.name, *map(str, args)): (action, args)
            for action, args in simulator.get_applicable_actions(state)
        }
        ours = {(task.actions[i].name, *task.actions[i].args): i for i in task.applicable(here)}
        assert ours.keys() <= offered.keys()
        for extra in offered.keys() - ours.keys():  # only what changes nothing
            same = simulator.apply(state, *offered[extra])
            assert facts(theirs, same, task) == task.facts_of(here)
        chosen = chance.choice(sorted(ours))
        after = simulator.apply(state, *offered[chosen])
        if metric is not None:
            action, args = offered[chosen]
            cost = more_cost(simulator, metric, cost, state, action, args, after)
            paid += task.costs[ours[chosen]]
            assert cost == paid
        state, here = after, task.successor(here, ours[chosen])
        assert facts(theirs, state, task) == task.facts_of(here)
        assert simulator.is_goal(state) == task.is_goal(here)


def facts(problem: Any, state: Any, task: Task) -> frozenset[tuple[str, ...]]:
    """Return which of the task's fluents hold in a state of unified-planning."""
    found = set()
    for fact in task.facts:
        objects = [problem.object(name) for name in fact[1:]]
        if state.get_value(problem.fluent(fact[0])(*objects)).bool_constant_value():
            found.add(fact)
    return frozenset(found)


def changes(lines: list[str]) -> Iterator[list[str]]:
    """Yield the plan, and the plan with one line left out, doubled or moved in time."""
    yield lines
    for i, line in enumerate(lines):
        yield lines[:i] + lines[i + 1 :]
        yield [*lines[: i + 1], *lines[i:]]
        if ":" in line:
            start, rest = line.split(":", 1)
            for by in ("-0.001", "-25", "0.001", "25"):
                moved = max(Fraction(start) + Fraction(by), Fraction(0))
                yield [*lines[:i], f"{float(moved):.3f}:{rest}", *lines[i + 1 :]]


@pytest.mark.parametrize("name", ["two-boxes", "handover", "oatmeal-apple"])
def test_validators_agree(name: str, reader: Any) -> None:
    from unified_planning.engines.plan_validator import (
        SequentialPlanValidator,
        TimeTriggeredPlanValidator,
    )
    from unified_planning.engines.results import ValidationResultStatus

    lines = (TESTS / "data" / "plans" / f"{name}.plan").read_text().splitlines()
    folder = "transport" if ":" in lines[0] else "kitchen"
    problem = re.sub(r"\(:metric.*", COST_ONLY, text("problems", folder, f"{name}.pddl"))
    theirs = reader.parse_problem_string(text("domains", f"{folder}.pddl"), problem)
    theirs.epsilon = Fraction(1, 1000)
    validator = TimeTriggeredPlanValidator() if ":" in lines[0] else SequentialPlanValidator()
    mine = read(folder, name)
    for changed in changes(lines):
        plan = parse_plan("\n".join(changed))
        report = validate(mine, plan)
        answer = validator.validate(theirs, reader.parse_plan_string(theirs, format_plan(plan)))
        accepted = answer.status == ValidationResultStatus.VALID
        assert report.valid == accepted, (report.reason, format_plan(plan))
