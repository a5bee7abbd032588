"""The world of a collaboration: actions take their time, and people act when they can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.persons import (
    Interruptible,
    Person,
    ReportedPerson,
    reported_words,
)
from hrcplan.collaboration.run import CompanionPhase, CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import UNIT_S
from hrcplan.execution.codec import exact_number
from hrcplan.execution.links import RobotLink
from hrcplan.execution.links.messages import PersonBegun
from hrcplan.execution.links.world import LinkWorld
from hrcplan.execution.run import Run, RunningAction
from hrcplan.execution.worlds.simulated import Nature, SimulatedWorld
from hrcplan.pddl.semantics import LiftedState


class SharedWorld:
    """A world in which people act by themselves.

    In a simulation the clock stands still while a person who could act decides what to do. With a
    robot it goes on, and what the robot does or senses interrupts the person's decision. ``watch``
    has to see every step of the companion, for people act on what has come of it.

    Args:
        setup: The collaboration.
        nature: What changes, and which actions fail.
        person: Acts for the people.
        robot: Carries the robots' actions out; None to simulate them.
        speed: With a robot: seconds of the run in a real second.
    """

    def __init__(
        self, setup: CollaborationSetup, nature: Nature, person: Person,
        robot: RobotLink | None = None, speed: float = 1.0,
    ) -> None:  # fmt: skip
        self.setup, self.person = setup, person
        self._inner: SimulatedWorld | LinkWorld
        if robot is None:
            self._inner = SimulatedWorld(setup.model, nature)
        else:
            self._inner = LinkWorld(setup.model, nature, robot, speed=speed)
            self._inner.hears_people = True
            self._inner.waits_for_people = isinstance(person, ReportedPerson)
            if isinstance(person, Interruptible):
                person.interrupt = self._inner.has_news
        self.keeps_deadlines = robot is not None
        self.is_repeating = False
        self._has_accidents = bool(nature.accidents)
        self._run: CompanionRun | None = None
        self._passed: set[str] = set()
        self._requests: dict[int, ev.Dispatch] = {}

    def resume(self, run: CompanionRun, new: Sequence[ev.Dispatch]) -> tuple[SharedEvent, ...]:
        """Go on in the middle of a collaboration with a robot (see `LinkWorld.resume`).

        What a plan asks a person to do is still asked for; nothing of it has begun.
        """
        assert isinstance(self._inner, LinkWorld)
        new = [command for command in new if command.number not in self._requests]
        begun = tuple(a for a in run.running if a.number not in self._requests)
        return self._seen(self._inner.resume(self._without_requests(run.run, begun), new))

    def _without_requests(self, run: Run, begun: tuple[RunningAction, ...]) -> Run:
        """Return a run in which nothing of what people are asked to do has begun."""
        state = run.state
        for action in reversed(run.running):
            if action not in begun:
                state = self.setup.model.actions.revert(state, action.start_effects)
        return replace(run, running=begun, state=state)

    def close(self) -> None:
        """Let go of the robot, if there is one."""
        if isinstance(self._inner, LinkWorld):
            self._inner.close()

    def begin(self) -> tuple[SharedEvent, ...]:
        """Return what is seen at time 0."""
        return self._seen(self._inner.begin())

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Take note of what has come of an event; a request that a person accepts begins."""
        self._run = run
        words = _begun_words(event)
        if words:
            for number, request in list(self._requests.items()):
                if (request.action, *request.args) == words:
                    self._inner_do(replace(self._requests.pop(number), t=run.t))

    def do(self, command: SharedCommand) -> None:
        """Begin or break off an action, or take note."""
        match command:
            case ev.Dispatch() if self._is_request(command):
                self._requests[command.number] = command
            case ev.Cancel(_, number) if number in self._requests:
                del self._requests[number]
            case shared.Correct() if self.is_repeating:
                pass
            case shared.Correct(_, facts, numbers, absent):
                state = self.setup.model.actions.state(facts, numbers, absent)
                self._inner.state = LiftedState(state.facts, state.values)
            case ev.Dispatch() | ev.Cancel() | ev.Wake() | ev.Finish():
                self._inner_do(command)

    def _inner_do(self, command: ev.Command) -> None:
        if not self.is_repeating:
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
        reports = self._reports(self._run)
        if reports:
            return reports
        agents = self._who_can_act(self._run)
        acts = self._acts(self._run, agents) if agents else ()
        if acts:
            self._passed.update(a.agent for a in acts if isinstance(a, shared.Passed))
            return acts
        self._passed.update(agents)
        if agents and self._run.question is None and self._who_can_act(self._run):
            return self.next()  # another person can act
        events = self._seen(self._inner.next())
        self._passed.clear()
        if not events:
            events = self._reports(self._run)
        if not events and self.person.is_live:
            return self._acts(self._run, self.setup.people) or self.next()
        return events or self._idle(self._run)

    def _idle(self, run: CompanionRun) -> tuple[SharedEvent, ...]:
        """Return that simulated people and robots stand still, where they need no turn to act."""
        takes_turns = self.setup.pace == TURNS or self.setup.has_one_goal
        if takes_turns or run.phase is not CompanionPhase.LISTENING or run.is_paused:
            return ()
        return (shared.Idle(run.t + UNIT_S, float(UNIT_S)),)

    def _acts(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[SharedEvent, ...]:
        """Return what people do, at the time at which they do it."""
        acts = self.person.act(run, agents)
        if not isinstance(self._inner, LinkWorld):
            return acts
        now_s = self._inner.clock.now_s
        return tuple(replace(act, t=max(act.t, now_s)) for act in acts)

    def _reports(self, run: CompanionRun) -> tuple[SharedEvent, ...]:
        """Return what people have said or begun, as the robot's program says."""
        if not isinstance(self._inner, LinkWorld) or not self._inner.reports:
            return ()
        report, t = self._inner.reports.popleft(), self._inner.clock.now_s
        if isinstance(report, PersonBegun):
            return (shared.Begun(t, report.agent, report.action, report.args),)
        return (reported_words(run, t, report),)

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
        if isinstance(self._inner, LinkWorld):
            return tuple(map(self._with_requests, events))
        if self._has_accidents:
            return events
        return tuple(event for event in events if not isinstance(event, ev.Observed))

    def _with_requests(self, event: ev.Event) -> SharedEvent:
        """Return an observation as if what a plan asks people to do had begun, as it counts so."""
        if not isinstance(event, ev.Observed) or not self._requests:
            return event
        model = self.setup.model.actions
        state = model.state(event.facts, event.numbers or {}, event.absent)
        for request in self._requests.values():
            step = model.step(ev.planned_action(request))
            assert step is not None
            duration = exact_number(request.duration_s)
            state, _ = model.begin(state, step, duration)  # type: ignore[arg-type]
        facts, absent = model.changing(state), model.absent(state)
        return ev.Observed(event.t, facts, state.values, absent)


def _begun_words(event: SharedEvent) -> tuple[str, ...]:
    """Return the action that a person has begun by an event, however it was said."""
    match event:
        case shared.Begun(_, _, action, args):
            return (action, *args)
        case shared.Read(_, shared.ACT, (option, *_)) | shared.Answered(_, option):
            return tuple(option.strip("()").split())
    return ()
