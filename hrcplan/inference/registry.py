"""Which methods there are, by name; each is a class that makes a belief from a bank or goals."""

from __future__ import annotations

from typing import Any

from hrcplan.core.registry import Registry
from hrcplan.inference.belief import Belief

BANK_METHOD, GOALS_METHOD = "switching", "cost"
METHODS: Registry[..., Belief[Any]] = Registry(
    "method",
    {
        "exact": "hrcplan.inference.exact:ExactBelief",
        "switching": "hrcplan.inference.switching:SwitchingBelief",
        "forest": "hrcplan.inference.classifier.forest:ForestBelief",
        "recursive": "hrcplan.inference.recursive:RecursiveBelief",
        "cost": "hrcplan.inference.recognition.cost:CostBelief",
    },
    "hrcplan.beliefs",
    Belief,
)


def takes_goals(kind: Any) -> bool:
    """Return whether a method is made from `Goals`, not from a `Bank`: its ``takes_goals`` says."""
    return bool(getattr(kind, "takes_goals", False))
