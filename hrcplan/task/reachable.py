"""Ground actions that relaxed reachability finds: deletes and negative conditions ignored."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator
from typing import NamedTuple

from hrcplan.errors import LimitError
from hrcplan.pddl.joins import Binding, FactIndex, Join, needed_atoms
from hrcplan.pddl.model import Action, Fact, Problem
from hrcplan.pddl.semantics import ground_key, instances

MAX_GROUND_ACTIONS = 200_000


class Instance(NamedTuple):
    """An action schema and the objects that its parameters are bound to."""

    action: Action
    args: tuple[str, ...]

    @property
    def binding(self) -> Binding:
        """Parameter names to objects."""
        return {p.name: arg for p, arg in zip(self.action.params, self.args, strict=True)}


def reachable(problem: Problem) -> tuple[list[Instance], set[Fact]]:
    """Return the reachable instances, by schema and then by objects, and the reachable facts.

    Every fact is taken in once and joined with those before it (semi-naive evaluation).

    Raises:
        LimitError: if there are more than ``MAX_GROUND_ACTIONS`` instances.
    """
    joins = [Join(action, needed_atoms(action), problem) for action in problem.domain.actions]
    users: dict[str, list[tuple[Join, int]]] = defaultdict(list)
    for join in joins:
        for position, atom in enumerate(join.atoms):
            users[atom.name].append((join, position))
    index = FactIndex()
    found: set[tuple[str, tuple[str, ...]]] = set()
    instances_: list[Instance] = []
    waiting: deque[Fact] = deque(sorted(problem.facts))

    def take(join: Join, bindings: Iterator[Binding]) -> None:
        for binding in bindings:
            args = tuple(binding[p.name] for p in join.action.params)
            if (join.action.name, args) not in found:
                found.add((join.action.name, args))
                instances_.append(Instance(join.action, args))
                waiting.extend(_added(join.action, binding, problem))
        if len(found) > MAX_GROUND_ACTIONS:
            message = f"the task has more than {MAX_GROUND_ACTIONS} ground actions"
            raise LimitError(message, hint="use a planner that does not need them: enhsp, kairos")

    for join in joins:
        if not join.atoms:
            take(join, join.bindings(index))
    while waiting:
        fact = waiting.popleft()
        if index.add(fact):
            for join, position in users[fact[0]]:
                take(join, join.bindings(index, (position, fact)))
    order = {action.name: i for i, action in enumerate(problem.domain.actions)}
    rank = {name: i for i, name in enumerate(problem.all_objects)}
    instances_.sort(key=lambda i: (order[i.action.name], [rank[arg] for arg in i.args]))
    return instances_, index.facts


def _added(action: Action, binding: Binding, problem: Problem) -> Iterator[Fact]:
    for effect in action.effects:
        if effect.kind == "add":
            for inner in instances(effect.params, binding, problem):
                yield ground_key(effect.target, inner)
