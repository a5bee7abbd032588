"""The robot that weighs goal and agent state together: steps, interactions and questions.

The belief is a product of two filters: one of the goal, one of the agents' states. What it does is
what reduces the expected cost to go of the team most. While no agent state has changed its steps
are those of `ExpectedHelp`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hrcplan.assistance.assistant import AssistantState
from hrcplan.assistance.bounded_roots import BoundedBelief
from hrcplan.assistance.expected_help import ExpectedHelp
from hrcplan.assistance.explanation import Explanation, StepChoice, explanation_of
from hrcplan.assistance.priced_help import PricedHelp
from hrcplan.assistance.questions import (
    answer_likelihood,
    best_question,
    one_goal,
)
from hrcplan.assistance.situation import Advice, PossibleInteraction, Situation, Values
from hrcplan.assistance.step_prices import Changes, PriceModel
from hrcplan.bank import Bank
from hrcplan.bank.progress import Evidence, Progress
from hrcplan.core.arrays import Bools, Floats
from hrcplan.inference.belief import (
    IMPOSSIBLE,
    Belief,
    PredictsSteps,
    after_evidence,
    n_declared,
    with_progress,
)
from hrcplan.pddl.conventions import people

NONE_PRIOR = 0.02  # that people want none of the goals of the bank
NONE_HAZARD = 0.1  # that before a human step this is drawn again
NONE_HOLDS = 0.5
IDLES = 0.2  # how likely people stand still who could do a next step of their goal
IDLES_WITHOUT = 0.4  # the same without a goal of the bank: they may have done what they wanted
MAX_PRICED = 8  # agent states whose prices are remembered


@dataclass(frozen=True, slots=True)
class JointState(AssistantState[Any]):
    """The state of `JointHelp`; ``none`` is the probability that no goal of the bank is wanted.

    ``certain_goal`` is a goal that is known for sure; None if none is.
    """

    none: float = NONE_PRIOR
    certain_goal: int | None = None


class JointHelp(ExpectedHelp):
    """Weighs steps, interactions and questions by the expected cost to go of the team.

    Args:
        bank: The plans.
        belief: What is believed about the goal; the adaptive filter by default, in bounded time.
        asks: Whether it asks people what they want.
    """

    def __init__(self, bank: Bank, belief: Belief[Any] | None = None, asks: bool = True) -> None:
        super().__init__(bank, BoundedBelief(bank) if belief is None else belief)
        self.asks = asks
        self.price_model = PriceModel(bank)
        self._helpers: dict[Changes, PricedHelp] = {}
        self._people = people(bank.goals.problem)

    def helper(self, values: Values) -> PricedHelp:
        """Return what values steps with an agent state."""
        prices = self.price_model.prices(values)
        helper = self._helpers.get(prices.changes)
        if helper is None:
            while len(self._helpers) >= MAX_PRICED:
                self._helpers.pop(next(iter(self._helpers)))
            helper = self._helpers[prices.changes] = self.help_at(prices)
        return helper

    def advise(self, state: JointState, situation: Situation) -> Advice:
        """Return what the robot should do now."""
        helper, weights = self.helper(situation.values), self.posterior(state)
        choice = helper.options(state.progress, weights)
        if self.asks and state.none <= NONE_HOLDS:
            question = best_question(helper, state.progress, weights, situation.asking)
            if question is not None:
                return Advice(question=question, value=question.worth)
        choice = self._claimed(helper, state, choice)
        if situation.stands_still:
            choice = helper.surely_nearer(choice, state.progress, weights)
        best = choice.best
        value = 0.0 if best is None else choice.values[choice.steps.index(best)]
        advice = Advice(step=best, value=value)
        for interaction in situation.interactions:
            worth = self._worth(helper, state.progress, weights, interaction)
            if worth > max(0.0, advice.value):
                advice = Advice(interaction=interaction, value=worth)
        return advice

    def _claimed(self, helper: PricedHelp, state: JointState, choice: StepChoice) -> StepChoice:
        """Return a choice; only what several goals need, if probably no goal of the bank holds."""
        if state.none <= NONE_HOLDS:
            return choice
        weights = self.posterior(state)
        pairs = [
            (step, value) for step, value in zip(choice.steps, choice.values, strict=True)
            if helper.n_helped(state.progress, step, weights) > 1
        ]  # fmt: skip
        return StepChoice(tuple(s for s, _ in pairs), tuple(v for _, v in pairs), choice.wait)

    def _worth(
        self, helper: PricedHelp, progress: Progress, weights: Floats, action: PossibleInteraction
    ) -> float:
        after = self.helper(action.values).to_go(progress, weights)
        return action.success * (helper.to_go(progress, weights) - after) - action.price

    def explain_at(
        self, state: JointState, values: Values, n_goals: int = 3, n_steps: int = 5
    ) -> Explanation:
        """Return what it weighs, with an agent state; see ``explain``."""
        weights = self.posterior(state)
        choice = self.helper(values).options(state.progress, weights)
        return explanation_of(
            self.step_values, state.progress, weights, choice, n_declared(state), n_goals, n_steps
        )

    # What was seen.

    def start(self) -> JointState:
        """Return the state before anything was done."""
        state, n_composed = _joint(super().start()), self.bank.n_composed
        if not n_composed:
            return state
        prior = np.ones(len(self.names))  # composed goals share what none of these has at first
        prior[-n_composed:] = NONE_PRIOR * (len(prior) - n_composed) / n_composed
        return self._after_evidence(state, prior)

    def posterior(self, state: AssistantState[Any]) -> Floats:
        """Return the probability of each goal, in order, given that it is one of the bank."""
        if isinstance(state, JointState) and state.certain_goal is not None:
            return one_goal(len(self.names), state.certain_goal)
        return super().posterior(state)

    def observe(
        self, state: AssistantState[Any], step: int, *, robot: bool = False
    ) -> AssistantState[Any]:
        """Return the state after one more step, done by the human or by the robot."""
        after = _joint(super().observe(state, step, robot=robot), state)
        return after if robot else self._with_none(state, after)

    def observe_attempt(self, state: AssistantState[Any], step: int) -> AssistantState[Any]:
        """Return the state after a step that the human tried to do: evidence, but no progress."""
        return self._with_none(state, _joint(super().observe_attempt(state, step), state))

    def _with_none(self, before: AssistantState[Any], after: JointState) -> JointState:
        """Return the state with what a human step says about goals that are not in the bank."""
        if after.ignored == IMPOSSIBLE:
            return after
        prior = after.none * (1 - NONE_HAZARD) + NONE_PRIOR * NONE_HAZARD
        unknown = prior / max(1, self._n_doable(before.progress))
        named = (1 - prior) * self._marginal(after)
        return replace(after, none=unknown / max(unknown + named, 1e-300))

    def _marginal(self, state: JointState) -> float:
        return state.belief.marginal if isinstance(state.belief, PredictsSteps) else 1.0

    def _n_doable(self, progress: Progress) -> int:
        moves = self.tracker.moves
        if moves is None or progress.moment is None:
            return progress.doable.bit_count()
        return len(moves.choices(progress.world, progress.moment).steps) + 1

    def observe_pause(self, state: JointState, is_evidence: bool = True) -> JointState:
        """Return the state after a person did nothing.

        A goal of which they could do a next step makes that less likely. A pause that goes on says
        nothing more.

        Args:
            state: The state before.
            is_evidence: Whether it says something about the goal.
        """
        if self.tracker.moves is not None:
            if is_evidence:
                return self._with_none(state, _joint(self.observe_wait(state), state))
            move = self.tracker.wait(state.progress)
            return state if move is None else self._with_progress(state, move[0])
        if not is_evidence:
            return state
        likelihood = np.where(self._has_step(state.progress, self._people), IDLES, 1.0)
        return self._weighed(state, likelihood, IDLES_WITHOUT)

    def _with_progress(self, state: JointState, progress: Progress) -> JointState:
        belief: Any = with_progress(state.belief, progress)
        return replace(state, belief=belief, progress=progress)

    def chance_of_pause(self, state: JointState, agent: str) -> float:
        """Return how likely an agent stands still now, if no action is hard for it."""
        has_step = self._has_step(state.progress, frozenset({agent}))
        return 1 - (1 - IDLES) * float(self.posterior(state)[has_step].sum())

    def _has_step(self, progress: Progress, agents: frozenset[str]) -> Bools:
        """Return for each goal whether its plans have a step now that one of the agents can do."""
        following = self.step_values.next_steps(progress)
        steps = np.unique(following.steps).tolist()
        able = list(self.bank.table.able(progress.world, steps, agents))
        has_step = np.zeros(len(self.names), dtype=np.bool_)
        has_step[following.goals[np.isin(following.steps, able)]] = True
        return has_step

    def observe_answer(
        self, state: JointState, options: tuple[int, ...], answer: int | None
    ) -> JointState:
        """Return the state after people have said which of several goals they have.

        Args:
            state: The state before.
            options: The goals that were asked about.
            answer: One of them; None for something else.
        """
        likelihood = answer_likelihood(len(self.names), options, answer)
        return self._weighed(state, likelihood, 1.0 if answer is None else float(likelihood.min()))

    def _weighed(self, state: JointState, likelihood: Floats, without: float) -> JointState:
        """Return the state after evidence; ``without`` is its likelihood if no goal is wanted."""
        none = state.none * without
        named = (1 - state.none) * float(self.posterior(state) @ likelihood)
        after = self._after_evidence(state, likelihood)
        return replace(after, none=none / max(none + named, 1e-300))

    def _after_evidence(self, state: JointState, likelihood: Floats) -> JointState:
        belief: Any = after_evidence(self.belief, state.belief, likelihood)
        return replace(state, belief=belief)


class JointOracle(JointHelp):
    """The same for a robot that knows what people want."""

    def inform(self, state: JointState, goal: int) -> JointState:
        """Return the state once the human's present goal is known."""
        return replace(state, certain_goal=goal, none=0.0)


class UniformBelief(BoundedBelief):
    """A belief to which no step says anything: all goals stay as likely as others."""

    def likelihood(self, progress: Progress, step: int | None, evidence: Evidence) -> Floats:
        """Return the same for all goals."""
        return np.ones_like(super().likelihood(progress, step, evidence))


def _joint(state: AssistantState[Any], before: AssistantState[Any] | None = None) -> JointState:
    """Return a state with the rest of the state before it."""
    if isinstance(state, JointState):
        return state
    none = before.none if isinstance(before, JointState) else NONE_PRIOR
    certain = before.certain_goal if isinstance(before, JointState) else None
    return JointState(state.belief, state.progress, state.last, state.ignored, none, certain)
