"""What can happen to the monitor (events) and what it asks for (commands), as values and as JSON.

Times are seconds on the world's clock. Events closer than ``INSTANT_S`` are one instant; within
it they come in the order of ``RANK``, and ``Settled`` closes it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any

from hrcplan.errors import PlanFormatError
from hrcplan.pddl.model import Fact, FluentKey, Number, fact_text
from hrcplan.plans import Plan, PlannedAction, format_plan, parse_plan

INSTANT_S = 0.01

DONE, FAILED, CANCELLED = "done", "failed", "cancelled"
OUTCOMES = (DONE, FAILED, CANCELLED)
CHANGE, FAILURE, DEVIATION = "change", "failure", "deviation"
REASONS = (CHANGE, FAILURE, DEVIATION)

GOAL, NO_PLAN, REPLAN_LIMIT, STOPPED = "goal reached", "no plan", "replan limit", "stopped"


@dataclass(frozen=True, slots=True)
class Ended:
    """A dispatched action ended: ``done``, ``failed`` or ``cancelled``."""

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
    """The changing facts, and changing numbers, as they are now."""

    t: float
    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number] | None = None


@dataclass(frozen=True, slots=True)
class Sensed:
    """Sensed agent state; any float may come in, the monitor rejects what makes no sense."""

    t: float
    values: Mapping[FluentKey, float | Number]


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
class StopAsked:
    """Somebody wants the run to end, or nothing can happen any more."""

    t: float
    why: str


Event = Ended | Overdue | Observed | Sensed | Settled | Planned | StopAsked
RANK: Mapping[type, int] = {Ended: 0, Overdue: 0, Observed: 1, Sensed: 2, Planned: 3, Settled: 4,
                            StopAsked: 0}  # fmt: skip


@dataclass(frozen=True, slots=True)
class AskPlan:
    """Wanted: a plan from these facts and numbers, with these agent-state values."""

    t: float
    facts: frozenset[Fact]
    numbers: Mapping[FluentKey, Number]
    values: Mapping[FluentKey, Number]
    reasons: tuple[str, ...] = ()


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
    """From now on this plan is followed: told, so that faces and links can show it."""

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

_KINDS: Mapping[str, type] = {
    kind.__name__.lower(): kind
    for kind in (Ended, Overdue, Observed, Sensed, Settled, Planned, StopAsked,
                 AskPlan, Dispatch, Cancel, Wake, Adopt, Tell, Finish)
}  # fmt: skip


def to_json(item: Event | Command) -> dict[str, Any]:
    """Return an event or command as a JSON object; ``kind`` comes first.

    >>> to_json(Ended(50.0, 1, "done"))
    {'kind': 'ended', 't': 50.0, 'number': 1, 'outcome': 'done'}
    """
    found: dict[str, Any] = {"kind": type(item).__name__.lower()}
    for field in fields(item):
        found[field.name] = _encoded(getattr(item, field.name))
    return found


def from_json(document: Mapping[str, Any]) -> Any:
    """Return the event or command that ``to_json`` made a JSON object of.

    Raises:
        ValueError: if it is none.
    """
    try:
        kind = _KINDS[document["kind"]]
        found = kind(**{k: _decoded(k, v) for k, v in document.items() if k != "kind"})
        if found.t >= 0 and isinstance(getattr(found, "number", 0), int):
            return found
        raise ValueError(f"no event: {document}")
    except (KeyError, TypeError, AttributeError, PlanFormatError) as error:
        raise ValueError(f"no event: {error}") from None


def _encoded(value: Any) -> Any:
    if isinstance(value, Plan):
        return format_plan(value).splitlines()
    if isinstance(value, frozenset):
        return sorted(" ".join(fact) for fact in value)
    if isinstance(value, Mapping):
        return {" ".join(key): _number(number) for key, number in value.items()}
    if isinstance(value, tuple):
        return list(value)
    return _number(value) if isinstance(value, Fraction) else value


def _number(value: float | Number) -> float | int | str:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)  # JSON knows no such numbers
    return value if isinstance(value, (int, float)) else float(value)


def exact(number: float | str) -> float | Number:
    """Return a number of a journal as it was before: what was exact is exact again.

    >>> exact(58.00051), exact("nan")
    (Fraction(5800051, 100000), nan)
    """
    if isinstance(number, str):
        return float(number)
    if isinstance(number, int):
        return number
    value = Fraction(repr(number))
    return int(value) if value.denominator == 1 else value


def _facts(words: list[str]) -> frozenset[Fact]:
    return frozenset(tuple(word.split(" ")) for word in words)


def _numbers(table: Mapping[str, float] | None) -> dict[FluentKey, Any] | None:
    if table is None:
        return None
    return {tuple(key.split(" ")): exact(number) for key, number in table.items()}


def _plan(lines: list[str] | None) -> Plan | None:
    return None if lines is None else parse_plan("\n".join(lines))


def _decoded(name: str, value: Any) -> Any:
    match name:
        case "facts":
            return _facts(value)
        case "numbers" | "values":
            return _numbers(value)
        case "plan":
            return _plan(value)
        case "args" | "reasons":
            return tuple(value)
        case "metric":
            return None if value is None else exact(value)
    return value


def planned(dispatch: Dispatch) -> PlannedAction:
    """Return the action of a dispatch, without times."""
    return PlannedAction(dispatch.action, dispatch.args)
