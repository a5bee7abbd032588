"""Which methods there are, by name; each is a class that makes a belief from a bank or goals."""

from __future__ import annotations

from typing import Any

from hrcplan.parts import Parts

BANK_METHOD, GOALS_METHOD = "switching", "cost"
METHODS = Parts(
    "method",
    {
        "exact": "hrcplan.inference.exact:Exact",
        "switching": "hrcplan.inference.switching:Switching",
        "forest": "hrcplan.inference.forest:Forest",
        "recursive": "hrcplan.inference.recursive:Recursive",
        "cost": "hrcplan.inference.cost:Cost",
    },
    "hrcplan.beliefs",
)


def takes_goals(kind: Any) -> bool:
    """Return whether a method is made from `Goals`, not from a `Bank`: its ``takes_goals`` says."""
    return bool(getattr(kind, "takes_goals", False))
