"""A bound on the metric from the relaxation in which nothing that is true becomes false.

For the part of the metric that adds up over actions: landmarks found by LM-cut, whose costs never
add up to more than a plan's. For total-time of a temporal plan: the chain of actions that takes
longest, however many run at the same time.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import lcm

from hrcplan.core.numbers import Number, exact
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.constructs import ALL
from hrcplan.pddl.model import TRUE, Domain
from hrcplan.planners.contract import Answer, Capabilities, OwnPlanner, Request, Status
from hrcplan.planners.exact.weights import metric
from hrcplan.planners.lowering import lower
from hrcplan.search.lm_cut import landmarks, longest_chain
from hrcplan.task import Task
from hrcplan.task.steps import Operator
from hrcplan.task.unreachable import is_out_of_reach

MAX_ACTIONS = 20_000


class RelaxedBound(OwnPlanner):
    """Bounds the metric, or proves that there is no plan; it finds none itself."""

    card = Capabilities(
        "lm-cut",
        "bounds the metric from below with landmarks, and finds no plans",
        temporal=True,
        numeric=True,
        metric="none",
        limits=True,
        own=True,
        constructs=ALL,
    )

    def solve(self, request: Request) -> Answer:
        """Return a bound, or that even the relaxed task has no plan.

        Raises:
            LimitError: if there is too little time or memory.
            UnsupportedError: if the metric is not a sum of costs and time, if there are too many
                actions, or if the sequential reading of a temporal task hides what can happen.
        """
        if not request.lazy_task.is_ready or request.problem.domain.is_temporal:
            deadline = time.monotonic() + request.time_left_s / 2
            if is_out_of_reach(request.problem, deadline):
                return Answer(Status.UNSOLVABLE)
        task = request.task
        if len(task.actions) > MAX_ACTIONS:
            raise UnsupportedError(f"more than {MAX_ACTIONS:,} ground actions")
        if not task.problem.domain.is_temporal:
            return _classical(task)
        _check_chains(task.problem.domain)
        return _temporal(task)


def _classical(task: Task) -> Answer:
    lowering = lower(task)
    cost = _least_cost(task, lowering.costs)
    if cost is None:
        return Answer(Status.UNSOLVABLE)
    return Answer(Status.UNSOLVED, note="", bound=lowering.objective(cost))


def _temporal(task: Task) -> Answer:
    objective = metric(task.problem)
    prices = [Fraction(objective.cost * cost) for cost in task.costs]
    if any(price < 0 for price in prices):
        raise UnsupportedError("an action has a negative cost")
    scale = lcm(*(price.denominator for price in prices))
    cost = _least_cost(task, [int(price * scale) for price in prices])
    if cost is None:
        return Answer(Status.UNSOLVABLE)
    bound = Fraction(cost, scale) + objective.time * _least_time(task) + objective.constant
    return Answer(Status.UNSOLVED, bound=exact(bound))


def _check_chains(domain: Domain) -> None:
    """Raise unless whatever an action needs has to be true when it starts.

    Else two actions can make true what the other one needs while both run, and a chain of whole
    actions says nothing.
    """
    for action in domain.actions:
        if any(c.when == "end" and c.formula != TRUE for c in action.conditions):
            raise UnsupportedError(f"'{action.name}' has a condition at its end")
    holds = any(c.when == "all" for action in domain.actions for c in action.conditions)
    early = any(e.when == "start" and e.kind == "add" and action.durative
                for action in domain.actions for e in action.effects)  # fmt: skip
    if holds and early:
        raise UnsupportedError("some action adds at its start what another may need all the time")


def _least_cost(task: Task, costs: Sequence[int]) -> int | None:
    """Return a bound on the sum of the actions' costs; None if the goal is out of reach."""
    ops = [
        Operator(action.tests, action.at_start, action.at_end, action.index, cost)
        for action, cost in zip(task.actions, costs, strict=True)
    ]
    cuts = landmarks(ops, task.initial, task.goal)
    return None if cuts is None else sum(landmark.cost for landmark in cuts)


def _least_time(task: Task) -> Number:
    """Return a bound on the makespan."""
    durations = [Fraction(action.duration or 0) for action in task.actions]
    scale = lcm(*(duration.denominator for duration in durations))
    ops = list(_halves(task, [int(duration * scale) for duration in durations]))
    return Fraction(longest_chain(ops, task.initial, task.goal) or 0, scale)


def _halves(task: Task, ticks: Sequence[int]) -> Iterator[Operator]:
    """Yield what each action does at its start, at once, and at its end, after its duration."""
    for action, length in zip(task.actions, ticks, strict=True):
        if action.at_start:
            yield Operator(action.tests, action.at_start, (), action.index, 0)
        if action.at_end:
            yield Operator(action.tests, (), action.at_end, action.index, length)
