"""A goal that may change, of a human who is not known: how often it errs and how it chooses.

The hidden state is the goal, the rate of mistakes, the way of choosing among useful steps, and
whether the goal may still change. There are two priors of changes: one for acting,
and one for declaring changes, which should seldom be wrong.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.combined_graph import CombinedGraph
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats
from hrcplan.errors import UsageError
from hrcplan.inference.changes import HAZARD, NEVER, SETTLES, ChangeFilter
from hrcplan.inference.filter_belief import FilterBelief
from hrcplan.inference.paired_filters import PairedFilters, PairedState

# Tuned on randomly generated goals of two domains (docs/papers/changed-mind-targets.md).
RATES: Mapping[float, float] = {0.002: 0.6, 0.1: 0.3, 0.3: 0.1}
CHOOSERS: Mapping[str, float] = {"uniform": 0.6, "plans": 0.2, "general": 0.1, "special": 0.1}
ACTING_HAZARD = 0.2
PLANS = "plans"
_POWERS = {"uniform": 0.0, "general": 1.0, "special": -1.0}  # of the number of goals
_TINY = 1e-300
_UNLIKELY = 1e-12  # the least share of a step among the mistakes


class StepPreferences:
    """How likely a human of each kind does a step among the next ones of a goal.

    ``uniform``: all alike; ``plans``: in proportion to the plans that go on with the step;
    ``general`` and ``special``: the likelier, the more or the fewer goals need it.

    Args:
        graph: All plans.
        choosers: The kinds of choosers, in order.

    Raises:
        UsageError: if there is no such kind.
    """

    def __init__(self, graph: CombinedGraph, choosers: Sequence[str]) -> None:
        for name in choosers:
            if name not in (PLANS, *_POWERS):
                hint = f"one of {', '.join((PLANS, *_POWERS))}"
                raise UsageError(f"there is no chooser '{name}'", hint=hint)
        self.graph, self.choosers = graph, tuple(choosers)
        n_goals = np.maximum(1.0, graph.needs.sum(axis=0))
        by_chooser = [n_goals ** _POWERS.get(name, 0.0) for name in choosers]
        totals = [graph.label_sums(weights) for weights in by_chooser]
        self._weights = np.stack(by_chooser, axis=1)
        self._totals = np.maximum(np.stack(totals, axis=1), _TINY)  # none where a graph was left
        self._by_plans = [i for i, name in enumerate(choosers) if name == PLANS]

    def of(self, step: int | None, progress: Progress, evidence: Evidence) -> Floats:
        """Return the probabilities of a step, by chooser and goal of ``evidence.goals``.

        Where agents take turns, and where goals have left their graph, all steps are alike.

        Args:
            step: The step; None for a wait.
            progress: The progress before it.
            evidence: What the step says.
        """
        goals = evidence.goals
        if step is None or evidence.log_odds is not None:
            return np.ones((len(self.choosers), 1)) / evidence.n_next[goals]
        nodes, weights = progress.nodes.take(goals), self._weights[self.graph.label[step]]
        chances: Floats = weights[:, None] / self._totals.take(nodes, axis=0).T
        if progress.off:
            left = nodes == self.graph.off
            chances[:, left] = 1 / evidence.n_next[goals[left]]
        chances[self._by_plans] = np.exp(evidence.log_shares)
        return chances


class AdaptiveBelief(FilterBelief[PairedState]):
    """The posterior of the present goal, and of what kind of human has it.

    A useful step has likelihood (1 - p) times its probability under the way of choosing, any other
    p over their number, as in `SwitchingBelief`; rates p and ways of choosing are hidden.

    Args:
        bank: The plans.
        hazard: The probability of a change before each human step, for acting.
        mistake_rates: Rates p with their prior probabilities.
        choosers: Ways of choosing (see `StepPreferences`) with their prior probabilities.
        settles: The probability that a goal that was changed to is kept to the end.
        declaring_hazard: The probability of a change before each step, for declaring changes.
        never: The prior probability that the goal never changes, for declaring changes.

    Raises:
        UsageError: if there is no such way of choosing.
    """

    def __init__(
        self, bank: Bank, hazard: float = ACTING_HAZARD,
        mistake_rates: Mapping[float, float] = RATES, choosers: Mapping[str, float] = CHOOSERS,
        settles: float = SETTLES, declaring_hazard: float = HAZARD, never: float = NEVER,
    ) -> None:  # fmt: skip
        kinds = tuple(p * q for p in mistake_rates.values() for q in choosers.values())
        n_goals, n_kinds = len(bank.names), len(kinds)
        filters = PairedFilters(
            ChangeFilter(n_goals, n_kinds, hazard, 0.0, settles, kinds),
            ChangeFilter(n_goals, n_kinds, declaring_hazard, never, settles, kinds),
        )
        super().__init__(ProgressTracker(bank), filters)
        self.rates = np.array(list(mistake_rates))[:, None]
        self._rate_of_kind, self._others = (
            self.rates.repeat(len(choosers), axis=0),
            1 - self.rates[:, :, None],
        )
        self._shares = 1 / np.maximum(1, np.arange(bank.table.n_labels + 1))
        self.preferences = StepPreferences(self.tracker.combined_graph, list(choosers))

    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood of a step by kind of human (rate, then chooser) and goal."""
        odd = (
            self._shares.take(evidence.n_doable - evidence.n_next, mode="clip")
            if evidence.log_odds is None
            else np.maximum(np.exp(evidence.log_odds), _UNLIKELY)
        )
        likelihood: Floats = self._rate_of_kind * odd
        if len(evidence.goals):
            chances = self.preferences.of(step, progress, evidence)
            by_kind = self._others * chances
            likelihood[:, evidence.goals] = by_kind.reshape(len(likelihood), -1)
        return likelihood
