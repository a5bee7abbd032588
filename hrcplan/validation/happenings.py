"""The happenings of a plan: starts and ends of its actions, and what must hold at each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from hrcplan.core.numbers import Number, number_text
from hrcplan.pddl.model import (
    DURATION,
    Action,
    Atom,
    Constant,
    Effect,
    Fact,
    Function,
    Problem,
    fact_text,
)
from hrcplan.pddl.semantics import Binding, LiftedState, Undefined, evaluate, unmet
from hrcplan.plans import EPSILON_S, PlannedAction, seconds_text

TIMED = -1  # the step of what comes by itself


class BrokenPlanError(Exception):
    """The replay stops here: at which action, why, and the gap that was too small, if it was."""

    def __init__(self, step: int, reason: str, gap_s: Number | None = None) -> None:
        super().__init__(reason)
        self.step = step
        self.gap_s = gap_s


class Happening(NamedTuple):
    """Start or end of one action of the plan; ``fault`` says why there is no such action."""

    time: Number
    is_start: bool
    step: int
    action: Action
    binding: Binding
    duration: Number
    fault: str | None = None

    @property
    def when(self) -> str:
        """The phase of the action that this is."""
        return "start" if self.is_start else "end"


def timed_happenings(problem: Problem) -> Iterator[Happening]:
    """Yield the timed initial literals as events of no step."""
    for change in problem.timed:
        target = Function if change.value is not None else Atom
        kind = "assign" if change.value is not None else "add" if change.positive else "delete"
        value = None if change.value is None else Constant(change.value)
        effect = Effect("start", kind, target(change.key[0], change.key[1:]), value)
        yield Happening(change.time, True, TIMED, Action(str(change), (), (), (effect,)), {}, 0)


def duration_of(
    action_in_plan: PlannedAction, action: Action, binding: Binding, state: LiftedState
) -> Number | str:
    """Return the duration given, or the one that ``(= ?duration …)`` fixes; or what is wrong."""
    if not action.durative:
        return 0
    if action_in_plan.duration_s is not None:
        return action_in_plan.duration_s
    for op, expression in action.durations:
        if op == "=":
            try:
                return evaluate(expression, state.values, binding)
            except Undefined as error:
                return str(error)
    return f"{action_in_plan} needs a duration in brackets"


def too_close(event: Happening, other: Happening, about: Fact, epsilon_s: Number) -> str:
    """Return the reason that two happenings interfere about something."""
    return (
        f"{_text(event)} and {_text(other)} interfere about {fact_text(about)} at "
        f"{seconds_text(event.time)} s; they need {number_text(epsilon_s)} s between them"
    )


def check_phase(problem: Problem, event: Happening, state: LiftedState) -> None:
    """Check the conditions of one happening, and at a start the duration.

    Raises:
        BrokenPlanError: if one of them does not hold.
    """
    check_conditions(problem, event, event.when, state)
    if event.is_start:
        _check_duration(event, state)


def check_conditions(problem: Problem, event: Happening, when: str, state: LiftedState) -> None:
    """Check the conditions of one phase of an action: ``start``, ``all`` or ``end``.

    Raises:
        BrokenPlanError: if one of them does not hold.
    """
    values = {**state.values, (DURATION,): event.duration}
    for condition in event.action.conditions:
        if condition.when != when:
            continue
        now = LiftedState(state.facts, values)
        missing = unmet(condition.formula, now, event.binding, problem)
        if missing is not None:
            reason = f"{_text(event)} needs {missing}{_where(event, when)}"
            raise BrokenPlanError(event.step, reason)


def _where(event: Happening, when: str) -> str:
    if not event.action.durative:
        return ""
    words = {"start": "at its start", "end": "at its end", "all": "all the time from its start"}
    return f" {words[when]} ({seconds_text(event.time)} s)"


def _check_duration(event: Happening, state: LiftedState) -> None:
    for op, expression in event.action.durations:
        try:
            duration = evaluate(expression, state.values, event.binding)
        except Undefined as error:
            raise BrokenPlanError(event.step, str(error)) from None
        # Durations are printed with three decimals: a difference below a gap is rounding.
        over = event.duration - duration
        too_long = op != ">=" and over >= EPSILON_S
        too_short = op != "<=" and -over >= EPSILON_S
        if too_long or too_short:
            allowance = number_text(duration) if op == "=" else f"{op} {number_text(duration)}"
            reason = f"{_text(event)} lasts {allowance} s, not {number_text(event.duration)} s"
            raise BrokenPlanError(event.step, reason)


def _text(event: Happening) -> str:
    return fact_text((event.action.name, *event.binding.values()))
