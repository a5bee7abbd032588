"""The laws of the humans of event-driven execution: all keep them, and each is broken once."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

import pytest

import hrcplan
from hrcplan.agents import load_profile
from hrcplan.errors import UsageError
from hrcplan.execution import FactChange, Nature, NatureSource, Spec, StateChange
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.natures import WORDS, checked_nature, parse_human
from hrcplan.execution.replanner import Replanner
from hrcplan.execution.simulate import Engine, nature_of
from hrcplan.pddl.model import Problem
from hrcplan.testing import check_nature

PROBLEM = hrcplan.read("transport", "two-boxes")
MOTIVATION = ("motivation", "human")


@dataclass
class Words:
    """A human as words describe it, as a class."""

    text: str

    def nature(self, problem: Problem, seed: str | int) -> Nature:
        model = ExecutionModel(problem)
        engine = Engine(Monitor(model, load_profile("hrcplan")), Replanner(model, ["exact"]))
        return nature_of(parse_human(self.text, Spec(seed=seed)), engine)


@pytest.mark.parametrize("text", [*WORDS, "partly-cooperative,random,attempt,before"])
def test_every_word_keeps_the_laws(text: str) -> None:
    natures = check_nature(lambda: Words(text), PROBLEM, seeds=range(3))
    assert [not nature.changes for nature in natures] == [text == "steady"] * 3


class Steady:
    def nature(self, problem: Problem, seed: str | int) -> Nature:
        return Nature(seed)


def test_a_class_keeps_the_laws() -> None:
    assert check_nature(Steady, PROBLEM, seeds=["a", 7]) == [Nature("a"), Nature(7)]


class Moody:
    """Its nature depends on how often it was asked."""

    n_asked = 0

    def nature(self, problem: Problem, seed: str | int) -> Nature:
        self.n_asked += 1
        return Nature(seed, (StateChange(self.n_asked, {MOTIVATION: 9}),))


class Lucky:
    """Its nature depends on a random number that no seed decides."""

    def __init__(self) -> None:
        self.t = random.random()

    def nature(self, problem: Problem, seed: str | int) -> Nature:
        return Nature(seed, (StateChange(self.t, {MOTIVATION: 9}),))


def with_nature(**fields: Any) -> type:
    class Source:
        def nature(self, problem: Problem, seed: str | int) -> Nature:
            return Nature(**{"seed": seed, **fields})

    return Source


class Wordy:
    def nature(self, problem: Problem, seed: str | int) -> str:
        return "uncooperative"


class Absent:
    pass


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Moody, "is answered differently"),
        (Lucky, "two humans with seed 7 differ"),
        (Wordy, "returns a Nature, not 'uncooperative'"),
        (Absent, "Absent has no nature"),
        (with_nature(sensed="never"), "sensed of a nature is one of before, during, after"),
        (with_nature(draws="twice"), "draws of a nature is one of once, attempt"),
        (with_nature(can_fail=frozenset({"fly"})), "not 'fly'"),
        (with_nature(stretch=(2.0, 1.0)), "stretch of a nature"),
        (with_nature(stretch=(1.0, 2.0, 3.0)), "stretch of a nature"),
        (with_nature(changes=(StateChange(-1.0, {MOTIVATION: 9}),)), "not a number from 0 on"),
        (with_nature(changes=(StateChange(0.0, {("mood", "human"): 9}),)), "no function 'mood'"),
        (with_nature(changes=(StateChange(0.0, {MOTIVATION: 11}),)), "no value in"),
        (with_nature(accidents=(FactChange(1.0, frozenset({("lost", "blue")})),)), "'lost'"),
        (with_nature(seed=(1, 2)), "a journal changes this nature"),
        (with_nature(seed={1}), "a journal cannot hold this nature"),
    ],
)
def test_a_human_that_breaks_a_law(kind: type, message: str) -> None:
    with pytest.raises(AssertionError, match=message):
        check_nature(kind, PROBLEM)


def test_a_wrong_nature_is_refused_before_the_run() -> None:
    source: NatureSource = with_nature(sensed="never")()
    with pytest.raises(UsageError, match="sensed of a nature"):
        hrcplan.execute(PROBLEM, human=source)
    with pytest.raises(TypeError, match="returns a Nature"):
        checked_nature("steady", ExecutionModel(PROBLEM))  # type: ignore[arg-type]
