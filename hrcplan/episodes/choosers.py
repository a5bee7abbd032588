"""Simulated humans whose choice of steps differs from what beliefs assume.

They work in any domain, also where a team takes turns. Like every human of ``humans.py`` they draw
all that is random from their `Course`, and remember nothing between turns.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache

from hrcplan.bank import Bank
from hrcplan.bank.team_moves import Moment
from hrcplan.episodes.humans import Course, Draw, Frontier, HumanMove

LONGEST_INERTIA = 3  # turns that a human goes on with its old goal at most
BETAS = 3.0, 7.0  # of a noisy-rational human: the lowest and the highest inverse temperature
_TRIES = 16  # steps that a noisy-rational human considers before it takes the best one


class Habit(Frontier):
    """A human with an order of its own among all steps: of the next ones it does the first.

    The order is random, belongs to the human, and is the same for every goal.
    """

    def prefer(self, steps: Sequence[int], last: int | None, draw: Draw) -> int:
        """Return the step that comes first in the human's order."""
        labels = self.bank.table.labels
        order = _order(self.course.seed, self.bank.table.n_labels)
        return min(steps, key=lambda step: (order[labels[step]], step))


class Inertia(Frontier):
    """A human who goes on with its old goal for one to three turns after a change.

    If nothing is left to do for the old goal, it turns to the new one at once.
    """

    def __init__(self, bank: Bank, course: Course) -> None:
        super().__init__(bank, course)
        self._present = course
        chance = random.Random(f"{course.seed}/inertia")
        turns = [turn + chance.randint(1, LONGEST_INERTIA) for turn in course.turns]
        rising = tuple(max(turns[: place + 1]) for place in range(len(turns)))
        self._late = replace(course, turns=rising)

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return what the human does in a turn, in a state, after its own last step."""
        self.course = self._followed(turn, world)
        return super().move(turn, world, last)

    def move_in_turn(self, turn: int, world: int, last: int | None, moment: Moment) -> HumanMove:
        """Return what the human does whose turn it is."""
        self.course = self._followed(turn, world)
        return super().move_in_turn(turn, world, last, moment)

    def _followed(self, turn: int, world: int) -> Course:
        is_over = self.bank.goals.is_reached(self._late.goal(turn), world)
        return self._present if is_over else self._late


class GeneralFirst(Frontier):
    """A human who does first what most goals need, so that its goal shows late."""

    sign = -1

    def prefer(self, steps: Sequence[int], last: int | None, draw: Draw) -> int:
        """Return one of the steps that most goals need, or fewest; equals are alike."""
        goals = _generality(self.bank)
        key = [self.sign * goals[self.bank.table.labels[step]] for step in steps]
        best = [step for step, value in zip(steps, key, strict=True) if value == min(key)]
        return super().prefer(best, last, draw)


class SpecialFirst(GeneralFirst):
    """A human who does first what fewest goals need, so that its goal shows early."""

    sign = 1


class NoisyRational(Frontier):
    """A human who takes any step that it can do, the rarer the more it loses.

    A step that brings the goal ``r`` timesteps less far than the best one has weight exp(-beta r),
    so that steps that lose nothing are alike; ``beta`` is drawn for each human between 3 and 7. A
    step that loses the goal is never taken. The mistakes of the course come on top.
    """

    def __init__(self, bank: Bank, course: Course) -> None:
        super().__init__(bank, course)
        self.beta = random.Random(f"{course.seed}/beta").uniform(*BETAS)

    def move(self, turn: int, world: int, last: int | None) -> HumanMove:
        """Return what the human does in a turn, in a state, after its own last step."""
        planned = super().move(turn, world, last)
        if self._moves is not None or planned.step is None or planned.is_mistake:
            return planned
        goal, draws = self.course.goal(turn), random.Random(f"{self.course.seed}/{turn}/noise")
        steps = self._able(world, self.bank.table.applicable(world))
        useful = set(self._next_steps(goal, world))
        weights = [1.0 if step in useful else math.exp(-self.beta) for step in steps]
        for step in draws.choices(steps, weights, k=_TRIES):
            if step in useful:
                return HumanMove(step)
            more = self._regret(goal, world, step) - 1  # one timestep is in the weight already
            if draws.random() < math.exp(-self.beta * more):
                return HumanMove(step, is_mistake=True)
        return planned

    def move_in_turn(self, turn: int, world: int, last: int | None, moment: Moment) -> HumanMove:
        """Return what the human does whose turn it is."""
        planned = super().move_in_turn(turn, world, last, moment)
        if self._moves is None or planned.is_mistake:
            return planned
        goal, choices = self.course.goal(turn), self._moves.choices(world, moment)
        next_steps = choices.next_steps(goal)
        if planned.step is None and next_steps:  # it waits by choice
            return planned
        useful: set[int | None] = {*next_steps} or {None}
        savings = [0.0, *choices.savings[goal].tolist()]
        options: list[int | None] = [None, *choices.steps.tolist()]
        best = max((s for s in savings if not math.isnan(s)), default=0.0)
        weights = [
            1.0 if step in useful else math.exp(-self.beta * max(1.0, best - value))
            for step, value in zip(options, (_number(s) for s in savings), strict=True)
        ]
        draws = random.Random(f"{self.course.seed}/{turn}/{moment.turn}/noise")
        step = draws.choices(options, weights)[0]
        return HumanMove(step, is_mistake=step is not None and step not in useful)

    def _next_steps(self, goal: int, world: int) -> Iterable[int]:
        graph, node = self.bank.locate(goal, world)
        return () if node is None else graph.next(node)

    def _regret(self, goal: int, world: int, step: int) -> float:
        """Return how many timesteps a step loses that no plan has next; infinite with the goal."""
        after = self.bank.table.successor(world, step)
        graph, node = self.bank.locate(goal, world)
        later, place = self.bank.locate(goal, world if after is None else after)
        if node is None or place is None:
            return math.inf
        return 1.0 + float(later.steps_left[place]) - float(graph.steps_left[node])


def _number(saving: float) -> float:
    return -math.inf if math.isnan(saving) else saving


@lru_cache(maxsize=64)
def _order(seed: str, n_labels: int) -> tuple[int, ...]:
    """Return the place of each label in a human's order."""
    places = list(range(n_labels))
    random.Random(f"{seed}/habit").shuffle(places)
    return tuple(places)


@lru_cache(maxsize=4)
def _generality(bank: Bank) -> tuple[int, ...]:
    """Return for each label how many goals have it in their plans."""
    goals = [0] * bank.table.n_labels
    for graph in bank.graphs:
        for label in {bank.table.labels[step] for step in graph.used_steps}:
            goals[label] += 1
    return tuple(goals)
