"""Both ways of finding the actions that can run equal a plain scan."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hrcplan.task.lookup import IndexedRule, Lookup, Waiting, lookup
from hrcplan.task.transitions import Rule

N_FACTS = 37  # more than two slices, and not a whole number of them
BITS = st.integers(0, 2**N_FACTS - 1) | st.sets(st.integers(0, N_FACTS - 1), max_size=3).map(
    lambda positions: sum(1 << i for i in positions)
)


@st.composite
def tasks(draw: st.DrawFn) -> list[IndexedRule]:
    found = []
    for index in sorted(draw(st.sets(st.integers(0, 60), max_size=20))):
        mask, adds, deletes = draw(BITS), draw(BITS), draw(BITS)
        found.append((index, Rule(mask, mask & draw(BITS), adds | deletes, adds)))
    return found


@given(tasks(), st.lists(BITS, min_size=1, max_size=5))
def test_equal_to_a_scan(rules: list[IndexedRule], states: list[int]) -> None:
    tables, waiting = Lookup(N_FACTS, 61, rules), Waiting(rules)
    small = Lookup(N_FACTS, 61, rules)
    for table in small._tables:
        table._limit = 1  # forgets all but one value
    # The states that fit a rule, and what is near them, say more than random ones.
    fitting = [rule.value for _, rule in rules]
    for state in states + fitting + [f | s for f in fitting for s in states]:
        scan = [
            index
            for index, rule in rules
            if state & rule.mask == rule.value and rule.apply(state) != state
        ]
        assert tables.runnable(state) == scan
        assert waiting.runnable(state) == scan
        assert small.runnable(state) == scan


def test_no_facts_and_no_actions() -> None:
    assert lookup(0, 0, [])(0) == []
    assert lookup(5, 0, [])(3) == []


def test_large_tasks_wait_at_a_fact() -> None:
    assert lookup(100_000, 100_000, []).__qualname__ == Waiting.runnable.__qualname__
    assert lookup(300, 400, []).__qualname__ == Lookup.runnable.__qualname__
