"""A robot that waits where its own choice is probably useless."""

from __future__ import annotations

from typing import Any, Generic

import numpy as np

from hrcplan.assistance.assistant import Assistant, P, ValueAssistant
from hrcplan.assistance.expected_help import WASTE_PRICE
from hrcplan.assistance.explanation import StepChoice
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats, Ids
from hrcplan.inference.belief import after_attempt, after_wait, at_turn


class MayWait(ValueAssistant[P], Generic[P]):
    """Another assistant that may also wait.

    It waits if the step that the other one chooses is worth less than nothing by the other's own
    belief, where a step is worth one if the goal has it next and costs ``waste_price`` if not.

    Args:
        inner: The other assistant.
        waste_price: What a step that is not needed costs, in steps.
    """

    def __init__(self, inner: ValueAssistant[P], waste_price: float = WASTE_PRICE) -> None:
        super().__init__(inner.bank, inner.tracker)
        self.inner, self.waste_price = inner, waste_price

    def start(self) -> P:
        """Return the state before anything was done."""
        return self.inner.start()

    def observe(self, state: P, step: int, *, robot: bool = False) -> P:
        """Return the state after one more step, done by the human or by the robot."""
        return self.inner.observe(state, step, robot=robot)

    def observe_wait(self, state: P) -> P:
        """Return the state after a wait of the agent whose turn it is, where agents take turns."""
        return after_wait(self.inner, state)

    def observe_attempt(self, state: P, step: int) -> P:
        """Return the state after a step that the human tried to do."""
        return after_attempt(self.inner, state, step)

    def at_turn(self, state: P, agent: str) -> P:
        """Return the state as it is if it is an agent's turn, where agents take turns."""
        return at_turn(self.inner, state, agent)

    def posterior(self, state: P) -> Floats:
        """Return the probability of each goal, in order."""
        return self.inner.posterior(state)

    def options(self, state: P) -> StepChoice:
        """Return the other assistant's options; waiting is the best one where its choice is not."""
        choice = self.inner.options(state)
        if choice.best is None:
            return choice
        share = float(self.posterior(state)[self._helped(state.progress, choice.best)].sum())
        if share > self.waste_price * (1 - share):
            return choice
        return StepChoice(choice.steps, choice.values, wait=max(choice.values))

    def _helped(self, progress: Progress, step: int) -> Ids:
        """Return the goals that have a step next."""
        choices = self.step_values.in_turn(progress)
        if choices is not None:
            return np.flatnonzero(choices.is_next[:, choices.place(step)])
        next_steps = self.step_values.next_steps(progress)
        return np.unique(next_steps.goals[next_steps.steps == step])


def may_wait(assistant: Assistant[Any]) -> Assistant[Any]:
    """Return an assistant that may also wait; the same one if it does not value its steps."""
    return MayWait(assistant) if isinstance(assistant, ValueAssistant) else assistant
