"""A grounded task: facts and ground actions as bit positions, states as integers."""

from hrcplan.task.actions import GroundAction
from hrcplan.task.task import Task
from hrcplan.task.transitions import BitEffect

__all__ = ["BitEffect", "GroundAction", "Task"]
