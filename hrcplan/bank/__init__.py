"""Policy banks: every valid plan of every goal, as graphs that are counted exactly.

The short way: ``build_bank("kitchen")``. A `Bank` has `Goals` (names, task, goal tests), a
`StepTable` (the steps, numbered alike for all goals) and a `PlanGraph` for each goal.
"""

from hrcplan.bank.bank import Bank, BuildOptions
from hrcplan.bank.builder import build, build_bank
from hrcplan.bank.goals import Goals, from_problems
from hrcplan.bank.graph import PlanGraph
from hrcplan.bank.search import BuildLimits
from hrcplan.bank.sources import read_goals
from hrcplan.bank.store import find_fault, load, save
from hrcplan.core.deprecation import warn_old_name
from hrcplan.task.steps import Step, StepTable

__all__ = [
    "Bank",
    "BuildLimits",
    "BuildOptions",
    "Goals",
    "PlanGraph",
    "Step",
    "StepTable",
    "build",
    "build_bank",
    "find_fault",
    "from_problems",
    "load",
    "read_goals",
    "save",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name == "verify":
        warn_old_name("function", "hrcplan.bank.verify", "hrcplan.bank.find_fault")
        return find_fault
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
