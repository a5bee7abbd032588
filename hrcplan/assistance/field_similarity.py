"""Recursive Bayes (Jain and Argall, THRI 2019) as the changed-mind paper compares with it (IV-D.1).

Every step is a field over the goals: it attracts those that need it and repels the others. The
robot does the step whose field is most like that of the human's last action; it does not use its
belief. In a team that takes turns, a step attracts the goals that have it next.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import AssistantState, BeliefAssistant
from hrcplan.assistance.explanation import StepChoice
from hrcplan.bank import Bank
from hrcplan.bank.progress import Progress
from hrcplan.bank.team_moves import TeamChoices
from hrcplan.core.arrays import Floats
from hrcplan.inference.belief import Belief
from hrcplan.inference.recursive import Next, RecursiveBelief

# Most right guesses, 70.4 %, of humans who change goals, with mistakes and without: the best of 44
# settings on three random banks of 30 goals (tools/tune_changed_mind.py: stay .8 to .99,
# Needed .001 to .3, Attractor 2 to 10, Next .001 to .3; 100 episodes for each bank and human). The
# default of `RecursiveBelief` reaches 68.1 %; stay .7 with Next(.2), tried later, is as good.
BEST_STAY, BEST_LIKELIHOOD = 0.8, Next(0.1)


@dataclass(frozen=True, slots=True)
class FieldState(AssistantState[Any]):
    """The state of `FieldSimilarity`, with the field of the human's last action in a team."""

    field: Floats | None = None


class FieldSimilarity(BeliefAssistant[Any]):
    """Does the step that helps the same goals as the human's last action.

    It waits only if there is nothing to do. Candidates are the steps that the robot can do and some
    goal's plans have. Their fields are compared by cosine, and the first of equals is done; before
    any human action all are equal.

    Args:
        bank: The plans.
        belief: What is believed about the goal; recursive Bayes by default.
    """

    def __init__(self, bank: Bank, belief: Belief[Any] | None = None) -> None:
        super().__init__(bank, RecursiveBelief(bank) if belief is None else belief)
        graph = self.tracker.combined_graph
        self._fields = np.where(graph.needs, 1.0, -1.0)
        self._used = sorted(set(graph.step_of.tolist()))

    def start(self) -> FieldState:
        """Return the state before anything was done."""
        first = super().start()
        return FieldState(first.belief, first.progress)

    def observe(
        self, state: AssistantState[Any], step: int, *, robot: bool = False
    ) -> AssistantState[Any]:
        """Return the state after one more step, done by the human or by the robot."""
        after = super().observe(state, step, robot=robot)
        field = state.field if isinstance(state, FieldState) else None
        if not robot and not after.ignored:
            field = self._field_in_turn(state.progress, step)
        return FieldState(after.belief, after.progress, after.last, after.ignored, field)

    def _field_in_turn(self, progress: Progress, step: int) -> Floats | None:
        """Return the field of an agent's step in its turn; None where agents do not take turns."""
        moves, moment = self.tracker.moves, progress.moment
        if moves is None or moment is None:
            return None
        choices = moves.choices(progress.world, moves.turn_of(moment, step))
        return _fields(choices)[:, choices.place(step)]

    def options(self, state: AssistantState[Any]) -> StepChoice:
        """Return the steps that some goal needs, and how like the human's last action each is."""
        choices = self.step_values.in_turn(state.progress)
        if choices is not None:
            return self.in_turn(_in_turn(choices, state), state)
        label, progress = self.tracker.combined_graph.label, state.progress
        steps = tuple(self.bank.table.able(progress.world, self._used, self.step_values.agents))
        values = np.zeros(len(steps))
        if state.last is not None:
            # All fields are equally long, so the cosine is the mean of the products.
            fields = self._fields.take([label[step] for step in steps], axis=1)
            values = fields.T @ self._fields[:, label[state.last]] / len(self._fields)
        return StepChoice(steps, tuple(values.tolist()), wait=-math.inf)


def _in_turn(choices: TeamChoices, state: AssistantState[Any]) -> StepChoice:
    """Return the steps that some goal has next, and how like the last action each is."""
    is_open = choices.is_next.any(axis=0)
    values = np.zeros(len(choices.steps))
    if isinstance(state, FieldState) and state.field is not None:
        values = state.field @ _fields(choices) / len(state.field)
    steps = tuple(choices.steps[is_open].tolist())
    return StepChoice(steps, tuple(values[is_open].tolist()), wait=-math.inf)


def _fields(choices: TeamChoices) -> Floats:
    """Return the fields of steps, one column each: 1 for the goals that have it next, else -1."""
    return np.where(choices.is_next, 1.0, -1.0)


class BestFieldSimilarity(FieldSimilarity):
    """The same with the parameters of the belief that guess best, where they were tuned."""

    def __init__(self, bank: Bank, belief: Belief[Any] | None = None) -> None:
        own = RecursiveBelief(bank, BEST_STAY, BEST_LIKELIHOOD) if belief is None else belief
        super().__init__(bank, own)
