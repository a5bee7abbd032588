"""A human who may change goals and make mistakes: exact filtering over plan graphs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.inference.changes import HAZARD, NEVER, SETTLES, ChangeFilter, FilterState
from hrcplan.inference.filter_belief import FilterBelief

MISTAKE_RATES = (0.002, 0.1)
IMPROBABLE = 1e-12  # the least share of a step among the mistakes


class SwitchingBelief(FilterBelief[FilterState]):
    """The posterior of the present goal.

    A step of the goal has likelihood (1 - p) over the number of steps that could come next in its
    plans; a mistake p over the number of steps that could be done and would not. Where agents take
    turns, a mistake is the less likely the more time it loses the team, and a wait is evidence.

    Args:
        bank: The plans.
        hazard: The probability of a change before each human step.
        mistake_rates: Equally likely rates of mistakes p.
        never: The prior probability that the goal never changes.
        settles: The probability that a goal that was changed to is kept to the end.
    """

    def __init__(
        self, bank: Bank, hazard: float = HAZARD,
        mistake_rates: Sequence[float] = MISTAKE_RATES, never: float = NEVER,
        settles: float = SETTLES,
    ) -> None:  # fmt: skip
        change_filter = ChangeFilter(len(bank.names), len(mistake_rates), hazard, never, settles)
        super().__init__(ProgressTracker(bank), change_filter)
        self.rates = np.array(mistake_rates)[:, None]

    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood of a step, by mistake rate and goal."""
        likelihood: Floats = (
            self.rates / np.maximum(1, evidence.n_doable - evidence.n_next)
            if evidence.log_odds is None
            else self.rates * np.maximum(np.exp(evidence.log_odds), IMPROBABLE)
        )
        likelihood[:, evidence.goals] = (1 - self.rates) / evidence.n_next[evidence.goals]
        return likelihood
