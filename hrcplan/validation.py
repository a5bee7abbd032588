"""Replay a plan in PDDL's own semantics: is it valid, what does it cost, where does it break.

It works on the lifted model, so it also judges numeric plans that the bit task cannot hold,
and it shares no code with any planner.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from hrcplan.pddl.interference import Access, access, clash
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TOTAL_TIME,
    Action,
    Fact,
    FluentKey,
    Formula,
    Number,
    Problem,
    fact_text,
    number_text,
)
from hrcplan.pddl.semantics import Binding, State, Undefined, bind, changes, evaluate, unmet
from hrcplan.plans import EPSILON_S, Plan, PlannedAction, seconds_text

COST: FluentKey = (TOTAL_COST,)


@dataclass(frozen=True, slots=True)
class Report:
    """What a replay found.

    ``failed_step`` counts actions from 0 in order of start time, ties in file order; it is None
    if the plan is valid or only the goal is missed. ``cost``, ``metric`` (None if the problem
    has none) and ``makespan_s`` are None unless the plan is valid. ``state`` is the state at the
    end, or where the replay broke off.
    """

    valid: bool
    cost: Number | None = None
    makespan_s: Number | None = None
    metric: Number | None = None
    failed_step: int | None = None
    reason: str | None = None
    state: frozenset[Fact] = frozenset()
    step_costs: tuple[Number, ...] = ()


class _BrokenError(Exception):
    """The replay stops here: which action, and why."""

    def __init__(self, step: int | None, reason: str, state: State) -> None:
        super().__init__(reason)
        self.step = step
        self.state = state


class _Event(NamedTuple):
    """Start or end of one action of the plan."""

    time: Number
    is_start: bool
    step: int
    action: Action
    binding: Binding
    duration: Number


def validate(problem: Problem, plan: Plan) -> Report:
    """Return whether a plan is valid, with its cost, makespan and metric.

    A sequential plan of a temporal domain is read as one action after the other. Interfering
    happenings closer than ``EPSILON_S`` are invalid, as in VAL with ``-t 0.001`` (Fox and Long,
    PDDL2.1, JAIR 2003, section 8); others may coincide.

    Args:
        problem: The problem that the plan is for.
        plan: Any plan, also one of unknown actions or objects.
    """
    start = _initial_state(problem)
    try:
        events = list(_events(problem, plan, start))
        end, costs = _replay(problem, events, len(plan.actions), start)
    except _BrokenError as broken:
        return Report(False, failed_step=broken.step, reason=str(broken),
                      state=frozenset(broken.state.facts))  # fmt: skip
    missing = unmet(problem.goal, end, {}, problem)
    if missing is not None:
        return Report(False, reason=f"the goal {missing} does not hold at the end",
                      state=frozenset(end.facts), step_costs=costs)  # fmt: skip
    makespan = _makespan(problem, plan, events)
    return Report(
        True, _cost(problem, end, plan), makespan, _metric(problem, end, makespan),
        state=frozenset(end.facts), step_costs=costs,
    )  # fmt: skip


def _makespan(problem: Problem, plan: Plan, events: Sequence[_Event]) -> Number | None:
    """Return the end of the last action; steps of a classical problem last what lanes give them."""
    if problem.domain.is_temporal:
        return max((event.time for event in events), default=0)
    return plan.makespan_s


def _initial_state(problem: Problem) -> State:
    values = dict(problem.values)
    if TOTAL_COST in problem.domain.functions:
        values.setdefault(COST, 0)
    return State(problem.facts, values)


def _cost(problem: Problem, end: State, plan: Plan) -> Number | None:
    if TOTAL_COST in problem.domain.functions:
        return end.values[COST]
    return None if problem.domain.is_temporal else len(plan.actions)


def _metric(problem: Problem, end: State, makespan: Number | None) -> Number | None:
    if problem.metric is None:
        return None
    values = {**end.values, (TOTAL_TIME,): makespan or 0}
    return evaluate(problem.metric, values, {})


def _events(problem: Problem, plan: Plan, start: State) -> Iterator[_Event]:
    clock: Number = 0
    for step, planned in enumerate(plan.actions):
        action, binding = _resolve(problem, planned, step, start)
        duration = _duration(planned, action, binding, problem, step, start)
        begin = clock if planned.start_s is None else planned.start_s
        yield _Event(begin, True, step, action, binding, duration)
        if action.durative:
            yield _Event(begin + duration, False, step, action, binding, duration)
        clock = begin + duration + (EPSILON_S if problem.domain.is_temporal else 1)


def _resolve(
    problem: Problem, planned: PlannedAction, step: int, state: State
) -> tuple[Action, Binding]:
    action = next((a for a in problem.domain.actions if a.name == planned.name), None)
    if action is None:
        raise _BrokenError(step, f"there is no action '{planned.name}'", state)
    binding = bind(action, planned.args, problem)
    if isinstance(binding, str):
        raise _BrokenError(step, binding, state)
    return action, binding


def _duration(
    planned: PlannedAction, action: Action, binding: Binding, problem: Problem, step: int,
    state: State,
) -> Number:  # fmt: skip
    """Return the duration given, or the one that ``(= ?duration …)`` fixes from the start."""
    if not action.durative:
        return 0
    if planned.duration_s is not None:
        return planned.duration_s
    for op, expression in action.durations:
        if op == "=":
            try:
                return evaluate(expression, state.values, binding)
            except Undefined as error:
                raise _BrokenError(step, str(error), state) from None
    raise _BrokenError(step, f"{planned} needs a duration in brackets", state)


def _replay(
    problem: Problem, events: Sequence[_Event], n_steps: int, state: State
) -> tuple[State, tuple[Number, ...]]:
    """Return the state after all events, and the cost that each step added."""
    costs: list[Number] = [0] * n_steps
    ordered = sorted(events, key=lambda e: (e.time, e.step, not e.is_start))
    _check_interference(problem, ordered, state)
    running: dict[int, _Event] = {}
    index = 0
    while index < len(ordered):
        last = index
        while last < len(ordered) and ordered[last].time == ordered[index].time:
            last += 1
        state = _happen(problem, ordered[index:last], state, costs)
        for event in ordered[index:last]:
            if event.is_start and event.action.durative:
                running[event.step] = event
            else:
                running.pop(event.step, None)
        _check_invariants(problem, running, state)
        index = last
    return state, tuple(costs)


def _check_interference(problem: Problem, ordered: Sequence[_Event], state: State) -> None:
    """Stop at the first two events that interfere and are closer than ``EPSILON_S``."""
    near: list[tuple[_Event, Access]] = []
    for event in ordered:
        when = "start" if event.is_start else "end"
        mine = access(problem, event.action, event.binding, when)
        near = [(e, a) for e, a in near if event.time - e.time < EPSILON_S]
        for other, theirs in near:
            about = clash(mine, theirs) if other.step != event.step else None
            if about is not None:
                raise _BrokenError(
                    max(event.step, other.step), _too_close(event, other, about), state
                )
        near.append((event, mine))


def _too_close(event: _Event, other: _Event, about: Fact) -> str:
    return (
        f"{_shown(event)} and {_shown(other)} interfere about {fact_text(about)} at "
        f"{seconds_text(event.time)} s; they need {number_text(EPSILON_S)} s between them"
    )


def _happen(problem: Problem, group: Sequence[_Event], state: State, costs: list[Number]) -> State:
    """Return the state after events of one instant; all of them read the state before it."""
    after = state
    for event in group:
        when = "start" if event.is_start else "end"
        _require(problem, event, when, state)
        timed = State(state.facts, {**state.values, (DURATION,): event.duration})
        effects = [e for e in event.action.effects if e.when == when]
        try:
            change = changes(effects, timed, event.binding, problem)
        except Undefined as error:
            raise _BrokenError(event.step, str(error), state) from None
        if COST in change.values:
            costs[event.step] += change.values[COST] - state.values[COST]
        # Increases of one instant add up; assignments do not share an instant (interference).
        moved = {k: after.values.get(k, 0) + v - state.values.get(k, 0)
                 for k, v in change.values.items()}  # fmt: skip
        after = replace(change, values=moved).apply(after)
    return after


def _require(problem: Problem, event: _Event, when: str, state: State) -> None:
    for condition in event.action.conditions:
        if condition.when == when:
            _demand(problem, event, condition.formula, state, _where(event, when))
    if event.is_start:
        _check_duration(event, state)


def _check_invariants(problem: Problem, running: dict[int, _Event], state: State) -> None:
    for event in running.values():
        for condition in event.action.conditions:
            if condition.when == "all":
                _demand(problem, event, condition.formula, state, _where(event, "all"))


def _demand(problem: Problem, event: _Event, formula: Formula, state: State, where: str) -> None:
    try:
        missing = unmet(formula, state, event.binding, problem)
    except Undefined as error:
        raise _BrokenError(event.step, str(error), state) from None
    if missing is not None:
        raise _BrokenError(event.step, f"{_shown(event)} needs {missing}{where}", state)


def _where(event: _Event, when: str) -> str:
    if not event.action.durative:
        return ""
    moment = {"start": event.time, "end": event.time, "all": event.time}[when]
    words = {"start": "at its start", "end": "at its end", "all": "all the time from its start"}
    return f" {words[when]} ({seconds_text(moment)} s)"


def _check_duration(event: _Event, state: State) -> None:
    for op, expression in event.action.durations:
        try:
            wanted = evaluate(expression, state.values, event.binding)
        except Undefined as error:
            raise _BrokenError(event.step, str(error), state) from None
        # Durations are printed with three decimals: a difference below a gap is rounding.
        over = event.duration - wanted
        too_long = op != ">=" and over >= EPSILON_S
        too_short = op != "<=" and -over >= EPSILON_S
        if too_long or too_short:
            lasts = f"lasts {op} {number_text(wanted)} s, not {number_text(event.duration)} s"
            raise _BrokenError(event.step, f"{_shown(event)} {lasts}", state)


def _shown(event: _Event) -> str:
    return fact_text((event.action.name, *event.binding.values()))
