"""What actions do while they are carried out: begin, finish, or break off without effect.

States are ``semantics.LiftedState``: all base facts, and the numbers that actions or timed initial
literals change, apart from total-cost and agent state (no agent executes those). Derived
predicates are evaluated where a condition looks. It reads the lifted model, so that domains which
the bit task cannot hold are executed too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from hrcplan.core.numbers import Number
from hrcplan.pddl.conventions import agent_state_functions
from hrcplan.pddl.derivation import Derivation
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TRUE,
    Action,
    Effect,
    Fact,
    FluentKey,
    Problem,
    TimedChange,
)
from hrcplan.pddl.semantics import (
    Binding,
    LiftedState,
    Undefined,
    Values,
    bind,
    changes,
    holds,
    unmet_parts,
)
from hrcplan.pddl.walks import formula_functions
from hrcplan.plans import PlannedAction, lane, occupied

UNIT_S = 1  # how long a step of a domain without durations lasts


@dataclass(frozen=True, slots=True)
class BoundAction:
    """A ground action, ready to be carried out; ``agent`` is "" for an action without one."""

    schema: Action
    binding: Binding
    agent: str
    busy: frozenset[str]
    at_start: tuple[Effect, ...]
    at_end: tuple[Effect, ...]


@dataclass(frozen=True, slots=True)
class StartEffects:
    """What the start of an action changed; `ActionModel.revert` takes it back if it fails.

    ``before`` is the state at the start, if an effect at the end looks at it.
    """

    adds: frozenset[Fact]
    deletes: frozenset[Fact]
    numbers: Mapping[FluentKey, Number]
    before: LiftedState | None = None


class ActionModel:
    """The actions of one problem as they are carried out; remembers what it has looked up."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._steps: dict[tuple[str, ...], BoundAction] = {}
        self._agent_state = agent_state_functions(problem.domain)
        self._derivation = Derivation(problem)
        self._closure: tuple[LiftedState, LiftedState] | None = None
        changing = {e.target.name for a in problem.domain.actions for e in a.effects}
        timed = {change.key for change in problem.timed}
        self.static = frozenset(
            fact for fact in problem.facts if fact[0] not in changing and fact not in timed
        )
        costs = self._agent_state | {TOTAL_COST}
        changing |= {key[0] for key in timed}
        self._moving = changing.intersection(problem.domain.functions) - costs
        self._compares = bool(self._moving) or _compares(problem)

    def initial(self) -> LiftedState:
        """Return the state that the problem describes."""
        numbers = {k: v for k, v in self.problem.values.items() if k[0] in self._moving}
        return LiftedState(frozenset(self.problem.facts), numbers)

    def changing(self, state: LiftedState) -> frozenset[Fact]:
        """Return the facts of a state that an action or a timed initial literal could change."""
        return frozenset(state.facts) - self.static

    def absent(self, state: LiftedState) -> frozenset[Fact]:
        """Return the facts that no action changes and that do not hold in a state any more."""
        return self.static - frozenset(state.facts)

    def state(
        self, changing: frozenset[Fact], numbers: Mapping[FluentKey, Number],
        absent: frozenset[Fact] = frozenset(),
    ) -> LiftedState:  # fmt: skip
        """Return the state with these changing facts and numbers, without the absent facts."""
        return LiftedState(changing | (self.static - absent), numbers)

    def is_goal(self, state: LiftedState) -> bool:
        """Return whether the goal holds."""
        return holds(self.problem.goal, self._full(state), {}, self.problem)

    def step(self, action: PlannedAction) -> BoundAction | None:
        """Return a planned action as a step, or None if the problem has no such action."""
        key = (action.name, *action.args)
        step = self._steps.get(key)
        if step is None:
            schema = self.problem.domain.schemas.get(action.name)
            binding = "" if schema is None else bind(schema, action.args, self.problem)
            if schema is None or isinstance(binding, str):
                return None
            step = self._steps[key] = self._make(schema, binding, action)
        return step

    def _make(self, schema: Action, binding: Binding, action: PlannedAction) -> BoundAction:
        costs = self._agent_state | {TOTAL_COST}
        effects = [e for e in schema.effects if e.value is None or e.target.name not in costs]
        # A step without duration takes effect when it is finished: only then is its outcome known.
        return BoundAction(
            schema,
            binding,
            lane(action.args, self.problem) or "",
            occupied(action, self.problem),
            tuple(e for e in effects if schema.durative and e.when == "start"),
            tuple(e for e in effects if not schema.durative or e.when == "end"),
        )

    def obstacle(
        self, state: LiftedState, step: BoundAction, agent_state: Values | None = None
    ) -> str | None:
        """Return the first condition that keeps a step from beginning, as ground PDDL, or None.

        ``agent_state``: what conditions on agent state are held against; else the problem's values.
        """
        return next(self.obstacles(state, step, agent_state), None)

    def obstacles(
        self, state: LiftedState, step: BoundAction, agent_state: Values | None = None
    ) -> Iterator[str]:
        """Yield the conditions that keep a step from beginning; arguments as of ``obstacle``."""
        state = LiftedState(state.facts, {**state.values, **(agent_state or {})})
        full = self._full(state)
        for condition in step.schema.conditions:
            if condition.when == "start" or not step.schema.durative:
                yield from unmet_parts(condition.formula, full, step.binding, self.problem)
        state_after_start = self._full(self._state_after(state, step, step.at_start, 0))
        for condition in step.schema.conditions:
            if condition.when == "all":
                yield from unmet_parts(
                    condition.formula, state_after_start, step.binding, self.problem
                )

    def unmet_phase(self, state: LiftedState, step: BoundAction, when: str) -> str | None:
        """Return the first condition of a phase (``all``, ``end``) that is false in a state."""
        full = self._full(state)
        parts = (c.formula for c in step.schema.conditions if c.when == when)
        unmet = (p for part in parts for p in unmet_parts(part, full, step.binding, self.problem))
        return next(unmet, None)

    def influence(self, step: BoundAction, values: Values) -> dict[FluentKey, Number]:
        """Return the agent-state values after an interaction that has its effect."""
        effects = [e for e in step.schema.effects if e.target.name in self._agent_state]
        if not effects:
            return {}
        full = LiftedState(frozenset(), {**self.problem.values, **values})
        return dict(changes(effects, full, step.binding, self.problem).values)

    def begin(
        self, state: LiftedState, step: BoundAction, duration: Number = 0
    ) -> tuple[LiftedState, StartEffects]:
        """Return the state just after a step has begun, and how to take that back."""
        after = self._state_after(state, step, step.at_start, duration)
        before_facts, facts = frozenset(state.facts), frozenset(after.facts)
        old = {k: v for k, v in state.values.items() if after.values.get(k) != v}
        remembers = any(effect.start_condition != TRUE for effect in step.at_end)
        before = self._full(state) if remembers else None
        return after, StartEffects(facts - before_facts, before_facts - facts, old, before)

    def finish(
        self, state: LiftedState, step: BoundAction, duration: Number = 0,
        start: StartEffects | None = None,
    ) -> LiftedState:  # fmt: skip
        """Return the state just after a step has ended well; ``start`` is what `begin` returned."""
        before = None if start is None else start.before
        return self._state_after(state, step, step.at_end, duration, before)

    def happen(self, state: LiftedState, change: TimedChange) -> LiftedState:
        """Return the state after a timed initial literal; it holds no agent state and no costs."""
        facts = frozenset(state.facts)
        if change.value is None:
            fact = frozenset({change.key})
            return LiftedState(facts | fact if change.positive else facts - fact, state.values)
        if change.key[0] not in self._moving:
            return state
        return LiftedState(facts, {**state.values, change.key: change.value})

    def is_agent_state(self, change: TimedChange) -> bool:
        """Return whether a timed initial literal gives an agent state a value."""
        return change.value is not None and change.key[0] in self._agent_state

    def revert(self, state: LiftedState, effects: StartEffects) -> LiftedState:
        """Return the state as if a step that failed had never begun."""
        facts = frozenset(state.facts) - effects.adds | effects.deletes
        return LiftedState(facts, {**state.values, **effects.numbers})

    def _state_after(
        self, state: LiftedState, step: BoundAction, effects: tuple[Effect, ...],
        duration: Number, at_start: LiftedState | None = None,
    ) -> LiftedState:  # fmt: skip
        if not effects:
            return state
        full = self._full(state)
        if self._compares:
            full = LiftedState(full.facts, {**full.values, (DURATION,): duration})
        try:
            return changes(effects, full, step.binding, self.problem, at_start).apply(state)
        except Undefined:  # a number that was never given a value stays as it is
            plain = [effect for effect in effects if effect.value is None]
            return changes(plain, full, step.binding, self.problem, at_start).apply(state)

    def _full(self, state: LiftedState) -> LiftedState:
        """Return the state with derived facts, and the functions that conditions may look at."""
        if self._compares:
            state = LiftedState(state.facts, {**self.problem.values, **state.values})
        if not self.problem.domain.axioms:
            return state
        if self._closure is None or self._closure[0] != state:
            self._closure = state, self._derivation.close(state)
        return self._closure[1]


def _compares(problem: Problem) -> bool:
    """Return whether any condition of a problem looks at a number."""
    formulas = [problem.goal]
    for action in problem.domain.actions:
        formulas += [condition.formula for condition in action.conditions]
        formulas += [effect.condition for effect in action.effects]
        formulas += [effect.start_condition for effect in action.effects]
    formulas += [axiom.body for axiom in problem.domain.axioms]
    return any(True for formula in formulas for _ in formula_functions(formula))
