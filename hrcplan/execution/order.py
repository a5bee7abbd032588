"""What the actions of a plan wait for: a plan's times are a forecast, its order is binding.

Two actions keep their order if they interfere or share an agent; nothing else is kept, so an
action begins as soon as what it waits for has happened, early or late. An action that interferes
with a timed initial literal does not begin before it, if it comes first in the plan; if it comes
while the action runs, the action does not begin before its planned start.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, replace

from hrcplan.core.numbers import Number
from hrcplan.execution.timed import change_access
from hrcplan.pddl.interference import depends
from hrcplan.pddl.model import Problem, TimedChange
from hrcplan.planners.lanes import whole_access
from hrcplan.plans import EPSILON_S, Plan, PlannedAction, occupied


@dataclass(frozen=True, slots=True)
class Wait:
    """An action waits for the end of another, or for a time after its start."""

    index: int
    for_end: bool
    offset_s: Number = 0


Waits = tuple[tuple[Wait, ...], ...]


@dataclass(frozen=True, slots=True)
class Hold:
    """An action waits for timed initial literals: how many are past then, and for a time."""

    n_happened: int
    not_before_s: float


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
        return bool(busy[i] & busy[j]) or depends(problem, touches[i], touches[j])

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


def holds_of(
    problem: Problem, plan: Plan, coming: Sequence[TimedChange], n_happened: int, t: float
) -> dict[int, Hold]:
    """Return which actions of a schedule wait for timed initial literals, by their place.

    Args:
        problem: The problem.
        plan: The schedule; it begins at ``t``.
        coming: The literals, with the time from ``t`` until they happen.
        n_happened: How many are past at ``t``.
        t: Seconds on the world's clock.
    """
    holds: dict[int, Hold] = {}
    accesses = [change_access(change) for change in coming]
    for i, action in enumerate(plan.actions) if coming else ():
        begin, end = action.start_s or 0, action.end_s or 0
        touches = whole_access(problem, action)
        for number, change in enumerate(coming):
            if change.time <= end and depends(problem, accesses[number], touches):
                is_first = change.time <= begin
                old = holds.get(i, Hold(0, 0.0))
                holds[i] = Hold(
                    n_happened + number + 1 if is_first else old.n_happened,
                    max(old.not_before_s, t + float(change.time if is_first else begin)),
                )
    return holds


def rest_of(
    plan: Plan, order: Waits, past: Set[int], is_temporal: bool,
    held_s: Mapping[int, Number] | None = None,
) -> Plan:  # fmt: skip
    """Return what is left of a plan, started now and as early as its order allows.

    Args:
        plan: The whole plan.
        order: What its actions wait for.
        past: The places of the actions that have ended.
        is_temporal: Whether actions that follow each other need a gap.
        held_s: For how long actions have to wait in any case, from now on, by their place.
    """
    gap: Number = EPSILON_S if is_temporal else 0
    starts: dict[int, Number] = {}
    for i in range(len(plan.actions)):
        if i not in past:
            held = (held_s or {}).get(i, 0)
            starts[i] = max((_earliest(w, starts, plan, gap) for w in order[i]), default=0)
            starts[i] = max(starts[i], held)
    rest = (replace(plan.actions[i], start_s=start) for i, start in starts.items())
    return Plan(tuple(sorted(rest, key=lambda a: a.start_s or 0)))


def _earliest(wait: Wait, starts: dict[int, Number], plan: Plan, gap: Number) -> Number:
    if wait.index not in starts:
        return 0
    begin = starts[wait.index]
    if wait.for_end:
        return begin + (plan.actions[wait.index].duration_s or 0) + gap
    return begin + wait.offset_s
