"""PDDL-first human-robot collaborative planning.

Every function takes objects, or the names, paths and PDDL texts that they are read from.

>>> import hrcplan
>>> problem = hrcplan.read("transport", "two-boxes")
>>> result = hrcplan.plan(problem, planner="exact")
>>> result.status.value, result.report.cost, len(result.plan.actions)
('solved-optimally', 24, 8)
>>> hrcplan.validate(problem, result.plan).valid
True
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "0.2.0"

if TYPE_CHECKING:
    from hrcplan import environments as environments
    from hrcplan import planners as planners
    from hrcplan.assistance import ASSISTANTS as assistants  # noqa: N811
    from hrcplan.assistance import Assistant, BeliefAssistant, StepChoice
    from hrcplan.bank import Bank, build_bank
    from hrcplan.bank import load as load_bank
    from hrcplan.collaboration.collaborate import collaborate
    from hrcplan.episodes.episode import TurnWorld, play
    from hrcplan.episodes.humans import HUMANS as humans  # noqa: N811
    from hrcplan.episodes.humans import Course, EpisodeHuman
    from hrcplan.episodes.worlds import WORLDS as worlds  # noqa: N811
    from hrcplan.errors import (
        CostGuardError,
        Diagnostic,
        HrcplanError,
        InputError,
        LimitError,
        MissingPlannerError,
        PddlError,
        PlanFormatError,
        PlannerError,
        UnsupportedError,
        UsageError,
    )
    from hrcplan.execution import FactChange, Nature, NatureSource, Outcome, StateChange
    from hrcplan.execution.execute import execute
    from hrcplan.execution.links import LINKS as links  # noqa: N811
    from hrcplan.execution.links import RobotLink as RobotLink
    from hrcplan.execution.natures import NATURES as natures  # noqa: N811
    from hrcplan.execution.worlds import EventWorld
    from hrcplan.execution.worlds.registry import EVENT_WORLDS as event_worlds  # noqa: N811
    from hrcplan.inference import Belief, Inference, infer
    from hrcplan.inference.registry import METHODS as beliefs  # noqa: N811
    from hrcplan.pddl.inputs import read
    from hrcplan.pddl.model import Domain, Problem
    from hrcplan.planners.contract import Answer, Capabilities, Planner, Request, Status
    from hrcplan.planners.from_up import from_up
    from hrcplan.planners.plan import plan
    from hrcplan.planners.solve import Result
    from hrcplan.planners.up import to_up
    from hrcplan.plans import Plan, PlannedAction
    from hrcplan.studies import run_study
    from hrcplan.task import Task
    from hrcplan.task.batch import BatchSimulator
    from hrcplan.task.ground import ground
    from hrcplan.validation import Report, validate

__all__ = [
    "Answer",
    "Assistant",
    "Bank",
    "BatchSimulator",
    "Belief",
    "BeliefAssistant",
    "Capabilities",
    "CostGuardError",
    "Course",
    "Diagnostic",
    "Domain",
    "EpisodeHuman",
    "EventWorld",
    "FactChange",
    "HrcplanError",
    "Inference",
    "InputError",
    "LimitError",
    "MissingPlannerError",
    "Nature",
    "NatureSource",
    "Outcome",
    "PddlError",
    "Plan",
    "PlanFormatError",
    "PlannedAction",
    "Planner",
    "PlannerError",
    "Problem",
    "Report",
    "Request",
    "Result",
    "RobotLink",
    "StateChange",
    "Status",
    "StepChoice",
    "Task",
    "TurnWorld",
    "UnsupportedError",
    "UsageError",
    "assistants",
    "beliefs",
    "build_bank",
    "collaborate",
    "environments",
    "event_worlds",
    "execute",
    "from_up",
    "ground",
    "humans",
    "infer",
    "links",
    "load_bank",
    "natures",
    "plan",
    "planners",
    "play",
    "read",
    "run_study",
    "to_up",
    "validate",
    "worlds",
]
# Where each name lives: "name=attribute" if it has another name there, "name=" for the module.
_HOMES = {
    "hrcplan.assistance": ("Assistant", "BeliefAssistant", "StepChoice", "assistants=ASSISTANTS"),
    "hrcplan.bank": ("Bank", "build_bank", "load_bank=load"),
    "hrcplan.collaboration.collaborate": ("collaborate",),
    "hrcplan.environments": ("environments=",),
    "hrcplan.episodes.episode": ("TurnWorld", "play"),
    "hrcplan.episodes.humans": ("Course", "EpisodeHuman", "humans=HUMANS"),
    "hrcplan.errors": (
        "CostGuardError", "Diagnostic", "HrcplanError", "InputError", "LimitError",
        "MissingPlannerError", "PddlError", "PlanFormatError", "PlannerError", "UnsupportedError",
        "UsageError",
    ),
    "hrcplan.execution": ("FactChange", "Nature", "NatureSource", "Outcome", "StateChange"),
    "hrcplan.execution.execute": ("execute",),
    "hrcplan.execution.natures": ("natures=NATURES",),
    "hrcplan.episodes.worlds": ("worlds=WORLDS",),
    "hrcplan.execution.worlds": ("EventWorld",),
    "hrcplan.execution.links": ("RobotLink", "links=LINKS"),
    "hrcplan.execution.worlds.registry": ("event_worlds=EVENT_WORLDS",),
    "hrcplan.inference": ("Belief", "Inference", "infer"),
    "hrcplan.inference.registry": ("beliefs=METHODS",),
    "hrcplan.pddl.inputs": ("read",),
    "hrcplan.pddl.model": ("Domain", "Problem"),
    "hrcplan.planners": ("planners=",),
    "hrcplan.planners.contract": ("Answer", "Capabilities", "Planner", "Request", "Status"),
    "hrcplan.planners.from_up": ("from_up",),
    "hrcplan.planners.plan": ("plan",),
    "hrcplan.planners.solve": ("Result",),
    "hrcplan.planners.up": ("to_up",),
    "hrcplan.plans": ("Plan", "PlannedAction"),
    "hrcplan.studies": ("run_study",),
    "hrcplan.task": ("Task",),
    "hrcplan.task.batch": ("BatchSimulator",),
    "hrcplan.task.ground": ("ground",),
    "hrcplan.validation": ("Report", "validate"),
}  # fmt: skip
_PUBLIC = {
    name: (module, attribute if equals else name)
    for module, entries in _HOMES.items()
    for name, equals, attribute in (entry.partition("=") for entry in entries)
}
_DEPRECATED = {
    "load": ("hrcplan.task.ground", "ground", "hrcplan.ground"),
    "lower": ("hrcplan.planners.lowering", "lower", "hrcplan.planners.lowering.lower"),
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that ``import hrcplan`` is cheap."""
    from importlib import import_module

    from hrcplan.core.garbage import no_garbage_search

    if name in _PUBLIC:
        module, attribute = _PUBLIC[name]
        with no_garbage_search():  # modules make none; the search would be a tenth of the import
            home = import_module(module)
        return getattr(home, attribute) if attribute else home
    if name in _DEPRECATED:
        import warnings

        module, attribute, successor = _DEPRECATED[name]
        message = f"hrcplan.{name} is deprecated; use {successor}"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return getattr(import_module(module), attribute)
    raise AttributeError(f"module 'hrcplan' has no attribute '{name}'")


def __dir__() -> list[str]:
    """Return the public names too, although they are imported late."""
    return sorted({*globals(), *__all__})
