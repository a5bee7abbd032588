"""Where actions are carried out: a simulation, or something real."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from hrcplan.execution.events import Command, Event


@runtime_checkable
class EventWorld(Protocol):
    """Carries commands out and says what happens, one instant at a time."""

    def begin(self) -> tuple[Event, ...]:
        """Return what is seen at time 0, before anything is done."""

    def do(self, command: Command) -> None:
        """Begin or break off an action, or take note; returns at once."""

    def next(self) -> tuple[Event, ...]:
        """Return the events of the next instant, in order; none if nothing can happen any more."""
