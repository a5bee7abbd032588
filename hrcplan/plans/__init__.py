"""Plans, and their texts as people, standards and planners write them."""

from hrcplan.plans.logs import as_plan, find_plans, plans_of_log, read_plan
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
