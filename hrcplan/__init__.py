"""PDDL-first human-robot collaborative planning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from hrcplan.facade import load
    from hrcplan.task import Task

_HOMES = {"load": "hrcplan.facade", "Task": "hrcplan.task"}
__all__ = ["Task", "load"]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that ``import hrcplan`` is cheap."""
    if name not in _HOMES:
        raise AttributeError(f"module 'hrcplan' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)
