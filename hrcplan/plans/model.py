"""Plans: ground actions in order, or with times and durations.

A plan with times is a *schedule*; every action belongs to the *lane* of its agent.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from hrcplan.core.numbers import Number, decimal_of
from hrcplan.core.records import record
from hrcplan.core.text import cut, plural
from hrcplan.pddl.model import Problem

EPSILON_S = Fraction(1, 1000)
"""Smallest gap, in seconds, between two happenings that interfere."""


@record
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

    def __repr__(self) -> str:
        when = "" if self.start_s is None else f" at {float(self.start_s):g} s"
        return f"<PlannedAction {cut(str(self), 150)}{when}>"


@record
class Plan:
    """Ground actions in an order that can be executed: by start time if they have times."""

    actions: tuple[PlannedAction, ...] = ()

    @property
    def is_schedule(self) -> bool:
        """Whether the actions have start times."""
        return any(action.start_s is not None for action in self.actions)

    @property
    def makespan_s(self) -> Number | None:
        """End of the last action, in seconds from time 0; None without times or actions."""
        if not self.is_schedule:
            return None
        return max(a.end_s for a in self.actions if a.end_s is not None)

    def __str__(self) -> str:
        return format_plan(self)

    def __repr__(self) -> str:
        makespan = self.makespan_s
        time = "" if makespan is None else f", makespan {float(makespan):g} s"
        return f"<Plan: {plural(len(self.actions), 'action')}{time}>"

    def rows(self, problem: Problem | None = None) -> list[dict[str, str | float | None]]:
        """Return one row per action, for ``pandas.DataFrame``.

        Keys: ``start_s``, ``duration_s`` (both None in a sequential plan), with the problem also
        ``agent`` (None for an action without one), then ``action``, ``args`` (separated by spaces).

        >>> Plan((PlannedAction("move", ("human", "wp1")),)).rows()
        [{'start_s': None, 'duration_s': None, 'action': 'move', 'args': 'human wp1'}]
        """
        return [
            {
                "start_s": None if a.start_s is None else float(a.start_s),
                "duration_s": None if a.duration_s is None else float(a.duration_s),
                **({} if problem is None else {"agent": lane(a.args, problem)}),
                "action": a.name,
                "args": " ".join(a.args),
            }
            for a in self.actions
        ]

    def picture(self, problem: Problem | None = None) -> str:
        """Return the plan as an SVG picture with a lane per agent.

        Without the problem, the agent of an action is taken to be its first argument.
        """
        from hrcplan.core.svg import LaneBar, gantt

        bars = []
        for i, a in enumerate(self.actions):
            first = a.args[0] if a.args else ""
            agent = first if problem is None else lane(a.args, problem) or ""
            words = [a.name, *(arg for arg in a.args if arg != agent)]
            start, length = (i, 1) if a.start_s is None else (a.start_s, a.duration_s or 1)
            bars.append(LaneBar(agent, " ".join(words), float(start), float(start + length)))
        return gantt(bars, "s" if self.is_schedule else "steps")

    def _repr_html_(self) -> str:
        """Return the plan as a picture."""
        return self.picture()


_INSTANT_S = Fraction(1, 1000)  # the duration in PlanSys2 of an action that has none


def lane(args: Iterable[str], problem: Problem) -> str | None:
    """Return the agent whose lane an action is in: its first argument that is an agent."""
    return next((arg for arg in args if arg in problem.agents), None)


def occupied(action: PlannedAction, problem: Problem) -> frozenset[str]:
    """Return the agents that an action keeps busy: its lane, and each agent it changes.

    An agent is changed if a fact that mentions it is added or deleted by the action.
    """
    schema = problem.domain.action(action.name)
    bound = dict(zip((p.name for p in schema.params), action.args, strict=True))
    agents = {
        bound.get(term, term)
        for effect in schema.effects
        if effect.value is None
        for term in effect.target.args
    }
    busy = {arg for arg in action.args if arg in problem.agents and arg in agents}
    own = lane(action.args, problem)
    return frozenset(busy if own is None else busy | {own})


def format_plan(plan: Plan) -> str:
    """Return the plan in IPC format, one action a line, times with at least three decimals.

    >>> print(format_plan(Plan((PlannedAction("move", ("human", "wp1"), 0, 50),))), end="")
    0.000: (move human wp1) [50.000]
    """
    return "".join(f"{_format(action)}\n" for action in plan.actions)


def format_plansys2(plan: Plan) -> str:
    """Return the plan as a file for ``run plan-file`` in the terminal of PlanSys2.

    There every action has a start and a duration; the steps of a sequence last 1 s.

    >>> steps = (PlannedAction("open", ("a",)), PlannedAction("go", ()))
    >>> print(format_plansys2(Plan(steps)), end="")
    0.000: (open a) [1.000]
    1.000: (go) [1.000]
    """
    actions = (
        PlannedAction(
            action.name,
            action.args,
            n if action.start_s is None else action.start_s,
            1 if action.start_s is None else action.duration_s or _INSTANT_S,
        )
        for n, action in enumerate(plan.actions)
    )
    return "".join(f"{_format(action)}\n" for action in actions)


def _format(action: PlannedAction) -> str:
    if action.start_s is None:
        return str(action)
    duration = "" if action.duration_s is None else f" [{seconds_text(action.duration_s)}]"
    return f"{seconds_text(action.start_s)}: {action}{duration}"


def seconds_text(seconds: Number) -> str:
    """Return seconds with three decimals, or more (at most nine) where three lose something."""
    whole, _, decimals = decimal_of(Fraction(seconds), 9).partition(".")
    return f"{whole}.{decimals:0<3}"
