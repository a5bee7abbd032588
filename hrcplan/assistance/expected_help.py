"""The assistant ``hrcplan``: the step of highest expected help, over goals that may change.

The belief is the adaptive filter. Every goal counts in proportion to its probability, and a step
that no goal may need has a price.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import AssistantState, BeliefAssistant
from hrcplan.assistance.explanation import StepChoice
from hrcplan.assistance.priced_help import PricedHelp, priced_help
from hrcplan.assistance.step_prices import PriceModel, StepPrices
from hrcplan.assistance.team_help import TeamHelp
from hrcplan.bank import Bank
from hrcplan.core.numbers import Number
from hrcplan.inference.adaptive import AdaptiveBelief
from hrcplan.inference.belief import Belief
from hrcplan.inference.switching import SwitchingBelief
from hrcplan.pddl.model import FluentKey

WASTE_PRICE = 0.95  # steps; tuned on randomly generated kitchens; more saves waste, but costs time
N_LOOKED, N_ANSWERS = 5, 6  # best steps that are looked beyond, and likeliest answers to each


class ExpectedHelp(BeliefAssistant[Any]):
    """Does the step that saves most steps in expectation; waits if no step has a positive value.

    The value of a step is the number of steps it saves each goal, weighted by the goals'
    probabilities, minus ``waste_price`` times the probability that no goal needs it. In a team that
    takes turns it is the expected number of timesteps that it saves (`TeamHelp`).

    Args:
        bank: The plans.
        belief: What is believed about the goal; the adaptive filter by default.
        waste_price: What a step that is not needed costs, in steps.
        look_ahead: Also count what the robot's next step is expected to save after the human's
            response. This favours steps after which the response is more informative.
        may_wait: Whether it waits if no step has a positive value; else it does the best one.
        agent_state: Function values as planners get them, such as ``{("motivation", "human"): 7}``;
            those that are missing are low. What steps then cost whom counts in the cost to go.
    """

    def __init__(
        self, bank: Bank, belief: Belief[Any] | None = None, waste_price: float = WASTE_PRICE,
        look_ahead: bool = False, may_wait: bool = True,
        agent_state: Mapping[FluentKey, Number] | None = None,
    ) -> None:  # fmt: skip
        super().__init__(bank, AdaptiveBelief(bank) if belief is None else belief)
        self.waste_price, self.look_ahead, self.may_wait = waste_price, look_ahead, may_wait
        moves = self.tracker.moves
        takes_turns = moves is not None and any(moves.is_robot)
        self.team_help = TeamHelp(moves) if moves is not None and takes_turns else None
        prices = PriceModel(bank).prices(agent_state) if agent_state else None
        self._priced = self.help_at(prices) if prices is not None and prices.changes else None

    def help_at(self, prices: StepPrices) -> PricedHelp:
        """Return what values steps at other prices than those of low agent states."""
        moves = None if self.team_help is None else self.team_help.moves
        return priced_help(self.step_values, moves, prices, self.waste_price)

    def options(self, state: AssistantState[Any]) -> StepChoice:
        """Return the steps that some goal could have next, and what each is expected to save."""
        choice = self._now(state)
        if not self.may_wait:
            return replace(choice, wait=-math.inf)
        if not self.look_ahead:
            return choice
        order = np.argsort([-value for value in choice.values], kind="stable")[:N_LOOKED]
        steps = tuple(choice.steps[i] for i in order)
        values = tuple(
            choice.values[i] + self._later(self.observe(state, choice.steps[i], robot=True))
            for i in order
        )
        return StepChoice(steps, values, wait=self._later(state))

    def _later(self, state: AssistantState[Any]) -> float:
        """Return what the robot's step after the human's next one is expected to save."""
        next_steps, posterior = self.step_values.next_steps(state.progress), self.posterior(state)
        n_next = np.maximum(1, np.bincount(next_steps.goals, minlength=len(posterior)))
        chances = np.bincount(next_steps.steps, (posterior / n_next).take(next_steps.goals))
        likely = np.argsort(-chances, kind="stable")[:N_ANSWERS]
        total = float(chances.take(likely).sum())
        if not total:
            return 0.0
        best = (
            max(self._now(self.observe(state, int(step))).values, default=0.0) for step in likely
        )
        saving = sum(
            p * max(0.0, value) for p, value in zip(chances.take(likely), best, strict=True)
        )
        return float(saving / total)

    def _now(self, state: AssistantState[Any]) -> StepChoice:
        progress = state.progress
        if self._priced is not None:
            return self._priced.options(progress, self.posterior(state))
        if self.team_help is not None:
            moment = self.step_values.next_robot(progress)
            return self.team_help.options(progress.world, moment, self.posterior(state))
        next_steps = self.step_values.next_steps(state.progress)
        steps = self.step_values.candidates(state.progress, next_steps)
        savings, needs = self.step_values.expected_saving(
            state.progress, next_steps, steps, self.posterior(state)
        )
        worth = savings - self.waste_price * (1 - needs)
        return StepChoice(tuple(steps), tuple(worth.tolist()))


class SwitchingHelp(ExpectedHelp):
    """The same with the switching filter: the method ``hrcplan`` as it was first."""

    def __init__(self, bank: Bank, belief: Belief[Any] | None = None) -> None:
        super().__init__(bank, SwitchingBelief(bank) if belief is None else belief)
