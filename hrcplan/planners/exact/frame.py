"""The class of tasks that ``exact`` takes, action by action, and those actions as bit masks.

Together with ``overlap.py`` this makes three things true on which the proof rests:

* ordering the actions of any schedule by their starts gives a sequential plan to the same state;
* letting an action end earlier never hurts, so starts at time 0 and at completions are enough;
* what happens at an instant may be ordered: completions first, then starts.

Outside the class concurrency can be required (Cushing et al., IJCAI 2007), and no sequential
reading bounds what a schedule costs.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import gcd, inf, lcm

from hrcplan.core.bits import common, holders, positions, union
from hrcplan.core.clock import check_time
from hrcplan.core.numbers import Number, number_text
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, TRUE, fact_text
from hrcplan.search.reachable_pairs import DurativeMasks
from hrcplan.task import GroundAction, Task
from hrcplan.task.conditions import Test

MAX_ACTIONS = 2000
HINT = "kairos plans such tasks, without a proof"

RunningActions = tuple[tuple[int, int], ...]
"""Ticks that are left and action, of each running action; the next to end comes first."""


@dataclass(frozen=True)
class StaticMasks(DurativeMasks):
    """What does not depend on costs: tuples with one entry per ground action.

    ``tests`` are conditions at start and over all, ``over`` those over all; ``ticks`` are
    durations in units of ``tick_s`` seconds. ``shuns`` are facts that must be false in some
    alternative of the tests, ``over_shuns`` in some of those over all.
    ``late`` are facts that are deleted at the end. ``overlap.py`` checks that no action looks at
    them before, so they are among the ``deletes`` of the start, too.
    ``dependent`` holds, as bits, the actions whose starts do not commute with this one's.
    """

    agents: tuple[str, ...]
    tests: tuple[tuple[Test, ...], ...]
    over: tuple[tuple[Test, ...], ...]
    ticks: tuple[int, ...]
    tick_s: Fraction
    shuns: tuple[int, ...]
    over_shuns: tuple[int, ...]
    dependent: tuple[int, ...]


def frame(task: Task, deadline: float = inf) -> StaticMasks:
    """Return the masks of a task.

    Raises:
        UnsupportedError: naming the first action outside the class, and why it is.
        LimitError: if there are too many actions to compare in pairs, or at the deadline.
    """
    check_schemas(task)
    if len(task.actions) > MAX_ACTIONS:
        raise LimitError(f"more than {MAX_ACTIONS:,} ground actions")
    for action in task.actions:
        check_time(deadline, "while looking at the actions")
        _check(task, action)
    tests = tuple(action.tests for action in task.actions)
    over = tuple(tuple(t for t in a.over if t != (0, 0)) for a in task.actions)
    late = tuple(union(c.deletes for c in a.at_end) for a in task.actions)
    deletes = tuple(union(c.deletes for c in (*a.at_start, *a.at_end)) for a in task.actions)
    tick_s = _tick([a.duration or 1 for a in task.actions])
    return StaticMasks(
        n_facts=len(task.facts),
        agents=tuple(a.agent or "" for a in task.actions),
        tests=tests,
        over=over,
        deletes=deletes,
        late=late,
        adds=tuple(union(c.adds for c in a.at_end) for a in task.actions),
        ticks=tuple(int((a.duration or 1) / tick_s) for a in task.actions),
        tick_s=tick_s,
        needs=tuple(common(v for _, v in t) for t in tests),
        shuns=tuple(union(m & ~v for m, v in t) for t in tests),
        avoids=tuple(common(m & ~v for m, v in t) for t in tests),
        over_needs=tuple(common(v for _, v in t) if t else 0 for t in over),
        over_shuns=tuple(union(m & ~v for m, v in t) for t in over),
        dependent=_dependent(len(task.facts), tests, over, deletes),
    )


def _tick(durations: list[Number]) -> Fraction:
    """Return the greatest number of which every duration is a multiple."""
    exact = [Fraction(d) for d in durations] or [Fraction(1)]
    scale = lcm(*(d.denominator for d in exact))
    return Fraction(gcd(*(int(d * scale) for d in exact)), scale)


def _dependent(
    n_facts: int, tests: tuple[tuple[Test, ...], ...], over: tuple[tuple[Test, ...], ...],
    deletes: tuple[int, ...],
) -> tuple[int, ...]:  # fmt: skip
    reads = [union(m for m, _ in (*t, *o)) for t, o in zip(tests, over, strict=True)]
    readers, deleters = holders(reads, n_facts), holders(deletes, n_facts)
    return tuple(
        union(readers[p] for p in positions(d)) | union(deleters[p] for p in positions(r))
        for d, r in zip(deletes, reads, strict=True)
    )


def check_schemas(task: Task) -> None:
    """Raise unless every action lasts, and has its conditions and costs in time.

    Ground actions are not enough: one with an impossible condition at its end is not among them,
    although another action might make it possible meanwhile.

    Raises:
        UnsupportedError: naming the first action that does not.
    """
    domain = task.problem.domain
    if not domain.is_temporal:
        raise UnsupportedError("no action has a duration", hint="fast-downward proves such tasks")
    for action in domain.actions:
        if not action.durative:
            raise UnsupportedError(f"'{action.name}' is instantaneous", hint=HINT)
        if any(c.when == "end" and c.formula != TRUE for c in action.conditions):
            raise UnsupportedError(f"'{action.name}' has a condition at its end", hint=HINT)
        for effect in action.effects:
            if effect.target.name == TOTAL_COST and effect.when != "start":
                raise UnsupportedError(f"'{action.name}' costs something at its end", hint=HINT)


def _check(task: Task, action: GroundAction) -> None:
    reason = _outside(task, action)
    if reason is not None:
        raise UnsupportedError(f"{action} {reason}", hint=HINT)


def _outside(task: Task, action: GroundAction) -> str | None:
    """Return why an action is outside the class, None if it is inside."""
    adds = union(c.adds for c in action.at_start)
    late = union(c.deletes for c in action.at_end)
    invariant = union(mask for mask, _ in action.over)
    if action.duration is None:
        return "has a duration that the planner may choose"
    if action.duration <= 0:
        return f"lasts {number_text(action.duration)} s"
    if action.agent is None:
        return "has no agent"
    if action.conditional:
        return "has a conditional effect"
    if adds:
        return f"adds {_first(task, adds)} at its start"
    if late & invariant:
        return f"deletes {_first(task, late & invariant)} at its end, which it needs until then"
    return None


def _first(task: Task, bits: int) -> str:
    return fact_text(task.facts[next(positions(bits))])
