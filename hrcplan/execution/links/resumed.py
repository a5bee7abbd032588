"""A run with a robot that goes on: first its journal says what happened, then the world does.

A real robot does not go back to where it was. What had been dispatched and had not ended when the
journal stops has an unknown outcome; what the robot observes says what is true.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Generic, Protocol, TypeVar

from hrcplan.execution import events as ev
from hrcplan.execution.codec import KINDS, Item
from hrcplan.execution.driver import DrivenRun
from hrcplan.execution.journal.reader import Journal, event_in

R = TypeVar("R", bound=DrivenRun)
E = TypeVar("E", bound=Item)
C = TypeVar("C", bound=Item)
R_contra = TypeVar("R_contra", bound=DrivenRun, contravariant=True)
E_co = TypeVar("E_co", bound=Item, covariant=True)
C_contra = TypeVar("C_contra", bound=Item, contravariant=True)


class ResumableWorld(Protocol[R_contra, E_co, C_contra]):
    """A world that can begin in the middle of a run."""

    is_repeating: bool
    """Whether a journal still says what happens: commands are noted, and not carried out."""

    def resume(self, run: R_contra, new: Sequence[ev.Dispatch]) -> tuple[E_co | ev.Event, ...]:
        """Begin in the middle of a run; ``new`` has been dispatched, and no world has seen it."""

    def do(self, command: C_contra | ev.Dispatch | ev.Wake) -> None:
        """Begin or break off an action, or take note."""

    def next(self) -> tuple[E_co, ...]:
        """Return the events of the next instant."""


class ResumedWorld(Generic[R, E, C]):
    """Returns the events of a journal, and then those of a world.

    Args:
        journal: The journal.
        world: Begins where the journal ends.
        answers: The kinds of events that answer questions: no world makes them.
        kinds: The classes of events by ``kind``.
        watch: Is called after every step, too.
    """

    def __init__(
        self, journal: Journal, world: ResumableWorld[R, E, C],
        answers: tuple[type, ...] = (ev.Planned,), kinds: Mapping[str, type] = KINDS,
        watch: Callable[[R, E, tuple[C, ...]], None] | None = None,
    ) -> None:  # fmt: skip
        self.world, self._watch = world, watch
        world.is_repeating = True
        self.keeps_deadlines = True  # the journal holds what was too late
        self._instants = list(_instants(journal, answers, kinds))
        self._old = _dispatched(journal)
        self._new: list[ev.Dispatch] = []
        self._wakes: list[ev.Wake] = []
        self._run: R | None = None

    def watch(self, run: R, event: E, commands: tuple[C, ...]) -> None:
        """Take note of the run."""
        self._run = run
        if self._watch is not None:
            self._watch(run, event, commands)

    def begin(self) -> tuple[E | ev.Event, ...]:
        """Return what was seen at time 0."""
        return self.next()

    def do(self, command: C) -> None:
        """Take note of a command; what the journal holds was done before."""
        self.world.do(command)
        if not self.world.is_repeating:
            return
        if isinstance(command, ev.Dispatch) and command.number not in self._old:
            self._new.append(command)
        elif isinstance(command, ev.Wake):
            self._wakes.append(command)

    def next(self) -> tuple[E | ev.Event, ...]:
        """Return the events of the next instant."""
        if self._instants:
            return self._instants.pop(0)
        if not self.world.is_repeating:
            return self.world.next()
        self.world.is_repeating = False
        assert self._run is not None
        events = self.world.resume(self._run, self._new)
        wakes = [wake for wake in self._wakes if wake.at_s > self._run.t]
        commands: list[ev.Dispatch | ev.Wake] = [*self._new, *wakes]
        for command in commands:
            self.world.do(command)
        return (ev.Noticed(self._run.t, "resumed", "the run goes on from its journal"), *events)


def _instants(
    journal: Journal, answers: tuple[type, ...], kinds: Mapping[str, type]
) -> Iterator[tuple[Any, ...]]:
    """Yield the events of each instant that a world has made; the last may be incomplete."""
    events: list[Any] = []
    is_open = False
    for number, line in enumerate(journal.lines[1:], start=2):
        if "event" not in line:
            continue
        event = event_in(line, number, journal.path, kinds)
        if isinstance(event, ev.Settled):
            if is_open:
                yield tuple(events)
            events, is_open = [], False
        elif not isinstance(event, answers):
            events.append(event)
            is_open = True
    if is_open:
        yield tuple(events)


def _dispatched(journal: Journal) -> frozenset[int]:
    """Return the numbers of the actions that the journal has dispatched."""
    return frozenset(
        command["number"]
        for line in journal.lines
        for command in line.get("decided", ())
        if command.get("kind") == "dispatch"
    )
