"""Information gathering (Sadigh et al., IROS 2016), adapted to turns as in IV-D.3.

A tree of three steps: robot, human, robot. A branch is worth the bits of entropy that the belief
loses between root and leaf, and ``alignment`` bits for each robot step that the likeliest goal has
next; for each other one it is worth as much less. The weight is open in Sadigh et al. As there, the
best branch is taken, however probable the human's response in it is. The belief
is the forest on all steps done by either agent; the likeliest goal is that at the root.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import AssistantState
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.explanation import StepChoice
from hrcplan.assistance.imagined_steps import BRANCHING
from hrcplan.assistance.lookahead import (
    LookaheadAssistant,
    StepSequence,
    TreePosition,
    entropy,
    futures,
)
from hrcplan.bank import Bank
from hrcplan.core.arrays import Floats
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Belief

# Bits that a step of the likeliest goal is worth, and any other one costs; from .1 to 3 it makes no
# significant difference on randomly generated goals (tools/tune_changed_mind.py).
ALIGNMENT = 1.0


class InformationGain(LookaheadAssistant[Any]):
    """Does the first step of the branch that tells most, and agrees with the likeliest goal.

    Args:
        bank: The plans.
        belief: What is believed about the goal; by default a forest, which is trained first.
        alignment: What a robot step that the likeliest goal has next is worth, in bits.
        bigrams: How often a step follows another; by default counted in sampled plans.
        width: How many steps are tried from each position of the tree.

    Raises:
        UsageError: if ``alignment`` is negative, or ``width`` less than 1.
    """

    def __init__(
        self, bank: Bank, belief: Belief[Any] | None = None, alignment: float = ALIGNMENT,
        bigrams: Bigrams | None = None, width: int = BRANCHING,
    ) -> None:  # fmt: skip
        if not alignment >= 0:
            raise UsageError(f"alignment is worth 0 bits or more, not {alignment}")
        super().__init__(bank, belief, bigrams, width)
        self.alignment = alignment

    def options(self, state: AssistantState[Any]) -> StepChoice:
        """Return the likeliest steps, and what the best branch of each is worth, in bits."""
        present = self.posterior(state)
        branches, agreed = self._tree(self.lookahead.root(state), present)
        if not branches:
            return self.in_turn(StepChoice(), state)
        after = futures(self.belief, state.belief, branches)
        values = float(entropy(present)) - entropy(after) + self.alignment * np.array(agreed)
        best: dict[int, float] = {}
        for branch, value in zip(branches, values.tolist(), strict=True):
            best[branch[0]] = max(value, best.get(branch[0], -math.inf))
        choice = StepChoice(tuple(best), tuple(best.values()), wait=-math.inf)
        return self.in_turn(choice, state)

    def _tree(self, root: TreePosition, present: Floats) -> tuple[list[StepSequence], list[int]]:
        """Return all branches, and by how many more of their robot steps agree than do not."""
        look, goal = self.lookahead, int(present.argmax())
        branches: list[StepSequence] = []
        agreed: list[int] = []
        for first, sign in self._robot(root, present, goal):
            middle = look.after(root, first)
            responses = look.responses(middle, present)
            if not responses:
                branches.append((first,))
                agreed.append(sign)
            for response, _ in responses:
                last = self._robot(look.after(middle, response), present, goal)
                branches += [(first, response, step) for step, _ in last] or [(first, response)]
                agreed += [sign + other for _, other in last] or [sign]
        return branches, agreed

    def _robot(self, place: TreePosition, present: Floats, goal: int) -> list[tuple[int, int]]:
        """Return the robot's likeliest steps, and +1 or -1 as the likeliest goal wants them."""
        mine = set(place.next_steps.steps[place.next_steps.goals == goal].tolist())
        steps = self.lookahead.steps(place, present)
        return [(step, 1 if step in mine else -1) for step in steps]
