"""What has happened, as far as it can be known: each event changes what is believed.

Beliefs only; what is to be done about them is decided in ``monitor.py``, once the instant settled.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from hrcplan.agents import AgentModel, Profile
from hrcplan.agents.state import LEAST, MOST
from hrcplan.core.numbers import Number, number_text
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.execution.acting import ActionModel, BoundAction
from hrcplan.execution.codec import exact_number
from hrcplan.execution.events import Command
from hrcplan.execution.order import Waits
from hrcplan.execution.run import Phase, Run, RunningAction, plus
from hrcplan.pddl.model import FluentKey, Problem, fact_text
from hrcplan.pddl.semantics import LiftedState
from hrcplan.planners.expected_price import expected_retries
from hrcplan.plans import Plan

Stepped = tuple[Run, tuple[Command, ...]]


@dataclass(frozen=True)
class Observer:
    """One problem and one profile; ``sensing`` false means that sensed values are not used."""

    problem: Problem
    profile: Profile
    sensing: bool = True
    agents: AgentModel = field(init=False)
    acting: ActionModel = field(init=False)
    _priced: Problem = field(init=False, repr=False)
    _orders: dict[Plan, Waits] = field(init=False, default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        """Look up what depends on the problem alone."""
        object.__setattr__(self, "agents", AgentModel(self.problem))
        object.__setattr__(self, "acting", ActionModel(self.problem))
        object.__setattr__(self, "_priced", expected_retries(self.problem))

    def begin(self) -> Run:
        """Return a run at time 0, before its first plan."""
        return Run(self.acting.initial(), memory=self.profile.begin(self.agents))

    def _ended(self, run: Run, event: ev.Ended) -> Stepped:
        action = run.find(event.number)
        if action is None:
            known = 0 <= event.number < run.n_dispatched
            what = "has ended before" if known else "was never dispatched"
            return run, (ev.Tell(run.t, "unknown-action", f"action {event.number} {what}"),)
        if event.outcome not in ev.OUTCOMES:
            return run, (ev.Tell(run.t, "unknown-outcome", f"no outcome '{event.outcome}'"),)
        if event.outcome == ev.DONE:
            return self._done(run, action), ()
        return self._undone(run, action, event.outcome), ()

    def _done(self, run: Run, action: RunningAction) -> Run:
        assert run.pursuit is not None
        pursuit = replace(run.pursuit, ended=run.pursuit.ended | {action.index})
        step, tally = action.step, run.tally
        tally = replace(
            tally, done=plus(tally.done, [step.agent]), last_end_s=run.t,
            interactions=tally.interactions + self.agents.is_interaction(step.schema.name),
        )  # fmt: skip
        run = replace(
            run, running=run.without(action), pursuit=pursuit, tally=tally,
            state=self.acting.finish(run.state, step, _number(action.duration_s)),
            memory=run.memory.went_well(self._touching(step)),
        )  # fmt: skip
        return self._influenced(run, step)

    def _influenced(self, run: Run, step: BoundAction) -> Run:
        """Expect an interaction to have its effect; what is sensed next says whether it had."""
        for key, value in self.acting.influence(step, run.sensed).items():
            if key in self.agents.low:
                expected = min(max(value, LEAST), MOST)
                memory = run.memory.sensed(key)
                run = replace(run, sensed={**run.sensed, key: expected}, memory=memory)
        return run

    def _undone(self, run: Run, action: RunningAction, outcome: str) -> Run:
        """Take a failed or cancelled action back: no effect, the time is used up."""
        agent, tally = action.step.agent, run.tally
        assert run.pursuit is not None
        begun = {i: t for i, t in run.pursuit.begun.items() if i != action.index}
        run = replace(
            run, running=run.without(action), pursuit=replace(run.pursuit, begun=begun),
            state=self.acting.undo(run.state, action.undo),
        )  # fmt: skip
        if outcome == ev.CANCELLED:
            tally = replace(tally, cancelled=plus(tally.cancelled, [agent]), last_end_s=run.t)
            return replace(run, tally=tally)
        tally = replace(tally, failed=plus(tally.failed, [agent]), last_end_s=run.t)
        memory = run.memory.failed(self._suspects(run, action.step))
        text = f"{_shown(action.step)} failed"
        return replace(run, tally=tally, memory=memory).because(ev.FAILURE, text)

    def _suspects(self, run: Run, step: BoundAction) -> Iterable[FluentKey]:
        """Return the elements that can have made an action fail: those sensed high, if any."""
        touched = self._touching(step)
        if not self.sensing:
            return touched
        high = [key for key in touched if self.agents.failure_probability(key, run.sensed) > 0]
        return high or touched

    def _touching(self, step: BoundAction) -> tuple[FluentKey, ...]:
        return self.agents.touching(step.schema.name, tuple(step.binding.values()))

    def _overdue(self, run: Run, event: ev.Overdue) -> Stepped:
        action = run.find(event.number)
        if action is None:
            return run, ()
        return self._undone(run, action, ev.FAILED), (ev.Cancel(run.t, event.number),)

    def _observed(self, run: Run, event: ev.Observed) -> Stepped:
        numbers = run.state.values if event.numbers is None else event.numbers
        return replace(run, observed=self.acting.state(event.facts, numbers)), ()

    def _sensed(self, run: Run, event: ev.Sensed) -> Stepped:
        """Take good values in; a bad one is rejected and the last good value stays."""
        told: list[Command] = []
        for key, value in event.values.items():
            try:
                exact = self.agents.check(key, value)
            except UsageError as error:
                message = f"sensed {' '.join(key)} = {value}: {error.message}"
                told.append(ev.Tell(run.t, "bad-sensed-value", message))
                continue
            run = self._updated(run, key, exact)
        return run, tuple(told)

    def _updated(self, run: Run, key: FluentKey, value: Number) -> Run:
        before = run.sensed.get(key, self.agents.low[key])
        if not self.sensing or value == before:
            return run
        run = replace(run, sensed={**run.sensed, key: value}, memory=run.memory.sensed(key))
        if run.phase is Phase.IDLE:
            return run  # known before the first plan
        text = f"{fact_text(key)} {number_text(before)} → {number_text(value)}"
        return run.because(ev.CHANGE, text)

    def _compared(self, run: Run) -> Run:
        """Hold the observed state against the expected one; what is observed is believed."""
        seen = run.observed
        if seen is None:
            return run
        run = replace(run, observed=None)
        if seen.facts == run.state.facts and seen.values == run.state.values:
            return run
        text = _difference(run.state, seen)
        return replace(run, state=seen).because(ev.DEVIATION, text)

    def told(self, run: Run) -> dict[FluentKey, Number]:
        """Return the agent-state values that a planner is given now: the knowledge base."""
        return self.profile.told(self.agents, run.sensed, run.memory)

    def now(self, run: Run) -> Problem:
        """Return the problem from here on, as it is believed to be and as planners get it."""
        values = {**self.problem.values, **run.state.values, **self.told(run)}
        return replace(self._priced, facts=frozenset(run.state.facts), values=values)


def _number(seconds: float) -> Number:
    return int(seconds) if seconds == int(seconds) else exact_number(seconds)  # type: ignore[return-value]


def _shown(step: BoundAction) -> str:
    return fact_text((step.schema.name, *step.binding.values()))


def _difference(expected: LiftedState, seen: LiftedState) -> str:
    missing = sorted(frozenset(expected.facts) - frozenset(seen.facts))
    extra = sorted(frozenset(seen.facts) - frozenset(expected.facts))
    words = [f"{fact_text(fact)} does not hold" for fact in missing]
    words += [f"{fact_text(fact)} holds" for fact in extra]
    words += [
        f"{fact_text(key)} is {number_text(seen.values[key])}"
        for key in sorted(seen.values)
        if expected.values.get(key) != seen.values[key]
    ]
    return ", ".join(words)
