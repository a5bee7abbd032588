"""Random goals of a world: facts that hold together after random walks of all agents.

Nothing is known here about any domain. A goal can be reached, because a walk did; it needs some
steps, and the steps of none hold those of another.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, replace

from hrcplan.bank.goals import Goals
from hrcplan.bank.variants import is_new, shape_of
from hrcplan.errors import UsageError
from hrcplan.pddl.model import And, Atom, Formula, Problem
from hrcplan.task import Task
from hrcplan.task.steps import StepTable

MAX_TRIES = 2000  # walks, after which there seem to be no more goals


@dataclass(frozen=True, slots=True)
class GoalRules:
    """What goals are drawn.

    Attributes:
        predicates: Those of the facts of a goal.
        n_facts: The most facts of a goal; it has one at least.
        least_steps: How many steps a goal needs at least, by the cost of its landmarks.
        most_steps: The steps of the longest walk.
    """

    predicates: frozenset[str]
    n_facts: int = 2
    least_steps: int = 4
    most_steps: int = 60


def walked_goals(problem: Problem, rules: GoalRules, n: int, seed: int) -> Goals:
    """Return ``n`` goals in the world of a problem, whose own goal plays no part.

    Args:
        problem: The world.
        rules: What goals are drawn.
        n: How many.
        seed: Same seed, same goals.

    Raises:
        UsageError: if no more goals are found.
    """
    rng = random.Random(seed)
    table = StepTable(Task(problem))
    goals: list[Formula] = []
    step_sets: list[int] = []
    for goal in _candidates(table.task, rules, rng):
        shape = shape_of(table, goal)
        if shape and shape.n_steps >= rules.least_steps and is_new(shape.steps, step_sets):
            step_sets.append(shape.steps)
            goals.append(goal)
        if len(goals) == n:
            break
    else:
        message = f"only {len(goals)} of {n} goals found"
        raise UsageError(message, code="no-goals", hint="ask for fewer goals, or other predicates")
    names = tuple(f"goal-{i:0{len(str(n))}}" for i in range(1, n + 1))
    return Goals(replace(problem, goal=goals[0], name=names[0]), names, tuple(goals))


def _candidates(task: Task, rules: GoalRules, rng: random.Random) -> Iterator[Formula]:
    """Yield goals: facts that are so after a walk, and were not so before it."""
    before = task.facts_of(task.initial)
    for _ in range(MAX_TRIES):
        state = task.initial
        for _ in range(rng.randint(1, rules.most_steps)):
            state = task.successor(state, rng.choice(task.applicable(state)))
        facts = sorted(f for f in task.facts_of(state) - before if f[0] in rules.predicates)
        if facts:
            wanted = rng.sample(facts, min(len(facts), rng.randint(1, rules.n_facts)))
            yield And(tuple(Atom(name, tuple(args)) for name, *args in sorted(wanted)))
