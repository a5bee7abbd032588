"""Actions that improve the metric: what they add up to at most, and whether one can be idle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import reduce
from math import inf
from operator import and_
from types import MappingProxyType

from hrcplan.core.bits import positions
from hrcplan.core.numbers import Number
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, TRUE, Action, Atom, Problem
from hrcplan.pddl.walks import conjuncts
from hrcplan.planners.number_range import signs
from hrcplan.task import GroundAction, Task
from hrcplan.task.changing import ValueSets
from hrcplan.task.numbers import linear


def idle_gain(problem: Problem, value_sets: ValueSets = MappingProxyType({})) -> Action | None:
    """Return an action that may improve the metric and change nothing else; None if there is none.

    A ground task leaves such actions out, so what is said of it is not said of the problem.
    ``value_sets`` are the values of functions that actions change, as far as they are known.
    """
    for action in problem.domain.actions:
        if _may_gain(action, problem, value_sets) and not _uses_up(action):
            return action
    return None


def most_gain(task: Task, prices: Sequence[Number]) -> Number:
    """Return what actions with negative prices add up to at most, as a number above zero.

    An action that needs a fact and makes it false is done no more often than the fact is made true.

    Raises:
        UnsupportedError: if nothing limits such an action.
    """
    gaining = [a for a, price in zip(task.actions, prices, strict=True) if price < 0]
    if not gaining:
        return 0
    supplies = _supplies(task)
    gains: dict[int, Number] = {}
    for action in gaining:
        fact = min(_used_up(action), key=lambda bit: supplies.get(bit, inf), default=0)
        if supplies.get(fact, inf) == inf:
            raise UnsupportedError(f"{action} can improve the metric again and again")
        gains[fact] = max(gains.get(fact, 0), -prices[action.index])
    return sum(gain * int(supplies[fact]) for fact, gain in gains.items())


def _supplies(task: Task) -> dict[int, float]:
    """Return how often each fact that is used up can be true, by its bit, where that is limited."""
    users = {action.index: tuple(_used_up(action)) for action in task.actions}
    supplies = dict.fromkeys({bit for bits in users.values() for bit in bits}, inf)
    makers: dict[int, list[int]] = {bit: [] for bit in supplies}
    for action in task.actions:
        for position in positions(_added(action)):
            makers.get(1 << position, []).append(action.index)
    while True:
        new = {
            bit: bool(task.initial & bit) + _uses([users[i] for i in indices], supplies)
            for bit, indices in makers.items()
        }
        if new == supplies:
            return supplies
        supplies = new


def _uses(users: Sequence[Sequence[int]], supplies: Mapping[int, float]) -> float:
    """Return how often actions can be done that use up facts: together as often as a fact is there.

    Each action counts for the scarcest fact that it uses up.
    """
    if not all(users):
        return inf
    facts = {min(bits, key=lambda bit: (supplies[bit], bit)) for bits in users}
    return sum(supplies[fact] for fact in facts)


def _added(action: GroundAction) -> int:
    effects = (*action.at_start, *action.at_end)
    return reduce(lambda bits, effect: bits | effect.adds, effects, action.adds)


def _used_up(action: GroundAction) -> Iterator[int]:
    """Yield the bits of the facts that an action needs and makes false."""
    needed = reduce(and_, (mask & value for mask, value in action.tests))
    yield from (1 << position for position in positions(needed & action.deletes & ~_added(action)))


def _may_gain(action: Action, problem: Problem, value_sets: ValueSets) -> bool:
    """Return whether an action may improve the metric."""
    weight: Number = 1
    step: Number = 0
    if problem.metric is not None:
        parts = linear(problem.metric, {}) or {}
        weight, step = parts.get((TOTAL_COST,), 0), parts.get((TOTAL_TIME,), 0)
    weight, step = (-weight, -step) if problem.maximize else (weight, step)
    if step < 0:
        return True
    for effect in action.effects:
        if effect.target.name == TOTAL_COST and weight:
            below, above = signs(effect.value, problem, value_sets)
            if effect.kind != "increase" or (below if weight > 0 else above):
                return True
    return False


def _uses_up(action: Action) -> bool:
    """Return whether all instances of an action make a fact false that they need."""
    needed = {p for c in action.conditions for p in conjuncts(c.formula) if isinstance(p, Atom)}
    added = {effect.target.name for effect in action.effects if effect.kind == "add"}
    return any(
        effect.kind == "delete" and effect.condition == TRUE and not effect.params
        and effect.target in needed and effect.target.name not in added
        for effect in action.effects
    )  # fmt: skip
