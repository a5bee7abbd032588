"""The first half of the monitor: each event updates what is believed about the run.

Nothing is decided here. ``decide.py`` does that when the instant has settled.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from hrcplan.core.numbers import Number, number_text
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import BoundAction
from hrcplan.execution.codec import exact_number
from hrcplan.execution.events import Command
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.run import Phase, Run, RunningAction, RunStep, plus
from hrcplan.pddl.model import FluentKey, fact_text
from hrcplan.pddl.semantics import LiftedState


class Observer:
    """Updates what is believed about one problem; ``sensing`` false ignores sensed values."""

    def __init__(self, model: ExecutionModel, sensing: bool = True) -> None:
        self.actions, self.agents, self.timed = model.actions, model.agents, model.timed
        self.sensing = sensing

    def outcome(self, run: Run, event: ev.Ended) -> RunStep:
        """Return the run after an action has ended; an impossible outcome is only reported."""
        action = run.running_action(event.number)
        if action is None:
            is_past = 0 <= event.number < run.n_dispatched
            what = "has ended before" if is_past else "was never dispatched"
            return run, (ev.Tell(run.t, "unknown-action", f"action {event.number} {what}"),)
        if event.outcome not in ev.OUTCOMES:
            return run, (ev.Tell(run.t, "unknown-outcome", f"no outcome '{event.outcome}'"),)
        if event.outcome == ev.DONE:
            return self._take_success(run, action), ()
        return self._revert(run, action, event.outcome), ()

    def _take_success(self, run: Run, action: RunningAction) -> Run:
        plan = run.current_plan
        if plan is not None and action.index is not None:
            plan = replace(plan, ended=plan.ended | {action.index})
        step, counts = action.step, run.counts
        counts = replace(
            counts, done=plus(counts.done, [step.agent]), last_end_s=run.t,
            interactions=counts.interactions + self.agents.is_interaction(step.schema.name),
        )  # fmt: skip
        run = replace(
            run, running=run.without(action), current_plan=plan, counts=counts,
            state=self.actions.finish(
                run.state, step, _number(action.duration_s), action.start_effects
            ),
            memory=run.memory.went_well(self._touching(step)),
        )  # fmt: skip
        return self._after_interaction(run, step)

    def _after_interaction(self, run: Run, step: BoundAction) -> Run:
        """Expect an interaction to have its effect; what is sensed next says whether it had."""
        for key, value in self.actions.influence(step, run.sensed_values).items():
            if key in self.agents.low:
                run = run.with_sensed(key, self.agents.clamp(key, value))
        return run

    def _revert(self, run: Run, action: RunningAction, outcome: str) -> Run:
        """Take a failed or cancelled action back: no effect, the time is used up."""
        agent, counts = action.step.agent, run.counts
        broken = self._broken_condition(run, action.step)
        plan = run.current_plan
        if plan is not None:
            starts = {i: t for i, t in plan.begun.items() if i != action.index}
            plan = replace(plan, begun=starts)
        run = replace(
            run, running=run.without(action), current_plan=plan,
            state=self.actions.revert(run.state, action.start_effects),
        )  # fmt: skip
        if outcome == ev.CANCELLED:
            counts = replace(counts, cancelled=plus(counts.cancelled, [agent]), last_end_s=run.t)
            return replace(run, counts=counts)
        counts = replace(counts, failed=plus(counts.failed, [agent]), last_end_s=run.t)
        text = _action_text(action.step)
        if outcome == ev.UNKNOWN:  # which is no sign of an agent's state
            run = replace(run, counts=counts)
            return run.with_reason(ev.FAILURE, f"whether {text} was done is unknown")
        if broken is not None:  # which is no sign of an agent's state either
            run = replace(run, counts=counts)
            return run.with_reason(ev.FAILURE, f"{text} failed, {broken} does not hold any more")
        memory = run.memory.failed(self._suspects(run, action.step))
        text = f"{text} failed"
        return replace(run, counts=counts, memory=memory).with_reason(ev.FAILURE, text)

    def _broken_condition(self, run: Run, step: BoundAction) -> str | None:
        """Return the condition of a failed action that a timed initial literal has made false."""
        if not self.timed.literals:
            return None
        return self.actions.unmet_phase(run.state, step, "all") or self.timed.obstacle_at_end(
            self.actions, run.state, step
        )

    def timed_events(self, run: Run, n_happened: int) -> Run:
        """Return the run after so many of the problem's timed initial literals have happened."""
        if n_happened <= run.n_happened:
            return run
        state = run.state
        for change in self.timed.literals[run.n_happened : n_happened]:
            state = self.actions.happen(state, change)
        return replace(run, state=state, n_happened=n_happened)

    def _suspects(self, run: Run, step: BoundAction) -> Iterable[FluentKey]:
        """Return the elements that can have made an action fail: those sensed high, if any."""
        suspects = self._touching(step)
        if not self.sensing:
            return suspects
        values = run.sensed_values
        return [k for k in suspects if self.agents.failure_probability(k, values) > 0] or suspects

    def _touching(self, step: BoundAction) -> tuple[FluentKey, ...]:
        return self.agents.touching(step.schema.name, tuple(step.binding.values()))

    def overdue(self, run: Run, event: ev.Overdue) -> RunStep:
        """Return the run without an action that lasts too long: it is cancelled and has failed."""
        action = run.running_action(event.number)
        if action is None:
            return run, ()
        return self._revert(run, action, ev.FAILED), (ev.Cancel(run.t, event.number),)

    def state(self, run: Run, event: ev.Observed) -> Run:
        """Return the run with an observed state, to be compared once the instant has settled."""
        numbers = run.state.values if event.numbers is None else event.numbers
        return replace(run, observation=self.actions.state(event.facts, numbers, event.absent))

    def sensed_values(self, run: Run, event: ev.Sensed) -> RunStep:
        """Return the run with valid sensed values; an invalid one is reported and not used."""
        messages: list[Command] = []
        for key, value in event.values.items():
            try:
                exact = self.agents.check(key, value)
            except UsageError as error:
                message = f"sensed {' '.join(key)} = {value}: {error.message}"
                messages.append(ev.Tell(run.t, "bad-sensed-value", message))
                continue
            run = self._with_value(run, key, exact)
        return run, tuple(messages)

    def _with_value(self, run: Run, key: FluentKey, value: Number) -> Run:
        before = run.sensed_values.get(key, self.agents.low[key])
        if not self.sensing or value == before:
            return run
        run = run.with_sensed(key, value)
        if run.phase is Phase.IDLE:
            return run  # known before the first plan
        text = f"{fact_text(key)} {number_text(before)} → {number_text(value)}"
        return run.with_reason(ev.CHANGE, text)

    def compare_states(self, run: Run) -> Run:
        """Return the run with the observed state, and a deviation if it is not the expected one."""
        observation = run.observation
        if observation is None:
            return run
        run = replace(run, observation=None)
        if observation.facts == run.state.facts and observation.values == run.state.values:
            return run
        text = _difference(run.state, observation)
        return replace(run, state=observation).with_reason(ev.DEVIATION, text)


def _number(seconds: float) -> Number:
    return int(seconds) if seconds == int(seconds) else exact_number(seconds)  # type: ignore[return-value]


def _action_text(step: BoundAction) -> str:
    return fact_text((step.schema.name, *step.binding.values()))


def _difference(expectation: LiftedState, observation: LiftedState) -> str:
    missing = sorted(frozenset(expectation.facts) - frozenset(observation.facts))
    extra = sorted(frozenset(observation.facts) - frozenset(expectation.facts))
    words = [f"{fact_text(fact)} does not hold" for fact in missing]
    words += [f"{fact_text(fact)} holds" for fact in extra]
    words += [
        f"{fact_text(key)} is {number_text(observation.values[key])}"
        for key in sorted(observation.values)
        if expectation.values.get(key) != observation.values[key]
    ]
    return ", ".join(words)
