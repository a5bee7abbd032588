"""Random variants of given goals: other objects of the same types in their places.

Nothing is known here about any domain. A variant is kept if it can be reached, needs about as many
steps as the goals it was made from, and neither holds nor is held by the steps of another.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass, replace

from hrcplan.bank.goals import Goals
from hrcplan.errors import UsageError
from hrcplan.pddl.generate import objects_in, rename, with_copy
from hrcplan.pddl.model import Formula, Problem
from hrcplan.search.lm_cut import landmarks
from hrcplan.search.relevance import relevant
from hrcplan.task.steps import StepTable

MAX_SWAPS = 3  # objects of a goal that are replaced
MAX_TRIES = 200  # failed attempts in a row before there seem to be no more


@dataclass(frozen=True, slots=True)
class GoalShape:
    """How many steps a goal needs at least, and which may be among them, as bits."""

    n_steps: int
    steps: int


def vary(goals: Goals, n: int, seed: int, *, n_objects: int = 0) -> Goals:
    """Return ``n`` further goals in the same world, or in a larger one.

    Args:
        goals: The goals to start from; they are not among those returned.
        n: How many.
        seed: Same seed, same goals.
        n_objects: Objects to add first: copies of objects that goals mention.

    Raises:
        UsageError: if no more variants are found, or there is no object to copy.

    >>> from hrcplan.bank import read_goals
    >>> vary(read_goals("kitchen"), 2, seed=1).names
    ('variant-1', 'variant-2')
    """
    rng = random.Random(seed)
    world = _with_copies(goals, rng, n_objects)
    table = StepTable(replace(goals, problem=world).task)
    old = [shape for goal in goals.formulas if (shape := shape_of(table, goal)) is not None]
    if not old:
        raise UsageError("none of the goals can be reached", code="no-variants")
    low, high = min(s.n_steps for s in old), max(s.n_steps for s in old)
    step_sets, variants = [shape.steps for shape in old], list[Formula]()
    tries = 0
    for goal in _candidates(goals, world, rng):
        shape = shape_of(table, goal)
        if shape and low <= shape.n_steps <= high and is_new(shape.steps, step_sets):
            step_sets.append(shape.steps)
            variants.append(goal)
            tries = 0
        tries += 1
        if len(variants) == n:
            break
        if tries > MAX_TRIES:
            message = f"only {len(variants)} of {n} variants found"
            raise UsageError(message, code="no-variants", hint="add objects, or ask for fewer")
    names = tuple(f"variant-{i:0{len(str(n))}}" for i in range(1, n + 1))
    return Goals(replace(world, goal=variants[0], name=names[0]), names, tuple(variants))


def _with_copies(goals: Goals, rng: random.Random, n_objects: int) -> Problem:
    world = goals.problem
    terms = sorted({term for goal in goals.formulas for term in objects_in(goal)})
    names = [name for name in terms if name in world.objects]
    if n_objects and not names:
        raise UsageError("no goal mentions an object that can be copied", code="no-variants")
    for number in range(1, n_objects + 1):
        old = rng.choice(names)
        new = next(
            name for i in range(number, 10**9) if (name := f"{old}-{i}") not in world.all_objects
        )
        world = with_copy(world, old, new)
    return world


def _candidates(goals: Goals, world: Problem, rng: random.Random) -> Iterator[Formula]:
    types = world.all_objects
    by_type: dict[str, list[str]] = {}
    for name, kind in types.items():
        by_type.setdefault(kind, []).append(name)
    while True:
        goal = rng.choice(goals.formulas)
        inside = [name for name in objects_in(goal) if name in types]
        targets = rng.sample(inside, min(len(inside), rng.randint(1, MAX_SWAPS)))
        swaps: dict[str, str] = {}
        for name in targets:
            free = [o for o in by_type[types[name]] if o not in inside and o not in swaps.values()]
            if free:
                swaps[name] = rng.choice(free)
        yield rename(goal, swaps)


def shape_of(table: StepTable, goal: Formula) -> GoalShape | None:
    """Return the shape of a goal, or None if it cannot be reached or is reached from the start."""
    task = table.task.with_goal(goal)
    ops, _ = relevant(table.ops, task.goal)
    marks = landmarks(ops, task.initial, task.goal) if task.goal else None
    if not marks:
        return None
    steps = 0
    for mark in marks:
        for op in mark.ops:
            steps |= 1 << ops[op].step
    return GoalShape(sum(mark.cost for mark in marks), steps)


def is_new(steps: int, step_sets: list[int]) -> bool:
    """Return whether a set of steps neither holds nor is held by any of others."""
    return all(steps & other not in (steps, other) for other in step_sets)
