"""The loop around the monitor: world and planner on one side, journal on the other.

Every event is written down before it is acted on, and so is every decision. A run that is
continued from a journal goes the same way again: recorded events are compared with what the world
does, recorded plans are used instead of asking a planner, and then the run goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.run import Run
from hrcplan.execution.worlds import EventWorld

PATIENCE = 3  # times its duration, after which an action counts as failed
MAX_STEPS = 100_000  # events of one run; a world that never ends is stopped


class PlanProvider(Protocol):
    """Answers requests for plans: a `Replanner`, or something else in tests."""

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return a plan, or none with the reason."""


class RunRecord(Protocol):
    """Where events and decisions go before they are acted on."""

    def record_event(self, event: Event) -> Event:
        """Write an event down and return it as it can be read again."""

    def record_decision(self, commands: tuple[Command, ...]) -> None:
        """Write down what the monitor decided."""

    def recorded_plan(self) -> ev.Planned | None:
        """Return the next event if it is a plan that was recorded before; None if not."""


class NullRecord:
    """A record that stores nothing."""

    def record_event(self, event: Event) -> Event:
        """Return the event."""
        return event

    def record_decision(self, commands: tuple[Command, ...]) -> None:
        """Do nothing."""

    def recorded_plan(self) -> ev.Planned | None:
        """Return None: nothing was recorded."""
        return None


RunWatch = Callable[[Run, Event, tuple[Command, ...]], None]


@dataclass
class Driver:
    """Carries one run out until it is over; ``watch`` is called after every step."""

    monitor: Monitor
    world: EventWorld
    planner: PlanProvider
    record: RunRecord
    watch: RunWatch | None = None

    def run(self) -> Run:
        """Return the finished run."""
        run = self.monitor.begin()
        events: Iterable[Event] = self.world.begin()
        for _ in range(MAX_STEPS):
            run = self._instant(run, events)
            if run.is_over:
                return run
            events = self.world.next() or (ev.StopAsked(run.t, "nothing happens any more"),)
        return self._step(run, ev.StopAsked(run.t, f"more than {MAX_STEPS} instants"))[0]

    def _instant(self, run: Run, events: Iterable[Event]) -> Run:
        """Return the run after the events of one instant, and what follows at once from them."""
        t = run.t
        for event in events:
            run, ask = self._step(run, event)
            t = max(t, event.t)
        for action in run.running:
            if t > action.begun_s + PATIENCE * action.duration_s + ev.INSTANT_S:
                run, ask = self._step(run, ev.Overdue(t, action.number))
        run, ask = self._step(run, ev.Settled(t))
        while ask is not None:
            run, again = self._step(run, self.record.recorded_plan() or self.planner.answer(ask))
            run, ask = (run, again) if again is not None else self._step(run, ev.Settled(t))
        return run

    def _step(self, run: Run, event: Event) -> tuple[Run, ev.AskPlan | None]:
        event = self.record.record_event(event)
        run, commands = self.monitor.step(run, event)
        self.record.record_decision(commands)
        if self.watch is not None:
            self.watch(run, event, commands)
        ask = None
        for command in commands:
            if isinstance(command, ev.AskPlan):
                ask = command
            else:
                self.world.do(command)
        return run, ask
