"""The worlds of event-driven execution by name."""

from __future__ import annotations

from hrcplan.core.registry import Registry
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.worlds import EventWorld
from hrcplan.execution.worlds.simulated import Nature

SIMULATED = "simulated"
ROBOT = "robot"  # what a journal says of a run that a link carried out; a link is no part by name

EVENT_WORLDS: Registry[[ExecutionModel, Nature], EventWorld] = Registry(
    "event-world",
    {SIMULATED: "hrcplan.execution.worlds.simulated:SimulatedWorld"},
    "hrcplan.event_worlds",
    EventWorld,
)
