"""Critical Decision Points (Ghose et al., RO-MAN 2024), adapted to turns as in IV-D.2.

The robot leads the human to where its next action says most about its goal, and ignores time. This
is one of many possible adaptations:

- The belief is the forest on all steps done by either agent; nothing is ever forgotten.
- The tree is a robot step and the human's response, five of each (see lookahead.py). A robot step
  is worth the bits of entropy that the response is expected to take from the present belief,
- and, as the robot is to support the human at the same time, ``support`` bits for each step that
  it is expected to save.
- Responses are weighted by their probability under the present belief. The robot never waits.
"""

from __future__ import annotations

import math
from typing import Any

from hrcplan.assistance.assistant import AssistantState
from hrcplan.assistance.bigrams import Bigrams
from hrcplan.assistance.explanation import StepChoice
from hrcplan.assistance.imagined_steps import BRANCHING
from hrcplan.assistance.lookahead import LookaheadAssistant, StepSequence, entropy, futures, shares
from hrcplan.bank import Bank
from hrcplan.errors import UsageError
from hrcplan.inference.belief import Belief

# Bits that a saved step is worth. Of .3, 1, 3 and 10, 3 guesses fixed goals best on randomly
# generated goals (tools/tune_changed_mind.py); with more, information hardly counts.
SUPPORT = 3.0


class DecisionPoints(LookaheadAssistant[Any]):
    """Does what makes the human's next action most telling, and helps the likely goals.

    Args:
        bank: The plans.
        belief: What is believed about the goal; by default a forest, which is trained first.
        support: What a step that is expected to be saved is worth, in bits.
        bigrams: How often a step follows another; by default counted in sampled plans.
        width: How many steps are tried from each position of the tree.

    Raises:
        UsageError: if ``support`` is negative, or ``width`` less than 1.
    """

    def __init__(
        self, bank: Bank, belief: Belief[Any] | None = None, support: float = SUPPORT,
        bigrams: Bigrams | None = None, width: int = BRANCHING,
    ) -> None:  # fmt: skip
        if not support >= 0:
            raise UsageError(f"support is worth 0 bits or more, not {support}")
        super().__init__(bank, belief, bigrams, width)
        self.support = support

    def options(self, state: AssistantState[Any]) -> StepChoice:
        """Return the likeliest steps, and what each is worth, in bits."""
        present, look = self.posterior(state), self.lookahead
        root = look.root(state)
        steps = look.steps(root, present)
        branches: list[StepSequence] = []
        parts: list[tuple[int, float]] = []
        for place, step in enumerate(steps):
            responses = look.responses(look.after(root, step), present)
            branches += [(step, response) for response, _ in responses] or [(step,)]
            parts += [(place, chance) for _, chance in responses] or [(place, 1.0)]
        if not steps:
            return self.in_turn(StepChoice(), state)
        after = futures(self.belief, state.belief, branches)
        drops = float(entropy(present)) - entropy(after)
        values = self.support * shares(root, present).take(steps)
        for (place, chance), drop in zip(parts, drops.tolist(), strict=True):
            values[place] += chance * drop
        choice = StepChoice(tuple(steps), tuple(values.tolist()), wait=-math.inf)
        return self.in_turn(choice, state)
