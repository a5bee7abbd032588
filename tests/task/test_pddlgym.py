"""The kitchen, without its costs, against pddlgym on random walks."""

from __future__ import annotations

import random
import sys

import pytest

from hrcplan.episodes.pddlgym_world import environment, fact_of
from hrcplan.pddl.inputs import read
from hrcplan.task import Task

pytestmark = [
    pytest.mark.skipif(
        sys.version_info >= (3, 12), reason="pddlgym needs a Pillow without wheels for this Python"
    ),
    pytest.mark.filterwarnings("ignore"),
]


@pytest.mark.parametrize("name", ["oatmeal-apple", "smoothie-green", "stew-lentil"])
def test_random_walk(name: str) -> None:
    problem = read("kitchen", name)
    world = environment(problem)
    task = Task(problem)
    there, _ = world.reset()
    here = task.initial
    chance = random.Random(name)
    for _ in range(25):
        offered = {fact_of(a): a for a in world.action_space.all_ground_literals(there)}
        ours = {(task.actions[i].name, *task.actions[i].args): i for i in task.applicable(here)}
        assert ours.keys() <= offered.keys()
        for extra in offered.keys() - ours.keys():  # only what changes nothing
            index = task.find(extra[0], extra[1:])
            assert all(task.successor(here, i) == here for i in index)
        chosen = chance.choice(sorted(ours))
        there, _, done, *_ = world.step(offered[chosen])
        here = task.successor(here, ours[chosen])
        assert {fact for fact in map(fact_of, there.literals) if fact in task.bits} == set(
            task.facts_of(here)
        )
        assert done == task.is_goal(here)
