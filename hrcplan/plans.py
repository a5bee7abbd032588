"""Plans and their text: sequential ``(move human wp1 wp2)``, or with times and durations.

A plan with times is a *schedule*; every action belongs to the *lane* of its agent.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from hrcplan.core.numbers import Number, decimal_of, to_number
from hrcplan.core.text import quote, type_text
from hrcplan.errors import PlanFormatError
from hrcplan.pddl.model import Problem
from hrcplan.pddl.source import read_text

EPSILON_S = Fraction(1, 1000)
"""Smallest gap, in seconds, between two happenings that interfere."""

_LINE = re.compile(
    r"(?:(?P<start>[^\s:()]+)\s*:)?\s*\(\s*(?P<words>[^()]*?)\s*\)\s*(?:\[\s*(?P<duration>[^\s\]]+)\s*\])?"
)


@dataclass(frozen=True, slots=True)
class PlannedAction:
    """One ground action of a plan; ``start_s`` and ``duration_s`` are None in sequential plans."""

    name: str
    args: tuple[str, ...]
    start_s: Number | None = None
    duration_s: Number | None = None

    @property
    def end_s(self) -> Number | None:
        """When it ends, in seconds, or None."""
        return None if self.start_s is None else self.start_s + (self.duration_s or 0)

    def __str__(self) -> str:
        return f"({' '.join([self.name, *self.args])})"


@dataclass(frozen=True, slots=True)
class Plan:
    """Ground actions in an order that can be executed: by start time if they have times."""

    actions: tuple[PlannedAction, ...] = ()

    @property
    def is_schedule(self) -> bool:
        """Whether the actions have start times."""
        return any(action.start_s is not None for action in self.actions)

    @property
    def makespan_s(self) -> Number | None:
        """End of the last action minus time 0, in seconds; None without times, 0 if empty."""
        if not self.is_schedule:
            return None
        return max((a.end_s for a in self.actions if a.end_s is not None), default=0)

    def __str__(self) -> str:
        return format_plan(self)


def lane(args: Iterable[str], problem: Problem) -> str | None:
    """Return the agent whose lane an action is in: its first argument that is an agent."""
    return next((arg for arg in args if arg in problem.agents), None)


def occupied(action: PlannedAction, problem: Problem) -> frozenset[str]:
    """Return the agents that an action keeps busy: its lane, and each agent it changes.

    An agent is changed if a fact that mentions it is added or deleted by the action.
    """
    schema = problem.domain.action(action.name)
    bound = dict(zip((p.name for p in schema.params), action.args, strict=True))
    changed = {
        bound.get(term, term)
        for effect in schema.effects
        if effect.value is None
        for term in effect.target.args
    }
    busy = {arg for arg in action.args if arg in problem.agents and arg in changed}
    own = lane(action.args, problem)
    return frozenset(busy if own is None else busy | {own})


def format_plan(plan: Plan) -> str:
    """Return the plan in IPC format, one action a line, times with at least three decimals.

    >>> print(format_plan(Plan((PlannedAction("move", ("human", "wp1"), 0, 50),))), end="")
    0.000: (move human wp1) [50.000]
    """
    return "".join(f"{_format(action)}\n" for action in plan.actions)


def _format(action: PlannedAction) -> str:
    if action.start_s is None:
        return str(action)
    duration = "" if action.duration_s is None else f" [{seconds_text(action.duration_s)}]"
    return f"{seconds_text(action.start_s)}: {action}{duration}"


def seconds_text(seconds: Number) -> str:
    """Return seconds with three decimals, or more (at most nine) where three lose something."""
    whole, _, decimals = decimal_of(Fraction(seconds), 9).partition(".")
    return f"{whole}.{decimals:0<3}"


def parse_plan(text: str, path: str = "<plan>") -> Plan:
    """Return the plan that a text in IPC format describes; comments start with ``;``.

    Raises:
        PlanFormatError: naming the first line that is no action, or that mixes formats.
    """
    actions: list[PlannedAction] = []
    for number, line in enumerate(text.lower().splitlines(), start=1):
        body = line.split(";", 1)[0].strip()
        if not body:
            continue
        action = _parse_line(body)
        if action is None:
            message = f"{quote(body)} is not an action of a plan"
            hint = "lines look like (move human wp1 wp2) or 0.000: (move human wp1 wp2) [50.000]"
            raise PlanFormatError(message, path=path, line=number, hint=hint)
        if actions and (action.start_s is None) != (actions[0].start_s is None):
            message = "some actions have a start time and some have none"
            raise PlanFormatError(message, path=path, line=number)
        actions.append(action)
    return Plan(tuple(sorted(actions, key=lambda a: a.start_s or 0)))


def as_plan(plan: Plan | str | os.PathLike[str]) -> Plan:
    """Return a `Plan` as it is, and the plan of a text in IPC format or of a file.

    A string is text if it holds a parenthesis or a line break, or is blank; else it is a path.

    Raises:
        PlanFormatError: if the text is no plan.
        InputError: if the file is missing or unreadable.
        TypeError: if it is something else.

    >>> as_plan("(move human wp1 wp2)").actions[0].args
    ('human', 'wp1', 'wp2')
    """
    if isinstance(plan, Plan):
        return plan
    if isinstance(plan, str) and (not plan.strip() or any(c in plan for c in "(\n")):
        return parse_plan(plan)
    if isinstance(plan, (str, os.PathLike)):
        path = os.fspath(plan)
        return parse_plan(read_text(path), path)
    raise TypeError(f"a plan is a Plan, its text, or a file's path, not {type_text(plan)}")


def _parse_line(body: str) -> PlannedAction | None:
    match = _LINE.fullmatch(body)
    words = match["words"].split() if match else []
    if match is None or not words:
        return None
    start = None if match["start"] is None else to_number(match["start"])
    duration = None if match["duration"] is None else to_number(match["duration"])
    unreadable = (match["start"] and start is None) or (match["duration"] and duration is None)
    if unreadable or (start or 0) < 0 or (duration or 0) < 0 or (start is None and duration):
        return None
    return PlannedAction(words[0], tuple(words[1:]), start, duration)
