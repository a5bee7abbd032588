"""Trajectory constraints (PDDL 3): read from a file, and judged on the states of a plan."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from hrcplan.core.numbers import Number, to_number
from hrcplan.core.records import replace
from hrcplan.core.text import quote
from hrcplan.pddl.formulas import read_formula
from hrcplan.pddl.model import Constraint, Formula, Trajectory
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.typed_lists import read_params

SECTION = ":constraints"
OPERATORS = {
    "at-end": (0, 1), "always": (0, 1), "sometime": (0, 1), "at-most-once": (0, 1),
    "within": (1, 1), "sometime-after": (0, 2), "sometime-before": (0, 2),
    "always-within": (1, 2), "hold-during": (2, 1), "hold-after": (1, 1),
}  # fmt: skip
"""How many times and how many conditions an operator takes; ``(at end c)`` is ``at-end``."""


def read_constraints(section: GroupNode | None, scope: Scope) -> tuple[Constraint, ...]:
    """Return the constraints of a ``:constraints`` section; every fault is noted."""
    if section is None:
        return ()
    scope.source.use(SECTION, section.at)
    return tuple(constraint for node in section[1:] for constraint in _constraints(node, scope))


def _constraints(node: ParseNode, scope: Scope, preference: str = "") -> Iterator[Constraint]:
    head = node.head if isinstance(node, GroupNode) else ""
    if not isinstance(node, GroupNode) or not head:
        if node != []:
            message = "a constraint such as (always (p)) is expected here"
            scope.source.error(node.at, "not-a-constraint", message)
    elif head == "and" and not preference:
        for part in node[1:]:
            yield from _constraints(part, scope)
    elif head == "forall" and len(node) == 3:
        params, inside = scope.quantifying(read_params(node[1], scope), node.at)
        for constraint in _constraints(node[2], inside, preference):
            yield replace(constraint, params=(*params, *constraint.params))
    elif head == "preference" and not preference and len(node) in (2, 3):
        name = str(node[1]) if len(node) == 3 else "unnamed"
        yield from _constraints(node[-1], scope, name)
    else:
        parts = node[1:] if head == "and" else [node]
        read = (_trajectory(part, scope) for part in parts)
        trajectories = tuple(trajectory for trajectory in read if trajectory is not None)
        if trajectories:
            yield Constraint(trajectories, preference=preference)


def _trajectory(node: ParseNode, scope: Scope) -> Trajectory | None:
    head = node.head if isinstance(node, GroupNode) else ""
    if isinstance(node, GroupNode) and head == "at" and len(node) == 3 and node[1] == "end":
        return Trajectory("at-end", (), (read_formula(node[2], scope),))
    if not isinstance(node, GroupNode) or head not in OPERATORS or head == "at-end":
        name = quote(head) if head else "this"
        message = f"{name} is no operator of a constraint"
        hint = f"operators are: at end, {', '.join(list(OPERATORS)[1:])}"
        scope.source.error(node.at, "not-a-constraint", message, hint)
        return None
    n_times, n_parts = OPERATORS[str(head)]
    words = node[1 : 1 + n_times]
    times = [to_number(word) for word in words if isinstance(word, WordNode)]
    if len(node) != 1 + n_times + n_parts or len(times) != n_times or None in times:
        form = " ".join([head, *["TIME"] * n_times, *["CONDITION"] * n_parts])
        scope.source.error(node.at, "not-a-constraint", f"({form}) is expected here")
        return None
    parts = tuple(read_formula(part, scope) for part in node[1 + n_times :])
    return Trajectory(str(head), tuple(t for t in times if t is not None), parts)


Trace = Sequence[Number]
"""The times from which the states of a plan hold; the first one is the initial state's."""


def is_kept(trajectory: Trajectory, times: Trace, test: Callable[[int, Formula], bool]) -> bool:
    """Return whether the states of a plan keep a constraint.

    ``test`` says whether a condition holds in the state of an index. See Gerevini, Haslum, Long,
    Saetti and Dimopoulos (AIJ 2009), section 2.
    """
    one, two = trajectory.parts[0], trajectory.parts[-1]
    states = range(len(times))
    holds = [test(i, one) for i in states]
    limit = trajectory.times[0] if trajectory.times else 0
    match trajectory.op:
        case "at-end":
            return holds[-1]
        case "always":
            return all(holds)
        case "sometime":
            return any(holds)
        case "within":
            return any(ok and time <= limit for ok, time in zip(holds, times, strict=True))
        case "at-most-once":
            n_starts = holds[0] + sum(now and not before for before, now in pairwise(holds))
            return n_starts <= 1
        case "hold-during":
            return all(holds[i] for i in _between(times, limit, trajectory.times[1]))
        case "hold-after":
            return all(holds[i] for i in _between(times, limit, None))
    other = [test(i, two) for i in states]
    if trajectory.op == "sometime-before":
        return all(any(other[:i]) for i in states if holds[i])
    within = limit if trajectory.op == "always-within" else None
    return all(
        any(other[j] for j in states[i:] if within is None or times[j] - times[i] <= within)
        for i in states
        if holds[i]
    )


def _between(times: Trace, first: Number, end: Number | None) -> Iterator[int]:
    """Yield the states that hold at any time from ``first`` to before ``end``."""
    for i, time in enumerate(times):
        following = times[i + 1] if i + 1 < len(times) else None
        if (end is None or time < end) and (following is None or following > first):
            yield i
