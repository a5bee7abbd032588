"""The grounded task: applicable, successor, cost, over states that are Python integers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from math import inf
from typing import Final

from hrcplan.core.bits import positions
from hrcplan.core.deprecation import Renamed
from hrcplan.core.numbers import Number, exact
from hrcplan.core.records import replace
from hrcplan.core.text import cut
from hrcplan.pddl.inlining import plain
from hrcplan.pddl.model import Fact, FluentKey, Formula, Problem
from hrcplan.pddl.semantics import evaluate
from hrcplan.pddl.walks import formula_functions
from hrcplan.task.actions import GroundAction
from hrcplan.task.changing import ValueSets
from hrcplan.task.conditions import Test, meets
from hrcplan.task.grounding import ActionIndex, Grounding, ground
from hrcplan.task.numbers import divisors, functions_read
from hrcplan.task.transitions import apply


class Task:
    """One problem, grounded by relaxed reachability.

    ``facts`` are the fluents in bit order; facts that never change are compiled away. ``actions``
    stand in ground-action order: by schema as declared, then by objects as declared. An action
    that would leave the state unchanged is not offered. ``value_sets`` are the values, in bit
    order, of the functions that actions change. Tasks with the same ``structure`` differ in costs
    and in the initial state only, so what was computed for one holds for the others. A task never
    changes; the ``with_…`` methods return others.

    Args:
        problem: The problem.
        deadline: When grounding gives up, as a time of ``time.monotonic()``.
        grounding: The facts and ground actions, if the problem has those of another task.

    Raises:
        UnsupportedError: if an action changes a number that is neither total-cost nor agent state,
            an agent-state function has more than 16 reachable values, or the problem has a
            construct that bits cannot hold (see `hrcplan.pddl.constructs`).
        LimitError: if there are too many ground actions, or at the deadline.

    >>> from hrcplan import ground
    >>> task = ground("transport", "two-boxes")
    >>> [str(task.actions[i]) for i in task.applicable(task.initial)][:2]
    ['(move robot wp0 wp1)', '(move robot wp0 wp2)']
    """

    reached = Renamed("value_sets")

    def __init__(
        self,
        problem: Problem,
        deadline: float = inf,
        *,
        grounding: Grounding | None = None,
        origin: Problem | None = None,
    ) -> None:
        self._origin: Final = problem if origin is None else origin  # with derived predicates
        problem = plain(problem)
        grounding = ground(problem, deadline) if grounding is None else grounding
        self.problem: Final = problem
        self.grounding: Final = grounding
        self.facts: Final[tuple[Fact, ...]] = grounding.facts
        self.bits: Final[Mapping[Fact, int]] = grounding.bits
        self.value_sets: Final[ValueSets] = grounding.value_sets
        self.actions: Final[tuple[GroundAction, ...]] = grounding.actions
        self.structure: Final = grounding.structure
        self.initial: Final[int] = grounding.initial(problem)
        self.goal: Final[tuple[Test, ...]] = grounding.goal(problem)

    @cached_property
    def _index(self) -> ActionIndex:
        return self.grounding.index

    def __repr__(self) -> str:
        problem = self.problem
        name = f"{problem.domain.name}/{problem.name}"
        return f"<Task {cut(name, 100)}: {len(self.facts)} facts, {len(self.actions)} actions>"

    # The ten verbs, over states as integers and actions as indices.

    def applicable(self, state: int) -> list[int]:
        """Return the indices of the actions that can run in ``state`` and change it, in order."""
        indices = self._index.runnable(state)
        if self._index.others:
            indices += [i for i in self._index.others if self.is_applicable(state, i)]
            indices.sort()
        return indices

    def is_applicable(self, state: int, index: int) -> bool:
        """Return whether one action can run in ``state`` and changes it."""
        return meets(state, self.actions[index].tests) and self.successor(state, index) != state

    def successor(self, state: int, index: int) -> int:
        """Return the state after an action, in the sequential reading (its start, then its end)."""
        net = self._index.net_effects[index]
        if net is None:
            return self.actions[index].apply(state)
        deletes = net.deletes
        return (state | deletes) ^ deletes | net.adds

    def start(self, state: int, index: int) -> int:
        """Return the state just after an action has started."""
        return apply(self.actions[index].at_start, state)

    def finish(self, state: int, index: int) -> int:
        """Return the state just after a running action has ended."""
        return apply(self.actions[index].at_end, state)

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
        return self.grounding.state_of(facts)

    def facts_of(self, state: int) -> frozenset[Fact]:
        """Return the fluents that hold in a state."""
        return frozenset(self.facts[position] for position in positions(state))

    @cached_property
    def costs(self) -> tuple[Number, ...]:
        """What each action adds to total-cost; 1 each if the domain counts no total-cost."""
        values, (sums, which) = self.problem.values, self.grounding.costs
        totals = [exact(sum(evaluate(cost, values, {}) for cost in costs)) for costs in sums]
        return tuple([totals[i] for i in which])

    def with_values(self, values: Mapping[FluentKey, Number]) -> Task:
        """Return this task with other function values, grounded again only where that matters.

        Values that only occur in costs (agent state, as a rule) leave facts and actions as they
        are; values in conditions or durations, or of functions that actions change, do not.
        """
        old, problem = self.problem.values, self.problem.with_values(values)
        changes = [key for key, value in values.items() if old.get(key) != value]
        if any(k not in old or k in self.value_sets or k[0] in self._structural for k in changes):
            return Task(problem, origin=self._origin)
        return Task(problem, grounding=self.grounding, origin=self._origin)

    def with_facts(self, facts: Iterable[Fact]) -> Task:
        """Return this task from another initial state, grounded again only if that is needed.

        What is reachable from reachable facts is reachable, so a state that has been reached from
        the initial state keeps the grounding (it may hold more than the new task needs).

        >>> from hrcplan import ground
        >>> task = ground("transport", "two-boxes")
        >>> moved = task.with_facts(task.problem.facts - {("at", "human", "wp1")})
        >>> moved.actions is task.actions, moved.initial == task.initial
        (True, False)
        """
        problem = replace(self.problem, facts=frozenset(facts))
        names = self.bits.keys()
        same = problem.facts - names == self.problem.facts - names
        return Task(problem, grounding=self.grounding if same else None, origin=self._origin)

    def with_goal(self, goal: Formula) -> Task:
        """Return this task with another goal, without grounding again.

        Raises:
            UnsupportedError: if bits cannot hold the goal.
        """
        goal = plain(replace(self._origin, goal=goal)).goal
        problem = replace(self.problem, goal=goal)
        return Task(problem, grounding=self.grounding, origin=self._origin)

    def with_actions(self, actions: tuple[GroundAction, ...], costs: tuple[Number, ...]) -> Task:
        """Return a task that only has some of the actions, at other costs and without a metric.

        ``actions`` are numbered from 0; what costs depended on no longer counts.
        """
        grounding = self.grounding.with_actions(actions, costs)
        problem = replace(self.problem, metric=None)
        return Task(problem, grounding=grounding, origin=self._origin)

    @cached_property
    def _structural(self) -> frozenset[str]:
        """The functions that decide more than costs, those of ``value_sets`` aside."""
        names = {function.name for function in formula_functions(self.problem.goal)}
        for action in self.problem.domain.actions:
            names.update(function.name for function in functions_read(action))
            # A cost that divides by zero is none: the action cannot run.
            names.update(f.name for effect in action.effects for f in divisors(effect.value))
        return frozenset(names)

    @cached_property
    def is_agent_free(self) -> bool:
        """Whether no fact that mentions an agent is ever changed by an action."""
        agents = set(self.problem.agents)
        return not any(agents.intersection(fact) for fact in self.facts)

    def find(self, name: str, args: Sequence[str]) -> list[int]:
        """Return the indices of the actions called ``(name *args)``; one per changing value."""
        return self._by_words.get((name, *args), [])

    @cached_property
    def _by_words(self) -> dict[tuple[str, ...], list[int]]:
        """The indices of the actions of each name and objects."""
        by_words: dict[tuple[str, ...], list[int]] = {}
        for action in self.actions:
            by_words.setdefault((action.name, *action.args), []).append(action.index)
        return by_words
