"""The loop around a machine: world and planner on one side, journal on the other.

Every event is written down before it is acted on, and so is every decision. A run that is
continued from a journal goes the same way again: recorded events are compared with what the world
does, recorded answers are used instead of asking a planner, and then the run goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from hrcplan.execution import events as ev
from hrcplan.execution.codec import Item
from hrcplan.execution.events import Command, Event
from hrcplan.execution.run import Run, RunningAction

PATIENCE = 3  # times its duration, after which an action counts as failed
MAX_STEPS = 100_000  # events of one run; a world that never ends is stopped
QUESTIONS: Mapping[type, type] = {ev.AskPlan: ev.Planned}  # and the events that answer them


class DrivenRun(Protocol):
    """The state of a machine, as far as the loop looks at it."""

    @property
    def t(self) -> float:
        """When the last event happened."""

    @property
    def is_over(self) -> bool:
        """Whether the run has ended."""

    @property
    def running(self) -> tuple[RunningAction, ...]:
        """The actions that have begun and not ended."""


R = TypeVar("R", bound=DrivenRun)
E = TypeVar("E", bound=Item)
C = TypeVar("C", bound=Item)
Own = TypeVar("Own", bound=Item)
C_co = TypeVar("C_co", bound=Item, covariant=True)
C_contra = TypeVar("C_contra", bound=Item, contravariant=True)
E_co = TypeVar("E_co", bound=Item, covariant=True)
E_contra = TypeVar("E_contra", bound=Item, contravariant=True)


class Machine(Protocol[R, E_contra, C_co]):
    """A pure state machine: `Monitor`, or another one."""

    def begin(self) -> R:
        """Return the run before any event."""

    def step(self, run: R, event: E_contra) -> tuple[R, tuple[C_co, ...]]:
        """Return the run after an event, and the commands that follow from it."""


class DrivenWorld(Protocol[E_co, C_contra]):
    """An `EventWorld`, whatever its events and commands are."""

    def begin(self) -> tuple[E_co, ...]:
        """Return what is seen at time 0, before anything is done."""

    def do(self, command: C_contra) -> None:
        """Begin or break off an action, or take note; returns at once."""

    def next(self) -> tuple[E_co, ...]:
        """Return the events of the next instant; none if nothing can happen any more."""


@runtime_checkable
class KeepsDeadlines(Protocol):
    """A world that may judge itself which actions last too long."""

    keeps_deadlines: bool
    """Whether it does; the loop judges them otherwise."""


class AnswersQuestions(Protocol[C_contra]):
    """Answers the commands that are questions."""

    def answer(self, ask: C_contra) -> Any:
        """Return the event that answers a question."""


class PlanProvider(Protocol):
    """Answers requests for plans: a `Replanner`, or something else in tests."""

    def answer(self, ask: ev.AskPlan) -> ev.Planned:
        """Return a plan, or none with the reason."""


class RunRecord(Protocol):
    """Where events and decisions go before they are acted on."""

    def record_event(self, event: Own) -> Own:
        """Write an event down and return it as it can be read again."""

    def record_decision(self, commands: Sequence[Item]) -> None:
        """Write down what the machine decided."""

    def recorded_answer(self, kind: type[Own]) -> Own | None:
        """Return the next event if it was recorded before and is of a kind; None if not."""


class NullRecord:
    """A record that stores nothing."""

    def record_event(self, event: Own) -> Own:
        """Return the event."""
        return event

    def record_decision(self, commands: Sequence[Item]) -> None:
        """Do nothing."""

    def recorded_answer(self, kind: type[Own]) -> Own | None:
        """Return None: nothing was recorded."""
        return None


RunWatch = Callable[[Run, Event, tuple[Command, ...]], None]


@dataclass
class Driver(Generic[R, E, C]):
    """Carries one run out until it is over; ``watch`` is called after every step.

    ``questions`` maps the commands that are questions to the events that answer them.
    """

    monitor: Machine[R, E | ev.Overdue | ev.Settled | ev.StopAsked, C]
    world: DrivenWorld[E, C]
    planner: AnswersQuestions[Any]
    record: RunRecord
    watch: Callable[[R, Any, tuple[C, ...]], None] | None = None
    questions: Mapping[type, type] = field(default_factory=lambda: QUESTIONS)

    def run(self) -> R:
        """Return the finished run."""
        run = self.monitor.begin()
        events: Iterable[E | ev.StopAsked] = self.world.begin()
        for _ in range(MAX_STEPS):
            run = self._instant(run, events)
            if run.is_over:
                return run
            events = self.world.next() or (ev.StopAsked(run.t, "nothing happens any more"),)
        return self._step(run, ev.StopAsked(run.t, f"more than {MAX_STEPS} instants"))[0]

    def _instant(self, run: R, events: Iterable[E | ev.StopAsked]) -> R:
        """Return the run after the events of one instant, and what follows at once from them."""
        t = run.t
        for event in events:
            run, ask = self._step(run, event)
            run = self._with_answer(run, ask)
            t = max(t, event.t)
        keeps_deadlines = isinstance(self.world, KeepsDeadlines) and self.world.keeps_deadlines
        for action in () if keeps_deadlines else run.running:
            if t > action.begun_s + PATIENCE * action.duration_s + ev.INSTANT_S:
                run, ask = self._step(run, ev.Overdue(t, action.number))
        run, ask = self._step(run, ev.Settled(t))
        while ask is not None:
            run, again = self._step(run, self._answer(ask))
            run, ask = (run, again) if again is not None else self._step(run, ev.Settled(t))
        return run

    def _with_answer(self, run: R, ask: C | None) -> R:
        """Return the run after the answers to what an event asks for at once."""
        while ask is not None:
            run, ask = self._step(run, self._answer(ask))
        return run

    def _answer(self, ask: C) -> E:
        answer: E | None = self.record.recorded_answer(self.questions[type(ask)])
        if answer is None:
            answer = self.planner.answer(ask)
        assert answer is not None
        return answer

    def _step(
        self, run: R, event: E | ev.Overdue | ev.Settled | ev.StopAsked
    ) -> tuple[R, C | None]:
        event = self.record.record_event(event)
        run, commands = self.monitor.step(run, event)
        self.record.record_decision(commands)
        if self.watch is not None:
            self.watch(run, event, commands)
        ask = None
        for command in commands:
            if type(command) in self.questions:
                ask = command
            else:
                self.world.do(command)
        return run, ask
