"""A grounded task: facts and ground actions as bit positions, states as integers."""

from hrcplan.task.actions import BitEffect, GroundAction
from hrcplan.task.task import Task

__all__ = ["BitEffect", "GroundAction", "Task"]
