"""Planners: adapters, our own exact search, and one checked result type.

``names()`` lists the planners that have a name of their own and ``make(name)`` returns one; see
`hrcplan.planners.contract` for what a planner is asked and what it answers.
"""

from hrcplan.planners.contract import Answer, Capabilities, Planner, Request, Status
from hrcplan.planners.registry import make, names

__all__ = ["Answer", "Capabilities", "Planner", "Request", "Status", "make", "names"]
