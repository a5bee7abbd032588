"""Which methods there are, by name; each is a class that makes a belief from a bank or goals."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from hrcplan.errors import UsageError
from hrcplan.pddl.source import nearest

BANK_METHOD, GOALS_METHOD = "switching", "cost"
GROUP = "hrcplan.beliefs"
METHODS = {
    "exact": "hrcplan.inference.exact:Exact",
    "switching": "hrcplan.inference.switching:Switching",
    "forest": "hrcplan.inference.forest:Forest",
    "recursive": "hrcplan.inference.recursive:Recursive",
    "cost": "hrcplan.inference.cost:Cost",
}


def names() -> list[str]:
    """Return the names of all methods, ours first."""
    return [*METHODS, *sorted(e.name for e in entry_points(group=GROUP) if e.name not in METHODS)]


def find(name: str) -> Any:
    """Return the class of a method: one of ours, a registered one, or ``module:Class``.

    Raises:
        UsageError: if there is none of this name.
    """
    place = METHODS.get(name, name if ":" in name else None)
    if place is None:
        found = next(iter(entry_points(group=GROUP, name=name)), None)
        if found is None:
            hint = nearest(name, names()) or f"methods: {', '.join(names())}, or module:Class"
            raise UsageError(f"there is no method '{name}'", code="unknown-method", hint=hint)
        return found.load()
    module, _, attribute = place.partition(":")
    try:
        return getattr(import_module(module), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        raise UsageError(f"cannot load '{name}': {error}", code="unknown-method") from None


def takes_goals(kind: Any) -> bool:
    """Return whether a method is made from `Goals`, not from a `Bank`: its ``takes_goals`` says."""
    return bool(getattr(kind, "takes_goals", False))
