"""PDDL-first human-robot collaborative planning.

>>> import hrcplan
>>> task = hrcplan.load("transport", "two-boxes")
>>> found = hrcplan.plan("transport", "two-boxes", planner="exact")
>>> found.status.value, found.report.cost, len(found.plan.actions)
('solved-optimally', 24, 8)
>>> hrcplan.validate("transport", "two-boxes", str(found.plan)).valid
True
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from hrcplan.bank import build_bank
    from hrcplan.execution.execute import execute
    from hrcplan.facade import load, plan, validate
    from hrcplan.inference import infer
    from hrcplan.planners.lowering import lower
    from hrcplan.studies import run_study
    from hrcplan.task import Task

__all__ = [
    "Task",
    "build_bank",
    "execute",
    "infer",
    "load",
    "lower",
    "plan",
    "run_study",
    "validate",
]
_HOMES = {
    "Task": "hrcplan.task",
    "build_bank": "hrcplan.bank",
    "execute": "hrcplan.execution.execute",
    "infer": "hrcplan.inference",
    "load": "hrcplan.facade",
    "lower": "hrcplan.planners.lowering",
    "plan": "hrcplan.facade",
    "run_study": "hrcplan.studies",
    "validate": "hrcplan.facade",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that ``import hrcplan`` is cheap."""
    if name not in _HOMES:
        raise AttributeError(f"module 'hrcplan' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names too, although they are imported late."""
    return sorted({*globals(), *__all__})
