"""What simulated humans want and when, drawn at random from a seed."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from hrcplan.bank import Bank
from hrcplan.episodes.humans import Course
from hrcplan.episodes.own_goals import own_lengths
from hrcplan.errors import UsageError

SPREAD = 4  # further changes come within the time that a fraction of the goal's steps takes


@dataclass(frozen=True, slots=True)
class Habits:
    """How often a human changes its goal in an episode, errs in a turn, and waits in a turn."""

    changes: int = 0
    mistake_rate: float = 0.0
    wait_rate: float = 0.0


def draw_course(
    bank: Bank, seed: str, habits: Habits, pair: tuple[int, int] | None = None
) -> Course:
    """Return what the humans of a bank want and when.

    The first change comes before a turn of the human that is uniform among those before the first
    goal could be finished; each further one after up to a quarter of the turns that its goal takes.

    Args:
        bank: The plans.
        seed: All that is random follows from it, the human's choices of steps included.
        habits: How often goals change, and the rates of mistakes and waits.
        pair: The first goal and the second; by default they are drawn.
    """
    lengths = {goal: graph.n_steps for goal, graph in enumerate(bank.graphs)}
    return _course(lengths, random.Random(f"{seed}/course"), seed, habits, pair)


def draw_own_courses(bank: Bank, seed: str, habits: Habits) -> dict[str, Course]:
    """Return what each human wants and when, drawn from the goals that it can reach itself.

    The robots help it, the other humans do not. Changes come as in ``draw_course``.

    Raises:
        UsageError: if a human can reach fewer than two goals.
    """
    courses = dict[str, Course]()
    for who in bank.humans:
        lengths = own_goal_lengths(bank, who)
        n_agents = len(bank.team) or 2
        rounds = {goal: int(length) // n_agents for goal, length in lengths.items()}
        chance = random.Random(f"{seed}/{who}/course")
        courses[who] = _course(rounds, chance, f"{seed}/{who}", habits)
    return courses


def _course(
    lengths: Mapping[int, int], chance: random.Random, seed: str, habits: Habits,
    pair: tuple[int, int] | None = None,
) -> Course:  # fmt: skip
    can = list(lengths)
    goals, turns = [chance.choice(can) if pair is None else pair[0]], list[int]()
    for number in range(habits.changes):
        length = lengths[goals[-1]]
        most = (length - 1) // 2 if number == 0 else length // SPREAD
        if number == 0 and pair is not None:
            goals.append(pair[1])
        else:
            goals.append(chance.choice([goal for goal in can if goal != goals[-1]]))
        turns.append((turns[-1] if turns else 0) + chance.randint(1, max(1, most)))
    return Course(tuple(goals), tuple(turns), habits.mistake_rate, habits.wait_rate, seed)


@lru_cache(maxsize=16)
def own_goal_lengths(bank: Bank, human: str) -> dict[int, float]:
    """Return the timesteps to each goal that a human can reach without the other humans.

    Raises:
        UsageError: if there are fewer than two.
    """
    lengths = enumerate(own_lengths(bank.for_human(human)))
    can = {goal: length for goal, length in lengths if 0 < length < math.inf}
    if len(can) < 2:
        message = f"{human} can reach fewer than two goals without the other humans"
        hint = "let the humans share their goals: --goals-per team"
        raise UsageError(message, code="too-few-goals", hint=hint)
    return can
