"""A metric as whole numbers: rationals are scaled, so that the search compares exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import lcm

from hrcplan.core.numbers import Number, number_text
from hrcplan.core.records import record
from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import TOTAL_COST, TOTAL_TIME, Arithmetic, Constant, Expr, Function, Problem
from hrcplan.planners.exact.frame import HINT, StaticMasks
from hrcplan.task import Task
from hrcplan.task.numbers import linear

_GRAIN = 64  # makes whole numbers fine enough to be shared out


@record
class Metric:
    """``cost`` times total-cost plus ``time`` times total-time plus ``constant``."""

    cost: Number
    time: Number
    constant: Number


def metric(problem: Problem) -> Metric:
    """Return the metric of a temporal problem; the makespan if it has none.

    Raises:
        UnsupportedError: if it is not a non-negative sum of total-cost and total-time.
    """
    if problem.metric is None:
        return Metric(0, 1, 0)
    sums = linear(_with_constants(problem.metric, problem), {})
    if problem.maximize or sums is None:
        raise UnsupportedError("the metric is not a sum of cost and time to minimize", hint=HINT)
    cost, time = sums.get((TOTAL_COST,), 0), sums.get((TOTAL_TIME,), 0)
    if cost < 0 or time < 0:
        raise UnsupportedError("the metric rewards cost or time", hint=HINT)
    before = problem.values.get((TOTAL_COST,), 0)
    return Metric(cost, time, sums.get((), 0) + cost * before)


def _with_constants(expression: Expr, problem: Problem) -> Expr:
    """Return a metric with the value of every function put in that no action changes."""
    match expression:
        case Constant():
            return expression
        case Function(name, args):
            if name in (TOTAL_COST, TOTAL_TIME):
                return expression
            value = problem.values.get((name, *args))
            if value is None or name in problem.domain.changed_functions:
                message = f"the metric looks at {expression}, which is no constant"
                raise UnsupportedError(message, hint=HINT)
            return Constant(value)
        case Arithmetic(op, parts):
            return Arithmetic(op, tuple(_with_constants(part, problem) for part in parts))


@record
class Weights:
    """The metric in whole numbers: ``cost`` of each action, ``tick`` of each tick that passes.

    In every tick some agent is busy: if each agent gets a share of ``tick``, the shares
    of all busy agents are at most what the time costs. ``share`` is the sum over the agents that an
    action keeps busy, and ``work`` what the action adds at least: its cost and its time's share.
    ``ticks`` is what an action lasts, ``n_lanes`` how many agents it keeps busy, and ``busy`` the
    product of both. ``scale`` is what the metric was multiplied with.
    """

    cost: tuple[int, ...]
    tick: int
    share: tuple[int, ...]
    work: tuple[int, ...]
    ticks: tuple[int, ...]
    n_lanes: tuple[int, ...]
    busy: tuple[int, ...]
    n_agents: int
    scale: int


def weights(
    task: Task, objective: Metric, frame: StaticMasks, lanes: Sequence[Sequence[str]]
) -> Weights:
    """Return the weights of a task's actions under its present costs.

    Raises:
        UnsupportedError: naming the first action with a negative cost.
    """
    for action, price in zip(task.actions, task.costs, strict=True):
        if price < 0:
            raise UnsupportedError(f"{action} costs {number_text(price)}", hint=HINT)
    prices = [objective.cost * price for price in task.costs]
    tick = objective.time * frame.tick_s
    scale = _GRAIN * lcm(tick.denominator, *{price.denominator for price in prices})
    costs = tuple(int(price * scale) for price in prices)
    whole = int(tick * scale)
    parts = shares(whole, _rates(frame, costs))
    share = tuple(sum(parts[agent] for agent in agents) for agents in lanes)
    work = tuple(c + s * t for c, s, t in zip(costs, share, frame.ticks, strict=True))
    n_lanes = tuple(len(agents) for agents in lanes)
    busy = tuple(n * t for n, t in zip(n_lanes, frame.ticks, strict=True))
    n_agents = max(1, len(set(frame.agents)))
    return Weights(costs, whole, share, work, frame.ticks, n_lanes, busy, n_agents, scale)


def _rates(frame: StaticMasks, costs: Sequence[int]) -> dict[str, int]:
    """Return what an agent's actions cost per tick, on average."""
    total: dict[str, list[int]] = {}
    for agent, cost, ticks in zip(frame.agents, costs, frame.ticks, strict=True):
        sums = total.setdefault(agent, [0, 0])
        sums[0] += cost
        sums[1] += ticks
    return {agent: cost // ticks for agent, (cost, ticks) in total.items()}


def shares(whole: int, rates: Mapping[str, int]) -> dict[str, int]:
    """Return how to share out ``whole``: to the cheapest agents, until they cost the same.

    Any shares that add up to no more than ``whole`` give a bound; a good one leaves no agent that
    looks cheap because others are busy, too.

    >>> shares(10, {"human": 7, "robot": 3})
    {'human': 3, 'robot': 7}
    """
    order = sorted(rates.values())
    for n in range(len(order), 0, -1):
        level = (whole + sum(order[:n])) // n
        if level >= order[n - 1]:
            return {agent: max(0, level - rate) for agent, rate in rates.items()}
    return {}
