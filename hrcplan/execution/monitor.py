"""The monitor: from what has happened to what is to be done. Pure, so that it can be replayed.

``Monitor.step(run, event)`` returns the next run and commands. Whoever drives it (simulation,
terminal, robot link) reports events and carries commands out; nothing here waits, reads a clock,
draws a random number or calls a planner.

Draining: once a replan is due nothing new begins; the robot's running action ends with its
effects, a human's is finished or cancelled as the profile says, and whatever else happens
meanwhile belongs to the same replan.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from hrcplan.core.numbers import Number
from hrcplan.execution import events as ev
from hrcplan.execution.acting import UNIT_S
from hrcplan.execution.events import Command, Event
from hrcplan.execution.observer import Observer, Stepped
from hrcplan.execution.order import Waits, rest_of, waits
from hrcplan.execution.run import FollowedPlan, Phase, Run, RunningAction, plus
from hrcplan.plans import Plan, PlannedAction
from hrcplan.validation import objective, validate

MAX_ASKED_AGAIN = 3  # times that one replan may ask anew because something changed meanwhile
_TIE = 1e-3  # relative; the gaps between printed actions differ by less between plans


class Monitor(Observer):
    """The monitor of one problem and one profile."""

    def step(self, run: Run, event: Event) -> Stepped:
        """Return the run after an event, and what is to be done, in order."""
        if run.is_over:
            return run, ()
        handle: Callable[[Run, Event], Stepped] = getattr(self, f"_{type(event).__name__.lower()}")
        return handle(replace(run, t=max(run.t, event.t)), event)

    def _stopasked(self, run: Run, event: ev.StopAsked) -> Stepped:
        return self._finish(run, ev.STOPPED, event.why)

    # Decisions: the instant has settled, or a planner has answered.

    def _settled(self, run: Run, event: ev.Settled) -> Stepped:
        run = self._compared(run)
        if run.phase is Phase.IDLE:
            return self._ask(run)
        if run.phase is Phase.PLANNING:
            return run, ()
        if self.acting.is_goal(run.state):
            if run.running:
                return replace(run, phase=Phase.DRAINING), ()
            return self._finish(run, ev.GOAL, "")
        if run.reasons or run.phase is Phase.DRAINING:
            return self._drain(run)
        return self._dispatch(run)

    def _drain(self, run: Run) -> Stepped:
        cancels: tuple[Command, ...] = ()
        if run.phase is not Phase.DRAINING and self.profile.while_draining == "cancel":
            cancels = tuple(
                ev.Cancel(run.t, r.number)
                for r in run.running
                if r.step.agent and r.step.agent not in self.agents.robots
            )
        run = replace(run, phase=Phase.DRAINING)
        if run.running:
            return run, cancels
        if not run.reasons:  # the goal held for a moment and does no more
            run = run.because(ev.DEVIATION, "the goal does not hold any more")
        return self._replan(run)

    def _replan(self, run: Run) -> Stepped:
        if run.tally.n_replans < self.profile.replan_limit:
            return self._ask(run)
        why = "; ".join(r.text for r in run.reasons)
        if any(r.kind != ev.CHANGE for r in run.reasons):
            return self._finish(run, ev.REPLAN_LIMIT, why)
        told = ev.Tell(run.t, "replan-limit", f"no replan left, the plan goes on: {why}")
        run, commands = self._dispatch(replace(run, reasons=(), phase=Phase.EXECUTING))
        return run, (told, *commands)

    def _ask(self, run: Run) -> Stepped:
        run = replace(run, phase=Phase.PLANNING, n_asked=len(run.reasons))
        return run, (
            ev.AskPlan(
                run.t, self.acting.changing(run.state), run.state.values, self.told(run),
                tuple(f"{r.kind}: {r.text}" for r in run.reasons),
            ),
        )  # fmt: skip

    def _planned(self, run: Run, event: ev.Planned) -> Stepped:
        if run.phase is not Phase.PLANNING:
            return run, (ev.Tell(run.t, "unasked-plan", "a plan that nobody asked for"),)
        if len(run.reasons) > run.n_asked and len(run.reasons) <= MAX_ASKED_AGAIN + run.n_asked:
            return self._ask(run)  # something changed while the planner thought: the same replan
        rest = self._rest(run)
        kind = _counted([r.kind for r in run.reasons])
        if event.plan is None:
            return self._without_plan(run, event, rest, kind)
        if rest is None or not _no_worse(rest[1], event.metric):
            return self._adopt(run, event.plan, kind)
        if self._may_confirm(run, kind):
            return self._confirm(run, "the plan stays the best")
        # Equally good plans differ in who does what: people are not asked to swap for nothing.
        return self._adopt(run, rest[0], kind)

    def _may_confirm(self, run: Run, kind: str | None) -> bool:
        """Whether the running plan may be confirmed: never after a failure, once per instant."""
        worse_only = self.profile.replan == "worse"
        return worse_only and kind != ev.FAILURE and run.confirmed_s != run.t

    def _without_plan(
        self, run: Run, event: ev.Planned, rest: tuple[Plan, Number] | None, kind: str | None
    ) -> Stepped:
        """Go on with the running plan if it can still be followed, else end the run."""
        if rest is None:
            return self._finish(run, ev.NO_PLAN, event.note)
        if kind == ev.CHANGE:
            return self._confirm(run, f"no new plan ({event.note})")
        return self._adopt(run, rest[0], kind)

    def _confirm(self, run: Run, why: str) -> Stepped:
        tally = replace(run.tally, plans_confirmed=run.tally.plans_confirmed + 1)
        run = replace(run, phase=Phase.EXECUTING, reasons=(), tally=tally, confirmed_s=run.t)
        return run, (ev.Tell(run.t, "plan-confirmed", why),)

    def _adopt(self, run: Run, plan: Plan, kind: str | None) -> Stepped:
        steps = [self.acting.step(action) for action in plan.actions]
        if any(step is None for step in steps):
            return self._finish(run, ev.NO_PLAN, "the plan has an action that the domain has not")
        tally = replace(run.tally, assigned=plus(run.tally.assigned, [s.agent for s in steps if s]))
        if kind is not None:
            tally = replace(tally, replans=plus(tally.replans, [kind]))
        why = "; ".join(f"{r.kind}: {r.text}" for r in run.reasons)
        pursuit = FollowedPlan(plan, self._order(plan))
        run = replace(run, phase=Phase.EXECUTING, pursuit=pursuit, tally=tally, reasons=())
        return run, (ev.Adopt(run.t, plan, why),)

    def _order(self, plan: Plan) -> Waits:
        if plan not in self._orders:
            self._orders[plan] = waits(self.problem, plan)
        return self._orders[plan]

    def _rest(self, run: Run) -> tuple[Plan, Number] | None:
        """Return what is left of the running plan and its metric now; None if it cannot go on."""
        pursuit = run.pursuit
        if pursuit is None:
            return None
        rest = rest_of(pursuit.plan, pursuit.order, pursuit.ended, self.problem.domain.is_temporal)
        now = self.now(run)
        report = validate(now, rest)
        value = objective(now, report)
        return None if not report.valid or value is None else (rest, value)

    # Dispatch: every action whose turn has come, if it still can be done.

    def _dispatch(self, run: Run) -> Stepped:
        pursuit = run.pursuit
        assert pursuit is not None
        commands: list[Command] = []
        for index, planned in enumerate(pursuit.plan.actions):
            if index in pursuit.begun or not self._is_free(run, planned):
                continue
            ready = run.pursuit.ready_s(index) if run.pursuit else None
            if ready is None:
                continue
            if ready > run.t + ev.INSTANT_S:
                commands.append(ev.Wake(run.t, ready))
                continue
            run, command = self._start(run, index, planned)
            if command is None:
                drained, more = self._drain(run)
                return drained, (*commands, *more)
            commands.append(command)
        if not run.running and not commands:
            return self._drain(run.because(ev.DEVIATION, "the plan has ended without the goal"))
        return run, tuple(commands)

    def _is_free(self, run: Run, planned: PlannedAction) -> bool:
        step = self.acting.step(planned)
        return step is not None and not any(step.busy & r.step.busy for r in run.running)

    def _start(
        self, run: Run, index: int, planned: PlannedAction
    ) -> tuple[Run, ev.Dispatch | None]:
        """Begin one action, or note as a deviation that it cannot begin."""
        step = self.acting.step(planned)
        assert step is not None
        assert run.pursuit is not None
        obstacle = self.acting.obstacle(run.state, step, self.told(run))
        if obstacle is not None:
            return run.because(ev.DEVIATION, f"{planned} needs {obstacle}"), None
        duration = planned.duration_s if step.schema.durative else None
        lasts = float(UNIT_S if duration is None else duration)
        state, undo = self.acting.begin(run.state, step, duration or 0)
        action = RunningAction(run.n_dispatched, index, step, run.t, lasts, undo)
        pursuit = replace(run.pursuit, begun={**run.pursuit.begun, index: run.t})
        run = replace(
            run, state=state, running=(*run.running, action), pursuit=pursuit,
            n_dispatched=run.n_dispatched + 1,
        )  # fmt: skip
        return run, ev.Dispatch(run.t, action.number, step.agent, planned.name, planned.args, lasts)

    def _finish(self, run: Run, ending: str, why: str) -> Stepped:
        run = replace(run, phase=Phase.OVER, ending=ending, why=why)
        return run, (ev.Finish(run.t, ending, why),)


def _counted(kinds: list[str]) -> str | None:
    """Return what one replan is counted as: the worst of its reasons; None for the first plan."""
    for kind in (ev.FAILURE, ev.DEVIATION, ev.CHANGE):
        if kind in kinds:
            return kind
    return None


def _no_worse(mine: Number, theirs: Number | None) -> bool:
    return theirs is not None and float(mine) <= float(theirs) + _TIE * max(1.0, abs(float(theirs)))
