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

from hrcplan.core.numbers import exact
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.constructs import ALL
from hrcplan.pddl.model import TRUE, Domain
from hrcplan.pddl.walks import lifted_names
from hrcplan.planners.contract import Answer, Capabilities, OwnPlanner, Request, Status
from hrcplan.planners.exact.weights import metric
from hrcplan.planners.gains import idle_gain, most_gain
from hrcplan.planners.lowering import prices
from hrcplan.search.lm_cut import landmarks, longest_chain
from hrcplan.task import BitEffect, Task
from hrcplan.task.conditions import all_of
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
                actions, or if an action's start may undo what its end needs.
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
        return _temporal(task)


def _classical(task: Task) -> Answer:
    metric = prices(task)
    idle = idle_gain(task.problem, task.value_sets)
    if idle is not None:
        raise UnsupportedError(f"'{idle.name}' can improve the metric again and again")
    gain = most_gain(task, metric.prices)
    scale = lcm(*(Fraction(price).denominator for price in metric.prices))
    cost = _least_cost(task, [int(max(0, price) * scale) for price in metric.prices])
    if cost is None:
        return Answer(Status.UNSOLVABLE)
    sign = -1 if task.problem.maximize else 1
    bound = sign * (Fraction(cost, scale) - gain) + metric.offset
    return Answer(Status.UNSOLVED, note="", bound=exact(bound))


def _temporal(task: Task) -> Answer:
    if task.problem.maximize:
        raise UnsupportedError("what a plan with durations can gain at most is not bounded")
    objective = metric(task.problem)
    prices = [Fraction(objective.cost * cost) for cost in task.costs]
    if any(price < 0 for price in prices):
        raise UnsupportedError("an action has a negative cost")
    durations = [Fraction(action.duration or 0) for action in task.actions]
    price_scale, time_scale = (lcm(*(x.denominator for x in part)) for part in (prices, durations))
    costs = [int(price * price_scale) for price in prices]
    ticks = [int(duration * time_scale) for duration in durations]
    if _has_chains(task.problem.domain):
        cost = _least_cost(task, costs)
        time_ops = list(_halves(task, ticks))
    else:
        _check_ends(task.problem.domain)
        no_time = [0] * len(costs)
        cost = _sum_of_cuts(task, list(_events(task, costs, no_time)))
        time_ops = list(_events(task, no_time, ticks))
    if cost is None:
        return Answer(Status.UNSOLVABLE)
    chain = longest_chain(time_ops, task.initial, task.goal) or 0
    bound = Fraction(cost, price_scale) + objective.time * Fraction(chain, time_scale)
    return Answer(Status.UNSOLVED, bound=exact(bound + objective.constant))


def _has_chains(domain: Domain) -> bool:
    """Return whether whatever an action needs has to be true when it starts.

    Else two actions can make true what the other one needs while both run, and a chain of whole
    actions says nothing.
    """
    if any(c.when == "end" and c.formula != TRUE for a in domain.actions for c in a.conditions):
        return False
    holds = any(c.when == "all" for action in domain.actions for c in action.conditions)
    early = any(e.when == "start" and e.kind == "add" and action.durative
                for action in domain.actions for e in action.effects)  # fmt: skip
    return not (holds and early)


def _check_ends(domain: Domain) -> None:
    """Raise if the start of an action may undo what it needs at its end.

    Ground tasks leave such actions out, since they can only run where another one helps.
    """
    for action in domain.actions:
        starts = {effect.target.name for effect in action.effects if effect.when == "start"}
        ends = (c.formula for c in action.conditions if c.when == "end")
        if any(not starts.isdisjoint(lifted_names(formula)) for formula in ends):
            raise UnsupportedError(f"the start of '{action.name}' may undo what its end needs")


def _least_cost(task: Task, costs: Sequence[int]) -> int | None:
    """Return a bound on the sum of the actions' costs; None if the goal is out of reach."""
    return _sum_of_cuts(task, [
        Operator(action.tests, action.at_start, action.at_end, action.index, cost)
        for action, cost in zip(task.actions, costs, strict=True)
    ])  # fmt: skip


def _sum_of_cuts(task: Task, ops: Sequence[Operator]) -> int | None:
    cuts = landmarks(ops, task.initial, task.goal)
    return None if cuts is None else sum(landmark.cost for landmark in cuts)


def _halves(task: Task, ticks: Sequence[int]) -> Iterator[Operator]:
    """Yield what each action does at its start, at once, and at its end, after its duration."""
    for action, length in zip(task.actions, ticks, strict=True):
        if action.at_start:
            yield Operator(action.tests, action.at_start, (), action.index, 0)
        if action.at_end:
            yield Operator(action.tests, (), action.at_end, action.index, length)


def _events(task: Task, costs: Sequence[int], ticks: Sequence[int]) -> Iterator[Operator]:
    """Yield three operators for each action: its start, its duration, and its end.

    What it needs while it runs is only asked for at its end, so that it may come of actions that
    run at the same time. Two facts more for each action say that it has started and lasted.
    """
    for action, cost, length in zip(task.actions, costs, ticks, strict=True):
        started = 1 << len(task.facts) + 2 * action.index
        lasted = started << 1
        start = (*action.at_start, BitEffect(started, 0))
        yield Operator(action.start, start, (), action.index, cost)
        yield Operator(((started, started),), (BitEffect(lasted, 0),), (), action.index, length)
        tests = all_of([((lasted, lasted),), action.over, action.end])
        yield Operator(tests, (), action.at_end, action.index, 0)
