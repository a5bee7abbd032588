"""The second half of the monitor: what is to be done, once the instant settled or a plan arrived.

Draining: once a replan is due nothing new begins. The robot's running action ends with its effects;
a human's is finished or cancelled, as the profile says. Whatever else happens meanwhile belongs to
the same replan.
"""

from __future__ import annotations

from dataclasses import replace

from hrcplan.agents import Profile
from hrcplan.core.numbers import Number, exact
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import UNIT_S
from hrcplan.execution.events import Command
from hrcplan.execution.forecast import foreseen_obstacle
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.order import Waits, holds_of, rest_of, waits
from hrcplan.execution.run import FollowedPlan, Phase, Run, RunStep, begin_action, plus
from hrcplan.pddl.model import FluentKey, Problem
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import EPSILON_S, Plan, PlannedAction
from hrcplan.validation import objective, validate

MAX_ASKED_AGAIN = 3  # times that one replan may ask again because something changed meanwhile
_TIE = 1e-3  # relative; the gaps between printed actions differ by less between plans


class Decider:
    """Chooses commands for one problem and one profile."""

    def __init__(self, model: ExecutionModel, profile: Profile) -> None:
        self.model, self.profile = model, profile
        self.actions = model.actions
        self._orders: dict[Plan, Waits] = {}

    def planner_values(self, run: Run) -> dict[FluentKey, Number]:
        """Return the agent-state values that a planner gets now."""
        return self.profile.planner_values(self.model.agents, run.sensed_values, run.memory)

    def problem_now(self, run: Run) -> Problem:
        """Return the problem from the present state on, with the values that planners get."""
        problem = self.model.priced_problem
        values = {**problem.values, **run.state.values, **self.planner_values(run)}
        timed = self.model.timed.coming(run.n_happened, run.t)
        return replace(problem, facts=frozenset(run.state.facts), values=values, timed=timed)

    def decide(self, run: Run) -> RunStep:
        """Return what is to be done now that an instant has settled."""
        if run.phase is Phase.IDLE:
            return self._ask_plan(run)
        if run.phase is Phase.PLANNING:
            return run, ()
        if self._is_done(run):
            if run.running:
                return replace(run, phase=Phase.DRAINING), ()
            return self.finish(run, ev.GOAL, "")
        if run.reasons or run.phase is Phase.DRAINING:
            return self._drain(run)
        obstacle = self._foreseen_obstacle(run)
        if obstacle is not None:
            return self._drain(run.with_reason(ev.CHANGE, obstacle))
        return self._dispatch(run)

    def _is_done(self, run: Run) -> bool:
        """Whether the goal holds and will hold; preferences are worth the rest of the plan."""
        if not self.actions.is_goal(run.state):
            return False
        if self.model.problem.preferences and _has_rest(run):
            return False
        return self.actions.is_goal(self._state_at_last(run))

    def _state_at_last(self, run: Run) -> LiftedState:
        """Return the state after all timed initial literals, if nothing else happens."""
        state = run.state
        for change in self.model.timed.literals[run.n_happened :]:
            state = self.actions.happen(state, change)
        return state

    def _foreseen_obstacle(self, run: Run) -> str | None:
        """Return what a coming timed initial literal will make impossible, if a replan is left."""
        is_late = run.counts.n_replans >= self.profile.replan_limit
        if is_late or run.n_happened == len(self.model.timed.literals):
            return None
        return foreseen_obstacle(self.model, run, self.planner_values(run))

    def _drain(self, run: Run) -> RunStep:
        cancels: tuple[Command, ...] = ()
        if run.phase is not Phase.DRAINING and self.profile.while_draining == "cancel":
            cancels = tuple(
                ev.Cancel(run.t, r.number) for r in run.running if self.model.is_human(r.step.agent)
            )
        run = replace(run, phase=Phase.DRAINING)
        if run.running:
            return run, cancels
        if not run.reasons:  # the goal held for a moment and does no more
            run = run.with_reason(ev.DEVIATION, "the goal does not hold any more")
        return self._replan(run)

    def _replan(self, run: Run) -> RunStep:
        if run.counts.n_replans < self.profile.replan_limit:
            return self._ask_plan(run)
        why = "; ".join(r.text for r in run.reasons)
        if any(r.kind != ev.CHANGE for r in run.reasons):
            return self.finish(run, ev.REPLAN_LIMIT, why)
        message = ev.Tell(run.t, "replan-limit", f"no replan left, the plan goes on: {why}")
        run, commands = self._dispatch(replace(run, reasons=(), phase=Phase.EXECUTING))
        return run, (message, *commands)

    def _ask_plan(self, run: Run) -> RunStep:
        run = replace(run, phase=Phase.PLANNING, n_reasons_asked=len(run.reasons))
        reasons = tuple(f"{r.kind}: {r.text}" for r in run.reasons)
        facts, absent = self.actions.changing(run.state), self.actions.absent(run.state)
        values = self.planner_values(run)
        numbers, n_happened = run.state.values, run.n_happened
        return run, (ev.AskPlan(run.t, facts, numbers, values, reasons, absent, n_happened),)

    def consider_plan(self, run: Run, event: ev.Planned) -> RunStep:
        """Return what follows from the answer of a planner: adopt, confirm, ask again, or end."""
        if run.phase is not Phase.PLANNING:
            return run, (ev.Tell(run.t, "unasked-plan", "a plan that was not asked for"),)
        # What changed while the planner thought belongs to the same replan.
        if 0 < len(run.reasons) - run.n_reasons_asked <= MAX_ASKED_AGAIN:
            return self._ask_plan(run)
        rest = self._rest_of_plan(run)
        kind = _replan_kind([r.kind for r in run.reasons])
        if event.plan is None:
            return self._go_on_without_plan(run, event, rest, kind)
        if rest is None or not _no_worse(rest[1], event.metric):
            return self._adopt_plan(run, event.plan, kind)
        if self._may_confirm(run, kind):
            return self._confirm_plan(run, "the plan stays the best")
        # Equally good plans differ in who does what: people are not asked to swap for nothing.
        return self._adopt_plan(run, rest[0], kind)

    def _may_confirm(self, run: Run, kind: str | None) -> bool:
        """Whether the running plan may be confirmed: never after a failure, once per instant."""
        worse_only = self.profile.replan == "worse"
        return worse_only and kind != ev.FAILURE and run.confirmation_s != run.t

    def _go_on_without_plan(
        self, run: Run, event: ev.Planned, rest: tuple[Plan, Number] | None, kind: str | None
    ) -> RunStep:
        """Go on with the running plan if it can still be followed, else end the run."""
        if rest is None:
            return self.finish(run, ev.NO_PLAN, event.note)
        if kind == ev.CHANGE:
            return self._confirm_plan(run, f"no new plan ({event.note})")
        return self._adopt_plan(run, rest[0], kind)

    def _confirm_plan(self, run: Run, why: str) -> RunStep:
        counts = replace(run.counts, plans_confirmed=run.counts.plans_confirmed + 1)
        run = replace(run, phase=Phase.EXECUTING, reasons=(), counts=counts, confirmation_s=run.t)
        return run, (ev.Tell(run.t, "plan-confirmed", why),)

    def _adopt_plan(self, run: Run, plan: Plan, kind: str | None) -> RunStep:
        steps = [self.actions.step(action) for action in plan.actions]
        if any(step is None for step in steps):
            return self.finish(run, ev.NO_PLAN, "the plan has an action that the domain has not")
        agents = [step.agent for step in steps if step is not None]
        counts = replace(run.counts, assigned=plus(run.counts.assigned, agents))
        if kind is not None:
            counts = replace(counts, replans=plus(counts.replans, [kind]))
        why = "; ".join(f"{r.kind}: {r.text}" for r in run.reasons)
        coming = self.model.timed.coming(run.n_happened, run.t)
        holds = holds_of(self.model.problem, plan, coming, run.n_happened, run.t)
        current = FollowedPlan(plan, self._order(plan), holds)
        run = replace(run, phase=Phase.EXECUTING, current_plan=current, counts=counts, reasons=())
        return run, (ev.Adopt(run.t, plan, why),)

    def _order(self, plan: Plan) -> Waits:
        if plan not in self._orders:
            self._orders[plan] = waits(self.model.problem, plan)
        return self._orders[plan]

    def _rest_of_plan(self, run: Run) -> tuple[Plan, Number] | None:
        """Return what is left of the running plan and its metric now; None if it cannot go on."""
        current = run.current_plan
        if current is None:
            return None
        is_temporal = self.model.problem.domain.is_temporal
        gap: Number = EPSILON_S if is_temporal else 0  # after a literal it waits for
        held = {i: exact(repr(max(0.0, h.not_before_s - run.t))) + gap
                for i, h in current.holds.items()}  # fmt: skip
        rest = rest_of(current.plan, current.order, current.ended, is_temporal, held)
        now = self.problem_now(run)
        report = validate(now, rest)
        value = objective(now, report)
        return None if not report.valid or value is None else (rest, value)

    # Dispatch: every action whose turn has come, if it still can be done.

    def _dispatch(self, run: Run) -> RunStep:
        current = run.current_plan
        assert current is not None
        commands: list[Command] = []
        for index, action in enumerate(current.plan.actions):
            if index in current.begun or not self._is_free(run, action):
                continue
            ready = run.current_plan.ready_s(index) if run.current_plan else None
            if ready is None:
                continue
            hold = current.holds.get(index)
            if hold is not None and hold.n_happened > run.n_happened:
                ready = max(ready, hold.not_before_s, run.t + 2 * ev.INSTANT_S)
            if ready > run.t + ev.INSTANT_S:
                commands.append(ev.Wake(run.t, ready))
                continue
            run, command = self._begin_action(run, index, action)
            if command is None:
                run_after, more = self._drain(run)
                return run_after, (*commands, *more)
            commands.append(command)
        if not run.running and not commands:
            if self.actions.is_goal(self._state_at_last(run)) and not _has_rest(run):
                return run, self._waking(run)
            return self._drain(run.with_reason(ev.DEVIATION, "the plan has ended without the goal"))
        return run, tuple(commands)

    def _is_free(self, run: Run, action: PlannedAction) -> bool:
        step = self.actions.step(action)
        return step is not None and not any(step.busy & r.step.busy for r in run.running)

    def _begin_action(
        self, run: Run, index: int, action: PlannedAction
    ) -> tuple[Run, ev.Dispatch | None]:
        """Begin one action, or note as a deviation that it cannot begin."""
        step = self.actions.step(action)
        assert step is not None
        assert run.current_plan is not None
        obstacle = self.actions.obstacle(run.state, step, self.planner_values(run))
        if obstacle is not None:
            return run.with_reason(ev.DEVIATION, f"{action} needs {obstacle}"), None
        duration = action.duration_s if step.schema.durative else None
        lasts = float(UNIT_S if duration is None else duration)
        current = replace(run.current_plan, begun={**run.current_plan.begun, index: run.t})
        run = replace(run, current_plan=current)
        return begin_action(self.actions, run, step, duration or 0, lasts, index)

    def _waking(self, run: Run) -> tuple[Command, ...]:
        """Return the command that wakes the run when the next timed initial literal has come."""
        coming = self.model.timed.literals[run.n_happened :]
        return tuple(ev.Wake(run.t, float(change.time)) for change in coming[:1])

    def finish(self, run: Run, ending: str, why: str) -> RunStep:
        """Return the run when it is over, and the command that stops every agent."""
        run = replace(run, phase=Phase.OVER, ending=ending, why=why)
        return run, (ev.Finish(run.t, ending, why),)


def _has_rest(run: Run) -> bool:
    """Return whether actions of the running plan have not begun."""
    plan = run.current_plan
    return plan is None or len(plan.begun) < len(plan.plan.actions)


def _replan_kind(kinds: list[str]) -> str | None:
    """Return what one replan is counted as: the worst of its reasons; None for the first plan."""
    for kind in (ev.FAILURE, ev.DEVIATION, ev.CHANGE):
        if kind in kinds:
            return kind
    return None


def _no_worse(mine: Number, theirs: Number | None) -> bool:
    return theirs is not None and float(mine) <= float(theirs) + _TIE * max(1.0, abs(float(theirs)))
