"""Plans: ground actions in order, or with times and durations.

A plan with times is a *schedule*; every action belongs to the *lane* of its agent.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from hrcplan.core.numbers import Number, decimal_of
from hrcplan.pddl.model import Problem

EPSILON_S = Fraction(1, 1000)
"""Smallest gap, in seconds, between two happenings that interfere."""


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
