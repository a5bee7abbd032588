"""The laws of the worlds of event-driven execution: kept, and each broken once."""

from __future__ import annotations

import itertools
import sys
from dataclasses import replace

import pytest

import hrcplan
from hrcplan.execution import ExecutionModel, FactChange, Nature, StateChange
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.execution.links.world import LinkWorld
from hrcplan.execution.worlds.registry import EVENT_WORLDS
from hrcplan.execution.worlds.simulated import SimulatedWorld
from hrcplan.pddl.model import And
from hrcplan.testing import check_event_world

PROBLEM = hrcplan.read("transport", "two-boxes")
LOST = StateChange(20.0, {("motivation", "human"): 10})
NATURES = [
    Nature(),
    Nature("lost", (LOST,)),
    Nature("at once", (replace(LOST, t=0.0),), sensed="before"),
    Nature("slow", stretch=(0.5, 2.0)),
    Nature("accident", accidents=(FactChange(60.0, frozenset({("box-at", "blue", "wp0")})),)),
]


@pytest.mark.parametrize("name", EVENT_WORLDS.names())
@pytest.mark.parametrize("nature", NATURES, ids=lambda nature: nature.seed)
def test_every_world_keeps_the_laws(name: str, nature: Nature) -> None:
    check_event_world(EVENT_WORLDS.find(name), PROBLEM, [nature])


@pytest.mark.parametrize("problem", ["kitchen/parfait-fruit", "transport/handover"])
def test_other_problems(problem: str) -> None:
    check_event_world(SimulatedWorld, hrcplan.read(problem))


def test_a_world_of_robots_keeps_the_laws() -> None:
    """Its clock is real, so times and the order of events are its own."""
    robot = f"cmd:{sys.executable} -m hrcplan robot --simulated --speed 500"
    worlds: list[LinkWorld] = []

    def make(model: ExecutionModel, nature: Nature) -> LinkWorld:
        worlds.append(LinkWorld(model, nature, hrcplan.links.make(robot), speed=500))
        return worlds[-1]

    try:
        check_event_world(make, PROBLEM, is_exact=False)
    finally:
        for world in worlds:
            world.close()
    assert len(worlds) == 2


class Changed(SimulatedWorld):
    """Reports other events than the simulated world."""

    def begin(self) -> tuple[Event, ...]:
        return self.other(super().begin())

    def next(self) -> tuple[Event, ...]:
        return self.other(super().next())

    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return tuple(self.change(event) for event in events)

    def change(self, event: Event) -> Event:
        return event


class Blind(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return tuple(event for event in events if not isinstance(event, ev.Observed))


class Late(Changed):
    def begin(self) -> tuple[Event, ...]:
        return tuple(replace(event, t=3.0) for event in super().begin())


class Backward(Changed):
    def change(self, event: Event) -> Event:
        return replace(event, t=100.0 - event.t if event.t else 0.0)


class Scattered(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return tuple(replace(event, t=event.t + i) for i, event in enumerate(events))


class Disordered(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return events[::-1]


class Listing(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return list(events)  # type: ignore[return-value]


class Deciding(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return (*events, *(ev.Settled(event.t) for event in events[:1]))


class Inventive(Changed):
    def change(self, event: Event) -> Event:
        if isinstance(event, ev.Observed):
            return replace(event, facts=event.facts | {("flies", "robot")})
        return event


class Stiff(Changed):
    """It takes a fact that never changes for one that does."""

    def change(self, event: Event) -> Event:
        if isinstance(event, ev.Observed):
            return replace(event, facts=event.facts | {("controllable", "robot")})
        return event


class Dreaming(Changed):
    def change(self, event: Event) -> Event:
        if isinstance(event, ev.Observed):
            return replace(event, absent=frozenset({("box-at", "green", "wp3")}))
        return event


class Feeling(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        return (*events, *(ev.Sensed(e.t, {("mood", "human"): 3}) for e in events[:1]))


class Doubling(Changed):
    def other(self, events: tuple[Event, ...]) -> tuple[Event, ...]:
        ended = [event for event in events if isinstance(event, ev.Ended)]
        return (*ended, *events)


class Ghostly(Changed):
    def change(self, event: Event) -> Event:
        return replace(event, number=999) if isinstance(event, ev.Ended) else event


class Quitting(Changed):
    def change(self, event: Event) -> Event:
        return replace(event, outcome=ev.CANCELLED) if isinstance(event, ev.Ended) else event


class Vague(Changed):
    def change(self, event: Event) -> Event:
        return replace(event, outcome="so so") if isinstance(event, ev.Ended) else event


class Sleepy(SimulatedWorld):
    def do(self, command: Command) -> None:
        if not isinstance(command, ev.Wake):
            super().do(command)


class Stubborn(SimulatedWorld):
    """It forgets what it was told to break off."""

    def _cancel(self, number: int) -> None:
        self._outcomes.pop(number, None)


class Idle(SimulatedWorld):
    """Its actions end, but nothing comes of them."""

    def _end(self, t: float, number: int) -> list[Event]:
        del self._outcomes[number]
        return [ev.Ended(t, number, ev.DONE)]


class Slow(SimulatedWorld):
    def _stretch(self, step: object, number: int) -> float:
        return 2.0


class Busy(SimulatedWorld):
    """It never comes to rest."""

    def next(self) -> tuple[Event, ...]:
        self.do(ev.Wake(self._now, self._now + 500.0))
        return super().next()


class Moody(SimulatedWorld):
    """Its humans are slower in every second world."""

    worlds = itertools.count()

    def __init__(self, model: ExecutionModel, nature: Nature) -> None:
        stretch = (1.0, 1.0 + next(self.worlds) % 2)
        super().__init__(model, replace(nature, stretch=stretch))


class Absent:
    def __init__(self, model: ExecutionModel, nature: Nature) -> None:
        pass


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Blind, "begin.. observes nothing"),
        (Late, "does not tell of 0 s"),
        (Backward, "time goes back"),
        (Scattered, "no one instant"),
        (Disordered, "not in the order of events.RANK"),
        (Listing, "events are a tuple"),
        (Deciding, "a world does not report Settled"),
        (Inventive, "cannot have the fact flies robot"),
        (Stiff, "no action changes controllable robot"),
        (Dreaming, "an absent fact is one that no action changes"),
        (Feeling, "no element of agent state is called mood human"),
        (Doubling, "action 0 ends twice"),
        (Ghostly, "action 999 was never dispatched"),
        (Quitting, "was not to be cancelled"),
        (Vague, "an outcome is one of done, failed, cancelled"),
        (Sleepy, "see Wake"),
        (Stubborn, "has never ended"),
        (Idle, "differ from what the domain says"),
        (Slow, "lasts 100 s instead of 50 s"),
        (Absent, "Absent lacks begin"),
    ],
)
def test_a_world_that_breaks_a_law(kind: type, message: str) -> None:
    with pytest.raises(AssertionError, match=message):
        check_event_world(kind, PROBLEM, NATURES[:1])


def test_a_world_that_differs_from_the_last_one() -> None:
    with pytest.raises(AssertionError, match="in a second world"):
        check_event_world(Moody, PROBLEM, [Nature("slow", stretch=(1.0, 2.0))])


def test_a_world_that_never_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hrcplan.testing.event_worlds.MAX_STEPS", 50)
    with pytest.raises(AssertionError, match="goes on for more than 50 instants"):
        check_event_world(Busy, PROBLEM)


def test_a_world_with_times_and_effects_of_its_own() -> None:
    check_event_world(Slow, PROBLEM, is_exact=False)


def test_a_problem_without_anything_to_do() -> None:
    with pytest.raises(AssertionError, match="take another one"):
        check_event_world(SimulatedWorld, replace(PROBLEM, goal=And(())))
