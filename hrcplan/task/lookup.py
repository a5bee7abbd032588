"""Which actions can run in a state, without a look at each.

An action cannot run if a fact says no, and is not offered unless a fact would change. Both can be
read off one slice of the state at a time: a query is one table look-up per slice, and costs the
same wherever the state comes from. The tables hold bits for every action, so that in tasks with
tens of thousands of facts and actions they would be too large; there each action waits at one
fact that it needs.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence

from hrcplan.core.bits import positions
from hrcplan.task.transitions import Rule

IndexedRule = tuple[int, Rule]

SLICE = 16  # bits: a state is looked at as unsigned 16-bit numbers
_BYTES = SLICE // 8
MAX_BITS = 2**29  # bound on what the tables of one task hold: 64 MB


def lookup(
    n_facts: int, n_actions: int, rules: Sequence[IndexedRule]
) -> Callable[[int], list[int]]:
    """Return what answers which rules hold in a state and change it: their indices, in order.

    Args:
        n_facts: Bits of a state.
        n_actions: One more than the largest index of a rule.
        rules: Conditions and effects of the actions.
    """
    large = n_facts * n_actions > MAX_BITS // 8
    return Waiting(rules).runnable if large else Lookup(n_facts, n_actions, rules).runnable


class Waiting:
    """Rules by one fact that each needs: only those of facts that hold are looked at."""

    def __init__(self, rules: Sequence[IndexedRule]) -> None:
        needs = [list(positions(value)) for _, (_, value, _, _) in rules]
        users = Counter(position for need in needs for position in need)
        self._free: list[IndexedRule] = []
        self._at: dict[int, list[IndexedRule]] = defaultdict(list)
        for rule, need in zip(rules, needs, strict=True):
            (self._at[min(need, key=users.__getitem__)] if need else self._free).append(rule)
        self._index_mask = sum(1 << position for position in self._at)

    def runnable(self, state: int) -> list[int]:
        """Return the indices of the rules, in order."""
        candidates = [self._free, *(self._at[i] for i in positions(state & self._index_mask))]
        indices = [
            index
            for rules in candidates
            for index, (mask, value, writes, adds) in rules
            if state & mask == value and state & writes != adds
        ]
        indices.sort()
        return indices


class Lookup:
    """Tables over slices of the state, filled as they are used."""

    def __init__(self, n_facts: int, n_actions: int, rules: Iterable[IndexedRule]) -> None:
        self._n_actions = n_actions
        n_slices = -(-n_facts // SLICE)
        self._n_bytes = n_slices * _BYTES
        false, true = _verdicts(n_facts, n_actions, rules)
        limit = max(SLICE, MAX_BITS // (2 * n_actions * n_slices + 1))
        self._tables = [
            _Table(false[i : i + SLICE], true[i : i + SLICE], limit)
            for i in range(0, n_facts, SLICE)
        ]
        self._lists = [_Lists(first) for first in range(0, n_actions, SLICE)]
        self._n_list_bytes = len(self._lists) * _BYTES

    def runnable(self, state: int) -> list[int]:
        """Return the indices of the rules, in order."""
        verdicts = 0
        slices = memoryview(state.to_bytes(self._n_bytes, "little")).cast("H")
        # Equal lengths by construction; strict=True would cost a tenth of the query.
        for table, part in zip(self._tables, slices):  # noqa: B905
            verdicts |= table[part]
        runs = verdicts >> self._n_actions & ~verdicts
        candidates: list[int] = []
        indices = memoryview(runs.to_bytes(self._n_list_bytes, "little")).cast("H")
        for lists, part in zip(self._lists, indices):  # noqa: B905
            if part:
                candidates += lists[part]
        return candidates


def _verdicts(
    n_facts: int, n_actions: int, rules: Iterable[IndexedRule]
) -> tuple[list[int], list[int]]:
    """Return what each fact says about all actions where it is false, and where it is true.

    Bit ``i`` keeps action ``i`` from running; bit ``n_actions + i`` says that it changes the fact.
    """
    false, true = [0] * n_facts, [0] * n_facts
    for index, (mask, value, writes, adds) in rules:
        blocks, changes = 1 << index, 1 << n_actions + index
        for verdicts, facts, says in (
            (false, value, blocks),
            (true, mask & ~value, blocks),
            (false, adds, changes),
            (true, writes & ~adds, changes),
        ):
            for position in positions(facts):
                verdicts[position] |= says
    return false, true


class _Table(dict[int, int]):
    """Verdicts of one slice of the state, by its value."""

    def __init__(self, false: Sequence[int], true: Sequence[int], limit: int) -> None:
        super().__init__()
        self._false, self._true, self._limit = false, true, limit

    def __missing__(self, part: int) -> int:
        verdicts = 0
        for position, (false, true) in enumerate(zip(self._false, self._true, strict=True)):
            verdicts |= true if part >> position & 1 else false
        if len(self) >= self._limit:
            self.clear()
        self[part] = verdicts
        return verdicts


class _Lists(dict[int, tuple[int, ...]]):
    """Indices of one slice of the actions, by its value."""

    def __init__(self, first: int) -> None:
        super().__init__()
        self._first = first

    def __missing__(self, part: int) -> tuple[int, ...]:
        indices = tuple(self._first + i for i in range(SLICE) if part >> i & 1)
        self[part] = indices
        return indices
