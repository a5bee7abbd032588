"""In turns, the companion with a simulated human is the turn-taking episode, step by step."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import pytest

from hrcplan.assistance.assistant import Assistant, needs_training
from hrcplan.assistance.registry import ASSISTANTS
from hrcplan.assistance.rhp.assistant import RecedingHorizonPlanner
from hrcplan.bank import Bank, build, build_bank
from hrcplan.collaboration.collaborate import make_setup, simulated
from hrcplan.collaboration.events import Begun, Chosen, Passed
from hrcplan.episodes.episode import play
from hrcplan.episodes.humans import Course, Frontier
from hrcplan.execution import events as ev
from hrcplan.inference.switching import SwitchingBelief
from tests.worlds import ERRAND, ERRANDS, HALL, world

QUICK = ("hrcplan", "oracle")  # the other robots look ahead, and take a second an episode
COURSES = [
    Course((1, 0), turns=(3,), mistake_rate=0.2, wait_rate=0.1, seed="restless"),
    Course((0,), seed="steady"),
    Course((2, 1), turns=(2,), seed="changed"),
]


@lru_cache
def bank_of(name: str) -> Bank:
    if name == "hall":
        return build(world(HALL, ERRAND, ERRANDS))
    return build_bank("kitchen", only=["pasta-bean", "pasta-tomato", "salad-bean"])


@lru_cache
def assistant(method: str, name: str) -> Assistant[Any]:
    """Return an assistant; where it would train a forest, one with another belief."""
    if method == "rhp":
        return RecedingHorizonPlanner(bank_of(name), "presence")
    kind = ASSISTANTS.find(method)
    bank = bank_of(name)
    return kind(bank, SwitchingBelief(bank)) if needs_training(kind) else kind(bank)


def steps_of_episode(bank: Bank, robot: Assistant[Any], course: Course) -> list[tuple[Any, ...]]:
    record = play(bank, Frontier(bank, course), robot, course)
    return [(turn.is_human, turn.step) for turn in record.turns]


def steps_of_companion(bank: Bank, method: str, name: str, course: Course) -> list[tuple[Any, ...]]:
    setup = make_setup(bank, method=method)
    steps: list[tuple[Any, ...]] = []

    def watch(run: Any, event: Any, commands: Any) -> None:
        if isinstance(event, Begun):
            steps.append((True, bank.table.find((event.action, *event.args))))
        if isinstance(event, Passed):
            steps.append((True, None))
        if isinstance(event, Chosen):
            words = (event.action, *event.args)
            steps.append((False, bank.table.find(words) if event.action else None))
        assert not [c for c in commands if isinstance(c, ev.Tell) and c.code != "goal-change"]

    parts = simulated(setup, bank, course, make_assistant=lambda _: assistant(method, name))
    run = parts.run(watch=watch)
    assert run.is_over
    return steps


@pytest.mark.parametrize("name", ["kitchen", "hall"])
@pytest.mark.parametrize("method", ASSISTANTS.built_in)
def test_turns_are_the_episode_step_by_step(method: str, name: str) -> None:
    bank = bank_of(name)
    for course in COURSES if method in QUICK else COURSES[:1]:
        for seed in ("a", "b") if method in QUICK else ("a",):
            one = replace(course, seed=f"{course.seed}-{seed}")
            episode = steps_of_episode(bank, assistant(method, name), one)
            companion = steps_of_companion(bank, method, name, one)
            assert companion[: len(episode)] == episode
            assert all(step is None for _, step in companion[len(episode) :])
