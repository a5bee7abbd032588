"""Ground actions that relaxed reachability finds.

Deletes are ignored. Of the conditions, facts must be reachable, and what no action can change must
hold; all others (negations, alternatives, numbers that change) are taken to be possible.
"""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import chain, product
from math import inf, prod

from hrcplan.core.progress import counting
from hrcplan.core.records import record, replace
from hrcplan.errors import LimitError
from hrcplan.pddl.joins import FactIndex, Join, JoinBinding, needed_atoms
from hrcplan.pddl.model import (
    DURATION,
    Action,
    And,
    Atom,
    Condition,
    Domain,
    Effect,
    Equal,
    Fact,
    Formula,
    Not,
    Or,
    Problem,
)
from hrcplan.pddl.rows import LiteralRows, Row, RowKey
from hrcplan.pddl.semantics import LiftedState, holds, instances
from hrcplan.pddl.walks import conjuncts, lifted_names

MIN_FREE_BYTES = 512 << 20
"""What grounding leaves to others: with less memory free it gives up."""
MAX_ALTERNATIVES = 64
"""Joins of one schema: where its static disjunctions give more, they are looked at last."""
_MOST_ADDED = 4096  # facts that effects add between two looks at the clock
_CHECK = 256  # bindings between two looks at the clock
_CHECK_MEMORY = 4096
NO_GROUNDING = "use a planner that does not need them: enhsp, kairos"


@record
class SchemaInstance:
    """An action schema, and the objects that its parameters are bound to."""

    action: Action
    args: Row

    @cached_property
    def binding(self) -> JoinBinding:
        """The objects by parameter."""
        return {param.name: arg for param, arg in zip(self.action.params, self.args, strict=True)}


def reachable(problem: Problem, deadline: float = inf) -> tuple[list[SchemaInstance], set[Fact]]:
    """Return the reachable instances, by schema and then by objects, and the reachable facts.

    Facts that no action adds are there from the beginning; all others are taken in once, in groups
    of one predicate, and joined with those before them (semi-naive evaluation).

    Raises:
        LimitError: at the deadline, or if memory becomes short.
    """
    with counting("reachable ground actions") as tell:
        search = _ReachabilitySearch(problem, deadline, tell)
        search.run()
    rank = {name: i for i, name in enumerate(problem.all_objects)}
    schema_instances = [
        SchemaInstance(rule.action, args)
        for rule in search.rules
        for args in sorted(rule.instances, key=lambda args: [rank[arg] for arg in args])
    ]
    return schema_instances, search.index.facts


def available_bytes() -> int:
    """Return how much memory new data may take without swapping, as Linux estimates it."""
    with open("/proc/meminfo", encoding="ascii") as lines:
        for line in lines:
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) << 10
    return MIN_FREE_BYTES


class _ReachabilitySearch:
    """The reachable facts and instances so far, and the facts that wait to be joined."""

    def __init__(self, problem: Problem, deadline: float, tell: Callable[[int], None]) -> None:
        self._deadline = deadline
        self._n_added = 0
        self._tell = tell
        self._n_bindings = self._n_instances = 0
        self.rules = [_ReachabilityRule(action, problem) for action in problem.domain.actions]
        # By predicate, and by the place and name of an object that the atom wants, if any:
        # where every schema names its own objects, few of them are asked about a fact.
        self._users: dict[str, dict[tuple[int, str], list[_User]]] = defaultdict(dict)
        self._addable = {add.name for rule in self.rules for add in rule.adds}
        for rule, join in self._joins():
            for position, atom in enumerate(join.atoms):
                if atom.name in self._addable:
                    key = _wanted_object(atom)
                    self._users[atom.name].setdefault(key, []).append((rule, join, position))
        self.index = FactIndex(fact for fact in problem.facts if fact[0] not in self._addable)
        self._facts = set(problem.facts)  # also those that wait
        self._waiting: dict[str, list[Fact]] = {}
        for fact in problem.facts:
            if fact[0] in self._addable:
                self._waiting.setdefault(fact[0], []).append(fact)

    def run(self) -> None:
        for rule, join in self._joins():
            if self._addable.isdisjoint(atom.name for atom in join.atoms):
                self._take(rule, join.rows(self.index, look=self._look))
        while self._waiting:
            name = next(iter(self._waiting))
            facts = self._waiting.pop(name)
            self.index.add(facts)
            users = self._users[name]
            for place in {place for place, _ in users}:
                groups: dict[str, list[Fact]] = defaultdict(list)
                for fact in facts:
                    groups[fact[place]].append(fact)
                for value, group in groups.items():
                    for rule, join, position in users.get((place, value), ()):
                        self._take(rule, join.rows(self.index, position, group, self._look))

    def _joins(self) -> Iterator[tuple[_ReachabilityRule, Join]]:
        return ((rule, join) for rule in self.rules for join in rule.joins)

    def _take(self, rule: _ReachabilityRule, rows: Iterator[Row]) -> None:
        for args in rows:
            self._n_bindings += 1
            if self._n_bindings % _CHECK == 0:
                self._check()
            if self._n_added > _MOST_ADDED:  # effects for all objects
                self._n_added = 0
                self._look()
            if args in rule.instances or not rule.can_hold(args):
                continue
            rule.instances.add(args)
            self._n_instances += 1
            for add in rule.adds:
                added = add.of(args)
                self._n_added += len(added)
                for fact in added:
                    if fact not in self._facts:
                        self._facts.add(fact)
                        self._waiting.setdefault(fact[0], []).append(fact)

    def _check(self) -> None:
        self._tell(self._n_instances)
        self._look()
        if self._n_bindings % _CHECK_MEMORY == 0 and available_bytes() < MIN_FREE_BYTES:
            message = f"no memory for more than {self._n_instances} ground actions"
            raise LimitError(message, hint=NO_GROUNDING)

    def _look(self) -> None:
        if time.monotonic() > self._deadline:
            message = f"no time for more than {self._n_instances} ground actions"
            raise LimitError(message, hint=NO_GROUNDING)


class _ReachabilityRule:
    """One schema as a rule: what it needs, what is decided once for all, and what it adds."""

    def __init__(self, action: Action, problem: Problem) -> None:
        self.action = action
        self.instances: set[Row] = set()
        self.adds = [
            EffectFacts(action, effect, problem)
            for effect in action.effects
            if effect.kind == "add"
        ]
        self._static_parts = tuple(_static_parts(action, problem.domain))
        self._names = [param.name for param in action.params]
        self.joins = [
            Join(one, needed_atoms(one, problem.domain), problem)
            for one in _alternatives(action, self._static_parts)
        ]
        self._start = LiftedState(problem.facts, problem.values)
        self._problem = problem

    def can_hold(self, args: Row) -> bool:
        """Return whether what no action can change holds for these objects."""
        if not self._static_parts:
            return True
        binding = dict(zip(self._names, args, strict=True))
        start, problem = self._start, self._problem
        return all(holds(part, start, binding, problem) for part in self._static_parts)


_User = tuple[_ReachabilityRule, Join, int]
"""A rule, one of its joins, and the position of an atom there."""


def _wanted_object(atom: Atom) -> tuple[int, str]:
    """Return the first place of an atom with an object, and the object; else its predicate."""
    places = enumerate((atom.name, *atom.args))
    return next(((i, term) for i, term in places if i and term[0] != "?"), (0, atom.name))


class EffectFacts:
    """The facts of an effect that adds or deletes: one, or one for each choice of its variables.

    >>> from hrcplan import read
    >>> problem = read("transport", "two-boxes")
    >>> move = problem.domain.action("move")
    >>> EffectFacts(move, move.effects[1], problem).of(("robot", "wp0", "wp1"))
    [('at', 'robot', 'wp0')]
    """

    def __init__(self, action: Action, effect: Effect, problem: Problem) -> None:
        self.name = effect.target.name
        self._params, self._problem = effect.params, problem
        self._rows = LiteralRows([param.name for param in (*action.params, *effect.params)])
        self._key: RowKey = self._rows.key(self.name, effect.target.args)

    def of(self, args: Row) -> list[Fact]:
        """Return the facts of an instance, by the objects of its action."""
        key, of = self._key, self._rows.of
        if not self._params:
            return [key(of(args))]
        choices = instances(self._params, {}, self._problem)
        return [key(of((*args, *choice.values()))) for choice in choices]


def _alternatives(action: Action, static_parts: Sequence[Formula]) -> Iterator[Action]:
    """Yield an action for each choice of what holds of its static disjunctions.

    So these take part in joins: whole, they could only be looked at once all objects are chosen.
    Where there are too many choices, that is done.
    """
    options = [_cases(part) for part in static_parts if isinstance(part, Or)]
    if prod(map(len, options)) > MAX_ALTERNATIVES:
        options = []
    for choice in product(*options):
        cases = tuple(Condition("start", And(case)) for case in choice)
        yield replace(action, conditions=(*action.conditions, *cases)) if cases else action


def _cases(formula: Formula) -> list[tuple[Formula, ...]]:
    """Return conjunctions of which one holds where the formula does."""
    match formula:
        case Or(parts):
            return [case for part in parts for case in _cases(part)]
        case And(parts):
            options = [_cases(part) for part in parts]
            if prod(map(len, options)) <= MAX_ALTERNATIVES:
                return [tuple(chain(*choice)) for choice in product(*options)]
    return [(formula,)]


def _static_parts(action: Action, domain: Domain) -> Iterator[Formula]:
    """Yield the parts of an action's conditions that no action can change, apart from plain facts.

    Equalities of terms are not among them: joins see to these.
    """
    changing = {effect.target.name for other in domain.actions for effect in other.effects}
    changing.add(DURATION)
    for condition in action.conditions:
        for part in conjuncts(condition.formula):
            match part:
                case Atom() | Equal() | Not(Equal()):
                    continue
            if changing.isdisjoint(lifted_names(part)):
                yield part
