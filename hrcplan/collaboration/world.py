"""The world of a collaboration: actions take their time, and people act when they can."""

from __future__ import annotations

from dataclasses import replace

from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.persons import Person
from hrcplan.collaboration.run import CompanionPhase, CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.execution import events as ev
from hrcplan.execution.worlds.simulated import Nature, SimulatedWorld
from hrcplan.pddl.semantics import LiftedState


class SharedWorld:
    """A simulated world in which people act by themselves.

    Its clock stands still while a person who could act decides what to do. ``watch`` has to see
    every step of the companion, for people act on what has come of it.

    Args:
        setup: The collaboration.
        nature: What changes, and which actions fail.
        person: Acts for the people.
    """

    def __init__(self, setup: CollaborationSetup, nature: Nature, person: Person) -> None:
        self.setup, self.person = setup, person
        self._inner = SimulatedWorld(setup.model, nature)
        self._has_accidents = bool(nature.accidents)
        self._run: CompanionRun | None = None
        self._passed: set[str] = set()
        self._requests: dict[int, ev.Dispatch] = {}

    def begin(self) -> tuple[SharedEvent, ...]:
        """Return what is seen at time 0."""
        return self._seen(self._inner.begin())

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Take note of what has come of an event; a request that a person accepts begins."""
        self._run = run
        if isinstance(event, shared.Begun):
            words = (event.action, *event.args)
            for number, request in list(self._requests.items()):
                if (request.action, *request.args) == words:
                    self._inner.do(replace(self._requests.pop(number), t=run.t))

    def do(self, command: SharedCommand) -> None:
        """Begin or break off an action, or take note."""
        match command:
            case ev.Dispatch() if self._is_request(command):
                self._requests[command.number] = command
            case ev.Cancel(_, number) if number in self._requests:
                del self._requests[number]
            case shared.Correct(_, facts, numbers, absent):
                state = self.setup.model.actions.state(facts, numbers, absent)
                self._inner.state = LiftedState(state.facts, state.values)
            case ev.Dispatch() | ev.Cancel() | ev.Wake():
                self._inner.do(command)

    def _is_request(self, dispatch: ev.Dispatch) -> bool:
        """Return whether a plan asks a live person for an action, which they may do or not."""
        run = self._run
        action = None if run is None else run.run.running_action(dispatch.number)
        asks = action is not None and action.index is not None
        return asks and self.person.is_live and dispatch.agent in self.setup.people

    def next(self) -> tuple[SharedEvent, ...]:
        """Return what happens next: what people do if they can act, else what ends first."""
        assert self._run is not None
        agents = self._who_can_act(self._run)
        acts = self.person.act(self._run, agents) if agents else ()
        if acts:
            self._passed.update(a.agent for a in acts if isinstance(a, shared.Passed))
            return acts
        self._passed.update(agents)
        if agents and self._who_can_act(self._run):
            return self.next()  # another person can act
        events = self._seen(self._inner.next())
        self._passed.clear()
        if not events and self.person.is_live:
            return self.person.act(self._run, self.setup.people)
        return events

    def _who_can_act(self, run: CompanionRun) -> tuple[str, ...]:
        if run.question is not None:
            return self.setup.people
        if run.phase is not CompanionPhase.LISTENING:
            return ()
        if self.setup.has_one_goal:
            holders = {request.agent for request in self._requests.values()}
            people = self.setup.people if self.person.is_live else ()
            return tuple(a for a in people if a not in self._passed
                         and (a in holders or not run.is_busy(a)))  # fmt: skip
        if self.setup.pace == TURNS:
            slot = self.setup.slots[run.slot]
            is_robots = self.setup.robots.issuperset(slot)
            return () if run.running or run.has_acted or is_robots else slot
        idle = (a for a in self.setup.people if a not in self._passed and not run.is_busy(a))
        first = next(idle, None)
        return () if first is None else (first,)

    def _seen(self, events: tuple[ev.Event, ...]) -> tuple[SharedEvent, ...]:
        """Return events without observations of states that follow from the actions."""
        if self._has_accidents:
            return events
        return tuple(event for event in events if not isinstance(event, ev.Observed))
