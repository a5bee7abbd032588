"""Beliefs the slow way: plans are listed anew after every step, and all histories enumerated."""

import math
from collections.abc import Sequence
from itertools import pairwise, product

from hrcplan.bank import Bank


def optimal_plans(bank: Bank, goal: int, state: int) -> list[tuple[int, ...]]:
    """Return all shortest step sequences from a state to a goal."""
    layer: dict[int, list[tuple[int, ...]]] = {state: [()]}
    seen = {state}
    while layer:
        done = [p for s, paths in layer.items() if bank.goals.is_reached(goal, s) for p in paths]
        if done:
            return done
        after: dict[int, list[tuple[int, ...]]] = {}
        for before, paths in layer.items():
            for step in bank.table.applicable(before):
                target = bank.table.successor(before, step)
                assert target is not None
                if target not in seen:
                    after.setdefault(target, []).extend((*p, step) for p in paths)
        seen |= after.keys()
        layer = after
    return []


def facts_read(bank: Bank, goal: int, plans: Sequence[Sequence[int]]) -> int:
    """Return the facts that a goal and the steps of its plans look at, as bits."""
    used = {step for plan in plans for step in plan}
    found = 0
    for mask, _ in bank.goals.tests[goal]:
        found |= mask
    for op in bank.table.ops:
        if op.step in used:
            for mask, _ in op.tests:
                found |= mask
    return found


class Standing:
    """The plans of a goal from one state on, and what is left of them after further steps."""

    def __init__(self, bank: Bank, goal: int, state: int) -> None:
        self.bank, self.goal = bank, goal
        plans = optimal_plans(bank, goal, state)
        self.relevant = facts_read(bank, goal, plans)
        self.tails: dict[int, list[tuple[int, ...]]] = {}
        for plan in plans:
            now: int | None = state
            for length in range(len(plan) + 1):
                assert now is not None
                rest = self.tails.setdefault(now & self.relevant, [])
                if plan[length:] not in rest:
                    rest.append(plan[length:])
                now = bank.table.successor(now, plan[length]) if length < len(plan) else None


class Follower:
    """The tracker of a goal, with lists of plans instead of graphs."""

    def __init__(self, bank: Bank, goal: int) -> None:
        self.first = self.now = Standing(bank, goal, bank.initial)
        self.left = self.first.tails.get(bank.initial & self.first.relevant, [])

    def move(self, state: int) -> None:
        """Take in that the world is in another state."""
        for standing in (self.first, self.now):
            if state & standing.relevant in standing.tails:
                self.now = standing
                break
        else:
            self.now = Standing(self.first.bank, self.first.goal, state)
        self.left = self.now.tails.get(state & self.now.relevant, [])


class Look:
    """For every goal what can be said about a step in a state."""

    def __init__(self, bank: Bank, followers: Sequence[Follower], state: int, step: int) -> None:
        names = [bank.table[i].name for i in range(len(bank.table))]
        self.shares, self.n_next = [], []
        for follower in followers:
            plans = [p for p in follower.left if p]
            fits = sum(names[p[0]] == names[step] for p in plans)
            self.shares.append(fits / len(plans) if plans else 0.0)
            self.n_next.append(len({names[p[0]] for p in plans}))
        self.n_doable = len({names[s] for s in bank.table.applicable(state)})

    def policy(self, goal: int, rate: float) -> float:
        if self.shares[goal]:
            return (1 - rate) / self.n_next[goal]
        return rate / max(1, self.n_doable - self.n_next[goal])


def looks(bank: Bank, steps: Sequence[int]) -> list[Look]:
    state, found = bank.initial, []
    followers = [Follower(bank, goal) for goal in range(len(bank.names))]
    for step in steps:
        found.append(Look(bank, followers, state, step))
        after = bank.table.successor(state, step)
        assert after is not None
        state = after
        for follower in followers:
            follower.move(state)
    return found


def exact(bank: Bank, steps: Sequence[int], rate: float) -> list[float]:
    n = len(bank.names)
    scores = [0.0] * n
    for look in looks(bank, steps):
        if any(look.shares):
            for goal in range(n):
                share = look.shares[goal]
                rest = max(1, look.n_doable - look.n_next[goal])
                scores[goal] += math.log((1 - rate) * share if share else rate / rest)
    weights = [math.exp(score) for score in scores]
    return [weight / sum(weights) for weight in weights]


def histories(
    bank: Bank, steps: Sequence[int], rates: Sequence[float], hazard: float, never: float,
    settles: float,
) -> list[tuple[tuple[int, ...], tuple[bool, ...], float]]:  # fmt: skip
    """Return (goal at each step, changed before it, probability with the observations)."""
    found, n = [], len(bank.names)
    seen = looks(bank, steps)
    for rate, goals in product(rates, product(range(n), repeat=len(steps))):
        changed = tuple(a != b for a, b in pairwise(goals))
        # The goal may change again, or will not.
        may, will_not = 1 - never, never
        for change in changed:
            if change:
                moved = may * hazard / (n - 1)
                may, will_not = moved * (1 - settles), moved * settles
            else:
                may *= 1 - hazard
        weight = (may + will_not) / len(rates) / n
        for look, goal in zip(seen, goals, strict=True):
            weight *= look.policy(goal, rate)
        found.append((goals, (False, *changed), weight))
    return found
