"""Asking people what they want: what the answer is worth, and what the question costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hrcplan.assistance.priced_help import MOST_ASKED, PricedHelp
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats

LEAST = 0.02  # the probability of a goal that is asked about
ASK_PRICE = 1.5  # steps that a first question costs; tuned on randomly generated households
IDLE_SHARE = 0.5  # of the price, where people stand still anyway
WRONG = 0.02  # the probability of an answer that is not true


@dataclass(frozen=True, slots=True)
class GoalQuestion:
    """A question which of several goals people have; ``worth`` is its value minus its price."""

    goals: tuple[int, ...]
    worth: float


@dataclass(frozen=True, slots=True)
class AskingRecord:
    """What became of earlier questions, and whether people wait now."""

    n_asked: int = 0
    n_answered: int = 0
    people_wait: bool = False

    @property
    def price(self) -> float:
        """What a question costs: each one more than the one before, less where people wait.

        So the number of questions is limited by what an answer can be worth.

        >>> AskingRecord().price, AskingRecord(1, 1, people_wait=True).price
        (1.5, 1.5)
        """
        return ASK_PRICE * (1 + self.n_asked) * (IDLE_SHARE if self.people_wait else 1.0)

    @property
    def chance_of_answer(self) -> float:
        """How likely people answer, from how often they have done so.

        >>> AskingRecord().chance_of_answer, AskingRecord(3, 0).chance_of_answer
        (1.0, 0.25)
        """
        return (1 + self.n_answered) / (1 + self.n_asked)


def best_question(
    helper: PricedHelp, progress: Progress, weights: Floats, record: AskingRecord
) -> GoalQuestion | None:
    """Return the question that is worth its price; None if there is none.

    It names the likeliest goals. Its value is what the best step costs now, minus what it costs
    on average once the answer is known, if people answer.

    Args:
        helper: Knows what steps cost.
        progress: Where the goals are.
        weights: The probability of each goal.
        record: What a question costs, and how likely it is answered.
    """
    price, chance = record.price, record.chance_of_answer
    now, certain = helper.least_cost(progress, weights), helper.least_costs(progress, weights)
    if chance * (now - float(weights @ certain)) <= price:
        return None  # not even worth it if the answer named the goal
    order = np.argsort(-weights, kind="stable")[:MOST_ASKED]
    goals = [int(goal) for goal in order if weights[goal] >= LEAST]
    cost, rest = float(weights[goals] @ certain[goals]), weights.copy()
    rest[goals] = 0.0
    share = float(rest.sum())
    if share > 0:
        cost += share * helper.least_cost(progress, rest / share)
    worth = chance * (now - cost) - price
    return GoalQuestion(tuple(goals), worth) if worth > 0 else None


def one_goal(n_goals: int, goal: int) -> Floats:
    """Return the weights of goals if one of them is certain."""
    weights = np.zeros(n_goals)
    weights[goal] = 1.0
    return weights


def answer_likelihood(n_goals: int, options: tuple[int, ...], answer: int | None) -> Floats:
    """Return how likely an answer is for each goal.

    Args:
        n_goals: The number of goals.
        options: The goals that were asked about.
        answer: One of them; None for something else.

    >>> answer_likelihood(3, (0, 1), 1).round(2).tolist()
    [0.01, 0.98, 0.01]
    """
    wrong = WRONG / max(1, len(options))
    likelihood = np.full(n_goals, wrong)
    if answer is None:
        likelihood[:] = 1 - WRONG
        likelihood[list(options)] = wrong
    else:
        likelihood[answer] = 1 - WRONG
    return likelihood
