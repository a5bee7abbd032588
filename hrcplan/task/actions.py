"""Ground actions as bit masks: an instance of a schema, for one choice of changing values."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from itertools import product
from math import inf

from hrcplan.core.bits import single_bits
from hrcplan.core.numbers import Number
from hrcplan.core.progress import counting
from hrcplan.core.records import field, record, replace
from hrcplan.errors import LimitError, UnsupportedError
from hrcplan.pddl.model import DURATION, TOTAL_COST, TRUE, Action, Constant, Expr, FluentKey
from hrcplan.pddl.semantics import Undefined, Values, evaluate, ground_key, instances
from hrcplan.pddl.walks import functions_in
from hrcplan.task.changing import (
    ValueSets,
    combinations,
    keys_read,
    moves,
    value_fact,
    with_duration,
)
from hrcplan.task.conditions import ALWAYS, Grounder, Tests, all_of, any_of, negation
from hrcplan.task.literal_schemas import LiteralSchema, changed_names, is_literal
from hrcplan.task.numbers import ground_expression
from hrcplan.task.reachable import NO_GROUNDING, SchemaInstance
from hrcplan.task.transitions import BitEffect, Effects, Transition, net_effect

_CHECK = 16  # instances between two looks at the clock: some have thousands of effects
_TELL = 256  # instances between two reports of progress
MAX_COST_CONDITIONS = 4
"""Conditions of one action's cost that the state decides: each doubles its ground actions."""

_UNIT_COST: tuple[Expr, ...] = (Constant(1),)
_NO_VALUES: Mapping[FluentKey, Number] = {}
_NO_EFFECTS: Effects = ()


@record
class GroundAction(Transition):
    """Who does what: conditions and effects as bits, for the sequential and temporal readings.

    As a transition it is the sequential reading: start, then end. ``start``, ``over`` and ``end``
    are the conditions of the temporal reading. ``adds`` and ``deletes`` are the net effect, but not
    the whole of it where ``conditional``: some effect then depends on the state. ``costs`` are sums
    over functions that no action changes; ``values`` are those that the action needs of the others.
    """

    index: int
    name: str
    args: tuple[str, ...]
    agent: str | None
    step: tuple[str, ...]
    duration: Number | None
    costs: tuple[Expr, ...]
    adds: int
    deletes: int
    start: Tests
    over: Tests
    end: Tests
    conditional: bool
    values: Mapping[FluentKey, Number]

    @property
    def sequential(self) -> tuple[Effects, Effects]:
        """The effects at start and end, in sum where none depends on the state."""
        if self.conditional:
            return self.at_start, self.at_end
        return (BitEffect(self.adds, self.deletes),), ()

    def __str__(self) -> str:
        return f"({' '.join([self.name, *self.args])})"


def ground_actions(
    grounder: Grounder,
    instances: Iterable[SchemaInstance],
    value_sets: ValueSets,
    deadline: float = inf,
) -> tuple[GroundAction, ...]:
    """Return the ground actions of instances: those that can run and change something.

    Raises:
        LimitError: at the deadline, a time of ``time.monotonic()``.
        UnsupportedError: if a condition or an effect cannot be held in bits.
    """
    builder = _Builder(grounder, value_sets)
    actions: list[GroundAction] = []
    with counting("ground actions") as tell:
        for count, instance in enumerate(instances):
            if count % _TELL == 0:
                tell(len(actions))
            if count % _CHECK == 0 and time.monotonic() > deadline:
                message = f"no time for more than {len(actions)} ground actions"
                raise LimitError(message, hint=NO_GROUNDING)
            schema = builder.literal_schema(instance.action)
            if schema is not None:
                try:
                    action = builder.build_literal(len(actions), instance, schema)
                except Undefined:  # what it needs has no value: it cannot run
                    continue
                if action is not None:
                    actions.append(action)
                continue
            for choice in combinations(keys_read(grounder, instance, value_sets), value_sets):
                with contextlib.suppress(Undefined):
                    actions += builder.build(len(actions), instance, choice)
    return tuple(actions)


@record
class _Phases:
    """Conditions and effects of an instance, by phase."""

    start: Tests
    over: Tests
    end: Tests
    at_start: Effects
    at_end: Effects

    @property
    def tests(self) -> Tests:
        """The condition of the sequential reading, before the start."""
        if self.over == ALWAYS == self.end:
            return self.start
        return all_of([self.start, _before(all_of([self.over, self.end]), self.at_start)])


@record
class _Builder:
    """Turns instances into ground actions over one set of fluents."""

    grounder: Grounder
    value_sets: ValueSets
    _literal_schemas: dict[str, LiteralSchema | None] = field(default_factory=dict)

    @cached_property
    def _changed_names(self) -> Set[str]:
        return changed_names(self.grounder.problem)

    def literal_schema(self, action: Action) -> LiteralSchema | None:
        """Return the schema of an action for look-ups, if it is of that kind."""
        if action.name not in self._literal_schemas:
            grounder, moving = self.grounder, {key[0] for key in self.value_sets}
            problem, names = grounder.problem, self._changed_names
            self._literal_schemas[action.name] = (
                LiteralSchema(action, problem, names, grounder.powers, grounder.fixed)
                if is_literal(action, names, moving)
                else None
            )
        return self._literal_schemas[action.name]

    def build_literal(
        self, index: int, instance: SchemaInstance, schema: LiteralSchema
    ) -> GroundAction | None:
        """Return the ground action of an instance, by look-ups; see `build`."""
        row = schema.rows.of(instance.args)
        start = schema.tests(row, "start")
        if not start:
            return None
        over = end = ALWAYS
        at_start, at_end = schema.effects(row, "start"), _NO_EFFECTS
        if instance.action.durative:
            over, end = schema.tests(row, "all"), schema.tests(row, "end")
            at_end = schema.effects(row, "end")
        phases = _Phases(start, over, end, at_start, at_end)
        tests = phases.tests
        if not tests or not (at_start or at_end):
            return None
        duration, costs = schema.figures(row)
        return self._action(index, instance, phases, tests, duration, costs, _NO_VALUES)

    def build(
        self, index: int, instance: SchemaInstance, choice: Mapping[FluentKey, Number]
    ) -> list[GroundAction]:
        """Return the ground action, numbered from ``index``; none if it can never do anything.

        Where its cost depends on the state there is one for each cost.
        """
        values = with_duration(instance, {**self.grounder.problem.values, **choice} if choice
                       else self.grounder.problem.values)  # fmt: skip
        start = self._conditions(instance, "start", values, choice)
        if not start:
            return []
        at_start, later = self._changes(instance, "start", values)
        over, end, at_end = ALWAYS, ALWAYS, _NO_EFFECTS
        if instance.action.durative:
            over = self._conditions(instance, "all", later)
            end = self._conditions(instance, "end", later)
            at_end, _ = self._changes(instance, "end", later)
        phases = _Phases(start, over, end, at_start, at_end)
        duration = values.get((DURATION,)) if instance.action.durative else 0
        before = phases.tests
        if not before or not (at_start or at_end):
            return []
        variants: list[GroundAction] = []
        for extra, costs in self._costs(instance, values, later, at_start):
            tests, part = before, phases
            if extra != ALWAYS:
                tests = all_of([before, extra])
                part = replace(phases, start=all_of([phases.start, extra]))
            if tests:
                place = index + len(variants)
                variants.append(self._action(place, instance, part, tests, duration, costs, choice))
        return variants

    def _action(
        self, index: int, instance: SchemaInstance, phases: _Phases, tests: Tests,
        duration: Number | None, costs: tuple[Expr, ...], choice: Mapping[FluentKey, Number],
    ) -> GroundAction:  # fmt: skip
        at_start, at_end = phases.at_start, phases.at_end
        net = net_effect(at_start, at_end)
        agent, step = self._who(instance)
        return GroundAction(
            tests, at_start, at_end, index, instance.action.name, instance.args, agent, step,
            duration, costs, net.adds, net.deletes, phases.start, phases.over, phases.end,
            conditional=any(c.tests != ALWAYS for c in (*at_start, *at_end)), values=choice,
        )  # fmt: skip

    def _who(self, instance: SchemaInstance) -> tuple[str | None, tuple[str, ...]]:
        """Return the agent, and the step: the action without its agent."""
        agents = self.grounder.problem.agents
        if not agents:
            return None, (instance.action.name, *instance.args)
        place = next((i for i, arg in enumerate(instance.args) if arg in agents), None)
        if place is None:
            return None, (instance.action.name, *instance.args)
        rest = instance.args[:place] + instance.args[place + 1 :]
        return instance.args[place], (instance.action.name, *rest)

    def _conditions(
        self,
        instance: SchemaInstance,
        when: str,
        values: Values,
        choice: Mapping[FluentKey, Number] = {},
    ) -> Tests:
        """Return the conditions of one phase, and that changing functions have these values."""
        tests = self.grounder.conditions(instance.action, when, instance.binding, values)
        if not self.value_sets:
            return tests
        keys = choice or keys_read(self.grounder, instance, self.value_sets, when)
        bits = (self.grounder.bit(value_fact(key, values[key])) for key in keys)
        return all_of([tests, *(((bit, bit),) for bit in bits)])

    def _changes(
        self, instance: SchemaInstance, when: str, values: Values
    ) -> tuple[tuple[BitEffect, ...], Values]:
        """Return the changes of one instant, and the function values after it."""
        adds = deletes = 0
        conditional: list[BitEffect] = []
        powers = self.grounder.powers
        for effect in instance.action.effects:
            if effect.when != when or effect.value is not None:
                continue
            for inner in instances(effect.params, instance.binding, self.grounder.problem):
                bit = powers.get(ground_key(effect.target, inner), 0)
                add_bit, delete_bit = (bit, 0) if effect.kind == "add" else (0, bit)
                tests = ALWAYS if effect.condition == TRUE else self.grounder.tests(
                    effect.condition, inner, values)  # fmt: skip
                if tests == ALWAYS:
                    adds, deletes = adds | add_bit, deletes | delete_bit
                elif tests and bit:
                    conditional.append(BitEffect(add_bit, delete_bit, tests))
        after = dict[FluentKey, Number]()
        for move in moves(self.grounder, instance, when, values) if self.value_sets else ():
            after[move.key] = move.value
            new = self.grounder.bit(value_fact(move.key, move.value))
            old = self._values_of(move.key) & ~new
            if move.tests == ALWAYS:
                adds, deletes = adds | new, deletes | old
            else:
                conditional.append(BitEffect(new, old, move.tests))
        sure = (BitEffect(adds, deletes & ~adds),) if adds | deletes else ()
        return (*sure, *conditional), {**values, **after} if after else values

    def _values_of(self, key: FluentKey) -> int:
        """Return the bits of all values of a changing function."""
        return sum(self.grounder.bit(value_fact(key, value)) for value in self.value_sets[key])

    def _costs(
        self,
        instance: SchemaInstance,
        values: Values,
        later: Values,
        at_start: Sequence[BitEffect],
    ) -> Iterator[tuple[Tests, tuple[Expr, ...]]]:
        """Yield what the action adds to total-cost, over ground functions that never change.

        With each sum the conditions under which it is that one. It is 1 if the domain has no
        total-cost.

        Raises:
            UnsupportedError: if a cost needs a duration that is not fixed, or depends on more than
                ``MAX_COST_CONDITIONS`` conditions.
            Undefined: if a cost needs a function without a value, or divides by zero.
        """
        if TOTAL_COST not in self.grounder.problem.domain.functions:
            yield ALWAYS, _UNIT_COST
            return
        prices = list(self._prices(instance, values, later, at_start))
        depends = [tests for tests, _ in prices if tests != ALWAYS]
        if len(depends) > MAX_COST_CONDITIONS:
            message = f"the cost of '{instance.action.name}' depends on {len(depends)} conditions"
            raise UnsupportedError(message, hint="enhsp and kairos plan with such costs")
        for choice in product((True, False), repeat=len(depends)):
            counts = iter(choice)
            costs = tuple(cost for tests, cost in prices if tests == ALWAYS or next(counts))
            tests = [t if holds else negation(t) for t, holds in zip(depends, choice, strict=True)]
            with contextlib.suppress(*([Undefined] if depends else ())):
                for cost in costs:
                    evaluate(cost, values, {})
                yield all_of(tests) if tests else ALWAYS, costs

    def _prices(
        self,
        instance: SchemaInstance,
        values: Values,
        later: Values,
        at_start: Sequence[BitEffect],
    ) -> Iterator[tuple[Tests, Expr]]:
        """Yield each amount that may be added to total-cost, and what must hold before for it."""
        first, last = self._constants(values), self._constants(later)
        length = instance.action.fixed_duration
        if length is not None:
            first[DURATION,] = last[DURATION,] = ground_expression(length, instance.binding, first)
        for effect in instance.action.effects:
            if effect.target.name != TOTAL_COST or effect.value is None:
                continue
            for inner in instances(effect.params, instance.binding, self.grounder.problem):
                tests = ALWAYS
                if effect.condition != TRUE:
                    tests = self.grounder.tests(effect.condition, inner, values)
                    tests = tests if effect.when == "start" else _before(tests, at_start)
                cost = ground_expression(
                    effect.value, inner, first if effect.when == "start" else last
                )
                if any(function.name == DURATION for function in functions_in(cost)):
                    message = f"the cost of '{instance.action.name}' needs a fixed duration"
                    raise UnsupportedError(message)
                if tests:
                    yield tests, cost

    def _constants(self, values: Values) -> dict[FluentKey, Expr]:
        """Return the values of the changing functions, as expressions."""
        return {key: Constant(values[key]) for key in self.value_sets if key in values}


def _before(tests: Tests, changes: Sequence[BitEffect]) -> Tests:
    """Return what must hold before changes of one instant for ``tests`` to hold after them."""
    writes = 0
    for change in changes:
        writes |= change.writes
    if not any(mask & writes for mask, _ in tests):
        return tests
    return any_of(
        all_of([
            ((mask & ~writes, value & ~writes),),
            *(_bit_before(bit, bool(bit & value), changes) for bit in single_bits(mask & writes)),
        ])
        for mask, value in tests
    )  # fmt: skip


def _bit_before(bit: int, value: bool, changes: Sequence[BitEffect]) -> Tests:
    """Return what must hold before changes for one fact to hold, or not to hold, after them."""
    add_tests = any_of(change.tests for change in changes if change.adds & bit)
    delete_tests = any_of(change.tests for change in changes if change.deletes & bit)
    if value:
        return any_of([add_tests, all_of([((bit, bit),), negation(delete_tests)])])
    return all_of([negation(add_tests), any_of([((bit, 0),), delete_tests])])
