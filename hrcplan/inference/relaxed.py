"""How far goals are from states, estimated: relaxed plans (Hoffmann and Nebel, JAIR 2001).

What makes a literal true cheapest, if nothing true ever becomes false, does not depend on the
goal. So one pass over many states at once serves all goals, and the steps that a goal needs are a
union of bits.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hrcplan.bank.rules import positions_of
from hrcplan.bank.steps import Op
from hrcplan.task.conditions import Test

FloatArray = NDArray[np.float64]

INFINITE = float("inf")


class Relaxation:
    """A task without deletes, for many states and goals.

    Args:
        ops: What can be done.
        costs: What each costs; not negative.
        goals: The alternatives of each goal, as ``(mask, value)``.
    """

    def __init__(
        self, ops: Sequence[Op], costs: Sequence[float], goals: Sequence[Sequence[Test]]
    ) -> None:
        self._ids: dict[int, int] = {}
        self._goals = [[self._needs(test) for test in tests] for tests in goals]
        rules = list(self._relax(ops))
        useful = self._useful(rules)
        rules = [rules[i] for i in useful]
        self.costs = list(costs)
        least = min((cost for cost in costs if cost > 0), default=1.0)
        # What costs nothing costs a little here: a literal must not support itself.
        self._rule_costs = np.array([costs[op] or least * 1e-3 for op, _, _ in rules])[:, None]
        self._lay_out(rules)
        self._rules = rules

    def _literal(self, literal: int) -> int:
        return self._ids.setdefault(literal, len(self._ids))

    def _needs(self, test: Test) -> tuple[int, ...]:
        mask, value = test
        return tuple(self._literal(2 * i + (not value >> i & 1)) for i in positions_of(mask))

    def _relax(self, ops: Sequence[Op]):
        for index, op in enumerate(ops):
            for test in op.tests:
                for change in op.changes:
                    for given in change.tests:
                        mask, value = test[0] | given[0], test[1] | given[1]
                        gives = [2 * i for i in positions_of(change.adds)]
                        gives += [2 * i + 1 for i in positions_of(change.deletes)]
                        yield index, (mask, value), gives

    def _useful(self, rules):
        """Number the literals that matter, backwards from the goals; return the rules that do."""
        chosen: dict[int, None] = {}
        makers: dict[int, list[int]] = {}
        for i, (_, _, gives) in enumerate(rules):
            for literal in gives:
                makers.setdefault(literal, []).append(i)
        waiting = list(self._ids)
        seen = set(waiting)
        while waiting:
            for i in makers.get(waiting.pop(), ()):
                if i in chosen:
                    continue
                chosen[i] = None
                mask, value = rules[i][1]
                for p in positions_of(mask):
                    literal = 2 * p + (not value >> p & 1)
                    if literal not in seen:
                        seen.add(literal)
                        waiting.append(literal)
                        self._literal(literal)
        return sorted(chosen)

    def _lay_out(self, rules) -> None:
        nothing = len(self._ids)  # a literal that always holds fills the table up
        needs = [[self._ids[2 * p + (not value >> p & 1)] for p in positions_of(mask)]
                 for _, (mask, value), _ in rules]
        width = max(map(len, needs), default=1) or 1
        self._table = np.array([n + [nothing] * (width - len(n)) for n in needs],
                               dtype=np.int32).reshape(-1, width)
        self._needs_of = needs
        entries = sorted((self._ids[g], i) for i, (_, _, gives) in enumerate(rules)
                         for g in gives if g in self._ids)
        lits = np.array([e[0] for e in entries], dtype=np.int32)
        self._entry_rule = np.array([e[1] for e in entries], dtype=np.int32)
        self._made, self._starts = np.unique(lits, return_index=True) if entries else (
            np.zeros(0, np.int32), np.zeros(0, np.int64))
        self._segment = np.repeat(np.arange(len(self._made)), np.diff([*self._starts, len(entries)]))
        order = sorted(self._ids, key=self._ids.__getitem__)
        self._fact = np.array([l >> 1 for l in order], dtype=np.int64)
        self._sign = np.array([not l & 1 for l in order], dtype=np.bool_)
        self._n_bytes = -(-(int(self._fact.max(initial=0)) + 1) // 8)
        self._bits = [1 << op for op, _, _ in rules]

    def _holds(self, states: Sequence[int]):
        size = self._n_bytes
        cut = (1 << 8 * size) - 1
        raw = b"".join((s & cut).to_bytes(size, "little") for s in states)
        bits = np.unpackbits(np.frombuffer(raw, np.uint8).reshape(-1, size), axis=1, bitorder="little")
        return (bits[:, self._fact] == self._sign).T

    def supporters(self, states: Sequence[int]):
        """Return the cheapest rule for each literal in each state: -1 holds, -2 out of reach."""
        holds = self._holds(states)
        n = len(self._ids)
        values = np.full((n + 1, len(states)), INFINITE)
        values[:n][holds] = 0
        values[n] = 0
        old = None
        while True:
            price = values[self._table[:, 0]]
            for c in range(1, self._table.shape[1]):
                price = price + values[self._table[:, c]]
            price = price + self._rule_costs
            entries = price[self._entry_rule]
            best = np.minimum.reduceat(entries, self._starts, axis=0) if len(self._starts) else entries
            new = np.minimum(values[self._made], best)
            if (new == values[self._made]).all():
                break
            values[self._made] = new
        eq = entries == best[self._segment]
        rank = np.where(eq, np.arange(len(entries))[:, None], len(entries))
        first = np.minimum.reduceat(rank, self._starts, axis=0)
        found = np.full((n, len(states)), -2)
        found[self._made] = self._entry_rule[np.minimum(first, len(entries) - 1)]
        found[~np.isfinite(values[:n])] = -2
        found[holds] = -1
        return found, values

    def plans(self, states: Sequence[int]) -> list[list[int | None]]:
        """Return for each state and goal the ops of a relaxed plan, as bits; None: out of reach."""
        found, values = self.supporters(states)
        return [self._plans_of(found[:, i].tolist()) for i in range(len(states))]

    def _plans_of(self, supporter: list[int]) -> list[int | None]:
        known: dict[int, int] = {}
        needs_of, bits = self._needs_of, self._bits

        def plan(literal: int) -> int:
            rule = supporter[literal]
            if rule == -1:
                return 0
            done = known.get(literal)
            if done is not None:
                return done
            bitset = bits[rule]
            for need in needs_of[rule]:
                if supporter[need] != -1:
                    bitset |= plan(need)
            known[literal] = bitset
            return bitset

        result = []
        for tests in self._goals:
            best = None
            for lits in tests:
                if any(supporter[l] == -2 for l in lits):
                    continue
                b = 0
                for l in lits:
                    b |= plan(l)
                if best is None or self.cost_of(b) < self.cost_of(best):
                    best = b
            result.append(best)
        return result

    def cost_of(self, bitset: int) -> float:
        return bitset.bit_count() if all(c == 1 for c in ()) else bitset.bit_count()
