"""From the order of decisions to a plan with times: gaps where happenings interfere."""

from __future__ import annotations

from fractions import Fraction
from math import ceil
from typing import NamedTuple

from hrcplan.core.numbers import Number, exact
from hrcplan.pddl.interference import Access, access, clash
from hrcplan.pddl.semantics import bind
from hrcplan.planners.exact.frame import StaticMasks
from hrcplan.planners.exact.search import WAIT
from hrcplan.plans import EPSILON_S, Plan, PlannedAction
from hrcplan.task import Task


class Accesses(NamedTuple):
    """What an action reads and writes: at its start, at its end, and altogether."""

    start: Access
    end: Access
    whole: Access


class Slot(NamedTuple):
    """An action of the plan: its ticks without gaps, its seconds with gaps, what it touches."""

    action: int
    start_tick: int
    end_tick: int
    start_s: Number
    end_s: Number
    touches: Accesses


def starts(path: str, frame: StaticMasks) -> list[tuple[int, int]]:
    """Return the actions of a path in order, each with the tick at which it starts."""
    schedule: list[tuple[int, int]] = []
    clock = 0
    for letter in path:
        if letter == WAIT:
            clock = min(end for a, t in schedule if (end := t + frame.ticks[a]) > clock)
        else:
            schedule.append((ord(letter), clock))
    return schedule


class Gaps:
    """Lays plans of one task out in time; what actions touch is remembered."""

    def __init__(self) -> None:
        self._accesses: dict[int, Accesses] = {}

    def plan(self, task: Task, path: str, frame: StaticMasks) -> Plan:
        """Return the plan of a path, every action as early as the gaps allow."""
        timeline: list[Slot] = []
        for action, tick in starts(path, frame):
            touches = self._touches(task, action)
            start = _earliest(touches, tick, timeline)
            end = start + printable(task.actions[action].duration or 0)
            last = tick + frame.ticks[action]
            timeline.append(Slot(action, tick, last, start, end, touches))
        timeline.sort(key=lambda p: (p.start_s, p.action))
        return Plan(tuple(_timed_action(task, p) for p in timeline))

    def _touches(self, task: Task, index: int) -> Accesses:
        if index not in self._accesses:
            action = task.actions[index]
            schema = task.problem.domain.action(action.name)
            binding = bind(schema, action.args, task.problem)
            assert not isinstance(binding, str)
            start, over, end = (
                access(task.problem, schema, binding, when) for when in ("start", "all", "end")
            )
            parts = zip(start, over, end, strict=True)
            self._accesses[index] = Accesses(start, end, Access(*(a | b | c for a, b, c in parts)))
        return self._accesses[index]


def _earliest(touches: Accesses, tick: int, timeline: list[Slot]) -> Number:
    """Return the earliest start, in seconds, after whatever of ``timeline`` it depends on."""
    start: Number = 0
    for other in timeline:
        if clash(other.touches.whole, touches.whole) is None:
            continue
        if other.end_tick <= tick:
            since, event = other.end_s, other.touches.end
        else:
            since, event = other.start_s, other.touches.start
        start = max(start, since + (EPSILON_S if clash(event, touches.start) else 0))
    for other in sorted(timeline, key=lambda p: p.end_s):
        # Starting after an end instead of just before it is always possible (see frame.py).
        near = -EPSILON_S < other.end_s - start < EPSILON_S
        if near and clash(other.touches.end, touches.start):
            start = other.end_s + EPSILON_S
    return start


def printable(seconds: Number) -> Number:
    """Return a duration as a plan can say it: nine decimals, rounded up.

    So the plan that is read again is the plan that was made, gaps included.

    >>> printable(50), printable(Fraction(1, 3))
    (50, Fraction(166666667, 500000000))
    """
    return exact(Fraction(ceil(seconds * 10**9), 10**9))


def _timed_action(task: Task, slot: Slot) -> PlannedAction:
    action = task.actions[slot.action]
    duration = slot.end_s - slot.start_s
    return PlannedAction(action.name, action.args, slot.start_s, duration)
