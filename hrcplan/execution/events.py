"""What can happen to the monitor (events) and what it asks for (commands), as values.

Times are seconds on the world's clock. Events closer than ``INSTANT_S`` are one instant; within
it they come in the order of ``RANK``, and ``Settled`` closes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hrcplan.core.numbers import Number
from hrcplan.pddl.model import Fact, FluentKey, fact_text
from hrcplan.plans import Plan, PlannedAction

INSTANT_S = 0.01

DONE, FAILED, CANCELLED, UNKNOWN = "done", "failed", "cancelled", "unknown"
OUTCOMES = (DONE, FAILED, CANCELLED, UNKNOWN)
CHANGE, FAILURE, DEVIATION = "change", "failure", "deviation"

GOAL, NO_PLAN, REPLAN_LIMIT, STOPPED = "goal reached", "no plan", "replan limit", "stopped"


@dataclass(frozen=True, slots=True)
class Ended:
    """A dispatched action ended: ``done``, ``failed`` or ``cancelled``.

    ``unknown``: the world cannot say whether it was done. It counts as failed, its effects are not
    assumed, and what is observed next says what is true.
    """

    t: float
    number: int
    outcome: str


@dataclass(frozen=True, slots=True)
class Overdue:
    """A dispatched action has not ended for far too long."""

    t: float
    number: int


@dataclass(frozen=True, slots=True)
class Observed:
    """The changing facts, and changing numbers, as they are now.

    ``absent``: facts of the problem that no action changes, and that do not hold any more.
    """

    t: float
    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number] | None = None
    absent: frozenset[Fact] = frozenset()


@dataclass(frozen=True, slots=True)
class Sensed:
    """Sensed agent state; any float may come in, the monitor rejects what makes no sense."""

    t: float
    values: Mapping[FluentKey, float | Number]


@dataclass(frozen=True, slots=True)
class Happened:
    """A timed initial literal of the problem has come about; ``text`` is what it says, as PDDL.

    ``number`` is its place among those of the problem, in order of time, from 0.
    """

    t: float
    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Settled:
    """Nothing more happens in this instant: now the monitor decides."""

    t: float


@dataclass(frozen=True, slots=True)
class Planned:
    """The answer to ``AskPlan``; no plan means that no planner has one, and ``note`` says why."""

    t: float
    plan: Plan | None
    metric: Number | None = None
    planner: str = ""
    note: str = ""
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Noticed:
    """Something that a world reports to the user, such as a robot that does not answer."""

    t: float
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class StopAsked:
    """The run is to end: a user asked for it, or nothing can happen any more."""

    t: float
    why: str


Event = Ended | Overdue | Observed | Sensed | Happened | Settled | Planned | StopAsked | Noticed
RANK: Mapping[type, int] = {Ended: 0, Overdue: 0, Happened: 0, Noticed: 0, Observed: 1, Sensed: 2,
                            Planned: 3, Settled: 4, StopAsked: 0}  # fmt: skip


@dataclass(frozen=True, slots=True)
class AskPlan:
    """Request for a plan from these facts and numbers, with these agent-state values.

    ``absent``: as in `Observed`. ``n_happened``: how many timed initial literals are past.
    """

    t: float
    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number]
    values: Mapping[FluentKey, Number]
    reasons: tuple[str, ...] = ()
    absent: frozenset[Fact] = frozenset()
    n_happened: int = 0


@dataclass(frozen=True, slots=True)
class Dispatch:
    """An agent is to begin an action now."""

    t: float
    number: int
    agent: str
    action: str
    args: tuple[str, ...]
    duration_s: float

    def __str__(self) -> str:
        return fact_text((self.action, *self.args))


@dataclass(frozen=True, slots=True)
class Cancel:
    """A running action is to be broken off."""

    t: float
    number: int


@dataclass(frozen=True, slots=True)
class Wake:
    """An action may begin at ``at_s`` and not before: the instant then has to settle."""

    t: float
    at_s: float


@dataclass(frozen=True, slots=True)
class Adopt:
    """From now on this plan is followed; views and robot links can show it."""

    t: float
    plan: Plan
    why: str


@dataclass(frozen=True, slots=True)
class Tell:
    """Something to know: a rejected value, an unknown action, a confirmed plan."""

    t: float
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Finish:
    """The run is over and every agent stops."""

    t: float
    ending: str
    why: str = ""


Command = AskPlan | Dispatch | Cancel | Wake | Adopt | Tell | Finish


def planned_action(dispatch: Dispatch) -> PlannedAction:
    """Return the action of a dispatch, without times."""
    return PlannedAction(dispatch.action, dispatch.args)
