"""The methods of goal inference by name: each is a class of beliefs."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any

from hrcplan.core.registry import Registry
from hrcplan.inference.belief import Belief, MadeFromGoals, ObservesFacts

BANK_METHOD, GOALS_METHOD = "switching", "cost"
METHODS: Registry[..., Belief[Any]] = Registry(
    "method",
    {
        "exact": "hrcplan.inference.exact:ExactBelief",
        "switching": "hrcplan.inference.switching:SwitchingBelief",
        "adaptive": "hrcplan.inference.adaptive:AdaptiveBelief",
        "forest": "hrcplan.inference.classifier.forest:ForestBelief",
        "recursive": "hrcplan.inference.recursive:RecursiveBelief",
        "cost": "hrcplan.inference.recognition.cost:CostBelief",
    },
    "hrcplan.beliefs",
    Belief,
)


def takes_goals(kind: Callable[..., Belief[Any]]) -> bool:
    """Return whether a class of beliefs is made from `Goals`, not from a `Bank`."""
    factory: Hashable = kind
    return isinstance(factory, MadeFromGoals) and factory.takes_goals


def takes_facts(kind: Callable[..., Belief[Any]]) -> bool:
    """Return whether a class of beliefs takes observations of facts, too."""
    return isinstance(kind, type) and issubclass(kind, ObservesFacts)
