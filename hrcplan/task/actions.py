"""Ground actions as bit masks: an instance of a schema, for one choice of changing values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from hrcplan.core.bits import single_bits
from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import DURATION, TOTAL_COST, TRUE, Constant, Expr, FluentKey
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
from hrcplan.task.numbers import ground_expression
from hrcplan.task.reachable import SchemaInstance
from hrcplan.task.transitions import BitEffect, Effects, Transition, net_effect

_UNIT_COST: tuple[Expr, ...] = (Constant(1),)


@dataclass(frozen=True, slots=True)
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
    grounder: Grounder, instances: Iterable[SchemaInstance], value_sets: ValueSets
) -> tuple[GroundAction, ...]:
    """Return the ground actions of instances: those that can run and change something.

    Raises:
        UnsupportedError: if a condition or an effect cannot be held in bits.
    """
    builder = _Builder(grounder, value_sets)
    actions: list[GroundAction] = []
    for instance in instances:
        for choice in combinations(keys_read(grounder, instance, value_sets), value_sets):
            try:
                action = builder.build(len(actions), instance, choice)
            except Undefined:
                continue  # what it needs has no value, so it can never run
            if action is not None:
                actions.append(action)
    return tuple(actions)


@dataclass(frozen=True)
class _Builder:
    """Turns instances into ground actions over one set of fluents."""

    grounder: Grounder
    value_sets: ValueSets

    def build(
        self, index: int, instance: SchemaInstance, choice: Mapping[FluentKey, Number]
    ) -> GroundAction | None:
        """Return the ground action, or None if it can never run or never changes anything."""
        values = with_duration(instance, {**self.grounder.problem.values, **choice} if choice
                       else self.grounder.problem.values)  # fmt: skip
        start = self._conditions(instance, "start", values, choice)
        if not start:
            return None
        at_start, later = self._changes(instance, "start", values)
        over = self._conditions(instance, "all", later)
        end = self._conditions(instance, "end", later)
        at_end, _ = self._changes(instance, "end", later)
        tests = all_of([start, _before(all_of([over, end]), at_start)])
        if not tests or not (at_start or at_end):
            return None
        net = net_effect(at_start, at_end)
        agent, step = self._who(instance)
        return GroundAction(
            index=index,
            name=instance.action.name,
            args=instance.args,
            agent=agent,
            step=step,
            duration=values.get((DURATION,)) if instance.action.durative else 0,
            costs=self._costs(instance, values, later),
            tests=tests,
            adds=net.adds,
            deletes=net.deletes,
            start=start,
            over=over,
            end=end,
            at_start=at_start,
            at_end=at_end,
            conditional=any(c.tests != ALWAYS for c in (*at_start, *at_end)),
            values=choice,
        )

    def _who(self, instance: SchemaInstance) -> tuple[str | None, tuple[str, ...]]:
        """Return the agent, and the step: the action without its agent."""
        agents = self.grounder.problem.agents
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
        for effect in instance.action.effects:
            if effect.when != when or effect.value is not None:
                continue
            for inner in instances(effect.params, instance.binding, self.grounder.problem):
                bit = self.grounder.bit(ground_key(effect.target, inner))
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

    def _costs(self, instance: SchemaInstance, values: Values, later: Values) -> tuple[Expr, ...]:
        """Return what the action adds to total-cost, over ground functions that never change.

        It is 1 if the domain has no total-cost.

        Raises:
            UnsupportedError: if a cost needs a duration that is not fixed.
            Undefined: if a cost needs a function without a value, or divides by zero.
        """
        if TOTAL_COST not in self.grounder.problem.domain.functions:
            return _UNIT_COST
        first, last = self._constants(values), self._constants(later)
        duration = instance.action.fixed_duration
        if duration is not None:
            first[DURATION,] = last[DURATION,] = ground_expression(
                duration, instance.binding, first
            )
        costs: list[Expr] = []
        for effect in instance.action.effects:
            if effect.target.name != TOTAL_COST or effect.value is None:
                continue
            constants = first if effect.when == "start" else last
            costs.append(ground_expression(effect.value, instance.binding, constants))
        if any(f.name == DURATION for cost in costs for f in functions_in(cost)):
            raise UnsupportedError(f"the cost of '{instance.action.name}' needs a fixed duration")
        for cost in costs:
            evaluate(cost, values, {})
        return tuple(costs)

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
