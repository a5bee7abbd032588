"""The replay itself: a plan on its way through its happenings."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

from hrcplan.core.numbers import Number
from hrcplan.pddl.derivation import Derivation
from hrcplan.pddl.interference import Access, access, clash
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TOTAL_TIME,
    VIOLATED,
    Action,
    Constraint,
    FluentKey,
    Formula,
    Preference,
    Problem,
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
)
from hrcplan.pddl.trajectories import is_kept
from hrcplan.pddl.write import constraint_text
from hrcplan.plans import Plan
from hrcplan.validation.happenings import (
    TIMED,
    BrokenPlanError,
    Happening,
    check_conditions,
    check_phase,
    duration_of,
    timed_happenings,
    too_close,
)
from hrcplan.validation.report import Report

COST: FluentKey = (TOTAL_COST,)


class PlanReplay:
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
        self._coming = deque(timed_happenings(problem))
        self._running: dict[int, tuple[Happening, LiftedState]] = {}
        self._near: list[Happening] = []
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

    def _events(self, step: int, start_s: Number | None) -> list[Happening]:
        """Return start and end of an action that starts at a time, read in the present state."""
        planned_action, time = self.plan.actions[step], start_s or 0
        action = self.problem.domain.schemas.get(planned_action.name)
        nothing = Action(planned_action.name, (), (), ())
        if action is None:
            fault = f"there is no action '{planned_action.name}'"
            return [Happening(time, True, step, nothing, {}, 0, fault)]
        binding = bind(action, planned_action.args, self.problem)
        if isinstance(binding, str):
            return [Happening(time, True, step, nothing, {}, 0, binding)]
        duration = duration_of(planned_action, action, binding, self.state)
        if isinstance(duration, str):
            return [Happening(time, True, step, nothing, {}, 0, duration)]
        start = Happening(time, True, step, action, binding, duration)
        return [start, start._replace(time=time + duration, is_start=False)][: 1 + action.durative]

    def _play(self, events: Sequence[Happening]) -> None:
        last = max((event.time for event in events), default=0)
        coming: list[Happening] = []
        while self._coming and self._coming[0].time <= last:
            coming.append(self._coming.popleft())
        in_order = sorted([*coming, *events], key=lambda e: (e.time, e.step, not e.is_start))
        for _, group in groupby(in_order, key=lambda e: e.time):
            self._happen(tuple(group))
        self.end_s = max(self.end_s, last)

    def _happen(self, group: Sequence[Happening]) -> None:
        """Let the events of one instant happen; all of them read the state before it."""
        before = self.seen
        after = self.state
        for event in group:
            if event.fault is not None:
                raise BrokenPlanError(event.step, event.fault)
            self._check_interference(event)
            check_phase(self.problem, event, before)
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
            check_conditions(self.problem, event, "all", self.seen)

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

    def _check_interference(self, event: Happening) -> None:
        """Stop if the event interferes with one that is closer than ``epsilon_s``."""
        self._near = [e for e in self._near if event.time - e.time < self.epsilon_s]
        for other in self._near:
            if other.step == event.step:
                continue
            about = clash(self._access(event), self._access(other))
            if about is not None:
                step = max(event.step, other.step)
                reason = too_close(event, other, about, self.epsilon_s)
                raise BrokenPlanError(step, reason, (event.time - other.time) or None)
        self._near.append(event)

    def _access(self, event: Happening) -> Access:
        """Return what an event reads and writes; where quantifiers are nested this is costly."""
        key = event.step, event.is_start
        if key not in self._accesses:
            self._accesses[key] = access(self.problem, event.action, event.binding, event.when)
        return self._accesses[key]

    def _state_after(self, event: Happening, after: LiftedState) -> LiftedState:
        """Return ``after`` with the effects of one event, read in the state before its instant."""
        before = self.state.values
        state_now = LiftedState(self.seen.facts, {**before, (DURATION,): event.duration})
        effects = [e for e in event.action.effects if e.when == event.when]
        _, state_at_start = self._running.get(event.step, (event, state_now))
        try:
            change = changes(effects, state_now, event.binding, self.problem, state_at_start)
        except Undefined as error:
            raise BrokenPlanError(event.step, str(error)) from None
        if COST in change.values and event.step != TIMED:
            self.costs[event.step] += change.values[COST] - before[COST]
        # Increases of one instant add up; assignments do not share an instant (interference).
        values_after = {
            key: after.values.get(key, 0) + value - before.get(key, 0)
            for key, value in change.values.items()
        }
        return replace(change, values=values_after).apply(after)


def _preferences(problem: Problem) -> Iterator[Preference]:
    yield from problem.preferences
    for action in problem.domain.actions:
        yield from action.preferences


def _metric(problem: Problem, end: LiftedState, makespan: Number | None) -> Number | None:
    """Return the metric; None if there is none, or one of a number that has no value."""
    if problem.metric is None:
        return None
    try:
        return evaluate(problem.metric, {**end.values, (TOTAL_TIME,): makespan or 0}, {})
    except Undefined:
        return None
