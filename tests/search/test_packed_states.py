"""Steps over arrays of states equal the same steps over one state at a time."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hrcplan.search.packed_states import FactPacking, PackedRules
from hrcplan.task import BitEffect
from hrcplan.task.conditions import ALWAYS, Tests
from hrcplan.task.steps import Operator

N_FACTS = 70  # more than one word
WIDE = st.integers(0, 2**N_FACTS - 1)
NARROW = st.integers(0, 15)
BITS = NARROW | NARROW.map(lambda bits: bits << N_FACTS - 4) | WIDE


@st.composite
def conditions(draw: st.DrawFn) -> Tests:
    masks = draw(st.lists(BITS, min_size=1, max_size=2))
    return tuple((mask, mask & draw(BITS)) for mask in masks)


@st.composite
def effects(draw: st.DrawFn, max_size: int) -> tuple[BitEffect, ...]:
    found = []
    for tests in draw(st.lists(st.just(ALWAYS) | conditions(), max_size=max_size)):
        adds = draw(BITS)
        found.append(BitEffect(adds, draw(BITS) & ~adds, tests))
    return tuple(found)


@st.composite
def operators(draw: st.DrawFn) -> list[Operator]:
    return [
        Operator(draw(conditions()), draw(effects(2)), draw(effects(1)), step, 1)
        for step in range(draw(st.integers(0, 5)))
    ]


@given(operators(), st.lists(BITS, min_size=1, max_size=6))
def test_arrays_equal_integers(ops: list[Operator], states: list[int]) -> None:
    packing = FactPacking.of_facts(2**N_FACTS - 1)
    rules = PackedRules(ops, packing)
    packed = {
        (int(row), int(op), after)
        for rows, indices, successors in rules.expand(packing.rows(states))
        for row, op, after in zip(rows, indices, packing.states(successors), strict=True)
    }
    single = {
        (row, i, op.apply(state))
        for row, state in enumerate(states)
        for i, op in enumerate(ops)
        if op.is_applicable(state)
    }
    assert packed == single


@given(operators(), st.lists(BITS, min_size=1, max_size=6))
def test_rules_say_the_same_as_their_operator(ops: list[Operator], states: list[int]) -> None:
    for op in ops:
        has_condition = any(effect.tests != ALWAYS for effect in op.effects)
        assert (op.rules is None) == has_condition
        assert op.is_simple == (len(op.tests) == 1 and not has_condition)
        for state in states:
            # The states where a condition holds are the ones that decide.
            for near in (state, *(state & ~mask | value for mask, value in op.tests)):
                for rule in op.rules or ():
                    if near & rule.mask == rule.value:
                        assert rule.apply(near) == op.apply(near)
                if op.rules is not None:
                    applicable = any(rule.is_applicable(near) for rule in op.rules)
                    assert applicable == op.is_applicable(near)
