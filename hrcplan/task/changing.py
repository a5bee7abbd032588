"""Agent state that actions change: the values it can take, and how an action moves it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product

from hrcplan.core.numbers import Number, number_text
from hrcplan.core.records import record
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import DURATION, Action, Fact, FluentKey, Formula
from hrcplan.pddl.semantics import (
    Binding,
    Undefined,
    Values,
    assigned,
    evaluate,
    ground_key,
    instances,
    mentions,
)
from hrcplan.pddl.walks import functions_in
from hrcplan.task.conditions import ALWAYS, NEVER, Grounder, Tests
from hrcplan.task.numbers import numeric_effects
from hrcplan.task.reachable import SchemaInstance

MAX_VALUES = 16
ValueSets = Mapping[FluentKey, Collection[Number]]
"""The functions that actions change, with the values that they can reach."""


def value_fact(key: FluentKey, value: Number) -> Fact:
    """Return the fact that says that a changing function has a value."""
    short = number_text(value)
    return ("=", *key, short if Fraction(short) == value else str(value))


@record
class ValueMove:
    """A function takes a new value where one of ``tests`` holds."""

    key: FluentKey
    value: Number
    tests: Tests


def moves(
    grounder: Grounder, instance: SchemaInstance, when: str, values: Values
) -> list[ValueMove]:
    """Return what the effects of one instant do to functions that had ``values`` before it.

    Raises:
        UnsupportedError: if that cannot be said without knowing the state.
        Undefined: if an effect needs a function without a value.
    """
    action, value_moves = instance.action, dict[FluentKey, ValueMove]()
    for effect in numeric_effects(action, when):
        assert effect.value is not None
        for inner in instances(effect.params, instance.binding, grounder.problem):
            tests = grounder.tests(effect.condition, inner, values)
            if tests == NEVER:
                continue
            key = ground_key(effect.target, inner)
            last = value_moves.get(key)
            if tests != ALWAYS and (last or (action.durative and when == "start")):
                message = f"what '{action.name}' does to ({' '.join(key)}) depends on the state"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
            before = values.get(key) if last is None else last.value
            amount = evaluate(effect.value, values, inner)
            value_moves[key] = ValueMove(key, assigned(effect.kind, key, before, amount), tests)
    return list(value_moves.values())


def with_duration(instance: SchemaInstance, values: Values) -> Values:
    """Return function values, with the instance's ``?duration`` if that is fixed.

    Raises:
        Undefined: if the duration needs a function without a value.
    """
    duration = instance.action.fixed_duration
    if duration is None:
        return values
    return {**values, (DURATION,): evaluate(duration, values, instance.binding)}


def reached_values(grounder: Grounder, schema_instances: Sequence[SchemaInstance]) -> ValueSets:
    """Return every value that each function which an instance changes can reach.

    Raises:
        UnsupportedError: if a function has more than ``MAX_VALUES`` values.
    """
    movers = [i for i in schema_instances if any(numeric_effects(i.action))]
    keys = {
        ground_key(effect.target, inner)
        for i in movers
        for effect in numeric_effects(i.action)
        for inner in instances(effect.params, i.binding, grounder.problem)
    }
    initial_values = grounder.problem.values
    value_sets = {
        key: {initial_values[key]} if key in initial_values else set[Number]()
        for key in sorted(keys)
    }
    while sum(_spread(grounder, mover, value_sets) for mover in movers):
        for key, values in value_sets.items():
            if len(values) > MAX_VALUES:
                message = f"({' '.join(key)}) takes more than {MAX_VALUES} values"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
    return {key: tuple(sorted(values)) for key, values in value_sets.items()}


def _spread(
    grounder: Grounder, mover: SchemaInstance, value_sets: dict[FluentKey, set[Number]]
) -> bool:
    """Add the values that one instance leads to; return whether any is new."""
    size = sum(map(len, value_sets.values()))
    for choice in list(combinations(keys_read(grounder, mover, value_sets), value_sets)):
        try:
            values = with_duration(mover, {**grounder.problem.values, **choice})
            for move in _possible_moves(grounder, mover, values):
                value_sets[move.key].add(move.value)
        except Undefined:
            continue
    return sum(map(len, value_sets.values())) > size


def _possible_moves(
    grounder: Grounder, mover: SchemaInstance, values: Values
) -> Iterator[ValueMove]:
    if not grounder.conditions(mover.action, "start", mover.binding, values):
        return
    at_start = moves(grounder, mover, "start", values)
    later = {**values, **{move.key: move.value for move in at_start}}
    rest = (grounder.conditions(mover.action, w, mover.binding, later) for w in ("all", "end"))
    if all(rest):
        yield from at_start
        yield from moves(grounder, mover, "end", later)


def combinations(
    keys: Collection[FluentKey], value_sets: ValueSets
) -> Iterator[dict[FluentKey, Number]]:
    """Yield every combination of reached values of the changing functions ``keys``."""
    moving = sorted(keys)
    for choice in product(*(sorted(value_sets[key]) for key in moving)):
        yield dict(zip(moving, choice, strict=True))


def keys_read(
    grounder: Grounder, instance: SchemaInstance, value_sets: ValueSets, phase: str | None = None
) -> frozenset[FluentKey]:
    """Return the changing functions that an instance looks at, in one phase or in any.

    A function that is increased or decreased is looked at, one that is assigned is not.
    """
    if not value_sets:
        return frozenset()
    keys = set(_keys(grounder, instance.action, instance.binding, phase))
    return frozenset(keys & value_sets.keys())


def _keys(
    grounder: Grounder, action: Action, binding: Binding, phase: str | None
) -> Iterator[FluentKey]:
    def keys_in(formula: Formula, bound: Binding) -> Iterator[FluentKey]:
        looked_at = mentions(formula, bound, grounder.problem)
        return (key for is_fact, key in looked_at if not is_fact)

    for condition in action.conditions:
        if phase in (None, condition.when):
            yield from keys_in(condition.formula, binding)
    if phase in (None, "start"):
        for _, duration in action.durations:
            yield from (ground_key(f, binding) for f in functions_in(duration))
    for effect in action.effects:
        if phase not in (None, effect.when):
            continue
        for inner in instances(effect.params, binding, grounder.problem):
            yield from keys_in(effect.condition, inner)
            yield from (ground_key(f, inner) for f in functions_in(effect.value))
            if effect.kind not in ("assign", "add", "delete"):
                yield ground_key(effect.target, inner)
