"""A world that passes commands and events on, and tests the laws of event worlds on the way."""

from __future__ import annotations

import json
from collections.abc import Sequence

from hrcplan.core.numbers import Number
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import BoundAction, StartEffects
from hrcplan.execution.codec import exact_number, from_json, to_json
from hrcplan.execution.events import Command, Event
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.worlds import EventWorld
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.semantics import LiftedState
from hrcplan.pddl.settings import check_fact

REPORTS = (ev.Ended, ev.Noticed, ev.Observed, ev.Sensed, ev.StopAsked)
"""The events that a world reports; the others are the driver's."""


class DomainTruth:
    """What the domain says about the actions under way: how long they last, what they change.

    A nature with accidents changes facts by itself; then only durations are compared.
    """

    def __init__(self, model: ExecutionModel, nature: Nature) -> None:
        self._model = model
        self._nature = nature
        self._state: LiftedState = model.actions.initial()
        self._running: dict[int, tuple[ev.Dispatch, BoundAction, Number, StartEffects]] = {}

    def begin(self, dispatch: ev.Dispatch) -> None:
        """Let an action begin."""
        step = self._model.actions.step(ev.planned_action(dispatch))
        assert step is not None, f"the problem has no action {dispatch}"
        duration = exact_number(dispatch.duration_s)
        self._state, effects = self._model.actions.begin(self._state, step, duration)  # type: ignore[arg-type]
        self._running[dispatch.number] = (dispatch, step, duration, effects)  # type: ignore[assignment]

    def end(self, event: ev.Ended) -> None:
        """Let an action end, with the effects of its outcome."""
        dispatch, step, duration, effects = self._running.pop(event.number)
        if event.outcome == ev.DONE:
            self._state = self._model.actions.finish(self._state, step, duration)
        else:
            self._state = self._model.actions.revert(self._state, effects)
        if event.outcome != ev.CANCELLED:
            is_human = self._model.is_human(step.agent)
            least, most = self._nature.stretch if is_human else (1.0, 1.0)
            lasted_s, tolerance_s = event.t - dispatch.t, 2 * ev.INSTANT_S
            lower, upper = least * dispatch.duration_s, most * dispatch.duration_s
            message = f"{dispatch} lasts {lasted_s:g} s instead of {dispatch.duration_s:g} s"
            assert lower - tolerance_s <= lasted_s <= upper + tolerance_s, message

    def compare(self, event: ev.Observed) -> None:
        """Compare what is observed with what the domain says."""
        if self._nature.accidents:
            return
        actions = self._model.actions
        own_facts, facts = actions.changing(self._state), event.facts
        more = ", ".join(" ".join(fact) for fact in sorted(own_facts ^ facts))
        assert facts == own_facts, f"observed facts differ from what the domain says: {more}"
        assert event.absent == actions.absent(self._state), "facts that nothing changes are absent"
        numbers = {} if event.numbers is None else event.numbers
        assert dict(numbers) == dict(self._state.values), "observed numbers differ from the domain"


class WatchedWorld:
    """Passes commands and events on, and tests them.

    Args:
        world: The world to test.
        model: The model that it was made from.
        truth: What the domain says, if the world has to do exactly that.

    Attributes:
        log: All commands and events.
        running: The numbers of the actions under way.
        t: The time of the last event, in seconds.
    """

    def __init__(self, world: EventWorld, model: ExecutionModel, truth: DomainTruth | None) -> None:
        assert isinstance(world, EventWorld), (
            f"{type(world).__name__} lacks begin(), do() or next()"
        )
        self.log: list[Command | Event] = []
        self.running: set[int] = set()
        self.t = 0.0
        self._world = world
        self._model = model
        self._truth = truth
        self._dispatches: set[int] = set()
        self._cancellations: set[int] = set()
        self._wakes_s: list[float] = []

    def begin(self) -> tuple[Event, ...]:
        """Return what is seen at time 0."""
        events = self._check(self._world.begin())
        assert any(isinstance(e, ev.Observed) for e in events), "begin() observes nothing"
        assert all(e.t < ev.INSTANT_S for e in events), "begin() does not tell of 0 s"
        return events

    def do(self, command: Command) -> None:
        """Pass a command on."""
        self.log.append(command)
        if isinstance(command, ev.Dispatch):
            self.running.add(command.number)
            self._dispatches.add(command.number)
            if self._truth is not None:
                self._truth.begin(command)
        elif isinstance(command, ev.Cancel):
            self._cancellations.add(command.number)
        elif isinstance(command, ev.Wake):
            self._wakes_s.append(command.at_s)
        self._world.do(command)

    def next(self) -> tuple[Event, ...]:
        """Return the events of the next instant."""
        events = self._check(self._world.next())
        due_s = [wake for wake in self._wakes_s if events and wake < self.t + ev.INSTANT_S]
        for wake_s in due_s if self._truth is not None else ():  # real worlds may be late
            assert wake_s > self.t - 2 * ev.INSTANT_S, f"no instant at {wake_s:g} s: see Wake"
        self._wakes_s = [wake for wake in self._wakes_s if wake not in due_s]
        return events

    def check_end(self) -> None:
        """Test what holds when nothing can happen any more."""
        assert not self.running, f"action {min(self.running)} has never ended"
        assert not self._wakes_s, f"no instant at {min(self._wakes_s):g} s: see Wake"

    def _check(self, events: Sequence[Event]) -> tuple[Event, ...]:
        assert isinstance(events, tuple), f"events are a tuple, not {events!r}"
        for event in events:
            assert isinstance(event, REPORTS), f"a world does not report {event!r}"
            line = json.loads(json.dumps(to_json(event)))
            assert to_json(from_json(line)) == line, f"a journal cannot hold {event!r}"
        self._check_instant(events)
        for event in events:
            self._check_content(event)
        self.log += events
        return events

    def _check_instant(self, events: Sequence[Event]) -> None:
        times = [event.t for event in events]
        if not times:
            return
        assert min(times) >= self.t - ev.INSTANT_S, f"time goes back from {self.t:g} s: {events}"
        assert max(times) - min(times) <= ev.INSTANT_S, f"no one instant: {times}"
        self.t = max(self.t, *times)
        ranks = [ev.RANK[type(event)] for event in events]
        assert ranks == sorted(ranks), "events of an instant are not in the order of events.RANK"

    def _check_content(self, event: Event) -> None:
        if isinstance(event, ev.Ended):
            self._end(event)
        elif isinstance(event, ev.Observed):
            for fact in event.facts:
                _check_known(fact, self._model)
            is_static = event.absent <= self._model.actions.static
            assert is_static, "an absent fact is one that no action changes"
            if self._truth is not None:
                self._truth.compare(event)
        elif isinstance(event, ev.Sensed):
            for key in event.values:
                name = " ".join(key)
                assert key in self._model.agents.low, f"no element of agent state is called {name}"

    def _end(self, event: ev.Ended) -> None:
        number, outcome = event.number, event.outcome
        assert number in self._dispatches, f"action {number} was never dispatched"
        assert number in self.running, f"action {number} ends twice"
        assert outcome in ev.OUTCOMES, f"an outcome is one of {', '.join(ev.OUTCOMES)}: {outcome!r}"
        if outcome == ev.CANCELLED:
            assert number in self._cancellations, f"action {number} was not to be cancelled"
        self.running.remove(number)
        if self._truth is not None:
            self._truth.end(event)


def _check_known(fact: tuple[str, ...], model: ExecutionModel) -> None:
    try:
        check_fact(fact, model.problem)
    except UsageError as error:
        message = f"the problem cannot have the fact {' '.join(fact)}: {error.message}"
        raise AssertionError(message) from error
    assert fact not in model.actions.static, f"no action changes {' '.join(fact)}; see absent"
