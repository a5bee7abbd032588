"""The algebra of a step, over states as integers: when it is enabled, and the state after it.

`search.packed_states` says the same of many states at once, with numpy; a test holds both together.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from hrcplan.core.bits import union
from hrcplan.core.records import record
from hrcplan.task.conditions import ALWAYS, Tests, meets


@record
class BitEffect:
    """Facts deleted and then added where one of ``tests`` holds in the state before."""

    adds: int
    deletes: int
    tests: Tests = ALWAYS

    @property
    def writes(self) -> int:
        """The facts that the effect sets, to true or to false."""
        return self.adds | self.deletes


Effects = tuple[BitEffect, ...]
"""Effects of one instant: all look at the state before it; an add wins over a delete."""


class Rule(NamedTuple):
    """One conjunctive condition and one unconditional effect.

    Its condition holds where ``state & mask == value``. It changes such a state unless
    ``state & writes == adds``. The state after it is ``state & ~writes | adds``. Inner loops
    repeat these three expressions instead of a call.
    """

    mask: int
    value: int
    writes: int
    adds: int

    def is_applicable(self, state: int) -> bool:
        """Return whether the condition holds and the effect changes the state."""
        return state & self.mask == self.value and state & self.writes != self.adds

    def apply(self, state: int) -> int:
        """Return the state after it."""
        return state & ~self.writes | self.adds


@record
class Transition:
    """A condition, and the effects of two instants, one after the other.

    >>> go = Transition(((0b01, 0b01),), (BitEffect(adds=0b10, deletes=0b01),), ())
    >>> go.is_applicable(0b01), bin(go.apply(0b01)), go.simple_rule
    (True, '0b10', Rule(mask=1, value=1, writes=3, adds=2))
    """

    tests: Tests
    at_start: Effects
    at_end: Effects

    @property
    def effects(self) -> Effects:
        """All effects, those at the start first."""
        return (*self.at_start, *self.at_end)

    def is_enabled(self, state: int) -> bool:
        """Return whether the condition holds."""
        return meets(state, self.tests)

    def is_applicable(self, state: int) -> bool:
        """Return whether the condition holds and the effects change the state."""
        return meets(state, self.tests) and self.apply(state) != state

    def apply(self, state: int) -> int:
        """Return the state after it, whether the condition holds or not."""
        return apply(self.at_end, apply(self.at_start, state))

    @property
    def rules(self) -> tuple[Rule, ...] | None:
        """Rules that together say the same, one per test; None if an effect has a condition."""
        if any(effect.tests != ALWAYS for effect in self.effects):
            return None
        net = net_effect(self.at_start, self.at_end)
        return tuple(Rule(mask, value, net.writes, net.adds) for mask, value in self.tests)

    @property
    def simple_rule(self) -> Rule | None:
        """The rule that says the same; None if that takes several, or an effect has a condition."""
        rules = self.rules if len(self.tests) == 1 else None
        return rules[0] if rules else None

    @property
    def is_simple(self) -> bool:
        """Whether one rule says the same."""
        return self.simple_rule is not None

    @property
    def footprint(self) -> int:
        """The facts that the condition and the effects look at or set, as bits."""
        tests = [*self.tests, *(test for effect in self.effects for test in effect.tests)]
        return union(mask for mask, _ in tests) | union(e.writes for e in self.effects)


def apply(effects: Iterable[BitEffect], state: int) -> int:
    """Return the state after effects of one instant."""
    adds = deletes = 0
    for effect in effects:
        if meets(state, effect.tests):
            adds |= effect.adds
            deletes |= effect.deletes
    return state & ~deletes | adds


def net_effect(at_start: Effects, at_end: Effects) -> BitEffect:
    """Return the one effect that does what the unconditional effects of two instants do."""
    if not at_end and len(at_start) == 1 and at_start[0].tests == ALWAYS:
        only = at_start[0]
        return BitEffect(only.adds, only.deletes & ~only.adds) if only.adds & only.deletes else only
    adds = deletes = 0
    for instant in (at_start, at_end):
        sure = [effect for effect in instant if effect.tests == ALWAYS]
        sure_adds, sure_deletes = union(e.adds for e in sure), union(e.deletes for e in sure)
        adds, deletes = adds & ~sure_deletes | sure_adds, (deletes | sure_deletes) & ~sure_adds
    return BitEffect(adds, deletes)
