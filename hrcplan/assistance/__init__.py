"""Robots that help a human whose goal they have to infer: history and belief in, step out.

The short way: ``ASSISTANTS.find("hrcplan")(bank)`` makes one; see `Assistant` for what it does.
"""

from hrcplan.assistance.assistant import (
    Assistant,
    AssistantState,
    BeliefAssistant,
    Explanation,
    StepChoice,
    explain,
)
from hrcplan.assistance.registry import ASSISTANTS

__all__ = [
    "ASSISTANTS",
    "Assistant",
    "AssistantState",
    "BeliefAssistant",
    "Explanation",
    "StepChoice",
    "explain",
]
