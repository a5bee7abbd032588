"""The grounded task: applicable, successor, cost, over states that are Python integers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, Fact, FluentKey, Formula, Number, Problem
from hrcplan.pddl.semantics import evaluate, ground_key
from hrcplan.task.actions import Builder, Change, GroundAction, value_fact
from hrcplan.task.conditions import Grounder, Test
from hrcplan.task.numbers import (
    Linear,
    changing_values,
    check_supported,
    keys_read,
    linear,
    structural_functions,
    value_of,
    variants,
)
from hrcplan.task.reachable import Instance, reachable

MAX_MEMORY = 100_000  # patterns of changed facts whose affected actions are remembered

_Rule = tuple[int, int, int, int, int]
"""Index, mask and value of the test, touched facts, added facts."""


class Task:
    """One problem, grounded by relaxed reachability.

    ``facts`` are the fluents in bit order; facts that never change are compiled away. ``actions``
    stand in ground-action order: by schema as declared, then by objects as declared. An action
    that would leave the state unchanged is not offered.

    Raises:
        UnsupportedError: if an action changes a number that is neither total-cost nor agent state,
            or an agent-state function has more than 16 reachable values.
        LimitError: if there are too many ground actions.

    >>> from hrcplan import load
    >>> task = load("transport", "two-boxes")
    >>> [str(task.actions[i]) for i in task.applicable(task.initial)][:2]
    ['(move robot wp0 wp1)', '(move robot wp0 wp2)']
    """

    def __init__(self, problem: Problem) -> None:
        check_supported(problem.domain)
        self.problem = problem
        self._instances, found = reachable(problem)
        self._moving = changing_values(problem, self._instances)
        self.facts = tuple(self._fluents(found))
        self.bits: Mapping[Fact, int] = {fact: i for i, fact in enumerate(self.facts)}
        fixed = problem.facts - set(self.facts)
        self._grounder = Grounder(problem, frozenset(self.facts), lambda fact: fact in fixed)
        self.actions = self._ground()
        self.initial = self.state_of(problem.facts | self._initial_values())
        self.goal: tuple[Test, ...] = self._goal()
        self._prepare()

    def _fluents(self, found: set[Fact]) -> list[Fact]:
        """Return the reachable facts that do not hold all the time, and the changing values."""
        deleted: set[Fact] = set()
        for action, args in self._instances:
            binding = Instance(action, args).binding
            for effect in action.effects:
                if effect.kind == "delete" and not effect.params:
                    deleted.add(ground_key(effect.target, binding))
        lifted = {e.target.name for a in self.problem.domain.actions for e in a.effects
                  if e.kind == "delete" and e.params}  # fmt: skip
        fluents = [
            fact for fact in sorted(found)
            if fact not in self.problem.facts or fact in deleted or fact[0] in lifted
        ]  # fmt: skip
        values = [value_fact(k, v) for k, numbers in self._moving.items() for v in numbers]
        return fluents + values

    def _initial_values(self) -> frozenset[Fact]:
        return frozenset(
            value_fact(key, self.problem.values[key])
            for key in self._moving
            if key in self.problem.values
        )

    def _ground(self) -> tuple[GroundAction, ...]:
        builder = Builder(self._grounder, self.bits, self._moving)
        found: list[GroundAction] = []
        for instance in self._instances:
            read = keys_read(instance.action, instance.binding)
            for values in variants(self.problem, self._moving, read):
                action = builder.build(instance, values, read)
                if action is not None:
                    found.append(replace(action, index=len(found)))
        return tuple(found)

    def _goal(self) -> tuple[Test, ...]:
        try:
            alternatives = self._grounder.alternatives(self.problem.goal, {}, self.problem.values)
        except ArithmeticError as error:
            raise UnsupportedError(f"the goal compares numbers that change: {error}") from None
        return Builder(self._grounder, self.bits, self._moving)._bits(alternatives)

    def _prepare(self) -> None:
        """Lay out what the inner loops need as flat tuples."""
        self._adds = [action.adds for action in self.actions]
        self._keeps = [~action.deletes for action in self.actions]
        self._rules: list[_Rule] = [_rule(action) for action in self.actions]
        self._complex = [a.index for a in self.actions if len(a.tests) != 1 or a.conditional]
        self._affected: dict[int, tuple[frozenset[int], tuple[_Rule, ...]]] = {}
        self._mentions = [0] * len(self.facts)
        for action in self.actions:
            for position in _positions(_mentioned(action)):
                self._mentions[position] |= 1 << action.index
        self._recent: tuple[int, list[int]] | None = None

    # The ten verbs, over states as integers and actions as indices.

    def applicable(self, state: int) -> list[int]:
        """Return the indices of the actions that can run in ``state`` and change it, in order.

        What follows a state that was asked about a moment ago costs only a look at the actions
        that mention a changed fact.
        """
        recent = self._recent
        if recent is None:
            found = [i for i, mask, value, touched, adds in self._rules
                     if state & mask == value and state & touched != adds]  # fmt: skip
        else:
            last, found = recent
            gone, rules = self._affected_by(state ^ last)
            found = [i for i in found if i not in gone]
            found += [i for i, mask, value, touched, adds in rules
                      if state & mask == value and state & touched != adds]  # fmt: skip
            found.sort()
        self._recent = (state, found)
        if self._complex:
            more = [i for i in self._complex if self._can_run(state, i)]
            return sorted(found + more)
        return found.copy()

    def _affected_by(self, pattern: int) -> tuple[frozenset[int], tuple[_Rule, ...]]:
        known = self._affected.get(pattern)
        if known is None:
            actions = 0
            for position in _positions(pattern):
                actions |= self._mentions[position]
            indices = list(_positions(actions))
            known = frozenset(indices), tuple(self._rules[i] for i in indices)
            if len(self._affected) < MAX_MEMORY:
                self._affected[pattern] = known
        return known

    def _can_run(self, state: int, index: int) -> bool:
        action = self.actions[index]
        return meets(state, action.tests) and self.successor(state, index) != state

    def is_applicable(self, state: int, index: int) -> bool:
        """Return whether one action can run in ``state`` and changes it."""
        return self._can_run(state, index)

    def successor(self, state: int, index: int) -> int:
        """Return the state after an action, in the sequential reading (its start, then its end)."""
        action = self.actions[index]
        if action.conditional:
            return self.finish(self.start(state, index), index)
        return state & self._keeps[index] | self._adds[index]

    def start(self, state: int, index: int) -> int:
        """Return the state just after an action has started."""
        return _apply(state, self.actions[index].at_start)

    def finish(self, state: int, index: int) -> int:
        """Return the state just after a running action has ended."""
        return _apply(state, self.actions[index].at_end)

    def is_goal(self, state: int) -> bool:
        """Return whether the goal holds in ``state``."""
        return meets(state, self.goal)

    def state_of(self, facts: Iterable[Fact]) -> int:
        """Return the state in which exactly these facts hold; facts that never change are ignored.

        >>> from hrcplan import load
        >>> task = load("transport", "two-boxes")
        >>> task.state_of(task.facts_of(task.initial)) == task.initial
        True
        """
        return sum({1 << self.bits[fact] for fact in facts if fact in self.bits})

    def facts_of(self, state: int) -> frozenset[Fact]:
        """Return the fluents that hold in a state."""
        return frozenset(self.facts[position] for position in _positions(state))

    @cached_property
    def _linear_costs(self) -> list[list[Linear] | None]:
        found: list[list[Linear] | None] = []
        for action in self.actions:
            sums = [linear(expr, action.binding) for expr in action.costs]
            known = [part for part in sums if part is not None]
            moving = any(key in self._moving for part in known for key in part)
            found.append(known if len(known) == len(sums) and not moving else None)
        return found

    @cached_property
    def costs(self) -> tuple[Number, ...]:
        """What each action adds to total-cost; 1 each if the domain counts no total-cost."""
        if TOTAL_COST not in self.problem.domain.functions:
            return (1,) * len(self.actions)
        values = self.problem.values
        found: list[Number] = []
        for action, sums in zip(self.actions, self._linear_costs, strict=True):
            if sums is None:
                fresh = {**values, **{k: action.values[k] for k in self._moving if k in action.values}}
                found.append(sum(evaluate(e, fresh, action.binding) for e in action.costs))
            else:
                found.append(sum(value_of(part, values) for part in sums))
        return tuple(found)

    def with_values(self, values: Mapping[FluentKey, Number]) -> Task:
        """Return this task with other function values, grounded anew only where that matters.

        Values that only occur in costs (agent state, as a rule) leave facts and actions as they
        are; values in conditions or durations, or of functions that actions change, do not.
        """
        problem = self.problem.with_values(values)
        if not self._structural.isdisjoint(k for k, v in values.items()
                                           if self.problem.values.get(k) != v):  # fmt: skip
            return Task(problem)
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__)
        other.__dict__.pop("costs", None)
        other.problem = problem
        return other

    def with_goal(self, goal: Formula) -> Task:
        """Return this task with another goal, without grounding anything anew.

        Raises:
            UnsupportedError: if bits cannot hold the goal.
        """
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__)
        other.problem = replace(self.problem, goal=goal)
        other._grounder = replace(self._grounder, problem=other.problem)
        other.goal = other._goal()
        return other

    def with_actions(self, actions: tuple[GroundAction, ...], costs: tuple[Number, ...]) -> Task:
        """Return a task that only has some of the actions, at other costs and without a metric.

        ``actions`` are numbered from 0; what costs depend on no longer counts.
        """
        other = object.__new__(Task)
        kept = {k: v for k, v in self.__dict__.items() if k not in ("_structural", "_linear_costs")}
        other.__dict__.update(kept, actions=actions, costs=costs)
        other.problem = replace(self.problem, metric=None)
        other._prepare()
        return other

    @cached_property
    def _structural(self) -> frozenset[FluentKey]:
        keys = set(self._moving)
        for instance in self._instances:
            binding = instance.binding
            keys.update(ground_key(f, binding) for f in structural_functions(instance.action))
            if self._moving:
                keys.update(keys_read(instance.action, binding))
        return frozenset(keys)

    @cached_property
    def is_agent_free(self) -> bool:
        """Whether no fact that mentions an agent is ever changed by an action."""
        agents = set(self.problem.agents)
        return not any(agents.intersection(fact) for fact in self.facts)

    def find(self, name: str, args: Sequence[str]) -> list[int]:
        """Return the indices of the actions called ``(name *args)``; one per changing value."""
        wanted = (name, *args)
        return [a.index for a in self.actions if (a.name, *a.args) == wanted]


def meets(state: int, tests: Iterable[Test]) -> bool:
    """Return whether any of the alternatives holds in a state."""
    return any(state & mask == value for mask, value in tests)


def _apply(state: int, changes: tuple[Change, ...]) -> int:
    adds = deletes = 0
    for change in changes:
        if meets(state, change.tests):
            adds |= change.adds
            deletes |= change.deletes
    return state & ~deletes | adds


def _rule(action: GroundAction) -> _Rule:
    if len(action.tests) != 1 or action.conditional:
        return action.index, 0, 1, 0, 0  # never: looked at one by one
    mask, value = action.tests[0]
    return action.index, mask, value, action.adds | action.deletes, action.adds


def _mentioned(action: GroundAction) -> int:
    found = action.adds | action.deletes
    for mask, _ in action.tests:
        found |= mask
    return found


def _positions(bits: int) -> Iterable[int]:
    while bits:
        low = bits & -bits
        yield low.bit_length() - 1
        bits ^= low
