"""Robots that help a human whose goal they infer: observed steps in, the robot's step out.

The short way: ``ASSISTANTS.make("hrcplan", bank)``. The contract is `Assistant`.
"""

from hrcplan.assistance.assistant import (
    Assistant,
    AssistantState,
    BeliefAssistant,
    Explains,
    KnowsGoal,
    explain,
)
from hrcplan.assistance.explanation import Explanation, StepChoice
from hrcplan.assistance.registry import ASSISTANTS

__all__ = [
    "ASSISTANTS",
    "Assistant",
    "AssistantState",
    "BeliefAssistant",
    "Explains",
    "Explanation",
    "KnowsGoal",
    "StepChoice",
    "explain",
]
