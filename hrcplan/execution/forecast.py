"""What a running plan leads to: does a coming timed initial literal make an action impossible?

The rest of the plan is followed ahead in time, every action as early as its order allows. Only
conditions, durations and goals that look at what the literals change are held against them; all
others the order of the plan takes care of.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from hrcplan.core.numbers import Number, number_text
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import UNIT_S, BoundAction, StartEffects
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.run import FollowedPlan, Run
from hrcplan.pddl.model import TimedChange
from hrcplan.pddl.semantics import Undefined, Values, evaluate
from hrcplan.plans import EPSILON_S, PlannedAction

_END, _LITERAL, _START = range(3)
_BRIEF_S = 1e-9
"""By which the end of an action comes after its start, however short it is."""


class _Moment(NamedTuple):
    """The end or the start of an action, or a literal: ``number`` is its place among its kind.

    Within one instant actions end, then literals happen, then actions start: ``key`` says so.
    """

    key: float
    kind: int
    number: int


def foreseen_obstacle(model: ExecutionModel, run: Run, agent_state: Values) -> str | None:
    """Return the first action, or the goal, that a coming literal makes impossible, and why.

    Args:
        model: The problem, prepared for execution.
        run: The run; it follows a plan.
        agent_state: The values that planners get.
    """
    return _Forecast(model, run, agent_state).obstacle()


class _Forecast:
    """The rest of one plan, followed ahead in time."""

    def __init__(self, model: ExecutionModel, run: Run, agent_state: Values) -> None:
        assert run.current_plan is not None
        self.model, self.agent_state = model, agent_state
        self.actions, self.timed = model.actions, model.timed
        self.plan: FollowedPlan = run.current_plan
        self.state = run.state
        self.starts, self.ends = _times(run, self.plan)
        self.running: dict[int, tuple[BoundAction, StartEffects]] = {
            r.index: (r.step, r.start_effects) for r in run.running if r.index is not None
        }
        self.n_happened = run.n_happened
        self.now = run.t

    def obstacle(self) -> str | None:
        """Return the first obstacle on the way, or a goal that is missed at the end."""
        for _, kind, number in sorted(self._moments()):
            if kind == _LITERAL:
                text = self._happen(self.timed.literals[number])
            else:
                text = self._end(number) if kind == _END else self._start(number)
            if text is not None:
                return text
        goal = self.model.problem.goal
        if self.timed.touch(goal) and not self.actions.is_goal(self.state):
            return "the plan misses the goal, as timed initial literals come before its end"
        return None

    def _moments(self) -> Iterator[_Moment]:
        for index, end_s in self.ends.items():
            start_key = self.starts[index] + ev.INSTANT_S
            yield _Moment(max(end_s - ev.INSTANT_S, start_key + _BRIEF_S), _END, index)
            if index not in self.running:
                yield _Moment(start_key, _START, index)
        for number in range(self.n_happened, len(self.timed.literals)):
            time_s = float(self.timed.literals[number].time)
            yield _Moment(max(self.now, time_s), _LITERAL, number)

    def _step(self, index: int) -> tuple[PlannedAction, BoundAction]:
        action = self.plan.plan.actions[index]
        step = self.actions.step(action)
        assert step is not None  # or the plan would not have been adopted
        return action, step

    def _start(self, index: int) -> str | None:
        action, step = self._step(index)
        if any(self.timed.touch(c.formula) for c in step.schema.conditions if c.when != "end"):
            missing = self.actions.obstacle(self.state, step, self.agent_state)
            if missing is not None:
                return f"{action} would need {missing} at {self.starts[index]:g} s"
        duration = self._changed_duration(action, step)
        if duration is not None:
            return f"{action} would last {number_text(duration)} s at {self.starts[index]:g} s"
        self.state, effects = self.actions.begin(self.state, step, action.duration_s or 0)
        self.running[index] = step, effects
        return None

    def _changed_duration(self, action: PlannedAction, step: BoundAction) -> Number | None:
        """Return the duration that an action has then, if it is fixed and another one."""
        fixed, planned_s = step.schema.fixed_duration, action.duration_s
        if fixed is None or planned_s is None or not self.timed.touch_duration(step.schema):
            return None
        values = {**self.model.problem.values, **self.state.values, **self.agent_state}
        try:
            duration: Number = evaluate(fixed, values, step.binding)
        except Undefined:
            return None
        changes = not -EPSILON_S < duration - planned_s < EPSILON_S
        return duration if changes else None

    def _happen(self, change: TimedChange) -> str | None:
        self.state = self.actions.happen(self.state, change)
        for index, (step, _) in self.running.items():
            conditions = (c.formula for c in step.schema.conditions if c.when == "all")
            if any(map(self.timed.touch, conditions)):
                missing = self.actions.unmet_phase(self.state, step, "all")
                if missing is not None:
                    return self._broken(index, change, missing)
        return None

    def _broken(self, index: int, change: TimedChange, missing: str) -> str:
        action, _ = self._step(index)
        return (
            f"{action} would need {missing} until {self.ends[index]:g} s, but {change.literal} "
            f"comes at {number_text(change.time)} s"
        )

    def _end(self, index: int) -> str | None:
        action, _ = self._step(index)
        step, effects = self.running.pop(index)
        missing = self.timed.obstacle_at_end(self.actions, self.state, step)
        if missing is not None:
            return f"{action} would need {missing} at its end, at {self.ends[index]:g} s"
        self.state = self.actions.finish(self.state, step, action.duration_s or 0, effects)
        return None


def _times(run: Run, plan: FollowedPlan) -> tuple[dict[int, float], dict[int, float]]:
    """Return when the actions that have not ended start and end, by their place in the plan."""
    starts: dict[int, float] = {}
    ends: dict[int, float] = {}
    running = {r.index: r for r in run.running if r.index is not None}
    for index, action in enumerate(plan.plan.actions):
        if index in plan.ended:
            continue
        lasts = float(UNIT_S if action.duration_s is None else action.duration_s)
        if index in running:
            starts[index] = running[index].begun_s
        else:
            starts[index] = _start_of(index, run, plan, starts, ends)
        ends[index] = max(run.t, starts[index] + lasts)
    return starts, ends


def _start_of(
    index: int, run: Run, plan: FollowedPlan, starts: dict[int, float], ends: dict[int, float]
) -> float:
    times = [run.t]
    if index in plan.holds:
        times.append(plan.holds[index].not_before_s)
    for wait in plan.order[index]:
        if wait.for_end:
            times.append(ends.get(wait.index, run.t))
        else:
            begun = plan.begun.get(wait.index, starts.get(wait.index, run.t))
            times.append(begun + float(wait.offset_s))
    return max(times)
