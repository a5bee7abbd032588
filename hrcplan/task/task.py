"""The grounded task: applicable, successor, cost, over states that are Python integers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import replace
from functools import cached_property
from math import inf

from hrcplan.core.bits import positions
from hrcplan.core.numbers import Number, exact
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    TOTAL_COST,
    TOTAL_TIME,
    Fact,
    FluentKey,
    Formula,
    Problem,
    formula_functions,
)
from hrcplan.pddl.semantics import evaluate, ground_key, instances, mentions
from hrcplan.task.actions import BitEffect, GroundAction, ground_actions
from hrcplan.task.changing import Reached, combinations, reached_values, value_fact
from hrcplan.task.conditions import Grounder, Test, Tests, all_of, any_of, meets
from hrcplan.task.lookup import lookup
from hrcplan.task.numbers import check_supported, divisors, functions_read, numeric_effects
from hrcplan.task.reachable import SchemaInstance, reachable


class Task:
    """One problem, grounded by relaxed reachability.

    ``facts`` are the fluents in bit order; facts that never change are compiled away. ``actions``
    stand in ground-action order: by schema as declared, then by objects as declared. An action
    that would leave the state unchanged is not offered. ``reached`` are the values, in bit order,
    of the functions that actions change, and ``movers`` the instances that could change them. Tasks
    with the same ``structure`` differ in costs and in the initial state only, so what was found out
    about one holds for the others.

    Raises:
        UnsupportedError: if an action changes a number that is neither total-cost nor agent state,
            or an agent-state function has more than 16 reachable values.
        LimitError: if there are too many ground actions, or at the deadline (a time of
            ``time.monotonic()``).

    >>> from hrcplan import ground
    >>> task = ground("transport", "two-boxes")
    >>> [str(task.actions[i]) for i in task.applicable(task.initial)][:2]
    ['(move robot wp0 wp1)', '(move robot wp0 wp2)']
    """

    def __init__(self, problem: Problem, deadline: float = inf) -> None:
        check_supported(problem.domain)
        self.problem = problem
        found, facts = reachable(problem, deadline)
        fluents = _fluents(problem, found, facts)
        fixed = problem.facts.difference(fluents)
        bits = {fact: i for i, fact in enumerate(fluents)}
        reached = reached_values(Grounder(problem, bits, fixed), found)
        values = [value_fact(key, value) for key in reached for value in reached[key]]
        self.facts = (*fluents, *values)
        self.bits: Mapping[Fact, int] = {fact: i for i, fact in enumerate(self.facts)}
        grounder = Grounder(problem, self.bits, fixed)
        self.reached: Reached = reached
        self.movers = tuple(i for i in found if any(numeric_effects(i.action)))
        self.actions = ground_actions(grounder, found, reached)
        self.structure: object = self.actions
        given = [value_fact(k, problem.values[k]) for k in reached if k in problem.values]
        self.initial = self.state_of([*problem.facts, *given])
        self._grounder, self._reached = grounder, reached
        self.goal: tuple[Test, ...] = _goal(grounder, reached)
        self._prepare()

    def _prepare(self) -> None:
        """Lay out what the inner loops need."""
        self._adds = [action.adds for action in self.actions]
        self._deletes = [action.deletes for action in self.actions]
        simple = [a for a in self.actions if len(a.tests) == 1 and not a.conditional]
        rules = [(a.index, *a.tests[0], a.adds, a.deletes) for a in simple]
        self._complex = sorted({a.index for a in self.actions}.difference(a.index for a in simple))
        self._runnable = lookup(len(self.facts), len(self.actions), rules)

    # The ten verbs, over states as integers and actions as indices.

    def applicable(self, state: int) -> list[int]:
        """Return the indices of the actions that can run in ``state`` and change it, in order."""
        found = self._runnable(state)
        if self._complex:
            found += [i for i in self._complex if self.is_applicable(state, i)]
            found.sort()
        return found

    def is_applicable(self, state: int, index: int) -> bool:
        """Return whether one action can run in ``state`` and changes it."""
        return meets(state, self.actions[index].tests) and self.successor(state, index) != state

    def successor(self, state: int, index: int) -> int:
        """Return the state after an action, in the sequential reading (its start, then its end)."""
        action = self.actions[index]
        if action.conditional:
            return self.finish(self.start(state, index), index)
        deletes = self._deletes[index]
        return (state | deletes) ^ deletes | self._adds[index]

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

        >>> from hrcplan import ground
        >>> task = ground("transport", "two-boxes")
        >>> task.state_of(task.facts_of(task.initial)) == task.initial
        True
        """
        return sum({1 << self.bits[fact] for fact in facts if fact in self.bits})

    def facts_of(self, state: int) -> frozenset[Fact]:
        """Return the fluents that hold in a state."""
        return frozenset(self.facts[position] for position in positions(state))

    @cached_property
    def costs(self) -> tuple[Number, ...]:
        """What each action adds to total-cost; 1 each if the domain counts no total-cost."""
        if TOTAL_COST not in self.problem.domain.functions:
            return (1,) * len(self.actions)
        values = self.problem.values
        return tuple(
            exact(sum(evaluate(cost, values, {}) for cost in action.costs))
            for action in self.actions
        )

    def with_values(self, values: Mapping[FluentKey, Number]) -> Task:
        """Return this task with other function values, grounded anew only where that matters.

        Values that only occur in costs (agent state, as a rule) leave facts and actions as they
        are; values in conditions or durations, or of functions that actions change, do not.
        """
        old, problem = self.problem.values, self.problem.with_values(values)
        changed = [key for key, value in values.items() if old.get(key) != value]
        if any(k not in old or k in self.reached or k[0] in self._structural for k in changed):
            return Task(problem)
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__)
        other.__dict__.pop("costs", None)
        other.problem = problem
        return other

    def with_facts(self, facts: Iterable[Fact]) -> Task:
        """Return this task from another initial state, grounded anew only if that is needed.

        What is reachable from reachable facts is reachable, so a state that has been reached from
        the initial state keeps the grounding (it may hold more than the new task needs).

        >>> from hrcplan import ground
        >>> task = ground("transport", "two-boxes")
        >>> moved = task.with_facts(task.problem.facts - {("at", "human", "wp1")})
        >>> moved.actions is task.actions, moved.initial == task.initial
        (True, False)
        """
        problem = replace(self.problem, facts=frozenset(facts))
        known = self.bits.keys()
        if problem.facts - known != self.problem.facts - known:
            return Task(problem)
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__)
        other.problem = problem
        changing = self._value_facts & self.facts_of(self.initial)
        other.initial = self.state_of([*problem.facts, *changing])
        return other

    @cached_property
    def _value_facts(self) -> frozenset[Fact]:
        """The facts that stand for values of functions that actions change."""
        return frozenset(fact for fact in self.facts if fact[0] == "=")

    def with_goal(self, goal: Formula) -> Task:
        """Return this task with another goal, without grounding anything anew.

        Raises:
            UnsupportedError: if bits cannot hold the goal.
        """
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__)
        other.__dict__.pop("_structural", None)
        other.problem = replace(self.problem, goal=goal)
        other._grounder = replace(self._grounder, problem=other.problem)
        other.goal = _goal(other._grounder, self._reached)
        return other

    def with_actions(self, actions: tuple[GroundAction, ...], costs: tuple[Number, ...]) -> Task:
        """Return a task that only has some of the actions, at other costs and without a metric.

        ``actions`` are numbered from 0; what costs depended on no longer counts.
        """
        other = object.__new__(Task)
        other.__dict__.update(self.__dict__, actions=actions, costs=costs)
        other.problem = replace(self.problem, metric=None)
        other._prepare()
        return other

    @cached_property
    def _structural(self) -> frozenset[str]:
        """The functions that decide more than costs, those of ``reached`` aside."""
        found = {function.name for function in formula_functions(self.problem.goal)}
        for action in self.problem.domain.actions:
            found.update(function.name for function in functions_read(action))
            # A cost that divides by zero is none: the action cannot run.
            found.update(f.name for effect in action.effects for f in divisors(effect.value))
        return frozenset(found)

    @cached_property
    def is_agent_free(self) -> bool:
        """Whether no fact that mentions an agent is ever changed by an action."""
        agents = set(self.problem.agents)
        return not any(agents.intersection(fact) for fact in self.facts)

    def find(self, name: str, args: Sequence[str]) -> list[int]:
        """Return the indices of the actions called ``(name *args)``; one per changing value."""
        wanted = (name, *args)
        return [a.index for a in self.actions if (a.name, *a.args) == wanted]


def _fluents(problem: Problem, found: Iterable[SchemaInstance], facts: Set[Fact]) -> list[Fact]:
    """Return the reachable facts that do not hold all the time."""
    deleted: set[Fact] = set()
    for instance in found:
        for effect in instance.action.effects:
            if effect.kind == "delete":
                for inner in instances(effect.params, instance.binding, problem):
                    deleted.add(ground_key(effect.target, inner))
    return sorted(facts & deleted | facts - problem.facts)


def _goal(grounder: Grounder, reached: Reached) -> Tests:
    """Return the goal as alternatives, for every combination of the changing values it names."""
    problem = grounder.problem
    named = {key for is_fact, key in mentions(problem.goal, {}, problem) if not is_fact}
    if not named.isdisjoint([(TOTAL_COST,), (TOTAL_TIME,)]):
        raise UnsupportedError("the goal looks at the cost or time of the plan",
                               hint="enhsp and kairos plan with such numbers")  # fmt: skip
    found: list[Tests] = []
    for chosen in combinations(named & reached.keys(), reached):
        bits = (grounder.bit(value_fact(key, value)) for key, value in chosen.items())
        goal = grounder.tests(problem.goal, {}, {**problem.values, **chosen})
        found.append(all_of([goal, *(((bit, bit),) for bit in bits)]))
    return any_of(found)


def _apply(state: int, changes: tuple[BitEffect, ...]) -> int:
    adds = deletes = 0
    for change in changes:
        if meets(state, change.tests):
            adds |= change.adds
            deletes |= change.deletes
    return state & ~deletes | adds
