"""What people report to the companion: actions, words, answers, corrections."""

from __future__ import annotations

from dataclasses import replace

from hrcplan.collaboration import events as shared
from hrcplan.collaboration.history import (
    AskedGoal,
    DeniedGoals,
    EndedAction,
    History,
    PassedTurn,
    as_failed,
    begun_action,
    state_after,
    without,
)
from hrcplan.collaboration.run import CompanionPhase, CompanionRun, CompanionStep
from hrcplan.collaboration.setup import FREE, TURNS, CollaborationSetup
from hrcplan.core.numbers import Number
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import UNIT_S, BoundAction
from hrcplan.execution.decide import Decider
from hrcplan.execution.observe import Observer
from hrcplan.execution.run import Run, begin_action
from hrcplan.pddl.model import fact_text
from hrcplan.pddl.semantics import Undefined
from hrcplan.planners.lanes import shortest_duration
from hrcplan.plans import PlannedAction, parse_plan


class Reports:
    """Takes in what people report in one collaboration."""

    def __init__(self, setup: CollaborationSetup, observer: Observer, decider: Decider) -> None:
        self.setup, self.actions = setup, setup.model.actions
        self.observer, self.decider = observer, decider

    def begin(self, companion: CompanionRun, step: BoundAction) -> tuple[CompanionRun, ev.Dispatch]:
        """Return the run when an action that can begin has begun."""
        duration = self._duration(step)
        is_timed = self.setup.pace == FREE or self.setup.has_one_goal
        lasts = float(duration if is_timed and step.schema.durative else UNIT_S)
        run, dispatch = begin_action(self.actions, companion.run, step, duration, lasts)
        companion = replace(companion, run=run, has_acted=True)
        return companion.with_dispatches((dispatch,), self.setup.robots), dispatch

    def _duration(self, step: BoundAction) -> Number:
        if not step.schema.durative:
            return 0
        try:
            return shortest_duration(self.setup.problem, step.schema, step.binding)
        except Undefined:
            return UNIT_S

    def obstacle(self, run: Run, step: BoundAction) -> str | None:
        """Return what keeps an action from beginning now; None if nothing does."""
        if step.busy & {agent for r in run.running for agent in r.step.busy}:
            return "an agent that is busy"
        return self.actions.obstacle(run.state, step, self.decider.planner_values(run))

    def begun(self, companion: CompanionRun, event: shared.Begun) -> CompanionStep:
        """Return the run when a person has begun an action; an impossible one is only reported."""
        step = self.actions.step(PlannedAction(event.action, event.args))
        text = fact_text((event.action, *event.args))
        if step is None:
            return _told(companion, "unknown-action", f"there is no action {text}")
        agent = step.agent or event.agent
        if agent not in self.setup.people or (step.agent and event.agent not in ("", step.agent)):
            return _told(companion, "unknown-agent", f"{text} is no action of a person here")
        if self.setup.has_one_goal and _runs(companion.run, step):
            return self._closed(_begun_now(companion, step)), ()  # it was asked for
        companion = self._after_question(companion, agent)
        if not self._has_turn(companion, agent):
            return _told(companion, "not-your-turn", f"it is not the turn of {agent}")
        after, cancels = self._without_request(companion, agent)
        obstacle = self.obstacle(after.run, step)
        if obstacle is not None:
            return _told(companion, "impossible", f"{text} needs {obstacle}")
        after, dispatch = self.begin(self._closed(after), step)
        if self.setup.has_one_goal:
            run = after.run.with_reason(ev.DEVIATION, f"{agent} does {text}")
            after = replace(after, run=run)
        return after, (*cancels, dispatch)

    def _after_question(self, companion: CompanionRun, agent: str) -> CompanionRun:
        """Return the run in a person's turn if they go on instead of saying that it was all."""
        question = companion.question
        if question is None or companion.running or self.setup.pace != TURNS:
            return companion
        if not companion.has_acted and question.question != shared.GOAL:
            return companion
        following = companion.in_next_turn(len(self.setup.slots))
        return following if agent in self.setup.slots[following.slot] else companion

    def _has_turn(self, companion: CompanionRun, agent: str) -> bool:
        if self.setup.pace != TURNS or self.setup.has_one_goal:
            return True
        return agent in self.setup.slots[companion.slot] and not companion.has_acted

    def _without_request(self, companion: CompanionRun, agent: str) -> CompanionStep:
        """Return the run without what a plan asks an agent to do, and the commands for that."""
        requests = [
            r for r in companion.running if r.index is not None and agent in r.step.busy
        ]  # fmt: skip
        for request in requests:
            ended = ev.Ended(companion.t, request.number, ev.CANCELLED)
            run, _ = self.observer.outcome(companion.run, ended)
            companion = replace(companion, run=run).plus(EndedAction(request.number, ev.CANCELLED))
        return companion, tuple(ev.Cancel(companion.t, r.number) for r in requests)

    def passed(self, companion: CompanionRun, event: shared.Passed) -> CompanionStep:
        """Return the run when a person does nothing now, or does not answer a question."""
        slot = self.setup.slots[companion.slot]
        agent = event.agent or slot[0]
        if self.setup.has_one_goal or companion.question is not None:
            return self._closed(companion), ()
        if not self._has_turn(companion, agent):
            return _told(companion, "not-your-turn", f"it is not the turn of {agent}")
        return replace(self._closed(companion), has_acted=True).plus(PassedTurn(agent)), ()

    def idle(self, companion: CompanionRun) -> CompanionRun:
        """Return the run when people have stood still; only where agents take no turns."""
        takes_turns = self.setup.pace == TURNS or self.setup.has_one_goal
        if takes_turns or companion.phase is not CompanionPhase.LISTENING:
            return companion
        still = (agent for agent in self.setup.people if not companion.is_busy(agent))
        return companion.plus(*map(PassedTurn, still))

    def take_words(self, companion: CompanionRun, event: shared.Said) -> CompanionStep:
        """Return the run when a person has said something, and the question what it means."""
        agents = (event.agent,) if event.agent else self._listeners(companion)
        companion = replace(companion, phase=CompanionPhase.READING)
        return companion, (shared.AskReading(companion.t, agents, event.text),)

    def _listeners(self, companion: CompanionRun) -> tuple[str, ...]:
        if self.setup.pace == TURNS and not self.setup.has_one_goal:
            slot = self.setup.slots[companion.slot]
            if not self.setup.robots.intersection(slot):
                return slot
        return self.setup.people

    def read(self, companion: CompanionRun, event: shared.Read) -> CompanionStep:
        """Return the run when the meaning of words has arrived: an action, a question, nothing."""
        if companion.phase is not CompanionPhase.READING:
            return _told(companion, "unasked-reading", "a reading that was not asked for")
        is_asking = companion.question is not None
        phase = CompanionPhase.ASKING if is_asking else CompanionPhase.LISTENING
        companion = replace(companion, phase=phase)
        if event.outcome == shared.ACT and len(event.options) == 1:
            return self._begun_text(companion, event.options[0])
        if event.outcome == shared.ASK and event.options:
            ask = shared.Ask(companion.t, shared.WHICH, event.options)
            return replace(companion, phase=CompanionPhase.ASKING, question=ask), (ask,)
        why = event.note or "this is no action that can be done now"
        return _told(companion, "not-understood", why)

    def _begun_text(self, companion: CompanionRun, text: str) -> CompanionStep:
        action = parse_plan(text).actions[0]
        return self.begun(companion, shared.Begun(companion.t, "", action.name, action.args))

    def answered(self, companion: CompanionRun, event: shared.Answered) -> CompanionStep:
        """Return the run when the open question has been answered."""
        question = companion.question
        if question is None:
            return _told(companion, "unasked-answer", "an answer to no question")
        if question.question == shared.WHICH:
            if event.choice not in question.options:
                return _told(companion, "unknown-answer", f"'{event.choice}' was no option")
            return self._begun_text(self._closed(companion), event.choice)
        if question.question == shared.GOAL:
            if event.choice not in question.options:
                return _told(companion, "unknown-answer", f"'{event.choice}' was no option")
            return self._closed(companion, event.choice), ()
        if event.choice != shared.YES:
            return self._closed(companion), ()
        run, commands = self.decider.finish(companion.run, ev.GOAL, ", ".join(question.options))
        reached = frozenset(question.options)
        return replace(companion, run=run, question=None, reached=reached), commands

    def _closed(self, companion: CompanionRun, answer: str = "") -> CompanionRun:
        """Return the run without an open question; goals that people go on from are not all.

        Args:
            companion: The run.
            answer: What people have said to a question about their goal; "" if nothing.
        """
        question = companion.question
        if question is None:
            return companion
        denied = companion.denied
        if question.question == shared.GOAL:
            goals = tuple(o for o in question.options if o != shared.OTHER)
            companion = companion.plus(AskedGoal(goals, answer))
        if question.question == shared.DONE:
            denied = denied | frozenset(question.options)
            if self.setup.is_joint:
                companion = companion.plus(DeniedGoals(question.options))
        return replace(companion, question=None, denied=denied, phase=CompanionPhase.LISTENING)

    def undone(self, companion: CompanionRun, event: shared.Undone) -> CompanionStep:
        """Return the run as if a person had never begun an action, or as if it had failed.

        What robots did since remains.
        """
        number = event.number
        action = begun_action(companion.history, number)
        if action is None or action.is_robot:
            return _told(companion, "nothing-to-undo", "no action of a person can be taken back")
        change = as_failed if event.attempted else without
        is_running = companion.run.running_action(number) is not None
        if companion.question is not None:  # which is withdrawn, not answered
            companion = replace(companion, question=None, phase=CompanionPhase.LISTENING)
        companion = self._corrected(companion, change(companion.history, number), number)
        if self.setup.has_one_goal:
            reason = f"{fact_text(action.words)} was not done"
            companion = replace(companion, run=companion.run.with_reason(ev.DEVIATION, reason))
        if not event.attempted:  # the turn has not been used
            slot = next(i for i, s in enumerate(self.setup.slots) if action.agent in s)
            companion = replace(companion, slot=slot, has_acted=False)
        cancel = (ev.Cancel(companion.t, number),) if is_running else ()
        model, state = self.actions, companion.run.state
        facts, absent = model.changing(state), model.absent(state)
        return companion, (*cancel, shared.Correct(companion.t, facts, state.values, absent))

    def _corrected(self, companion: CompanionRun, history: History, number: int) -> CompanionRun:
        """Return the run with another history, in which an action does not run any more."""
        state, effects = state_after(history, self.actions)
        running = tuple(
            replace(r, start_effects=effects[r.number])
            for r in companion.running
            if r.number != number
        )
        run = replace(companion.run, state=state, running=running)
        return replace(companion, run=run, history=history)


def _runs(run: Run, step: BoundAction) -> bool:
    return any(r.step == step for r in run.running)


def _begun_now(companion: CompanionRun, step: BoundAction) -> CompanionRun:
    """Return the run in which an action that a plan asked for begins now."""
    run = companion.run
    running = tuple(replace(r, begun_s=run.t) if r.step == step else r for r in run.running)
    return replace(companion, run=replace(run, running=running))


def _told(companion: CompanionRun, code: str, message: str) -> CompanionStep:
    return companion, (ev.Tell(companion.t, code, message),)
