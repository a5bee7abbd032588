"""Ground actions that relaxed reachability finds.

Deletes are ignored. Of the conditions, facts must be reachable, and what no action can change must
hold; all others (negations, alternatives, numbers that change) are taken to be possible.
"""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from math import inf
from pathlib import Path
from typing import NamedTuple

from hrcplan.core.progress import counting
from hrcplan.errors import LimitError
from hrcplan.pddl.joins import FactIndex, Join, JoinBinding, needed_atoms
from hrcplan.pddl.model import DURATION, Action, Atom, Domain, Fact, Formula, Problem
from hrcplan.pddl.semantics import LiftedState, ground_key, holds, instances
from hrcplan.pddl.walks import conjuncts, lifted_names

MIN_FREE_BYTES = 512 << 20
"""What grounding leaves to others: with less memory free it gives up."""
_CHECK = 256  # bindings between two looks at the clock
_CHECK_MEMORY = 4096
_HINT = "use a planner that does not need them: enhsp, kairos"


class SchemaInstance(NamedTuple):
    """An action schema, and the objects that its parameters are bound to."""

    action: Action
    args: tuple[str, ...]
    binding: JoinBinding


def reachable(problem: Problem, deadline: float = inf) -> tuple[list[SchemaInstance], set[Fact]]:
    """Return the reachable instances, by schema and then by objects, and the reachable facts.

    Facts that no action adds are there from the beginning; every other one is taken in once and
    joined with those before it (semi-naive evaluation).

    Raises:
        LimitError: at the deadline, or if memory becomes short.
    """
    with counting("reachable ground actions") as tell:
        search = _ReachabilitySearch(problem, deadline, tell)
        search.run()
    order = {action.name: i for i, action in enumerate(problem.domain.actions)}
    rank = {name: i for i, name in enumerate(problem.all_objects)}
    instances = list(search.instances.values())
    instances.sort(key=lambda i: (order[i.action.name], [rank[arg] for arg in i.args]))
    return instances, search.index.facts


def available_bytes() -> int:
    """Return how much memory new data may take without swapping, as Linux estimates it."""
    for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) << 10
    return MIN_FREE_BYTES


class _ReachabilitySearch:
    """The reachable facts and instances so far, and the facts that wait to be joined."""

    def __init__(self, problem: Problem, deadline: float, tell: Callable[[int], None]) -> None:
        self.problem = problem
        self.deadline = deadline
        self._tell = tell
        self.index = FactIndex()
        self.instances: dict[tuple[str, tuple[str, ...]], SchemaInstance] = {}
        self._n_bindings = 0
        self._start = LiftedState(problem.facts, problem.values)
        self._rules = [_ReachabilityRule(action, problem) for action in problem.domain.actions]
        self._users: dict[str, list[tuple[_ReachabilityRule, int]]] = defaultdict(list)
        self._addable = {atom.name for rule in self._rules for _, atom in rule.adds}
        for rule in self._rules:
            for position, atom in enumerate(rule.join.atoms):
                if atom.name in self._addable:
                    self._users[atom.name].append((rule, position))
        facts = sorted(problem.facts)
        self._waiting = deque(fact for fact in facts if fact[0] in self._addable)
        for fact in facts:
            if fact[0] not in self._addable:
                self.index.add(fact)

    def run(self) -> None:
        for rule in self._rules:
            if self._addable.isdisjoint(atom.name for atom in rule.join.atoms):
                self._take(rule, rule.join.bindings(self.index))
        while self._waiting:
            fact = self._waiting.popleft()
            if self.index.add(fact):
                for rule, position in self._users[fact[0]]:
                    self._take(rule, rule.join.bindings(self.index, (position, fact)))

    def _take(self, rule: _ReachabilityRule, bindings: Iterator[JoinBinding]) -> None:
        for binding in bindings:
            self._n_bindings += 1
            self._check()
            args = tuple([binding[name] for name in rule.names])
            key = rule.action.name, args
            if key in self.instances or not self._can_hold(rule.static_parts, binding):
                continue
            self.instances[key] = SchemaInstance(rule.action, args, binding)
            for params, atom in rule.adds:
                for inner in instances(params, binding, self.problem):
                    self._waiting.append(ground_key(atom, inner))

    def _check(self) -> None:
        n_instances = len(self.instances)
        if self._n_bindings % _CHECK == 0:
            self._tell(n_instances)
            if time.monotonic() > self.deadline:
                raise LimitError(f"no time for more than {n_instances} ground actions", hint=_HINT)
        if self._n_bindings % _CHECK_MEMORY == 0 and available_bytes() < MIN_FREE_BYTES:
            message = f"no memory for more than {n_instances} ground actions"
            raise LimitError(message, hint=_HINT)

    def _can_hold(self, parts: tuple[Formula, ...], binding: JoinBinding) -> bool:
        return all(holds(part, self._start, binding, self.problem) for part in parts)


class _ReachabilityRule:
    """One schema as a rule: what it needs, what is decided once for all, and what it adds."""

    def __init__(self, action: Action, problem: Problem) -> None:
        self.action = action
        self.names = [param.name for param in action.params]
        self.join = Join(action, needed_atoms(action, problem.domain), problem)
        self.static_parts = tuple(_static_parts(action, problem.domain))
        self.adds = [
            (effect.params, effect.target)
            for effect in action.effects
            if effect.kind == "add" and isinstance(effect.target, Atom)
        ]


def _static_parts(action: Action, domain: Domain) -> Iterator[Formula]:
    """Yield the parts of an action's conditions that no action can change, but for plain facts."""
    changing = {effect.target.name for other in domain.actions for effect in other.effects}
    changing.add(DURATION)
    for condition in action.conditions:
        for part in conjuncts(condition.formula):
            if not isinstance(part, Atom) and changing.isdisjoint(lifted_names(part)):
                yield part
