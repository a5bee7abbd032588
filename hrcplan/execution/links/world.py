"""A world in which a link carries out the robots' actions, on a real clock.

The actions of agents that the link does not serve, such as a human's, are simulated on the same
clock. What is believed of an action follows from what the link says, never from the time alone: an
action without an answer has the outcome *unknown*, and what is observed then says what is true.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from hrcplan.core.numbers import Number, exact
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import UNIT_S
from hrcplan.execution.changes import checked_changes
from hrcplan.execution.driver import PATIENCE
from hrcplan.execution.events import Command, Event
from hrcplan.execution.links import LimitsActions, RobotLink
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.clock import RunClock
from hrcplan.execution.links.session import LinkSession
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.run import Run
from hrcplan.execution.worlds.simulated import FactChange, Nature, SimulatedWorld, StateChange
from hrcplan.pddl.model import FluentKey
from hrcplan.pddl.semantics import LiftedState

ACCEPT_S = 2.0  # how long it may take to accept or refuse an action, to cancel, and to observe
MAX_TRIES = 3  # how often an action is asked for
STEP_LIMIT_S = 60.0  # how long a step may take whose duration no one knows
MAX_FAULTS = 20  # reported per run
_FEEDBACK_S = 1.0  # between two reports of how far an action is
_LONG_S = 3600.0


@dataclass(slots=True)
class _Request:
    """An action that the link was asked for; ``until_s`` (real time) an answer has to come.

    ``limit_s``: how long it may take in all; ``deadline_s`` is then, on the real clock.
    """

    dispatch: ev.Dispatch
    until_s: float
    limit_s: float
    deadline_s: float
    n_tries: int = 1
    is_accepted: bool = False
    is_overdue: bool = False
    feedback_s: float = float("-inf")


class LinkWorld:
    """Carries actions out through a link, and simulates the agents that it does not serve.

    ``speed``: seconds of the run in a second of the clock.

    Attributes:
        reports: What people have said and begun, as the link says, if ``hears_people``.
        hears_people: Whether these reports are taken.
        waits_for_people: Whether nothing but these reports says what people do.
        is_repeating: Whether a journal still says what happens, so that commands do nothing.
    """

    keeps_deadlines = True

    def __init__(
        self, model: ExecutionModel, nature: Nature, link: RobotLink, *, speed: float = 1.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self.model = model
        self.link = link
        self.clock = RunClock(speed, clock)
        self.session = LinkSession(link, model, self.clock)
        self.simulated = SimulatedWorld(model, nature)
        self._requests: dict[int, _Request] = {}
        self._outcomes: dict[int, str] = {}  # of the actions that have ended
        self._waiting: list[Command] = []  # while an emergency stop lasts
        self._n_faults = 0
        self._events: list[Event] = []  # that were taken in before they were asked for
        self.reports: deque[msg.PersonSaid | msg.PersonBegun] = deque()
        self.hears_people = self.waits_for_people = self.is_repeating = False

    def begin(self) -> tuple[Event, ...]:
        """Start the link and return what is seen at time 0.

        Raises:
            PlannerError: if the program is missing, ends at once, or does not say that it is ready.
            UsageError: if it takes actions of agents that the problem has not.
        """
        self.session.start()
        self.clock.begin()
        return self.simulated.begin()

    def resume(self, run: Run, new: Sequence[ev.Dispatch]) -> tuple[Event, ...]:
        """Start the link in the middle of a run, and return what is seen then.

        What was dispatched before and has not ended has an unknown outcome: the link is asked what
        it observes, and no effect is assumed.

        Args:
            run: The run as it is now.
            new: Dispatches that no world has seen yet; `do` begins them afterwards.

        Raises:
            PlannerError: as `begin`.
            UsageError: as `begin`.
        """
        self.session.start()
        self.clock.begin(run.t)
        numbers = {command.number for command in new}
        state = run.state
        for action in reversed(run.running):
            if action.number in numbers:
                state = self.model.actions.revert(state, action.start_effects)
        old = [action for action in run.running if action.number not in numbers]
        self.simulated.resume(run.t, state, run.sensed_values, old)
        self._outcomes = dict.fromkeys(range(run.n_dispatched), ev.UNKNOWN)
        events: list[Event] = [
            event for action in old for event in self._end(action.number, ev.UNKNOWN)
        ]
        return (*events, *self._look(), self.simulated.observation())

    @property
    def state(self) -> LiftedState:
        """What is believed to hold."""
        return self.simulated.state

    @state.setter
    def state(self, state: LiftedState) -> None:
        """Believe that this holds."""
        self.simulated.state = state

    def close(self) -> None:
        """Cancel what is under way, and end the link."""
        for number in list(self._requests):
            self.session.send({"do": "cancel", "n": number})
        self.session.close()

    # Commands.

    def do(self, command: Command) -> None:
        """Begin or break off an action; during an emergency stop actions wait for its release."""
        if self.is_repeating:
            return
        if isinstance(command, ev.Dispatch):
            self._events += self._link_events()  # an emergency stop may have come meanwhile
        match command:
            case ev.Dispatch() if self.clock.is_stopped:
                self._waiting.append(command)
            case ev.Dispatch(agent=agent) if agent in self.session.served:
                self._dispatch(command)
            case ev.Cancel(_, number) if number in self._requests:
                self._cancel(number)
            case ev.Finish():
                self.close()
            case _:
                self.simulated.do(command)

    def _dispatch(self, command: ev.Dispatch) -> None:
        self.simulated.begin_action(command)
        now_s, limit_s = self.clock.real_s, self._limit_s(command)
        request = _Request(command, now_s + ACCEPT_S, limit_s, now_s + limit_s)
        self._requests[command.number] = request
        self._send_dispatch(request)

    def _limit_s(self, command: ev.Dispatch) -> float:
        """Return how many real seconds an action may take."""
        limit_s = (
            self.link.limit_s(command.action) if isinstance(self.link, LimitsActions) else None
        )
        if limit_s is not None:
            return limit_s
        if command.duration_s == UNIT_S:  # a step whose duration is not known
            return STEP_LIMIT_S
        return PATIENCE * command.duration_s / self.clock.speed

    def _send_dispatch(self, request: _Request) -> None:
        command = request.dispatch
        self.session.send({
            "do": "dispatch", "n": command.number, "agent": command.agent, "action": command.action,
            "args": list(command.args), "duration_s": command.duration_s / self.clock.speed,
            "limit_s": request.limit_s,
        })  # fmt: skip

    def _cancel(self, number: int) -> None:
        request = self._requests[number]
        request.is_accepted, request.until_s = True, self.clock.real_s + ACCEPT_S
        request.n_tries = MAX_TRIES  # no answer to it leaves the outcome unknown
        self.session.send({"do": "cancel", "n": number})

    # Events.

    def next(self) -> tuple[Event, ...]:
        """Return the events of the next instant; none if nothing can happen any more."""
        while True:
            events = self._happened()
            if events:
                t = self.clock.now_s
                events = [replace(event, t=t) for event in events]
                events.append(replace(self.simulated.observation(), t=t))
                return tuple(sorted(events, key=lambda event: ev.RANK[type(event)]))
            if self.reports or self._is_idle():
                return ()
            self.session.wait(self._wait_s())

    def has_news(self, wait_s: float) -> bool:
        """Return whether something happens within a time, or people have reported something."""
        self._events = self._happened()
        if not self._events and not self.reports:
            self.session.wait(min(wait_s, self._wait_s()))
            self._events = self._happened()
        return bool(self._events or self.reports)

    def _link_events(self) -> list[Event]:
        return [event for message in self.session.messages() for event in self._take(message)]

    def _happened(self) -> list[Event]:
        """Return what has happened until now, at the link and on the simulated clock."""
        events, self._events = self._events, []
        events += self._link_events()
        while (due := self.simulated.next_s) is not None and due <= self.clock.now_s:
            events += self.simulated.next()
        for number, request in list(self._requests.items()):
            if self.clock.is_stopped:
                continue
            if self.clock.real_s >= request.deadline_s and not request.is_overdue:
                request.is_overdue = True
                events.append(ev.Overdue(self.clock.now_s, number))
            elif self.clock.real_s >= request.until_s:
                events += self._ask_again(number, request)
        return events

    def _is_idle(self) -> bool:
        if self.waits_for_people:
            return self.session.is_lost
        is_due = self.simulated.next_s is not None
        return not (self.clock.is_stopped or self._requests or is_due)

    def _wait_s(self) -> float:
        """Return for how many real seconds nothing can happen but a message."""
        times = [self._next_s(request) - self.clock.real_s for request in self._requests.values()]
        if self.simulated.next_s is not None:
            times.append(self.clock.real_until(self.simulated.next_s))
        return _LONG_S if self.clock.is_stopped else max(0.0, min([*times, _LONG_S]))

    def _next_s(self, request: _Request) -> float:
        """Return when something is due about an action, on the real clock."""
        return request.until_s if request.is_overdue else min(request.until_s, request.deadline_s)

    def _take(self, message: msg.LinkMessage) -> Iterable[Event]:
        match message:
            case msg.LinkEnded(why):
                return self._restart(why)
            case msg.StopPressed(why):
                return self._stop(why)
            case msg.StopReleased():
                return self._release()
            case msg.FactsObserved(facts, absent):
                return self._observe(FactChange(self.clock.now_s, facts, absent))
            case msg.ValuesSensed():
                return self._sense(message)
            case msg.BadLine(reason):
                return self._fault(reason)
            case msg.LinkReady():
                return ()
            case msg.PersonSaid() | msg.PersonBegun() if self.hears_people:
                self.reports.append(message)
                return ()
            case msg.PersonSaid() | msg.PersonBegun():
                return self._fault("hrcplan collaborate hears people")
        return self._answer(message)

    def _answer(
        self, message: msg.Accepted | msg.Rejected | msg.Feedback | msg.ActionEnded
    ) -> Iterable[Event]:
        """Take in what the link says about one action."""
        number = message.number
        request = self._requests.get(number)
        if request is None:
            return self._answer_late(message)
        match message:
            case msg.Rejected(_, why):
                text = f"the robot refuses {request.dispatch}" + (f": {why}" if why else "")
                return [*self._end(number, ev.FAILED), self._notice("robot-refuses", text)]
            case msg.ActionEnded(_, outcome, why):
                return self._ended(number, outcome, why)
            case msg.Feedback(_, text):
                return self._feedback(request, text)
        if not request.is_accepted:
            request.is_accepted, request.until_s = True, float("inf")
        return ()

    def _answer_late(
        self, message: msg.Accepted | msg.Rejected | msg.Feedback | msg.ActionEnded
    ) -> Iterable[Event]:
        """Take in what the link says about an action that has ended for us."""
        number = message.number
        if number not in self._outcomes:
            return self._fault(f"it speaks of action {number}, which was never dispatched")
        is_done = isinstance(message, msg.ActionEnded) and message.outcome == ev.DONE
        if is_done and self._outcomes[number] != ev.DONE:
            text = f"action {number} counts as {self._outcomes[number]}, and was done late"
            return [self._notice("robot", text), *self._look()]
        return ()

    def _ended(self, number: int, outcome: str, why: str) -> Iterable[Event]:
        dispatch = self._requests[number].dispatch
        if outcome == ev.UNKNOWN:
            return self._unknown(number, why or "the robot does not know")
        events = self._end(number, outcome)
        if why and outcome != ev.DONE:
            events = [*events, self._notice("robot", f"{dispatch}: {why}")]
        return events

    def _feedback(self, request: _Request, text: str) -> Iterable[Event]:
        request.is_accepted, request.until_s = True, float("inf")
        if not text or self.clock.real_s < request.feedback_s + _FEEDBACK_S:
            return ()
        request.feedback_s = self.clock.real_s
        return [self._notice("robot", f"{request.dispatch}: {text}")]

    def _end(self, number: int, outcome: str) -> Sequence[Event]:
        """End an action; one that was too late has ended for the monitor already."""
        request = self._requests.pop(number, None)
        self._outcomes[number] = outcome
        events = self.simulated.end_action(self.clock.now_s, number, outcome)
        return () if request is not None and request.is_overdue else events

    def _ask_again(self, number: int, request: _Request) -> Iterable[Event]:
        """Ask for an action again that was not accepted; give it up after some tries."""
        if request.n_tries >= MAX_TRIES:
            if not request.is_accepted:
                self.session.send({"do": "cancel", "n": number})
            return self._unknown(number, "the robot does not answer")
        request.n_tries += 1
        request.until_s = self.clock.real_s + ACCEPT_S
        self._send_dispatch(request)
        return ()

    def _unknown(self, number: int, why: str) -> Iterable[Event]:
        """End an action with an unknown outcome, and ask the link what it observes."""
        text = f"{self._requests[number].dispatch}: {why}"
        return [*self._end(number, ev.UNKNOWN), self._notice("robot", text), *self._look()]

    def _look(self) -> Iterable[Event]:
        """Ask the link what it observes, and wait a moment for the answer."""
        seen = self.session.observe(ACCEPT_S)
        return () if seen is None else self._take(seen)

    # What is sensed.

    def _observe(self, change: FactChange) -> Iterable[Event]:
        try:
            checked_changes([change], self.model)
        except UsageError as error:
            return self._fault(f"observed: {_with_hint(error)}")
        self.simulated.set_state(change.adds, change.deletes)
        return [self.simulated.observation()]

    def _sense(self, message: msg.ValuesSensed) -> Iterable[Event]:
        return [event for key, value in message.values.items()
                for event in self._sense_value(key, exact(repr(value)))]  # fmt: skip

    def _sense_value(self, key: FluentKey, value: Number) -> Iterable[Event]:
        t = self.clock.now_s
        try:
            checked_changes([StateChange(t, {key: value})], self.model)
        except UsageError as error:
            return self._fault(f"sensed: {_with_hint(error)}")
        if key in self.model.agents.low:
            self.simulated.values[key] = value
            return [ev.Sensed(t, {key: value})]
        self.simulated.set_state(frozenset(), frozenset(), {key: value})
        return [self.simulated.observation()]

    # Emergency stop.

    def _stop(self, why: str) -> Iterable[Event]:
        if self.clock.is_stopped:
            return ()
        self.clock.stop()
        for number in self._requests:
            self.session.send({"do": "cancel", "n": number})
        text = "emergency stop" + (f": {why}" if why else "")
        events: list[Event] = [self._notice("emergency-stop", text)]
        for number in self.simulated.running:
            events += self._end(number, ev.CANCELLED)
        return events

    def _release(self) -> Iterable[Event]:
        if not self.clock.is_stopped:
            return ()
        self.clock.go_on()
        commands, self._waiting = self._waiting, []
        for command in commands:
            self.do(command)
        return [self._notice("emergency-stop", "the emergency stop is released")]

    # Faults of the link.

    def _restart(self, why: str) -> Iterable[Event]:
        """Start a link again that has ended; what was under way has an unknown outcome."""
        events: list[Event] = [self._notice("robot", f"the robot's program ended: {why}")]
        for number in list(self._requests):
            events += self._end(number, ev.UNKNOWN)
        fault = self.session.restart()
        if fault is not None:
            return [*events, ev.StopAsked(self.clock.now_s, f"the robot is lost: {fault}")]
        return [*events, self._notice("robot", "the robot's program was started again"),
                *self._look()]  # fmt: skip

    def _fault(self, reason: str) -> Iterable[Event]:
        self._n_faults += 1
        if self._n_faults > MAX_FAULTS:
            return ()
        text = f"the robot's program: {reason}"
        if self._n_faults == MAX_FAULTS:
            text += " (further faults are not reported)"
        return [self._notice("bad-message", text)]

    def _notice(self, code: str, message: str) -> ev.Noticed:
        return ev.Noticed(self.clock.now_s, code, message)


def _with_hint(error: UsageError) -> str:
    return f"{error.message} ({error.hint})" if error.hint else error.message
