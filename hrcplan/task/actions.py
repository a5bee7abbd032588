"""Ground actions as bit masks: an instance of a schema, for one choice of changing values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hrcplan.pddl.model import TOTAL_COST, TRUE, Expr, Fact, FluentKey, Number, number_text
from hrcplan.pddl.semantics import Binding, Values, evaluate, ground_key, instances
from hrcplan.task.conditions import Grounder, Literals, Test, merge
from hrcplan.task.numbers import changed
from hrcplan.task.reachable import Instance

Index = Mapping[Fact, int]


@dataclass(frozen=True, slots=True)
class Change:
    """Facts deleted and then added where one of ``tests`` holds in the state before."""

    adds: int
    deletes: int
    tests: tuple[Test, ...] = ((0, 0),)


@dataclass(frozen=True, slots=True)
class GroundAction:
    """Who does what: conditions and effects as bits, for the sequential and temporal readings.

    ``tests``, ``adds`` and ``deletes`` are the sequential reading (start, then end); ``start``,
    ``over`` and ``end`` hold the conditions of the temporal one, ``at_start`` and ``at_end`` its
    changes. Several tests are alternatives. ``conditional`` says that some change depends on the
    state, and that ``adds`` and ``deletes`` are then not the whole of it.
    """

    index: int
    name: str
    args: tuple[str, ...]
    agent: str | None
    step: tuple[str, ...]
    duration: Number | None
    costs: tuple[Expr, ...]
    tests: tuple[Test, ...]
    adds: int
    deletes: int
    start: tuple[Test, ...]
    over: tuple[Test, ...]
    end: tuple[Test, ...]
    at_start: tuple[Change, ...]
    at_end: tuple[Change, ...]
    conditional: bool
    values: Values
    binding: Binding

    def __str__(self) -> str:
        return f"({' '.join([self.name, *self.args])})"


def value_fact(key: FluentKey, value: Number) -> Fact:
    """Return the fact that says that a changing function has a value."""
    return ("=", *key, number_text(value))


@dataclass(frozen=True)
class Builder:
    """Turns instances into ground actions over one set of fluents."""

    grounder: Grounder
    bits: Index
    moving: Mapping[FluentKey, tuple[Number, ...]]

    def build(self, instance: Instance, values: Values, read: Iterable[FluentKey]) -> GroundAction | None:
        """Return the ground action, or None if it can never run or never changes anything."""
        binding = instance.binding
        given: Literals = {value_fact(k, values[k]): True for k in read if k in self.moving}
        start = self._conditions(instance, binding, values, "start", given)
        over = self._conditions(instance, binding, values, "all", {})
        end = self._conditions(instance, binding, values, "end", {})
        at_start = self._changes(instance, binding, values, "start")
        at_end = self._changes(instance, binding, values, "end")
        tests = self._sequential(start, over, end, at_start)
        if not tests or not (at_start or at_end):
            return None
        adds, deletes = _both(at_start, at_end)
        problem = self.grounder.problem
        agent = next((arg for arg in instance.args if arg in problem.agents), None)
        rest = list(instance.args)
        if agent is not None:
            rest.remove(agent)
        return GroundAction(
            index=-1,
            name=instance.action.name,
            args=instance.args,
            agent=agent,
            step=(instance.action.name, *rest),
            duration=_duration(instance, binding, values),
            costs=_costs(instance),
            tests=self._bits(tests),
            adds=adds,
            deletes=deletes & ~adds,
            start=self._bits(start),
            over=self._bits(over),
            end=self._bits(end),
            at_start=at_start,
            at_end=at_end,
            conditional=any(c.tests != ((0, 0),) for c in (*at_start, *at_end)),
            values=values,
            binding=binding,
        )

    def _conditions(
        self, instance: Instance, binding: Binding, values: Values, when: str, given: Literals
    ) -> tuple[Literals, ...]:
        found: tuple[Literals, ...] = (given,)
        for condition in instance.action.conditions:
            if condition.when == when:
                more = self.grounder.alternatives(condition.formula, binding, values)
                merged = (merge(one, other) for one in found for other in more)
                found = tuple(literals for literals in merged if literals is not None)
        return found

    def _changes(
        self, instance: Instance, binding: Binding, values: Values, when: str
    ) -> tuple[Change, ...]:
        plain = [0, 0]
        conditional: list[Change] = []
        for effect in instance.action.effects:
            if effect.when != when or effect.target.name == TOTAL_COST:
                continue
            for inner in instances(effect.params, binding, self.grounder.problem):
                key = ground_key(effect.target, inner)
                if effect.value is None:
                    adds, deletes = self._bit(key), 0
                    if effect.kind == "delete":
                        adds, deletes = deletes, adds
                else:
                    after = changed(effect, key, values, inner)
                    adds = self._bit(value_fact(key, after))
                    deletes = self._bit(value_fact(key, values[key])) & ~adds
                if effect.given == TRUE:
                    plain = [plain[0] | adds, plain[1] | deletes]
                else:
                    tests = self.grounder.alternatives(effect.given, inner, values)
                    if tests and (adds or deletes):
                        conditional.append(Change(adds, deletes, self._bits(tests)))
        first = [Change(plain[0], plain[1] & ~plain[0])] if any(plain) else []
        return (*first, *conditional)

    def _sequential(
        self,
        start: tuple[Literals, ...],
        over: tuple[Literals, ...],
        end: tuple[Literals, ...],
        at_start: tuple[Change, ...],
    ) -> tuple[Literals, ...]:
        """Return what must hold before the start for the whole action to run undisturbed."""
        adds, deletes = _both(at_start, ())
        found: list[Literals] = []
        for one in start:
            for later in (m for o in over for e in end if (m := merge(o, e)) is not None):
                rest: Literals | None = one
                for fact, value in later.items():
                    bit = self._bit(fact)
                    if rest is None or (bit & adds and value) or (bit & deletes and not value):
                        continue
                    known_wrong = bit & (adds | deletes)
                    rest = None if known_wrong else merge(rest, {fact: value})
                if rest is not None and rest not in found:
                    found.append(rest)
        return tuple(found)

    def _bit(self, fact: Fact) -> int:
        position = self.bits.get(fact)
        return 0 if position is None else 1 << position

    def _bits(self, alternatives: tuple[Literals, ...]) -> tuple[Test, ...]:
        return tuple(
            (
                sum(self._bit(fact) for fact in literals),
                sum(self._bit(fact) for fact, value in literals.items() if value),
            )
            for literals in alternatives
        )


def _both(at_start: tuple[Change, ...], at_end: tuple[Change, ...]) -> tuple[int, int]:
    """Return adds and deletes of the unconditional changes, start and then end."""
    adds = deletes = 0
    for change in (*at_start, *at_end):
        if change.tests == ((0, 0),):
            adds = adds & ~change.deletes | change.adds
            deletes = (deletes | change.deletes) & ~change.adds
    return adds, deletes


def _duration(instance: Instance, binding: Binding, values: Values) -> Number | None:
    """Return the fixed duration in seconds, 0 if instantaneous, None if it may be chosen."""
    if not instance.action.durative:
        return 0
    fixed = [expr for op, expr in instance.action.durations if op == "="]
    return evaluate(fixed[0], values, binding) if len(fixed) == 1 else None


def _costs(instance: Instance) -> tuple[Expr, ...]:
    return tuple(
        effect.value
        for effect in instance.action.effects
        if effect.target.name == TOTAL_COST and effect.value is not None
    )
