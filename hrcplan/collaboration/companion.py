"""The companion: from what people and robots do to what the robot does. Pure; it can be replayed.

``Companion.step(run, event)`` returns the next run and commands, as the monitor of execution does,
on the same observer. It follows a belief: whenever a robot may act, it asks for a step (`AskStep`).
With one goal there is nothing to believe, and it follows a plan as the monitor does.

What the robot may begin is judged in the state as it is, with what runs begun; what it wants is
judged by the assistant, for which all that runs is done.
"""

from __future__ import annotations

from dataclasses import replace

from hrcplan.bank.composed_goals import composed_formula
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import SharedEvent
from hrcplan.collaboration.history import (
    BegunAction,
    ComposedGoals,
    DeniedGoals,
    EndedAction,
    PassedTurn,
    SeenState,
    SensedValues,
    WantedGoal,
    composed_in,
)
from hrcplan.collaboration.reports import Reports
from hrcplan.collaboration.run import CompanionPhase, CompanionRun, CompanionStep
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.execution import events as ev
from hrcplan.execution.decide import MAX_ASKED_AGAIN
from hrcplan.execution.monitor import Monitor
from hrcplan.execution.run import Phase
from hrcplan.plans import PlannedAction

LEAST_WAITS = 2  # before people are asked again about a goal that they have denied


class Companion:
    """The machine of one collaboration."""

    def __init__(self, setup: CollaborationSetup) -> None:
        self.setup = setup
        self.monitor = Monitor(setup.model, setup.profile)
        self.observer, self.decider = self.monitor.observer, self.monitor.decider
        self.reports = Reports(setup, self.observer, self.decider)

    def begin(self) -> CompanionRun:
        """Return a run at time 0. Goals that hold already end nothing."""
        run = self.monitor.begin()
        if self.setup.has_one_goal:
            return CompanionRun(run)
        return CompanionRun(
            replace(run, phase=Phase.EXECUTING), denied=self.setup.reached(run.state)
        )

    def step(self, run: CompanionRun, event: SharedEvent) -> CompanionStep:
        """Return the run after an event, and the commands that follow from it, in order.

        A run that is over does not change.
        """
        if run.is_over:
            return run, ()
        run = replace(run, run=replace(run.run, t=max(run.t, event.t)))
        match event:
            case shared.Begun():
                return self.reports.begun(run, event)
            case shared.Passed():
                return self.reports.passed(run, event)
            case shared.Idle():
                return self.reports.idle(run), ()
            case shared.Said():
                return self.reports.take_words(run, event)
            case shared.Read():
                return self.reports.read(run, event)
            case shared.Answered():
                return self.reports.answered(run, event)
            case shared.Undone():
                return self.reports.undone(run, event)
            case shared.StateTold(t, values):
                return self._sensed(run, ev.Sensed(t, values))
            case ev.Sensed():
                return self._sensed(run, event)
            case shared.Wanted():
                return run.plus(WantedGoal(event.goal)), ()
            case shared.Stopped():
                return replace(run, is_paused=True), self._cancels(run)
            case shared.Paused() | shared.Continued():
                return replace(run, is_paused=isinstance(event, shared.Paused)), ()
            case shared.Chosen():
                return self._chosen(run, event)
            case ev.Settled():
                return self._settled(run)
            case ev.Ended() | ev.Overdue():
                return self._ended(run, event)
            case _:
                return self._observed(run, event)

    def _cancels(self, run: CompanionRun) -> tuple[ev.Cancel, ...]:
        """Return the commands that break off what robots do."""
        own = (action for action in run.running if action.step.agent in self.setup.robots)
        return tuple(ev.Cancel(run.t, action.number) for action in own)

    def _ended(self, run: CompanionRun, event: ev.Ended | ev.Overdue) -> CompanionStep:
        is_running = run.run.running_action(event.number) is not None
        outcome = event.outcome if isinstance(event, ev.Ended) else ev.FAILED
        if not is_running and outcome == ev.CANCELLED:
            return run, ()  # it was taken back
        n_late = self._n_late(run, event)
        inner, commands = self.monitor.step(run.run, event)
        run = replace(run, run=inner)
        if is_running and inner.running_action(event.number) is None:
            run = run.plus(EndedAction(event.number, outcome, n_late))
        return run, commands

    def _n_late(self, run: CompanionRun, event: ev.Ended | ev.Overdue) -> int:
        """Return how often an action could have been done once more in the time that it took."""
        action = run.run.running_action(event.number)
        if action is None or self.setup.pace == TURNS or action.duration_s <= 0:
            return 0
        return max(0, round((event.t - action.begun_s) / action.duration_s) - 1)

    def _sensed(self, run: CompanionRun, event: ev.Sensed) -> CompanionStep:
        before = run.run.sensed_values
        run, commands = self._observed(run, event)
        now = run.run.sensed_values
        news = {key: now[key] for key in event.values if key in now and now[key] != before.get(key)}
        if not self.setup.is_joint:
            return run, commands
        return (run.plus(SensedValues(news)) if news else run), commands

    def _observed(self, run: CompanionRun, event: SharedEvent) -> CompanionStep:
        """Return the run after an event that the monitor of execution understands."""
        assert isinstance(event, ev.Event)
        inner, commands = self.monitor.step(run.run, event)
        return self._after(replace(run, run=inner), commands)

    def _after(self, run: CompanionRun, commands: tuple[ev.Command, ...]) -> CompanionStep:
        return run.with_dispatches(commands, self.setup.robots), commands

    # An instant has settled.

    def _settled(self, run: CompanionRun) -> CompanionStep:
        inner = self.observer.compare_states(run.run)
        if inner.state is not run.run.state and inner.state != run.run.state:
            seen = SeenState(frozenset(inner.state.facts), inner.state.values)
            run = run.plus(seen)
        run = replace(run, run=inner)
        if run.phase is not CompanionPhase.LISTENING:
            return run, ()
        question = self._done_question(run)
        if question is not None:
            return replace(run, question=question, phase=CompanionPhase.ASKING), (question,)
        run = replace(run, denied=run.denied & self._reached(run))
        if run.is_paused:
            return run, ()
        if self.setup.has_one_goal:
            return self._follow_plan(run)
        run = replace(run, run=replace(run.run, reasons=()))
        return self._take_turns(run) if self.setup.pace == TURNS else self._ask_idle(run)

    def _done_question(self, run: CompanionRun) -> shared.Ask | None:
        """Return the question whether that was all, if a goal holds that was not asked about."""
        if self.setup.has_one_goal and run.running:
            return None
        reached = self._reached(run)
        n_waits = self._n_waits(run)
        if not self.setup.is_joint or n_waits < LEAST_WAITS or n_waits & (n_waits - 1):
            reached -= run.denied  # who waits on and on may want by now what they have denied
        names = tuple(name for name in self.setup.goals if name in reached)
        if not names and reached:
            names = (next(name for name, _ in run.belief.goals if name in reached),)
        return shared.Ask(run.t, shared.DONE, names) if names else None

    def _reached(self, run: CompanionRun) -> frozenset[str]:
        """Return the goals that hold; of those that were composed only a probable one.

        Where people stand still, any of them may be what they wanted.
        """
        listed = self.setup.reached(run.run.state)
        composed = composed_in(run.history)
        if not composed:
            return listed
        still = self._n_waits(run) > 0
        names = {n for n, p in run.belief.goals if n in composed and (still or p > shared.HALF)}
        formulas = {name: composed_formula(name) for name in names | (run.denied - listed)}
        return listed | self.setup.reached(run.run.state, formulas)

    def _n_waits(self, run: CompanionRun) -> int:
        """Return how often people have done nothing; 0 if they have just denied that it is all."""
        n_waits = 0
        for mark in reversed(run.history):
            if isinstance(mark, DeniedGoals) and not n_waits:
                return 0
            if isinstance(mark, BegunAction) and not mark.is_robot:
                break
            n_waits += isinstance(mark, PassedTurn) and mark.agent in self.setup.people
        return n_waits

    def _follow_plan(self, run: CompanionRun) -> CompanionStep:
        if run.denied and not run.running:
            return run, ()  # the goal holds, and the people go on
        inner, commands = self.decider.decide(run.run)
        return self._after(replace(run, run=inner), commands)

    def _take_turns(self, run: CompanionRun) -> CompanionStep:
        if run.running:
            return run, ()
        if run.has_acted:
            run = run.in_next_turn(len(self.setup.slots))
        agents = self.setup.slots[run.slot]
        return self._ask_step(run, agents) if self.setup.robots.issuperset(agents) else (run, ())

    def _ask_idle(self, run: CompanionRun) -> CompanionStep:
        """Ask for a step of the idle robots, once for every change of what was seen."""
        idle = tuple(
            a for slot in self.setup.slots for a in slot
            if a in self.setup.robots and not run.is_busy(a)
        )  # fmt: skip
        if not idle or run.step_request == (idle, run.history):
            return run, ()
        return self._ask_step(run, idle)

    def _ask_step(self, run: CompanionRun, agents: tuple[str, ...]) -> CompanionStep:
        run = replace(run, phase=CompanionPhase.CHOOSING, step_request=(agents, run.history))
        return run, (shared.AskStep(run.t, agents),)

    # The assistant has answered.

    def _chosen(self, run: CompanionRun, event: shared.Chosen) -> CompanionStep:
        if run.phase is not CompanionPhase.CHOOSING or run.step_request is None:
            return run, (ev.Tell(run.t, "unasked-step", "a step that was not asked for"),)
        agents, history = run.step_request
        if history != run.history and run.n_asked_again < MAX_ASKED_AGAIN:
            return self._ask_step(replace(run, n_asked_again=run.n_asked_again + 1), agents)
        notes = self._change_notes(run, event)
        if event.composed:
            run = run.plus(ComposedGoals(event.composed))
        run = replace(run, phase=CompanionPhase.LISTENING, belief=event, n_asked_again=0)
        if event.asks:
            question = shared.Ask(run.t, shared.GOAL, (*event.asks, shared.OTHER))
            run = replace(run, phase=CompanionPhase.ASKING, question=question)
            return run, (*notes, question)
        step = self.reports.actions.step(PlannedAction(event.action, event.args))
        if event.action and (step is None or (step.agent and step.agent not in agents)):
            text = f"{PlannedAction(event.action, event.args)} is no step of {', '.join(agents)}"
            notes = (*notes, ev.Tell(run.t, "unknown-step", text))
            step = None
        if step is None or self.reports.obstacle(run.run, step) is not None:
            return self._waited(run, agents), notes
        run, dispatch = self.reports.begin(run, step)
        return run, (*notes, dispatch)

    def _waited(self, run: CompanionRun, agents: tuple[str, ...]) -> CompanionRun:
        """Return the run when a robot does not act; a wait is a turn only where turns are taken."""
        if self.setup.pace != TURNS:
            return run
        return replace(run, has_acted=True).plus(PassedTurn(agents[0]))

    def _change_notes(self, run: CompanionRun, event: shared.Chosen) -> tuple[ev.Tell, ...]:
        if event.n_declared <= run.belief.n_declared or not event.goals:
            return ()
        return (ev.Tell(run.t, "goal-change", f"the goal seems to be {event.goals[0][0]} now"),)
