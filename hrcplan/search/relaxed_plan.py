"""How far goals are from states, estimated: relaxed plans (Hoffmann and Nebel, JAIR 2001).

What makes a literal true cheapest, if nothing true ever becomes false, does not depend on the
goal. So one pass over many states serves all goals, and what a goal needs is a union of bits.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.core.arrays import Bools, Floats, Ids
from hrcplan.core.bits import positions
from hrcplan.search.delete_relaxation import RelaxedRule, literals, relaxed_rules
from hrcplan.task.conditions import Test
from hrcplan.task.steps import Operator

INFINITE = float("inf")
HOLDS, NEVER = -1, -2


class Relaxation:
    """The ops without what they make false, for many states and goals at once.

    Args:
        ops: What can be done.
        goals: The alternatives of each goal.
    """

    def __init__(self, ops: Sequence[Operator], goals: Sequence[Sequence[Test]]) -> None:
        self._prices = [op.cost for op in ops]
        self._is_unit = set(self._prices) <= {1}
        self._ids: dict[int, int] = {}
        self._goals = [[self._number(literals(test)) for test in tests] for tests in goals]
        rules = self._that_matter(list(relaxed_rules(ops, admissible=False)))
        self._op_bits = [1 << rule.op for rule in rules]
        self._needs = [self._number(rule.needs) for rule in rules]
        self._lay_out(rules)

    def _number(self, needs: Sequence[int]) -> tuple[int, ...]:
        """Return the numbers of literals, new ones where there are none yet."""
        return tuple(self._ids.setdefault(x, len(self._ids)) for x in needs)

    def _that_matter(self, rules: list[RelaxedRule]) -> list[RelaxedRule]:
        """Return the rules that can help with a goal; number the literals that they need."""
        makers: dict[int, list[int]] = {}
        for i, rule in enumerate(rules):
            for literal in rule.gives:
                makers.setdefault(literal, []).append(i)
        rule_ids: set[int] = set()
        waiting, needs = list(self._ids), set(self._ids)
        while waiting:
            for i in makers.get(waiting.pop(), ()):
                if i not in rule_ids:
                    rule_ids.add(i)
                    new = [x for x in rules[i].needs if x not in needs]
                    needs.update(new)
                    waiting += new
                    self._number(rules[i].needs)
        return [rules[i] for i in sorted(rule_ids)]

    def _lay_out(self, rules: Sequence[RelaxedRule]) -> None:
        """Lay needs and makers out in tables for numpy."""
        n = len(self._ids)  # the literal behind the last one always holds: it fills the table
        width = max((len(needs) for needs in self._needs), default=0) or 1
        rows = [[*needs, *[n] * (width - len(needs))] for needs in self._needs]
        self._table = np.array(rows, dtype=np.int64).reshape(-1, width)
        # What costs nothing costs a little here: a literal must not support itself.
        prices = [self._prices[rule.op] or 1e-3 for rule in rules]
        self._rule_prices = np.array(prices, dtype=np.float64).reshape(-1, 1)
        makers = sorted((self._ids[x], i) for i, rule in enumerate(rules)
                      for x in rule.gives if x in self._ids)  # fmt: skip
        literals = np.array([literal for literal, _ in makers], dtype=np.int64)
        self._makers = np.array([i for _, i in makers], dtype=np.int64)
        self._literals, self._first = np.unique(literals, return_index=True)
        self._segment = np.repeat(
            np.arange(len(self._literals)), np.diff([*self._first.tolist(), len(makers)])
        )
        order = np.array(list(self._ids), dtype=np.int64)
        self._fact, self._is_true = order >> 1, order & 1 == 0
        self._n_bytes = -(-(int(self._fact.max(initial=0)) + 1) // 8)

    def costs(self, states: Sequence[int]) -> list[list[float | None]]:
        """Return for each state and goal the cost of a relaxed plan; None if there is none."""
        supporters = self._supporters(states).T.tolist()
        return [self._costs(supporter) for supporter in supporters]

    def _holding(self, states: Sequence[int]) -> Bools:
        size = self._n_bytes
        cut = (1 << 8 * size) - 1
        raw = b"".join((state & cut).to_bytes(size, "little") for state in states)
        rows = np.frombuffer(raw, np.uint8).reshape(-1, size)
        bits = np.unpackbits(rows, axis=1, bitorder="little")
        holds: Bools = (bits[:, self._fact] == self._is_true).T
        return holds

    def _supporters(self, states: Sequence[int]) -> Ids:
        """Return for each literal and state the rule that makes it true cheapest (h-add)."""
        holds = self._holding(states)
        n = len(self._ids)
        rule_of = np.where(holds, HOLDS, NEVER)
        if not len(self._literals):
            return rule_of
        values = np.full((n + 1, len(states)), INFINITE)
        values[:n][holds] = values[n] = 0
        while True:
            offers = self._offers(values)
            best = np.minimum.reduceat(offers, self._first, axis=0)
            now = values[self._literals]
            if (best >= now).all():
                break
            values[self._literals] = np.minimum(now, best)
        rank = np.where(offers == best[self._segment], np.arange(len(offers))[:, None], len(offers))
        cheapest = np.minimum.reduceat(rank, self._first, axis=0)
        rules = self._makers[np.minimum(cheapest, len(offers) - 1)]
        rule_of[self._literals] = np.where(np.isfinite(values[self._literals]), rules, NEVER)
        rule_of[holds] = HOLDS
        return rule_of

    def _offers(self, values: Floats) -> Floats:
        price = values[self._table[:, 0]]
        for column in self._table.T[1:]:
            price += values[column]
        price += self._rule_prices
        offers: Floats = price[self._makers]
        return offers

    def _costs(self, supporter: list[int]) -> list[float | None]:
        ops_of: dict[int, int] = {}
        costs: list[float | None] = []
        for tests in self._goals:
            least: float | None = None
            for needs in tests:
                if all(supporter[literal] != NEVER for literal in needs):
                    cost = self._cost(self._ops_for(needs, supporter, ops_of))
                    least = cost if least is None else min(least, cost)
            costs.append(least)
        return costs

    def _ops_for(
        self, literals: Sequence[int], supporter: list[int], ops_of: dict[int, int]
    ) -> int:
        """Return the ops of a relaxed plan for some literals, as bits.

        ``ops_of`` has those of single literals, and is added to. No recursion: chains may be long.
        """
        needs, op_bits = self._needs, self._op_bits
        waiting = [literal for literal in literals if supporter[literal] != HOLDS]
        while waiting:
            literal = waiting[-1]
            rule = supporter[literal]
            if literal not in ops_of:
                ops_of[literal] = op_bits[rule]
                before = [n for n in needs[rule] if n not in ops_of and supporter[n] != HOLDS]
                if before:
                    waiting += before
                    continue
            waiting.pop()
            for need in needs[rule]:
                if supporter[need] != HOLDS:
                    ops_of[literal] |= ops_of[need]
        ops = 0
        for literal in literals:
            if supporter[literal] != HOLDS:
                ops |= ops_of[literal]
        return ops

    def _cost(self, ops: int) -> float:
        if self._is_unit:
            return float(ops.bit_count())
        return float(sum(self._prices[op] for op in positions(ops)))
