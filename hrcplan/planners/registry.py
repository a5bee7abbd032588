"""Planners by name: built-in, installed, ``up:NAME``, ``cmd:PROGRAM …``, or ``module:Class``."""

from __future__ import annotations

from hrcplan.core.registry import Registry
from hrcplan.errors import MissingPlannerError
from hrcplan.planners.contract import Planner

GROUP = "hrcplan.planners"
BUILT_IN = {
    "fast-downward": "hrcplan.planners.fast_downward:FastDownward",
    "exact": "hrcplan.planners.exact:ExactPlanner",
    "kairos": "hrcplan.planners.kairos:Kairos",
    "enhsp": "hrcplan.planners.enhsp:Enhsp",
    "uniform-cost": "hrcplan.planners.uniform_cost:UniformCost",
}
PLANNERS: Registry[[], Planner] = Registry(
    "planner",
    BUILT_IN,
    GROUP,
    Planner,
    prefixes={
        "up": "hrcplan.planners.up:UnifiedPlanning",
        "cmd": "hrcplan.planners.command:CommandPlanner",
    },
    program_prefixes=frozenset({"cmd"}),
    load_error=MissingPlannerError,
)


def names() -> tuple[str, ...]:
    """Return the planners that have a name of their own: built-in ones first, then installed."""
    return tuple(PLANNERS.names())


def make(name: str) -> Planner:
    """Return the planner called ``name``.

    Raises:
        UsageError: if there is no such planner.
        MissingPlannerError: if a built-in or installed one cannot be imported.

    >>> make("kairos").card.name
    'kairos'
    """
    return PLANNERS.make(name)
