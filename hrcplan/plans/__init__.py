"""Plans, and their texts as people, standards and planners write them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from hrcplan.plans.model import (
    EPSILON_S,
    Plan,
    PlannedAction,
    format_plan,
    format_plansys2,
    lane,
    occupied,
    seconds_text,
)

if TYPE_CHECKING:
    from hrcplan.plans.logs import as_plan, find_plans, plans_of_log, read_plan
    from hrcplan.plans.text import parse_plan

__all__ = [
    "EPSILON_S",
    "Plan",
    "PlannedAction",
    "as_plan",
    "find_plans",
    "format_plan",
    "format_plansys2",
    "lane",
    "occupied",
    "parse_plan",
    "plans_of_log",
    "read_plan",
    "seconds_text",
]
_READERS = {
    "parse_plan": "hrcplan.plans.text",
    **dict.fromkeys(("as_plan", "find_plans", "plans_of_log", "read_plan"), "hrcplan.plans.logs"),
}


def __getattr__(name: str) -> Any:
    """Import what reads texts when it is first asked for: most plans come as objects."""
    if name in _READERS:
        return getattr(import_module(_READERS[name]), name)
    raise AttributeError(f"module 'hrcplan.plans' has no attribute '{name}'")
