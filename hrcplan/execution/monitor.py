"""The monitor: from what has happened to what is to be done. Pure, so that it can be replayed.

``Monitor.step(run, event)`` returns the next run and commands. The driver (simulation, terminal,
robot link) reports events and carries commands out. Nothing here waits, reads a clock, draws a
random number or calls a planner.

The monitor has two halves. ``observe.py`` updates what is believed: outcomes, observed states and
sensed values. ``decide.py`` chooses commands, when an instant has settled or a plan has arrived.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import assert_never

from hrcplan.agents import Profile
from hrcplan.execution import events as ev
from hrcplan.execution.decide import Decider
from hrcplan.execution.events import Event
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.observe import Observer
from hrcplan.execution.run import Run, RunStep


@dataclass(frozen=True)
class Monitor:
    """The monitor of one problem and one profile; ``sensing`` false ignores sensed values."""

    model: ExecutionModel
    profile: Profile
    sensing: bool = True
    observer: Observer = field(init=False, repr=False)
    decider: Decider = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Make the two halves."""
        object.__setattr__(self, "observer", Observer(self.model, self.sensing))
        object.__setattr__(self, "decider", Decider(self.model, self.profile))

    def begin(self) -> Run:
        """Return a run at time 0, before its first plan."""
        memory = self.profile.begin(self.model.agents)
        return Run(self.model.actions.initial(), memory=memory)

    def step(self, run: Run, event: Event) -> RunStep:
        """Return the run after an event, and the commands that follow from it, in order.

        A run that is over does not change.
        """
        if run.is_over:
            return run, ()
        run = replace(run, t=max(run.t, event.t))
        match event:
            case ev.Ended():
                return self.observer.outcome(run, event)
            case ev.Overdue():
                return self.observer.overdue(run, event)
            case ev.Observed():
                return self.observer.state(run, event), ()
            case ev.Sensed():
                return self.observer.sensed_values(run, event)
            case ev.Happened():
                return self.observer.timed_events(run, event.number + 1), ()
            case ev.Settled():
                run = self.observer.timed_events(run, self.model.timed.n_past(run.t))
                return self.decider.decide(self.observer.compare_states(run))
            case ev.Planned():
                return self.decider.consider_plan(run, event)
            case ev.Noticed(_, code, message):
                return run, (ev.Tell(run.t, code, message),)
            case ev.StopAsked():
                return self.decider.finish(run, ev.STOPPED, event.why)
            case _:
                assert_never(event)
