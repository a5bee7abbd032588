"""What an assistant has weighed: steps with values, and whom each step helps, in words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hrcplan.assistance.step_values import StepValues
from hrcplan.bank.progress import Progress
from hrcplan.core.arrays import Floats

WAIT = None
TIES = 9  # decimals of values: what differs by less is equally good


@dataclass(frozen=True, slots=True)
class StepChoice:
    """Steps that the robot could do, and how good each is; ``wait`` is how good it is to wait."""

    steps: tuple[int, ...] = ()
    values: tuple[float, ...] = ()
    wait: float = 0.0

    @property
    def best(self) -> int | None:
        """The best step, the first of equals; None if waiting is as good."""
        if not self.steps:
            return WAIT
        place = int(np.round(self.values, TIES).argmax())
        return self.steps[place] if round(self.values[place] - self.wait, TIES) > 0 else WAIT


@dataclass(frozen=True, slots=True)
class StepCandidate:
    """A step that the robot could do: its value, and the goals that it would help, likeliest first.

    ``saves`` is how many steps it is expected to save.
    """

    action: str
    value: float
    saves: float
    helps: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why an assistant does what it does: the goals it believes in, and what it could do."""

    goals: tuple[tuple[str, float], ...]
    chosen: str | None
    candidates: tuple[StepCandidate, ...]
    n_declared: int


def explanation_of(
    step_values: StepValues, progress: Progress, posterior: Floats, choice: StepChoice,
    n_declared: int, n_goals: int, n_steps: int,
) -> Explanation:  # fmt: skip
    """Return why the best step of a choice is the best.

    Args:
        step_values: Knows the goals' next steps.
        progress: Where the goals are.
        posterior: The probability of each goal.
        choice: The steps that were weighed.
        n_declared: How many changes of goal were declared.
        n_goals: The most goals to name.
        n_steps: The most candidates to name.
    """
    table, names = step_values.bank.table, step_values.bank.names

    def likeliest(goals: Iterable[int]) -> tuple[tuple[str, float], ...]:
        best_goals = sorted(goals, key=lambda goal: -posterior[goal])[:n_goals]
        return tuple((names[goal], float(posterior[goal])) for goal in best_goals)

    following = step_values.next_steps(progress)
    savings, _ = step_values.expected_saving(progress, following, choice.steps, posterior)
    order = sorted(range(len(choice.steps)), key=lambda i: -round(choice.values[i], TIES))
    candidates = tuple(
        StepCandidate(
            str(table[choice.steps[i]]),
            choice.values[i],
            float(savings[i]),
            likeliest(following.goals[following.steps == choice.steps[i]].tolist()),
        )
        for i in order[:n_steps]
    )
    best = None if choice.best is None else str(table[choice.best])
    return Explanation(likeliest(range(len(names))), best, candidates, n_declared)
