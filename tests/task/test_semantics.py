"""The bit task means what the lifted model means: on every small domain and every shipped one."""

from __future__ import annotations

import random
from collections import deque
from typing import Any

import pytest

from hrcplan.pddl.inputs import read
from hrcplan.pddl.library import domain_names, problem_names
from hrcplan.pddl.model import Problem
from hrcplan.task import Task

SHIPPED = [(domain, name) for domain in domain_names() for name in problem_names(domain)]


def test_every_state_of_a_small_domain(small_problem: Problem, oracle: Any) -> None:
    lifted, task = oracle(small_problem), Task(small_problem)
    seen = {task.initial}
    waiting = deque([lifted.initial])
    while waiting and len(seen) < 400:
        state = waiting.popleft()
        for after in lifted.compare(task, state).values():
            bits = lifted.bits(task, after.state)
            if bits not in seen:
                seen.add(bits)
                waiting.append(after.state)
    assert len(seen) > 10


@pytest.mark.parametrize(("domain", "name"), SHIPPED, ids=[f"{d}-{n}" for d, n in SHIPPED])
def test_random_walks_of_shipped_problems(domain: str, name: str, oracle: Any) -> None:
    problem = read(domain, name)
    lifted, task = oracle(problem), Task(problem)
    chance = random.Random(name)
    state = lifted.initial
    for _ in range(8):
        followers = lifted.compare(task, state)
        state = followers[chance.choice(sorted(followers))].state


@pytest.mark.parametrize(("domain", "name"), SHIPPED, ids=[f"{d}-{n}" for d, n in SHIPPED])
def test_lookup_equals_a_scan_from_any_state(domain: str, name: str) -> None:
    """Also where no plan ever leads: the tables do not lean on what was asked before."""
    task = Task(read(domain, name))
    chance = random.Random(name)
    for state in [chance.getrandbits(len(task.facts)) for _ in range(20)]:
        scan = [i for i in range(len(task.actions)) if task.is_applicable(state, i)]
        assert task.applicable(state) == scan
