"""A simulated world on one clock: it alone knows the truth.

Actions take their durations; a human's action fails because of the true agent state, whether or
not it was sensed. Robots do not fail. Nothing is drawn here but from ``chance``.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hrcplan.core.numbers import Number
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import BoundAction, StartEffects
from hrcplan.execution.codec import exact_number
from hrcplan.execution.events import Command, Event
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.run import RunningAction
from hrcplan.execution.worlds import chance
from hrcplan.pddl.model import Fact, FluentKey
from hrcplan.pddl.semantics import LiftedState

BEFORE, DURING, AFTER = "before", "during", "after"
SENSED = (BEFORE, DURING, AFTER)
ONCE, ATTEMPT = "once", "attempt"
DRAWS = (ONCE, ATTEMPT)


@dataclass(frozen=True, slots=True)
class StateChange:
    """At a time, elements of an agent's state take other values (the truth, not yet sensed)."""

    t: float
    values: Mapping[FluentKey, Number]


@dataclass(frozen=True, slots=True)
class FactChange:
    """At a time, facts begin or cease to hold though no agent of the plan did it."""

    t: float
    adds: frozenset[Fact] = frozenset()
    deletes: frozenset[Fact] = frozenset()


@dataclass(frozen=True, slots=True)
class Nature:
    """How a simulated world behaves.

    ``sensed``: a change is sensed when it happens (``before`` the next action), in the middle of
    the human's first action under it (``during``), or when that action has ended (``after``).
    ``draws``: whether an element makes actions fail is drawn ``once`` per simulation or again at
    every ``attempt``. ``can_fail``: the actions that can fail, None for all. ``stretch``: a human's
    action lasts this many times its duration, drawn uniformly between two factors. ``failure_s``: a
    failed action lasts so many seconds longer.
    """

    seed: str | int = 0
    changes: tuple[StateChange, ...] = ()
    accidents: tuple[FactChange, ...] = ()
    sensed: str = DURING
    draws: str = ONCE
    can_fail: frozenset[str] | None = None
    stretch: tuple[float, float] = (1.0, 1.0)
    failure_s: float = 0.0


@dataclass(frozen=True, slots=True)
class _ActionOutcome:
    """One action under way."""

    step: BoundAction
    duration: Number
    end_s: float
    start_effects: StartEffects


@dataclass(frozen=True, slots=True)
class _Literal:
    """A timed initial literal of the problem, by its place."""

    number: int


_Due = StateChange | FactChange | ev.Ended | _Literal | int | None
"""What is due at a time: a number is that of an action that ends."""
_END, _LITERAL, _ACCIDENT, _CHANGE, _SENSE, _WAKE = range(6)
"""Kinds of entries on the clock; in one instant they happen in this order."""


class SimulatedWorld:
    """Carries actions out as the PDDL says, with the failures and changes that nature holds."""

    def __init__(self, model: ExecutionModel, nature: Nature) -> None:
        self.nature = nature
        self.model = model
        self.actions, self.agents = model.actions, model.agents
        self.state: LiftedState = self.actions.initial()
        self.values: dict[FluentKey, Number] = dict(self.agents.low)
        self._outcomes: dict[int, _ActionOutcome] = {}
        self._news: dict[FluentKey, Number] = {}
        self._n_attempts: dict[str, int] = {}
        self._failures: set[int] = set()
        self._clock: list[tuple[float, int, int, _Due]] = []
        self._n_entries = 0
        self._now = 0.0
        for change in nature.changes:
            self._at(change.t, _CHANGE, change)
        for accident in nature.accidents:
            self._at(accident.t, _ACCIDENT, accident)
        for number, literal in enumerate(model.timed.literals):
            self._at(float(literal.time), _LITERAL, _Literal(number))

    def _at(self, t: float, kind: int, what: _Due) -> None:
        self._n_entries += 1
        heapq.heappush(self._clock, (t, kind, self._n_entries, what))

    def begin(self) -> tuple[Event, ...]:
        """Return what is there at time 0; a change that is sensed at once is known already."""
        if self.nature.sensed == BEFORE and self._clock and self._clock[0][0] < ev.INSTANT_S:
            return self.next()
        return (self.observation(),)

    def do(self, command: Command) -> None:
        """Begin or break off an action."""
        match command:
            case ev.Dispatch():
                self._begin(command)
            case ev.Cancel(_, number):
                self._cancel(number)
            case ev.Wake(_, at_s):
                self.wake_at(at_s)

    def _begin(self, command: ev.Dispatch) -> None:
        step = self.begin_action(command)
        end_s = self._outcomes[command.number].end_s
        self._at(end_s, _END, command.number)
        if self._news and self._is_human(step):
            self._schedule_sensing(command.t, end_s)

    def begin_action(self, command: ev.Dispatch) -> BoundAction:
        """Begin an action and return it; without ``do``, `end_action` has to end it."""
        step = self.actions.step(ev.planned_action(command))
        assert step is not None
        duration = exact_number(command.duration_s)
        self.state, effects = self.actions.begin(self.state, step, duration)  # type: ignore[arg-type]
        end_s = command.t + command.duration_s * self._stretch(step, command.number)
        self._outcomes[command.number] = _ActionOutcome(step, duration, end_s, effects)  # type: ignore[arg-type]
        return step

    def _stretch(self, step: BoundAction, number: int) -> float:
        least, most = self.nature.stretch
        if not self._is_human(step) or least == most == 1:
            return 1.0
        return least + (most - least) * chance.uniform(self.nature.seed, "stretch", number)

    def set_state(
        self, adds: frozenset[Fact], deletes: frozenset[Fact],
        numbers: Mapping[FluentKey, Number] | None = None,
    ) -> None:  # fmt: skip
        """Let facts begin or cease to hold, and numbers take values, for any reason."""
        facts = frozenset(self.state.facts) - deletes | adds
        self.state = LiftedState(facts, {**self.state.values, **(numbers or {})})

    def resume(
        self, t: float, state: LiftedState, values: Mapping[FluentKey, Number],
        running: Sequence[RunningAction],
    ) -> None:  # fmt: skip
        """Go on in the middle of a run; its running actions end by `end_action` only.

        Args:
            t: When that is; changes of before have happened.
            state: What holds.
            values: Agent state that was sensed.
            running: The actions that have begun.
        """
        self._now, self.state = t, state
        self.values.update(values)
        self._clock = [entry for entry in self._clock if entry[0] > t]
        heapq.heapify(self._clock)
        self._outcomes = {}
        for action in running:
            duration: Number = exact_number(action.duration_s)  # type: ignore[assignment]
            self._outcomes[action.number] = _ActionOutcome(
                action.step, duration, math.inf, action.start_effects
            )

    @property
    def running(self) -> tuple[int, ...]:
        """The numbers of the actions that have begun and not ended."""
        return tuple(self._outcomes)

    @property
    def next_s(self) -> float | None:
        """When the next instant is; None if nothing is due."""
        return self._clock[0][0] if self._clock else None

    def wake_at(self, t: float) -> None:
        """Make an instant at a time, whatever else happens."""
        self._at(t, _WAKE, None)

    def _cancel(self, number: int) -> None:
        """Break an action off in this instant; it leaves no effect."""
        action = self._outcomes.pop(number, None)
        if action is not None:
            self.state = self.actions.revert(self.state, action.start_effects)
            self._at(self._now, _END, ev.Ended(self._now, number, ev.CANCELLED))

    def _is_human(self, step: BoundAction) -> bool:
        return self.model.is_human(step.agent)

    def next(self) -> tuple[Event, ...]:
        """Return the events of the next instant: outcomes, then changes, then what is sensed."""
        while self._clock:
            self._now = t = self._clock[0][0]
            events: list[Event] = []
            instant: list[tuple[int, int, _Due]] = []
            while self._pull(t, instant):
                kind, _, what = heapq.heappop(instant)
                events += self._happen(t, kind, what)
            if events:
                events.append(self.observation())
                return tuple(sorted(events, key=lambda e: ev.RANK[type(e)]))
        return ()

    def _pull(self, t: float, instant: list[tuple[int, int, _Due]]) -> bool:
        """Move what belongs to an instant from the clock; return whether anything is left of it."""
        while self._clock and self._clock[0][0] < t + ev.INSTANT_S:
            _, kind, n, what = heapq.heappop(self._clock)
            heapq.heappush(instant, (kind, n, what))
        return bool(instant)

    def _happen(self, t: float, kind: int, what: _Due) -> Sequence[Event]:
        if isinstance(what, ev.Ended):
            return [what]
        if isinstance(what, int):
            return self._end(t, what)
        if isinstance(what, FactChange):
            self.set_state(what.adds, what.deletes)
            self._break_actions(t)
            return [self.observation()]
        if isinstance(what, _Literal):
            return self._come_about(t, what.number)
        if isinstance(what, StateChange):
            return self._change(t, what.values)
        if kind == _SENSE:
            return self._sense(t)
        return [self.observation()]

    def _come_about(self, t: float, number: int) -> Sequence[Event]:
        """Let a timed initial literal of the problem happen."""
        change = self.model.timed.literals[number]
        self.state = self.actions.happen(self.state, change)
        self._break_actions(t)
        events: list[Event] = [ev.Happened(t, number, change.literal)]
        if self.actions.is_agent_state(change):
            assert change.value is not None
            self.values[change.key] = change.value
            events.append(ev.Sensed(t, {change.key: change.value}))
        return events

    def _break_actions(self, t: float) -> None:
        """Let actions fail that need all the time what does not hold any more.

        Only in problems with timed initial literals, and not the actions that a link carries out.
        """
        if not self.model.timed.literals:
            return
        here = {what for _, kind, _, what in self._clock if kind == _END}
        for number, action in self._outcomes.items():
            if number in here and self.actions.unmet_phase(self.state, action.step, "all"):
                self._failures.add(number)
                self._at(t, _END, number)

    def _end(self, t: float, number: int) -> Sequence[Event]:
        action = self._outcomes.get(number)
        if action is None:
            return []  # it was cancelled
        if number in self._failures:
            return self.end_action(t, number, ev.FAILED)
        if self._succeeds(number, action):
            return self.end_action(t, number, ev.DONE)
        if not self.nature.failure_s:
            return self.end_action(t, number, ev.FAILED)
        self._failures.add(number)
        self._at(t + self.nature.failure_s, _END, number)
        return []

    def end_action(self, t: float, number: int, outcome: str) -> Sequence[Event]:
        """End an action: with its effects if it is done, else as if it had never begun."""
        action = self._outcomes.pop(number)
        if outcome != ev.DONE:
            self.state = self.actions.revert(self.state, action.start_effects)
            return [ev.Ended(t, number, outcome)]
        self.state = self.actions.finish(
            self.state, action.step, action.duration, action.start_effects
        )
        return [ev.Ended(t, number, ev.DONE), *self._influence(t, number, action.step)]

    def _influence(self, t: float, number: int, step: BoundAction) -> Sequence[Event]:
        """Let an interaction have its effect, or not, and sense what has come of it."""
        values = self.actions.influence(step, self.values)
        if not values:
            return []
        name = step.schema.name
        if chance.uniform(self.nature.seed, "interaction", number) < self._success(name):
            self.values.update({k: self.agents.clamp(k, v) for k, v in values.items()})
        for key in values:
            self._news.pop(key, None)
        return [ev.Sensed(t, {key: self.values[key] for key in values})]

    def _success(self, name: str) -> float:
        return float(self.model.problem.domain.success(name))

    def _succeeds(self, number: int, action: _ActionOutcome) -> bool:
        """Return the outcome of an action, from the true agent state and what was drawn for it.

        One that needs at its end what a timed initial literal has changed fails, too.
        """
        name = action.step.schema.name
        if self.model.timed.obstacle_at_end(self.actions, self.state, action.step):
            return False
        if not self._is_human(action.step) or name not in (self.nature.can_fail or {name}):
            return True
        agent = action.step.agent
        attempt = self._n_attempts[agent] = self._n_attempts.get(agent, 0) + 1
        about = () if self.nature.draws == ONCE else (attempt,)
        return not any(
            chance.uniform(self.nature.seed, "outcome", *key, *about) < p
            for key in self.agents.touching(name, tuple(action.step.binding.values()))
            if (p := self.agents.failure_probability(key, self.values)) > 0
        )

    def _change(self, t: float, values: Mapping[FluentKey, Number]) -> Sequence[Event]:
        """Change agent state, which is sensed later, and other numbers, which are seen at once."""
        numbers = {key: value for key, value in values.items() if key not in self.agents.low}
        values = {key: value for key, value in values.items() if key not in numbers}
        if values:
            self._change_agent_state(t, values)
        if not numbers:
            return []
        self.set_state(frozenset(), frozenset(), numbers)
        return [self.observation()]

    def _change_agent_state(self, t: float, values: Mapping[FluentKey, Number]) -> None:
        self.values.update(values)
        self._news.update(values)
        if self.nature.sensed == BEFORE:
            self._at(t, _SENSE, None)
            return
        ends = [a.end_s for a in self._outcomes.values() if self._is_human(a.step)]
        if ends:
            self._schedule_sensing(t, min(ends))

    def _schedule_sensing(self, begun_s: float, end_s: float) -> None:
        if self.nature.sensed != BEFORE:
            middle = (begun_s + end_s) / 2
            self._at(middle if self.nature.sensed == DURING else end_s, _SENSE, None)

    def _sense(self, t: float) -> Sequence[Event]:
        values, self._news = self._news, {}
        return [ev.Sensed(t, values)] if values else []

    def observation(self) -> ev.Observed:
        """Return the state as it is now, as it can be seen."""
        facts, absent = self.actions.changing(self.state), self.actions.absent(self.state)
        return ev.Observed(self._now, facts, self.state.values, absent)
