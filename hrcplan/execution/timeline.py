"""What happened in a run, collected while it runs: for lanes, Gantt charts and JSON."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from hrcplan.core.numbers import exact
from hrcplan.execution import events as ev
from hrcplan.execution.events import Command, Event
from hrcplan.execution.run import Run
from hrcplan.plans import Plan, PlannedAction, format_plan


@dataclass(frozen=True, slots=True)
class Bar:
    """One carried-out action; ``outcome`` is "" and ``end_s`` its forecast while it runs."""

    number: int
    agent: str
    action: str
    args: tuple[str, ...]
    start_s: float
    end_s: float
    outcome: str = ""


@dataclass(frozen=True, slots=True)
class Adopted:
    """A plan that was followed from a time on; ``why`` is "" for the first plan."""

    t: float
    plan: Plan
    why: str


@dataclass
class Timeline:
    """Give its ``watch`` to a driver, and read what happened from it."""

    bars: dict[int, Bar] = field(default_factory=dict)
    plans: list[Adopted] = field(default_factory=list)
    messages: list[ev.Tell] = field(default_factory=list)
    literals: list[ev.Happened] = field(default_factory=list)

    def watch(self, run: Run, event: Event, commands: tuple[Command, ...]) -> None:
        """Take in one step of the monitor."""
        if isinstance(event, ev.Ended):
            self._close(event.number, run.t, event.outcome)
        if isinstance(event, ev.Happened):
            self.literals.append(event)
        for command in commands:
            match command:
                case ev.Dispatch():
                    self._open(command)
                case ev.Adopt(t, plan, why):
                    self.plans.append(Adopted(t, plan, why))
                case ev.Cancel(t, number) if isinstance(event, ev.Overdue):
                    self._close(number, t, ev.FAILED)
                case ev.Tell():
                    self.messages.append(command)

    def _open(self, command: ev.Dispatch) -> None:
        end_s = command.t + command.duration_s
        self.bars[command.number] = Bar(
            command.number, command.agent, command.action, command.args, command.t, end_s
        )

    def _close(self, number: int, t: float, outcome: str) -> None:
        bar = self.bars.get(number)
        if bar is not None and not bar.outcome:
            self.bars[number] = Bar(
                number, bar.agent, bar.action, bar.args, bar.start_s, t, outcome
            )

    def as_plan(self) -> tuple[Plan, frozenset[int]]:
        """Return what was done as a schedule, and the places of the actions that have failed."""
        bars = [bar for bar in self.bars.values() if bar.end_s > bar.start_s]
        actions = tuple(
            PlannedAction(b.action, b.args, exact(b.start_s), exact(b.end_s - b.start_s))
            for b in bars
        )
        return Plan(actions), frozenset(i for i, b in enumerate(bars) if b.outcome == ev.FAILED)

    def to_json(self) -> dict[str, Any]:
        """Return actions, plans, messages and timed initial literals as a JSON object."""
        return {
            "actions": [
                {
                    "agent": bar.agent or None, "action": bar.action, "args": list(bar.args),
                    "start_s": bar.start_s, "end_s": bar.end_s, "outcome": bar.outcome or None,
                }
                for bar in self.bars.values()
            ],
            "plans": [
                {"t": p.t, "why": p.why or None, "steps": format_plan(p.plan).splitlines()}
                for p in self.plans
            ],
            "messages": [{"t": m.t, "code": m.code, "message": m.message} for m in self.messages],
            "literals": [{"t": happened.t, "literal": happened.text} for happened in self.literals],
        }  # fmt: skip
