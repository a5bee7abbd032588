"""Event-driven execution: a plan is carried out in continuous time, and replanned if needed.

Parts, from the outside to the inside:

* ``execute.py``: `execute` carries one problem out and returns an `Execution`; its ``outcome`` is
  an `Outcome`, its ``timeline`` holds every action, plan and message.
* ``simulate.py``: `simulate` returns the `Outcome` of one `Spec`, as studies need it. An `Engine`
  (monitor and planner) serves many runs.
* ``driver.py``: the loop between monitor, world, planner and journal.
* ``monitor.py``: the pure state machine, ``step(run, event) -> (run, commands)``.

What you can implement yourself:

* A world: `EventWorld` with ``begin()``, ``do(command)`` and ``next()``. It is made from an
  `ExecutionModel` and a `Nature`, and named in ``worlds.registry.EVENT_WORLDS`` (entry-point group
  ``hrcplan.event_worlds``) or as ``module:Class`` (``--world``).
* A human: a class with ``nature(problem, seed) -> Nature`` (`NatureSource`), named in
  ``natures.NATURES`` (group ``hrcplan.natures``) or as ``module:Class`` (``--human``).
* A planner: see `hrcplan.planners`. A `PlanProvider` answers requests for plans in its place.

Turn-taking episodes are another engine: see `hrcplan.episodes`.
"""

from hrcplan.execution.driver import PlanProvider
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.natures import NatureSource
from hrcplan.execution.outcome import MEASURES, Outcome, means
from hrcplan.execution.simulate import Engine, Spec, engine_for, simulate
from hrcplan.execution.worlds import EventWorld
from hrcplan.execution.worlds.simulated import FactChange, Nature, StateChange

__all__ = [
    "MEASURES",
    "Engine",
    "EventWorld",
    "ExecutionModel",
    "FactChange",
    "Nature",
    "NatureSource",
    "Outcome",
    "PlanProvider",
    "Spec",
    "StateChange",
    "engine_for",
    "means",
    "simulate",
]
