"""Replay a plan in PDDL's own semantics: is it valid, what does it cost, where does it break.

It works on the lifted model, so it also judges numeric plans that the bit task cannot hold,
and it shares no code with any planner.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from types import EllipsisType
from typing import NamedTuple, overload

from hrcplan.core.numbers import Number, number_text
from hrcplan.core.text import cut
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.derivation import Derivation
from hrcplan.pddl.inputs import Readable, as_problem
from hrcplan.pddl.interference import Access, access, clash
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TOTAL_TIME,
    VIOLATED,
    Action,
    Atom,
    Constant,
    Constraint,
    Domain,
    Effect,
    Fact,
    FluentKey,
    Formula,
    Function,
    Preference,
    Problem,
    fact_text,
)
from hrcplan.pddl.semantics import (
    Binding,
    LiftedState,
    Undefined,
    bind,
    changes,
    evaluate,
    holds,
    instances,
    unmet,
)
from hrcplan.pddl.trajectories import is_kept
from hrcplan.pddl.write import constraint_text
from hrcplan.plans import EPSILON_S, Plan, PlannedAction, as_plan, seconds_text

COST: FluentKey = (TOTAL_COST,)
TIMED = -1  # the step of what comes by itself


@dataclass(frozen=True, slots=True)
class Report:
    """What a replay found.

    ``failed_step`` counts actions from 0 in order of start time, ties in file order; it is None
    if the plan is valid or only the goal is missed. ``cost``, ``metric`` (None if the problem
    has none) and ``makespan_s`` are None unless the plan is valid. ``state`` is the state at the
    end, or where the replay broke off. ``gap_s`` is the gap that was too small, above zero, if that
    was the only fault until then.
    """

    valid: bool
    cost: Number | None = None
    makespan_s: Number | None = None
    metric: Number | None = None
    failed_step: int | None = None
    reason: str | None = None
    state: frozenset[Fact] = frozenset()
    step_costs: tuple[Number, ...] = ()
    gap_s: Number | None = None

    def __repr__(self) -> str:
        if not self.valid:
            step = "" if self.failed_step is None else f" at step {self.failed_step}"
            return cut(f"<Report: invalid{step}: {self.reason}", 190) + ">"
        figures = {"cost": self.cost, "metric": self.metric, "makespan_s": self.makespan_s}
        words = [f"{name} {number_text(n)}" for name, n in figures.items() if n is not None]
        return cut(f"<Report: {', '.join(['valid', *words])}", 190) + ">"


class _BrokenError(Exception):
    """The replay stops here: at which action, why, and the gap that was too small, if it was."""

    def __init__(self, step: int, reason: str, gap_s: Number | None = None) -> None:
        super().__init__(reason)
        self.step = step
        self.gap_s = gap_s


class _Event(NamedTuple):
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
        return "start" if self.is_start else "end"


PlanLike = Plan | str | os.PathLike[str]


@overload
def validate(
    domain: Problem | Readable, problem: PlanLike, /, *, epsilon_s: Number = ...
) -> Report: ...


@overload
def validate(
    domain: Domain | Readable | Problem,
    problem: Readable,
    plan: PlanLike,
    *,
    epsilon_s: Number = ...,
) -> Report: ...


@overload
def validate(domain: Problem | Readable, *, plan: PlanLike, epsilon_s: Number = ...) -> Report: ...


def validate(
    domain: Domain | Readable | Problem,
    problem: PlanLike | EllipsisType = ...,
    plan: PlanLike | EllipsisType = ...,
    *,
    epsilon_s: Number = EPSILON_S,
) -> Report:
    """Return whether a plan is valid, with its cost, makespan and metric.

    Called as ``validate(problem, plan)`` or ``validate(domain, problem, plan)``. A sequential plan
    of a temporal domain is read as one action after the other. Interfering happenings that are
    closer than ``epsilon_s`` are invalid (Fox and Long, PDDL2.1, JAIR 2003, section 8); others may
    coincide. VAL accepts gaps down to a tenth of its tolerance ``-t``. ``total-time`` of a
    classical plan is its number of actions, also if it is laid out in lanes.

    Args:
        domain: The problem that the plan is for: a `Problem`, or whatever `hrcplan.read` takes.
        problem: The problem, if ``domain`` is only its domain; else the plan.
        plan: A `Plan`, its text in IPC format, or a file's path. Unknown actions and objects make
            it invalid; they are no error. A planner's log counts as its last plan.
        epsilon_s: Smallest gap between interfering happenings, in seconds; above zero.

    Raises:
        InputError: if a file is missing or has faults, or the text is no plan.
        UnsupportedError: if numbers change while time passes.
        UsageError: if the problem is given twice.
        TypeError: if an argument is none of these.

    >>> validate("transport/two-boxes", "(move human wp1 wp4)").reason
    'the goal (box-at green wp2) does not hold at the end'
    """
    if isinstance(plan, EllipsisType):
        plan, problem = problem, ...
    if isinstance(plan, EllipsisType):
        raise TypeError("validate() needs a problem and a plan")
    if isinstance(problem, Plan):
        raise TypeError("the plan is the last argument of validate(), after the problem")
    parsed_problem = as_problem(domain, None if isinstance(problem, EllipsisType) else problem)
    return _replay(parsed_problem, as_plan(plan, parsed_problem), epsilon_s)


def _replay(problem: Problem, plan: Plan, epsilon_s: Number) -> Report:
    if problem.domain.is_continuous:
        message = "hrcplan cannot judge plans of domains with processes, events or #t"
        raise UnsupportedError(message, hint="VAL can")
    replay = _Replay(problem, plan, epsilon_s)
    try:
        replay.run()
        missing = unmet(problem.goal, replay.seen, {}, problem)
    except _BrokenError as broken:
        report = replay.report(reason=str(broken), failed_step=broken.step)
        return replace(report, gap_s=broken.gap_s)
    broken_constraint = replay.broken_constraint()
    if broken_constraint is not None:
        return replay.report(reason=f"the plan does not keep the constraint {broken_constraint}")
    if missing is not None:
        return replay.report(reason=f"the goal {missing} does not hold at the end")
    return replay.report()


class _Replay:
    """A plan on its way through the happenings: the state, and what is running."""

    def __init__(self, problem: Problem, plan: Plan, epsilon_s: Number) -> None:
        self.problem = problem
        self.plan = plan
        self.epsilon_s = epsilon_s
        values = dict(problem.values)
        if TOTAL_COST in problem.domain.functions:
            values.setdefault(COST, 0)
        values.update({(VIOLATED, p.name): 0 for p in _preferences(problem)})
        self.state = LiftedState(problem.facts, values)
        self._derivation = Derivation(problem)
        self.costs: list[Number] = [0] * len(plan.actions)
        self.end_s: Number = 0
        self._constraints = (*problem.domain.constraints, *problem.constraints)
        self._trace: list[tuple[Number, LiftedState]] = []
        self._coming = deque(_timed_events(problem))
        self._running: dict[int, tuple[_Event, LiftedState]] = {}
        self._near: list[_Event] = []
        self._accesses: dict[tuple[int, bool], Access] = {}

    @property
    def seen(self) -> LiftedState:
        """The state with what follows from it by axioms: what conditions look at."""
        return self._derivation.close(self.state)

    def report(self, *, reason: str | None = None, failed_step: int | None = None) -> Report:
        """Return what was found; numbers only of a valid plan."""
        facts, costs = frozenset(self.state.facts), tuple(self.costs)
        if reason is not None:
            return Report(
                False, failed_step=failed_step, reason=reason, state=facts, step_costs=costs
            )
        temporal = self.problem.domain.is_temporal
        # Steps of a classical problem last what lanes give them.
        makespan = self.end_s if temporal else self.plan.makespan_s
        n_actions = None if temporal else len(costs)
        cost = self.state.values.get(COST, n_actions)
        end = self.seen
        for preference in self.problem.preferences:
            end = self._with_violations(preference, self.seen, {}, end)
        for constraint in self._constraints:
            key = VIOLATED, constraint.preference
            n_violations = end.values.get(key, 0) + self._n_violations(constraint)
            end = replace(end, values={**end.values, key: n_violations})
        metric = _metric(self.problem, end, makespan if temporal else n_actions)
        return Report(True, cost, makespan, metric, state=facts, step_costs=costs)

    def run(self) -> None:
        """Play all actions: each when the one before has ended, or by their times."""
        gap = self.epsilon_s if self.problem.domain.is_temporal else 1
        if self.plan.is_schedule:
            steps = range(len(self.plan.actions))
            self._play([e for i in steps for e in self._events(i, self.plan.actions[i].start_s)])
        else:
            for step in range(len(self.plan.actions)):
                self._play(self._events(step, self.end_s + gap if step else 0))
        for _, group in groupby(self._coming, key=lambda e: e.time):
            self._happen(tuple(group))  # what comes by itself comes after the last action too

    def _events(self, step: int, start_s: Number | None) -> list[_Event]:
        """Return start and end of an action that starts at a time, read in the present state."""
        planned_action, time = self.plan.actions[step], start_s or 0
        action = self.problem.domain.schemas.get(planned_action.name)
        nothing = Action(planned_action.name, (), (), ())
        if action is None:
            fault = f"there is no action '{planned_action.name}'"
            return [_Event(time, True, step, nothing, {}, 0, fault)]
        binding = bind(action, planned_action.args, self.problem)
        if isinstance(binding, str):
            return [_Event(time, True, step, nothing, {}, 0, binding)]
        duration = _duration(planned_action, action, binding, self.state)
        if isinstance(duration, str):
            return [_Event(time, True, step, nothing, {}, 0, duration)]
        start = _Event(time, True, step, action, binding, duration)
        return [start, start._replace(time=time + duration, is_start=False)][: 1 + action.durative]

    def _play(self, events: Sequence[_Event]) -> None:
        last = max((event.time for event in events), default=0)
        coming: list[_Event] = []
        while self._coming and self._coming[0].time <= last:
            coming.append(self._coming.popleft())
        in_order = sorted([*coming, *events], key=lambda e: (e.time, e.step, not e.is_start))
        for _, group in groupby(in_order, key=lambda e: e.time):
            self._happen(tuple(group))
        self.end_s = max(self.end_s, last)

    def _happen(self, group: Sequence[_Event]) -> None:
        """Let the events of one instant happen; all of them read the state before it."""
        before = self.seen
        after = self.state
        for event in group:
            if event.fault is not None:
                raise _BrokenError(event.step, event.fault)
            self._check_interference(event)
            _require(self.problem, event, before)
            after = self._state_after(event, after)
            for preference in event.action.preferences:
                if preference.when == event.when:
                    after = self._with_violations(preference, before, event.binding, after)
        self._follow(group[0].time, before)
        self.state = after
        for event in group:
            if event.is_start and event.action.durative:
                self._running[event.step] = event, before
            else:
                self._running.pop(event.step, None)
        for event, _ in self._running.values():
            _demand(self.problem, event, "all", self.seen)

    def _follow(self, time: Number, before: LiftedState) -> None:
        """Remember the state that ends at a time, and that the next one begins there."""
        if self._constraints:
            begin = self._trace[-1][0] if self._trace else 0
            self._trace[-1:] = [(begin, before), (time, before)]

    def broken_constraint(self) -> str | None:
        """Return the first constraint that the states of the plan do not keep, as PDDL."""
        for constraint in self._constraints:
            if not constraint.preference and self._n_violations(constraint):
                return constraint_text(constraint)
        return None

    def _n_violations(self, constraint: Constraint) -> int:
        """Return how many instances of a constraint the states of the plan do not keep."""
        trace = [*self._trace[:-1], (self._trace[-1][0] if self._trace else 0, self.seen)]
        times = [time for time, _ in trace]

        def keeps(inner: Binding) -> bool:
            def test(index: int, formula: Formula) -> bool:
                return holds(formula, trace[index][1], inner, self.problem)

            return all(is_kept(part, times, test) for part in constraint.trajectories)

        choices = instances(constraint.params, {}, self.problem)
        return sum(not keeps(inner) for inner in choices)

    def _with_violations(
        self, preference: Preference, now: LiftedState, binding: Binding, after: LiftedState
    ) -> LiftedState:
        """Return ``after`` with the instances counted of a preference that ``now`` violates."""
        n_violations = sum(
            not holds(preference.formula, now, inner, self.problem)
            for inner in instances(preference.params, binding, self.problem)
        )
        key = VIOLATED, preference.name
        return replace(after, values={**after.values, key: after.values.get(key, 0) + n_violations})

    def _check_interference(self, event: _Event) -> None:
        """Stop if the event interferes with one that is closer than ``epsilon_s``."""
        self._near = [e for e in self._near if event.time - e.time < self.epsilon_s]
        for other in self._near:
            if other.step == event.step:
                continue
            about = clash(self._access(event), self._access(other))
            if about is not None:
                step = max(event.step, other.step)
                reason = _too_close(event, other, about, self.epsilon_s)
                raise _BrokenError(step, reason, (event.time - other.time) or None)
        self._near.append(event)

    def _access(self, event: _Event) -> Access:
        """Return what an event reads and writes; where quantifiers are nested this is costly."""
        key = event.step, event.is_start
        if key not in self._accesses:
            self._accesses[key] = access(self.problem, event.action, event.binding, event.when)
        return self._accesses[key]

    def _state_after(self, event: _Event, after: LiftedState) -> LiftedState:
        """Return ``after`` with the effects of one event, read in the state before its instant."""
        before = self.state.values
        state_now = LiftedState(self.seen.facts, {**before, (DURATION,): event.duration})
        effects = [e for e in event.action.effects if e.when == event.when]
        _, state_at_start = self._running.get(event.step, (event, state_now))
        try:
            change = changes(effects, state_now, event.binding, self.problem, state_at_start)
        except Undefined as error:
            raise _BrokenError(event.step, str(error)) from None
        if COST in change.values:
            self.costs[event.step] += change.values[COST] - before[COST]
        # Increases of one instant add up; assignments do not share an instant (interference).
        values_after = {
            key: after.values.get(key, 0) + value - before.get(key, 0)
            for key, value in change.values.items()
        }
        return replace(change, values=values_after).apply(after)


def _timed_events(problem: Problem) -> Iterator[_Event]:
    """Yield the timed initial literals as events of no step."""
    for change in problem.timed:
        target = Function if change.value is not None else Atom
        kind = "assign" if change.value is not None else "add" if change.positive else "delete"
        value = None if change.value is None else Constant(change.value)
        effect = Effect("start", kind, target(change.key[0], change.key[1:]), value)
        yield _Event(change.time, True, TIMED, Action(str(change), (), (), (effect,)), {}, 0)


def _preferences(problem: Problem) -> Iterator[Preference]:
    yield from problem.preferences
    for action in problem.domain.actions:
        yield from action.preferences


def objective(problem: Problem, report: Report) -> Number | None:
    """Return what planners minimize: the metric, else the makespan if temporal, else the cost."""
    if problem.metric is not None:
        return report.metric
    return report.makespan_s if problem.domain.is_temporal else report.cost


def _metric(problem: Problem, end: LiftedState, makespan: Number | None) -> Number | None:
    """Return the metric; None if there is none, or one of a number that has no value."""
    if problem.metric is None:
        return None
    try:
        return evaluate(problem.metric, {**end.values, (TOTAL_TIME,): makespan or 0}, {})
    except Undefined:
        return None


def _duration(
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


def _too_close(event: _Event, other: _Event, about: Fact, epsilon_s: Number) -> str:
    return (
        f"{_text(event)} and {_text(other)} interfere about {fact_text(about)} at "
        f"{seconds_text(event.time)} s; they need {number_text(epsilon_s)} s between them"
    )


def _require(problem: Problem, event: _Event, state: LiftedState) -> None:
    _demand(problem, event, event.when, state)
    if event.is_start:
        _check_duration(event, state)


def _demand(problem: Problem, event: _Event, when: str, state: LiftedState) -> None:
    """Stop if a condition of one phase does not hold."""
    values = {**state.values, (DURATION,): event.duration}
    for condition in event.action.conditions:
        if condition.when != when:
            continue
        now = LiftedState(state.facts, values)
        missing = unmet(condition.formula, now, event.binding, problem)
        if missing is not None:
            reason = f"{_text(event)} needs {missing}{_where(event, when)}"
            raise _BrokenError(event.step, reason)


def _where(event: _Event, when: str) -> str:
    if not event.action.durative:
        return ""
    words = {"start": "at its start", "end": "at its end", "all": "all the time from its start"}
    return f" {words[when]} ({seconds_text(event.time)} s)"


def _check_duration(event: _Event, state: LiftedState) -> None:
    for op, expression in event.action.durations:
        try:
            duration = evaluate(expression, state.values, event.binding)
        except Undefined as error:
            raise _BrokenError(event.step, str(error)) from None
        # Durations are printed with three decimals: a difference below a gap is rounding.
        over = event.duration - duration
        too_long = op != ">=" and over >= EPSILON_S
        too_short = op != "<=" and -over >= EPSILON_S
        if too_long or too_short:
            allowance = number_text(duration) if op == "=" else f"{op} {number_text(duration)}"
            reason = f"{_text(event)} lasts {allowance} s, not {number_text(event.duration)} s"
            raise _BrokenError(event.step, reason)


def _text(event: _Event) -> str:
    return fact_text((event.action.name, *event.binding.values()))
