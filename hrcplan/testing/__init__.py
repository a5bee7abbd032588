"""Laws that every part of a kind must keep, as functions: call them in your own tests.

Each function raises an AssertionError that names the broken law.
"""

from hrcplan.testing.beliefs import check_assistant, check_belief
from hrcplan.testing.episodes import check_human, check_world
from hrcplan.testing.event_worlds import check_event_world
from hrcplan.testing.links import check_link
from hrcplan.testing.natures import check_nature
from hrcplan.testing.planners import check_plan, check_planner
from hrcplan.testing.studies import check_study

__all__ = [
    "check_assistant",
    "check_belief",
    "check_event_world",
    "check_human",
    "check_link",
    "check_nature",
    "check_plan",
    "check_planner",
    "check_study",
    "check_world",
]
