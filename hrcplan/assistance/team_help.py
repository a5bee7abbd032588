"""What a robot's step is worth to a team that takes turns: expected timesteps, a round ahead.

The humans know the goal, the robots only believe. So after a robot's step the humans do what each
goal lets them do, the belief learns from it, and the next robot does what is best for the belief
that is left. From there on the team is taken to know the goal: the rest is the cost to go.
"""

from __future__ import annotations

import numpy as np

from hrcplan.assistance.explanation import StepChoice
from hrcplan.bank.cost_to_go import TIMESTEP
from hrcplan.bank.team_moves import OUT_OF_REACH, Moment, TeamChoices, TeamMoves
from hrcplan.core.arrays import Floats

ACTION = 1 / TIMESTEP  # timesteps that an action costs besides its own
LEAST_SAVING = 0.02  # timesteps: a step for improbable goals alone is left undone
RISK = 0.02  # the probability of losing the goal that is taken to end a standstill
PATIENCE = 3  # rounds without a human's step, after which any risk is taken
NEGLIGIBLE = 1e-3  # the share of humans that a step must have to be looked beyond


class TeamHelp:
    """Values what a robot can do in its turn, from the probabilities of the goals.

    Args:
        moves: What the agents do for each goal.
        extra: For each step, how many timesteps it costs besides its own; none by default.
    """

    def __init__(self, moves: TeamMoves, extra: Floats | None = None) -> None:
        self.moves = moves
        self.extra = np.zeros(len(moves.bank.table)) if extra is None else extra

    def options(self, world: int, moment: Moment, weights: Floats) -> StepChoice:
        """Return how many timesteps each step of a robot is expected to save.

        Where the humans wait and the robot would, too, only the likeliest goal counts. Else a step
        is chosen only if it saves more than `LEAST_SAVING`.

        Args:
            world: The state, as bits.
            moment: The moment, at which it is a robot's turn.
            weights: The probability of each goal.
        """
        choices = self.moves.choices(world, moment)
        costs = self.costs(world, moment, weights)
        worth = costs[-1] - costs[:-1]
        humans_wait = moment.without_human >= self.moves.n_turns - 1
        least = LEAST_SAVING
        if len(worth) and worth.max() <= least and humans_wait:
            worth, least = self._for_likeliest(choices, weights, moment), 0.0
        return StepChoice(tuple(choices.steps.tolist()), tuple(worth.tolist()), least)

    def _for_likeliest(self, choices: TeamChoices, weights: Floats, moment: Moment) -> Floats:
        """Return how many timesteps steps save the likeliest goal.

        A step that loses another goal is left to the humans, unless they wait on and on.
        """
        savings = choices.costs[:, -1:] - choices.costs[:, :-1]
        worth: Floats = savings[likeliest_goal(self.moves, choices, weights, moment)]
        if moment.without_human >= PATIENCE * self.moves.n_turns:
            return worth
        loses = (choices.costs[:, :-1] >= OUT_OF_REACH) & (choices.costs[:, -1:] < OUT_OF_REACH)
        return np.where(weights @ loses > RISK, -OUT_OF_REACH, worth)

    def costs(self, world: int, moment: Moment, weights: Floats) -> Floats:
        """Return the expected cost of each step that a robot can do, and then of waiting.

        It is in timesteps until the goal is reached; actions count a little.

        See ``options`` for the arguments.
        """
        choices = self.moves.choices(world, moment)
        later = [self._after(world, moment, step, weights, False) for step in choices.options]
        return np.array(later)

    def _after(
        self, world: int, moment: Moment, step: int | None, weights: Floats, seen: bool
    ) -> float:
        """Return the expected cost of a step or wait; ``seen`` says whether a human has acted."""
        world, moment = self.moves.state_after(world, step), self.moves.after(moment, step)
        own = 0.0 if step is None else ACTION + float(self.extra[step])
        price = float(weights.sum()) * (1 + own)
        return price + self._from(world, moment, weights, seen)

    def _from(self, world: int, moment: Moment, weights: Floats, seen: bool) -> float:
        """Return the expected cost from a turn on."""
        choices = self.moves.choices(world, moment)
        if not self.moves.is_robot[moment.turn]:
            return self._answers(world, moment, choices, weights)
        expected = weights @ choices.costs
        if seen or not self.moves.has_humans:
            return float(expected.min())
        best = choices.options[int(expected.argmin())]
        return self._after(world, moment, best, weights, seen)

    def _answers(self, world: int, moment: Moment, choices: TeamChoices, weights: Floats) -> float:
        """Return the expected cost where a human acts, who does what its goal lets it do."""
        joint = choices.shares * weights[:, None]
        likely = np.flatnonzero(joint.sum(axis=0) > NEGLIGIBLE * weights.sum())
        cost = sum(
            self._after(world, moment, choices.options[place], joint[:, place], True)
            for place in likely.tolist()
        )
        rest = weights - joint[:, likely].sum(axis=1)
        return float(cost + rest.clip(0) @ choices.costs.min(axis=1))


def likeliest_goal(moves: TeamMoves, choices: TeamChoices, weights: Floats, moment: Moment) -> int:
    """Return the likeliest goal that is not reached or lost.

    Where no robot has acted for a round, it is the likeliest of those that a step helps.
    """
    least = choices.costs.min(axis=1)
    is_open = (least > 0) & (least < OUT_OF_REACH)
    if moment.without_robot >= moves.n_turns:
        helped = least < choices.costs[:, -1]
        is_open = helped if helped.any() else is_open
    return int(np.where(is_open, weights, -1.0).argmax())


def for_likeliest_goal(
    choice: StepChoice, moves: TeamMoves, world: int, moment: Moment, weights: Floats
) -> StepChoice:
    """Return the part of a choice that brings the likeliest goal nearer.

    Steps that are worth something for other goals could be done and undone for ever, because in a
    team they need not be progress. If the choice has no step for the goal, any of these will do.
    """
    choices = moves.choices(world, moment)
    nearer = choices.costs[:, :-1] < choices.costs[:, -1:]
    goal = likeliest_goal(moves, choices, weights, moment)
    steps = set(choices.steps[nearer[goal]].tolist())
    pairs = [pair for pair in zip(choice.steps, choice.values, strict=True) if pair[0] in steps]
    pairs = pairs or [(step, 0.0) for step in choices.next_steps(goal)]
    return StepChoice(tuple(s for s, _ in pairs), tuple(v for _, v in pairs), choice.wait)
