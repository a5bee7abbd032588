"""What people do, without who does it: the steps of a task, numbered once for all goals."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from math import lcm

from hrcplan.core.numbers import Number, exact
from hrcplan.core.records import record
from hrcplan.errors import UnsupportedError
from hrcplan.task import GroundAction, Task
from hrcplan.task.transitions import Rule, Transition

STEPS = "steps"
TASK = "task"
COSTS = (STEPS, TASK)
TIE_BITS = 20
"""Bits that count steps below a cost, where zero-cost steps make their number matter."""
MAX_TIES = (1 << TIE_BITS) - 1

_NEVER = Rule(mask=0, value=1, writes=0, adds=0)


@record
class Step:
    """One step: what it is called and which ground actions of the task do it.

    ``words`` is ``(name, *objects)``; the agent is left out where agents are dropped. ``name`` is
    always without the agent, so that steps that differ only in who acts share it.
    """

    index: int
    words: tuple[str, ...]
    name: tuple[str, ...]
    actions: tuple[int, ...]

    def __str__(self) -> str:
        return f"({' '.join(self.words)})"


@record
class Operator(Transition):
    """One way to do a step, and its bank cost (a positive integer)."""

    step: int
    cost: int


class StepTable:
    """The steps of a task in ground-action order, and the step of every ground action.

    Agents are dropped if no fact that mentions an agent is ever changed, and a step has the same
    effects for every agent; then a step exists if some agent can do it, and costs what it costs
    the cheapest. Otherwise agents are kept: a step is a ground action.

    Args:
        task: The task; its goal does not matter.
        cost: ``steps``: one per step; ``task``: what the task says.

    Raises:
        UnsupportedError: if a cost is negative, or there is no such bank cost.

    >>> from hrcplan import ground
    >>> table = StepTable(ground("kitchen", "pasta-bean"))
    >>> table.agents, str(table[0]), len(table[0].actions)
    ('dropped', '(get pasta)', 2)
    """

    def __init__(self, task: Task, cost: str = STEPS) -> None:
        if cost not in COSTS:
            raise UnsupportedError(f"there is no bank cost '{cost}'", hint="steps or task")
        self.task = task
        self.cost = cost
        self.agents = "dropped" if _can_drop(task) else "kept"
        groups: dict[tuple[str, ...], list[int]] = {}
        for action in task.actions:
            groups.setdefault(self._words(action), []).append(action.index)
        self._steps = tuple(
            Step(i, words, task.actions[members[0]].step, tuple(members))
            for i, (words, members) in enumerate(groups.items())
        )
        self._index = {step.words: step.index for step in self._steps}
        self.of_action: tuple[int, ...] = tuple(self._index[self._words(a)] for a in task.actions)
        labels: dict[tuple[str, ...], int] = {}
        self.labels: tuple[int, ...] = tuple(
            labels.setdefault(step.name, len(labels)) for step in self._steps
        )
        self.n_labels = len(labels)
        self._rules: dict[frozenset[str], list[Rule | None]] = {}

    def __repr__(self) -> str:
        return f"<StepTable: {len(self)} steps, agents {self.agents}, cost {self.cost}>"

    def _words(self, action: GroundAction) -> tuple[str, ...]:
        return action.step if self.agents == "dropped" else (action.name, *action.args)

    def __len__(self) -> int:
        return len(self._steps)

    def __getitem__(self, index: int) -> Step:
        return self._steps[index]

    def find(self, words: Sequence[str]) -> int | None:
        """Return the step called ``(name, *objects)``, with its agent or without; None if none is.

        Where agents are kept, words without an agent name no step.
        """
        step = self._index.get(tuple(words))
        if step is None:
            actions = self.task.find(words[0], words[1:]) if words else []
            return self.of_action[actions[0]] if actions else None
        return step

    def applicable(self, state: int) -> list[int]:
        """Return the steps that some agent can do in ``state`` and that change it, in order."""
        return sorted({self.of_action[i] for i in self.task.applicable(state)})

    def successor(self, state: int, step: int) -> int | None:
        """Return the state after a step, or None if no agent can do it in ``state``.

        A step that changes nothing leaves the state as it is.
        """
        rule = self._by_anyone[step]
        if rule is not None:
            return rule.apply(state) if state & rule.mask == rule.value else None
        for index in self._steps[step].actions:
            if self.task.actions[index].is_enabled(state):
                return self.task.successor(state, index)
        return None

    def doer(self, state: int, step: int, agents: Set[str]) -> int | None:
        """Return a ground action by which one of ``agents`` can do a step in ``state``.

        It is the first that changes the state; None if there is none. Any agent can do
        what names none.
        """
        task = self.task
        for index in self._steps[step].actions:
            agent = task.actions[index].agent
            if (agent is None or agent in agents) and task.is_applicable(state, index):
                return index
        return None

    def able(self, state: int, steps: Iterable[int], agents: Set[str]) -> Iterator[int]:
        """Yield those of several steps that one of ``agents`` can do in ``state``, in order.

        It is what ``doer`` says of each, and quicker.
        """
        rules = self.rules_of(agents)
        for step in steps:
            rule = rules[step]
            if rule is None:
                if self.doer(state, step, agents) is not None:
                    yield step
                continue
            mask, value, writes, adds = rule
            if state & mask == value and state & writes != adds:
                yield step

    def rules_of(self, agents: Set[str]) -> Sequence[Rule | None]:
        """Return for each step the rule by which agents can do it.

        It is None if one rule does not say it all, and one that never holds if they cannot.
        """
        key = frozenset(agents)
        rules = self._rules.get(key)
        if rules is None:
            rules = self._rules[key] = [self._rule(step, key) for step in self._steps]
        return rules

    def _rule(self, step: Step, agents: Set[str]) -> Rule | None:
        """Return the rule by which agents can do a step; None if one rule does not say it all."""
        actions = [self.task.actions[index] for index in step.actions]
        return _one_rule(a for a in actions if a.agent is None or a.agent in agents)

    @cached_property
    def _by_anyone(self) -> list[Rule | None]:
        """For each step the rule that says the same as all its actions, if there is one."""
        return [_one_rule(self.task.actions[i] for i in step.actions) for step in self._steps]

    @cached_property
    def _prices(self) -> tuple[list[int], int]:
        """Integer prices of ground actions and how many make one unit of bank cost.

        Where something costs nothing, plans are ordered by cost and then by steps.
        """
        if self.cost == STEPS:
            return [1] * len(self.task.actions), 1
        costs = [Fraction(cost) for cost in self.task.costs]
        if any(cost < 0 for cost in costs):
            raise UnsupportedError(
                "a bank needs costs that are not negative", hint="--bank-cost steps"
            )
        scale = lcm(*(cost.denominator for cost in costs))
        whole = [int(cost * scale) for cost in costs]
        if all(whole):
            return whole, scale
        return [(cost << TIE_BITS) + 1 for cost in whole], scale << TIE_BITS

    def price(self, action: int) -> int:
        """Return the integer price of a ground action of the task."""
        return self._prices[0][action]

    def ways(self, step: int) -> list[Operator]:
        """Return the ways to do a step, the cheapest first."""
        return self._ways[step]

    @cached_property
    def _ways(self) -> list[list[Operator]]:
        ways: list[list[Operator]] = [[] for _ in self._steps]
        for op in sorted(self.ops, key=lambda op: op.cost):
            ways[op.step].append(op)
        return ways

    def in_units(self, price: int) -> Number:
        """Return an integer price as bank cost."""
        unit = self._prices[1]
        if unit >= 1 << TIE_BITS:
            price, unit = price >> TIE_BITS, unit >> TIE_BITS
        return exact(Fraction(price, unit))

    def bound(self, price: int, quality: Fraction) -> tuple[int, int]:
        """Return the largest price within ``quality`` times ``price``, and the most steps.

        The steps are limited only where some cost nothing, and then by the same factor.
        """
        if self._prices[1] < 1 << TIE_BITS:
            return int(price * quality), MAX_TIES
        cost, steps = price >> TIE_BITS, price & MAX_TIES
        return (int(cost * quality) << TIE_BITS) + MAX_TIES, int(steps * quality)

    @cached_property
    def ops(self) -> tuple[Operator, ...]:
        """The ways to do the steps, by step; the cheapest where they differ in nothing else."""
        prices, _ = self._prices
        price_of: dict[Operator, int] = {}
        for action in self.task.actions:
            step, price = self.of_action[action.index], prices[action.index]
            way = Operator(action.tests, *action.sequential, step=step, cost=0)
            price_of[way] = min(price, price_of.get(way, price))
        ops = [replace(way, cost=price) for way, price in price_of.items()]
        return tuple(sorted(ops, key=lambda op: op.step))


def _one_rule(actions: Iterable[GroundAction]) -> Rule | None:
    """Return the rule that says the same as all the actions; None if there is no such rule."""
    rules: set[Rule] = set()
    for action in actions:
        if action.rules is None:
            return None
        rules.update(action.rules)
    return None if len(rules) > 1 else rules.pop() if rules else _NEVER


def _can_drop(task: Task) -> bool:
    if not task.is_agent_free:
        return False
    effects: dict[tuple[str, ...], object] = {}
    return all(
        effects.setdefault(action.step, action.sequential) == action.sequential
        for action in task.actions
    )
