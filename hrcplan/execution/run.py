"""The state of a run: what is believed, what is running, what was counted. Values only."""

from __future__ import annotations

import enum
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from hrcplan.agents.memory import Memory
from hrcplan.agents.profile import Experience
from hrcplan.core.numbers import Number
from hrcplan.execution.action_model import ActionModel, BoundAction, StartEffects
from hrcplan.execution.events import Command, Dispatch
from hrcplan.execution.order import Hold, Waits
from hrcplan.pddl.model import FluentKey
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import Plan


class Phase(enum.Enum):
    """Where a run is: ``draining`` lets running actions end before a replan."""

    IDLE = "idle"
    PLANNING = "planning"
    EXECUTING = "executing"
    DRAINING = "draining"
    OVER = "over"


@dataclass(frozen=True, slots=True)
class RunningAction:
    """One action that has begun and has not ended; ``index`` is its place in the plan, if any."""

    number: int
    index: int | None
    step: BoundAction
    begun_s: float
    duration_s: float
    start_effects: StartEffects


@dataclass(frozen=True, slots=True)
class FollowedPlan:
    """A plan that is being followed: which of its actions have begun, and which have ended.

    ``holds``: what actions wait for besides other actions (see ``order.py``), by their place.
    """

    plan: Plan
    order: Waits
    holds: Mapping[int, Hold] = field(default_factory=dict)
    begun: Mapping[int, float] = field(default_factory=dict)
    ended: frozenset[int] = frozenset()

    def ready_s(self, index: int) -> float | None:
        """Return from when an action may begin; None while it waits for something unfinished."""
        earliest = self.holds[index].not_before_s if index in self.holds else 0.0
        for wait in self.order[index]:
            if wait.for_end:
                if wait.index not in self.ended:
                    return None
            elif wait.index not in self.begun:
                return None
            else:
                earliest = max(earliest, self.begun[wait.index] + float(wait.offset_s))
        return earliest


@dataclass(frozen=True, slots=True)
class Reason:
    """Why a replan is due: ``change``, ``failure`` or ``deviation``, and what happened."""

    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class RunCounts:
    """What was counted so far: replans by reason, and actions by outcome and agent."""

    replans: Mapping[str, int] = field(default_factory=dict)
    plans_confirmed: int = 0
    assigned: Mapping[str, int] = field(default_factory=dict)
    done: Mapping[str, int] = field(default_factory=dict)
    failed: Mapping[str, int] = field(default_factory=dict)
    cancelled: Mapping[str, int] = field(default_factory=dict)
    interactions: int = 0
    last_end_s: float = 0.0

    @property
    def n_replans(self) -> int:
        """Return all replans, for whatever reason."""
        return sum(self.replans.values())


def plus(counts: Mapping[str, int], names: Iterable[str]) -> Mapping[str, int]:
    """Return counts with one more for each name.

    >>> plus({"a": 1}, ["a", "b"])
    {'a': 2, 'b': 1}
    """
    total = dict(counts)
    for name in names:
        total[name] = total.get(name, 0) + 1
    return total


@dataclass(frozen=True, slots=True)
class Run:
    """Everything the monitor knows; the next run follows from this one and one event.

    ``sensed_values``: the last valid value of each element. ``observation``: an observed state that
    was not yet compared with the expected ``state``. ``n_reasons_asked``: how many ``reasons`` the
    planner was asked with. ``confirmation_s``: when the current plan was confirmed last.
    ``n_happened``: how many timed initial literals of the problem are past.
    """

    state: LiftedState
    phase: Phase = Phase.IDLE
    t: float = 0.0
    sensed_values: Mapping[FluentKey, Number] = field(default_factory=dict)
    memory: Experience = field(default_factory=Memory)
    current_plan: FollowedPlan | None = None
    running: tuple[RunningAction, ...] = ()
    n_dispatched: int = 0
    reasons: tuple[Reason, ...] = ()
    observation: LiftedState | None = None
    n_reasons_asked: int = 0
    confirmation_s: float | None = None
    n_happened: int = 0
    counts: RunCounts = field(default_factory=RunCounts)
    ending: str | None = None
    why: str = ""

    @property
    def is_over(self) -> bool:
        """Whether the run has ended."""
        return self.phase is Phase.OVER

    def running_action(self, number: int) -> RunningAction | None:
        """Return the running action with this dispatch number."""
        return next((r for r in self.running if r.number == number), None)

    def without(self, action: RunningAction) -> tuple[RunningAction, ...]:
        """Return the running actions but one."""
        return tuple(r for r in self.running if r.number != action.number)

    def with_sensed(self, key: FluentKey, value: Number) -> Run:
        """Return this run with another value of an element; old failures do not count for it."""
        values = {**self.sensed_values, key: value}
        return replace(self, sensed_values=values, memory=self.memory.sensed(key))

    def with_reason(self, kind: str, text: str) -> Run:
        """Return this run with one more reason to replan."""
        return replace(self, reasons=(*self.reasons, Reason(kind, text)))

    def __repr__(self) -> str:
        counts = self.counts
        n_done, n_failed = (sum(c.values()) for c in (counts.done, counts.failed))
        phase = self.ending or self.phase.value
        actions = f"{n_done} actions done, {n_failed} failed"
        return f"Run({phase}, t={self.t:g}, {actions}, {counts.n_replans} replans)"


def begin_action(
    actions: ActionModel, run: Run, step: BoundAction, duration: Number, lasts_s: float,
    index: int | None = None,
) -> tuple[Run, Dispatch]:  # fmt: skip
    """Return the run when an action has begun, and the command that says so.

    Args:
        actions: How actions begin.
        run: The run before.
        step: The action.
        duration: Its duration in the PDDL; 0 for a step without duration.
        lasts_s: After how many seconds it is expected to end.
        index: Its place in the plan; None if no plan has it.
    """
    state, start_effects = actions.begin(run.state, step, duration)
    action = RunningAction(run.n_dispatched, index, step, run.t, lasts_s, start_effects)
    run = replace(
        run, state=state, running=(*run.running, action), n_dispatched=run.n_dispatched + 1
    )
    args = tuple(step.binding.values())
    return run, Dispatch(run.t, action.number, step.agent, step.schema.name, args, lasts_s)


RunStep = tuple[Run, tuple[Command, ...]]
"""What one event leads to: the next run, and commands in order."""
