"""A goal that may change, of a human who is not known: how often it errs and how it chooses.

The hidden state is the goal, the rate of mistakes, the way of choosing among useful steps, and
whether the goal may still change. There are two priors of changes: one for acting,
and one for declaring changes, which should seldom be wrong.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hrcplan.bank import Bank
from hrcplan.bank.combined_graph import CombinedGraph
from hrcplan.bank.progress import Evidence, Progress, ProgressTracker
from hrcplan.core.arrays import Floats, Ids
from hrcplan.errors import UsageError
from hrcplan.inference.belief import IMPOSSIBLE, GoalChange, PlanFollower
from hrcplan.inference.changes import (
    HAZARD,
    NEVER,
    SETTLES,
    ChangeFilter,
    FilterState,
    change_points,
    changes_before,
)
from hrcplan.inference.probabilities import weights_to_posterior

# Tuned on randomly generated goals of two domains (docs/papers/changed-mind-targets.md).
RATES: Mapping[float, float] = {0.002: 0.6, 0.1: 0.3, 0.3: 0.1}
CHOOSERS: Mapping[str, float] = {"uniform": 0.6, "plans": 0.2, "general": 0.1, "special": 0.1}
ACTING_HAZARD = 0.2
_KINDS = ("uniform", "plans", "general", "special")
_POWERS = {"general": 1.0, "special": -1.0}
_UNLIKELY = 1e-12  # the least share of a step among the mistakes


@dataclass(frozen=True, slots=True)
class AdaptiveState:
    """The state of `AdaptiveBelief`: the goals' progress, and a filter for each prior of changes.

    ``filter_state`` is that for declaring changes. ``is_human`` says whether the last observation
    was an applicable step of the human.
    """

    progress: Progress
    acting: FilterState
    filter_state: FilterState
    is_human: bool = False
    ignored: str | None = None

    @property
    def world(self) -> int:
        """The state of the task, as bits."""
        return self.progress.world

    @property
    def n_declared(self) -> int:
        """How many changes of goal were declared so far."""
        return self.filter_state.n_declared


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
            if name not in _KINDS:
                raise UsageError(
                    f"there is no chooser '{name}'", hint=f"one of {', '.join(_KINDS)}"
                )
        self.graph, self.choosers = graph, tuple(choosers)
        n_goals = np.maximum(1, graph.needs.sum(axis=0))
        self._weights = {name: n_goals**power for name, power in _POWERS.items()}
        self._totals = {
            name: graph.label_sums(weights)
            for name, weights in self._weights.items()
            if name in choosers
        }

    def of(self, step: int | None, nodes: Ids, evidence: Evidence) -> Floats:
        """Return the probabilities of a step, by chooser and goal of ``evidence.goals``.

        Args:
            step: The step; None for a wait.
            nodes: The nodes of these goals before it; where they have left their graph, and where
                agents take turns, all steps are alike.
            evidence: What the step says.
        """
        uniform = 1 / evidence.n_next[evidence.goals]
        rows = np.empty((len(self.choosers), len(uniform)))
        for row, name in zip(rows, self.choosers, strict=True):
            row[:] = np.exp(evidence.log_shares) if name == "plans" else uniform
            if name in self._totals and step is not None and evidence.log_odds is None:
                total = self._totals[name].take(nodes)
                weight = self._weights[name][self.graph.label[step]]
                np.divide(weight, total, out=row, where=total > 0)
        return rows


class AdaptiveBelief(PlanFollower):
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
        self.tracker = ProgressTracker(bank)
        kinds = tuple(p * q for p in mistake_rates.values() for q in choosers.values())
        n_goals, n_kinds = len(bank.names), len(kinds)
        self.acting = ChangeFilter(n_goals, n_kinds, hazard, 0.0, settles, kinds)
        self.declaring = ChangeFilter(n_goals, n_kinds, declaring_hazard, never, settles, kinds)
        self.rates = np.array(list(mistake_rates))[:, None]
        self.preferences = StepPreferences(self.tracker.combined_graph, list(choosers))

    def start(self) -> AdaptiveState:
        """Return the uniform belief in the initial state."""
        return AdaptiveState(self.tracker.start, self.acting.start(), self.declaring.start())

    def observe(self, state: AdaptiveState, step: int, *, robot: bool = False) -> AdaptiveState:
        """Return the belief after one more step; the robot's own steps are no evidence."""
        move = self.tracker.follow(state.progress, step)
        if move is None:
            return replace(state, is_human=False, ignored=IMPOSSIBLE)
        if robot:
            return AdaptiveState(move[0], state.acting, state.filter_state)
        return self._after(state, step, *move)

    def observe_wait(self, state: AdaptiveState) -> AdaptiveState:
        """Return the belief after a wait of the agent whose turn it is, where agents take turns."""
        move = self.tracker.wait(state.progress)
        if move is None:
            return state
        if self.tracker.is_robots_turn(state.progress):
            return AdaptiveState(move[0], state.acting, state.filter_state)
        return self._after(state, None, *move)

    def _after(
        self, state: AdaptiveState, step: int | None, progress: Progress, evidence: Evidence
    ) -> AdaptiveState:
        likelihood = self.likelihood(state.progress, step, evidence)
        return AdaptiveState(
            progress,
            self.acting.step(state.acting, likelihood),
            self.declaring.step(state.filter_state, likelihood),
            is_human=True,
        )

    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the likelihood of a step by kind of human (rate, then chooser) and goal."""
        goals, n_choosers = evidence.goals, len(self.preferences.choosers)
        odd = (
            1 / np.maximum(1, evidence.n_doable - evidence.n_next)
            if evidence.log_odds is None
            else np.maximum(np.exp(evidence.log_odds), _UNLIKELY)
        )
        likelihood = (self.rates * odd)[:, None, :].repeat(n_choosers, axis=1)
        if len(goals):
            chances = self.preferences.of(step, progress.nodes.take(goals), evidence)
            likelihood[:, :, goals] = (1 - self.rates)[:, None] * chances
        by_kind: Floats = likelihood.reshape(-1, likelihood.shape[2])
        return by_kind

    def posterior(self, state: AdaptiveState) -> Floats:
        """Return the probability of each goal, in order."""
        return weights_to_posterior(self.acting.goals(state.acting))

    def changes(self, states: Sequence[AdaptiveState]) -> tuple[GoalChange, ...]:
        """Return the changes that are probable given all observations.

        Args:
            states: The belief after each observation, in order.
        """
        return changes_before(states)

    def changed(self, states: Sequence[AdaptiveState]) -> float:
        """Return the probability, given all observations, that the goal has changed at all."""
        return change_points(states)[1].changed
