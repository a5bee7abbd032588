"""What actions of a task cost and last while every agent state is low."""

from __future__ import annotations

from statistics import fmean

from hrcplan.bank import Bank
from hrcplan.execution.action_model import UNIT_S
from hrcplan.planners.exact.weights import metric
from hrcplan.planners.lanes import shortest_duration
from hrcplan.task import GroundAction


class TaskPrices:
    """The costs and durations of the ground actions of a bank, and the metric of its problem.

    Attributes:
        costs: The cost of each action, by its name and objects.
        durations_s: How long each action lasts.
        mean_cost: That of an average action.
        mean_duration_s: How long an average action lasts; a step without duration lasts 1.

    Raises:
        UnsupportedError: if the metric is no sum of cost and time.
    """

    def __init__(self, bank: Bank) -> None:
        task = bank.table.task
        self._problem = bank.goals.problem
        self.costs = {
            (action.name, *action.args): float(cost)
            for action, cost in zip(task.actions, task.costs, strict=True)
        }
        self.mean_cost = fmean(self.costs.values())
        self.durations_s = {
            (action.name, *action.args): self._duration_s(action) for action in task.actions
        }
        self.mean_duration_s = fmean(self.durations_s.values())
        self._metric = metric(self._problem)

    def _duration_s(self, action: GroundAction) -> float:
        schema = self._problem.domain.action(action.name)
        if not schema.durative:
            return float(UNIT_S)
        binding = {param.name: arg for param, arg in zip(schema.params, action.args, strict=True)}
        return float(shortest_duration(self._problem, schema, binding))

    def total(self, cost: float, makespan_s: float) -> float:
        """Return the problem's metric of a cost and a makespan."""
        return float(self._metric.cost) * cost + float(self._metric.time) * makespan_s
