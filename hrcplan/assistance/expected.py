"""Our assistant: the step of highest expected help, over goals that may change.

The belief is the switching filter; every goal that it holds possible has a say, in proportion to
its probability, and a step that nobody may need has its price.
"""

from __future__ import annotations

from typing import Any

from hrcplan.assistance.assistant import Options, Watched, Watcher
from hrcplan.bank import Bank
from hrcplan.inference.belief import Belief
from hrcplan.inference.switching import Switching

WASTE_PRICE = 0.05  # steps saved that a needless step has to be worth


class Expected(Watcher[Any]):
    """Does what saves most steps in expectation; waits if nothing is worth its risk.

    A step is worth the steps it saves each goal, weighted by the goals' probabilities, less
    ``waste_price`` for the probability that nobody needs it.

    Args:
        bank: The plans.
        belief: What is believed about the goal; the switching filter by default.
        waste_price: What a step that is not needed costs, in steps.
    """

    def __init__(
        self, bank: Bank, belief: Belief[Any] | None = None, waste_price: float = WASTE_PRICE
    ) -> None:
        super().__init__(bank, Switching(bank) if belief is None else belief)
        self.waste_price = waste_price

    def options(self, state: Watched[Any]) -> Options:
        """Return the steps that some goal could have next, and what each is expected to save."""
        wanted = self.outlook.wanted(state.track)
        steps = self.outlook.candidates(state.track, wanted)
        saved, needed = self.outlook.help(state.track, wanted, steps, self.posterior(state))
        values = saved - self.waste_price * (1 - needed)
        return Options(tuple(steps), tuple(values.tolist()))
