"""What the actions of a plan wait for: a plan's times are a forecast, its order is binding.

Two actions keep their order if they interfere or share an agent; nothing else is kept, so an
action begins as soon as what it waits for has happened, early or late.
"""

from __future__ import annotations

from collections.abc import Callable, Set
from dataclasses import dataclass, replace

from hrcplan.core.numbers import Number
from hrcplan.pddl.interference import clash
from hrcplan.pddl.model import Problem
from hrcplan.planners.lanes import whole_access
from hrcplan.plans import EPSILON_S, Plan, PlannedAction, occupied


@dataclass(frozen=True, slots=True)
class Wait:
    """An action waits for the end of another, or for a time after its start."""

    index: int
    for_end: bool
    offset_s: Number = 0


Waits = tuple[tuple[Wait, ...], ...]


def waits(problem: Problem, plan: Plan) -> Waits:
    r"""Return what each action of a schedule waits for.

    >>> from hrcplan.pddl.inputs import read
    >>> from hrcplan.plans import parse_plan
    >>> plan = parse_plan("0: (move human wp1 wp4) [50]\n60: (grasp human blue wp4) [50]")
    >>> waits(read("transport", "two-boxes"), plan)[1]
    (Wait(index=0, for_end=True, offset_s=0),)
    """
    touches = [whole_access(problem, action) for action in plan.actions]
    busy = [occupied(action, problem) for action in plan.actions]

    def must_wait(i: int, j: int) -> bool:
        return bool(busy[i] & busy[j]) or clash(touches[i], touches[j]) is not None

    return tuple(_waits_of(i, plan.actions, must_wait) for i in range(len(plan.actions)))


def _waits_of(
    i: int, actions: tuple[PlannedAction, ...], must_wait: Callable[[int, int], bool]
) -> tuple[Wait, ...]:
    start = actions[i].start_s or 0
    waits = []
    for j in range(i):  # plans are sorted by start
        if must_wait(j, i):
            begin, end = actions[j].start_s or 0, actions[j].end_s or 0
            over = end <= start
            waits.append(Wait(j, over, 0 if over else start - begin))
    return tuple(waits)


def rest_of(plan: Plan, order: Waits, past: Set[int], is_temporal: bool) -> Plan:
    """Return what is left of a plan, started now and as early as its order allows."""
    gap: Number = EPSILON_S if is_temporal else 0
    starts: dict[int, Number] = {}
    for i in range(len(plan.actions)):
        if i not in past:
            starts[i] = max((_earliest(w, starts, plan, gap) for w in order[i]), default=0)
    rest = (replace(plan.actions[i], start_s=start) for i, start in starts.items())
    return Plan(tuple(sorted(rest, key=lambda a: a.start_s or 0)))


def _earliest(wait: Wait, starts: dict[int, Number], plan: Plan, gap: Number) -> Number:
    if wait.index not in starts:
        return 0
    begin = starts[wait.index]
    if wait.for_end:
        return begin + (plan.actions[wait.index].duration_s or 0) + gap
    return begin + wait.offset_s
