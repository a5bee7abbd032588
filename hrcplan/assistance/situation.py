"""What a robot that weighs goal and agent state knows besides the steps, and what it advises."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from hrcplan.assistance.questions import AskingRecord, GoalQuestion
from hrcplan.core.numbers import Number
from hrcplan.pddl.model import FluentKey

Values = Mapping[FluentKey, Number]


@dataclass(frozen=True, slots=True)
class PossibleInteraction:
    """An interaction that a robot could begin.

    Attributes:
        words: Its name and objects.
        success: The probability that it has its effect.
        values: The function values that planners get if it has.
        price: What it costs, in steps.
    """

    words: tuple[str, ...]
    success: float
    values: Values
    price: float


@dataclass(frozen=True, slots=True)
class Situation:
    """What a robot knows besides what was done.

    Attributes:
        values: The agent state, as function values that planners get.
        asking: What became of questions about the goal, and whether people stand still.
        stands_still: Whether people go on to do nothing.
        interactions: What could be done for an agent's state.
    """

    values: Values = field(default_factory=dict)
    asking: AskingRecord = field(default_factory=AskingRecord)
    stands_still: bool = False
    interactions: Sequence[PossibleInteraction] = ()


@dataclass(frozen=True, slots=True)
class Advice:
    """What the robot should do: a question, an interaction, a step, or (all None) wait.

    ``value`` is what that is expected to save, in steps.
    """

    step: int | None = None
    question: GoalQuestion | None = None
    interaction: PossibleInteraction | None = None
    value: float = 0.0
