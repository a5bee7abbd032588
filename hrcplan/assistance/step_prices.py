"""What a step costs in whose hands, with the present agent state: one scale for cost and help.

A price is the PDDL cost of an action with the function values that planners get, over its cost with
low values. A profile turns a probability of failure into a cost, so a price counts expected
retries. It is 1 where no agent state has changed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from hrcplan.agents import AgentModel
from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.core.numbers import Number
from hrcplan.pddl.conventions import people
from hrcplan.pddl.model import TOTAL_COST, FluentKey
from hrcplan.pddl.semantics import Undefined, evaluate

GRID = 2.0  # prices are powers of it, so that a slight change of an estimate changes nothing
Changes = tuple[tuple[FluentKey, Number], ...]


@dataclass(frozen=True, eq=False)
class StepPrices:
    """The price of each step of a bank, in the hands of a person and of a robot.

    ``human`` and ``robot`` have one number per step: that of the cheapest agent, infinite if no
    agent of this kind does the step. ``changes`` are the elements that are not low.
    """

    human: Floats
    robot: Floats
    changes: Changes = ()

    @property
    def extra(self) -> Floats:
        """How much more than 1 each step costs its cheapest agent."""
        extra: Floats = np.minimum(self.human, self.robot) - 1
        return extra


@dataclass
class PriceModel:
    """Prices steps of one bank; remembers them by the agent state.

    >>> from hrcplan import build_bank
    >>> model = PriceModel(build_bank("kitchen", only=["pasta-bean"]))
    >>> prices = model.prices({("motivation", "human"): 4})
    >>> float(prices.robot[0]), float(prices.human[0]) > 1.5
    (1.0, True)
    """

    bank: Bank
    _prices: dict[Changes, StepPrices] = field(default_factory=dict)
    _low_costs: dict[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Look up which actions belong to whom, and what their cost depends on."""
        problem, actions = self.bank.goals.problem, self.bank.table.task.actions
        self.problem, self.agents = problem, AgentModel(problem)
        humans = people(problem)
        self._is_human = [action.agent in humans for action in actions]
        self._touching: dict[FluentKey, list[int]] = {}
        for index, action in enumerate(actions):
            for key in self.agents.touching(action.name, action.args):
                self._touching.setdefault(key, []).append(index)

    def prices(self, values: Mapping[FluentKey, Number]) -> StepPrices:
        """Return the prices of the steps.

        Args:
            values: Function values as planners get them; those that are missing are low.
        """
        low = self.agents.low
        changes = tuple(sorted((k, v) for k, v in values.items() if k in low and v != low[k]))
        prices = self._prices.get(changes)
        if prices is None:
            prices = self._prices[changes] = self._of(changes)
        return prices

    def _of(self, changes: Changes) -> StepPrices:
        task, table = self.bank.table.task, self.bank.table
        by_action = np.ones(len(task.actions))
        for index in {i for key, _ in changes for i in self._touching.get(key, ())}:
            by_action[index] = self._price(index, dict(changes))
        hands = np.full((2, len(table)), math.inf)
        for index, step in enumerate(table.of_action):
            doers = (0,) if self._is_human[index] else (1,)
            for hand in (0, 1) if task.actions[index].agent is None else doers:
                hands[hand, step] = min(hands[hand, step], by_action[index])
        return StepPrices(hands[0], hands[1], changes)

    def _price(self, index: int, changes: Mapping[FluentKey, Number]) -> float:
        if index not in self._low_costs:
            self._low_costs[index] = self._cost(index, {})
        low = self._low_costs[index]
        ratio = 1 + (self._cost(index, changes) - low) / max(low, 1.0)
        return float(GRID ** round(math.log(max(ratio, 0.1), GRID)))

    def _cost(self, index: int, changes: Mapping[FluentKey, Number]) -> float:
        action = self.bank.table.task.actions[index]
        return action_cost(self.agents, (action.name, *action.args), changes)

    def failure(self, words: tuple[str, ...], risks: Mapping[FluentKey, float]) -> float:
        """Return how likely a ground action fails, from the risks of its elements."""
        return 1 - math.prod(1 - p for p in self._risks(words, risks))

    def _risks(self, words: tuple[str, ...], risks: Mapping[FluentKey, float]) -> Iterable[float]:
        return (risks.get(key, 0.0) for key in self.agents.touching(words[0], words[1:]))


def action_cost(
    agents: AgentModel, words: tuple[str, ...], changes: Mapping[FluentKey, Number]
) -> float:
    """Return what a ground action adds to the total cost; 0 if its cost has no value.

    Args:
        agents: The agent state of its problem.
        words: Its name and objects.
        changes: Function values in place of those of the problem.
    """
    schema = agents.problem.domain.action(words[0])
    binding = {param.name: arg for param, arg in zip(schema.params, words[1:], strict=True)}
    values = {**agents.problem.values, **changes}
    try:
        return float(sum(
            evaluate(effect.value, values, binding)
            for effect in schema.effects
            if effect.target.name == TOTAL_COST and effect.value is not None
        ))  # fmt: skip
    except Undefined:
        return 0.0
