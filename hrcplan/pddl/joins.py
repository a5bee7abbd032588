"""Bindings of an action's parameters that are supported by facts: joins over its conditions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from hrcplan.pddl.model import (
    Action,
    Atom,
    Domain,
    Equal,
    Fact,
    Not,
    Problem,
)
from hrcplan.pddl.walks import conjuncts, lifted_names

JoinBinding = dict[str, str]


class FactIndex:
    """Facts by predicate and by one argument; growing, never shrinking."""

    def __init__(self, facts: Iterable[Fact] = ()) -> None:
        self.facts: set[Fact] = set()
        self._by_argument: dict[tuple[str, int, str], list[Fact]] = defaultdict(list)
        self._by_name: dict[str, list[Fact]] = defaultdict(list)
        for fact in facts:
            self.add(fact)

    def add(self, fact: Fact) -> bool:
        """Take in a fact; return whether it is new."""
        if fact in self.facts:
            return False
        self.facts.add(fact)
        self._by_name[fact[0]].append(fact)
        for position, argument in enumerate(fact[1:]):
            self._by_argument[fact[0], position, argument].append(fact)
        return True

    def candidates(self, atom: Atom, binding: Mapping[str, str]) -> Sequence[Fact]:
        """Return a superset of the facts that match an atom under a binding: the smallest list."""
        best = self._by_name[atom.name]
        for position, term in enumerate(atom.args):
            value = binding.get(term) if term.startswith("?") else term
            if value is not None:
                matches = self._by_argument.get((atom.name, position, value), [])
                if len(matches) < len(best):
                    best = matches
        return best


class Join:
    """An action's parameters, and the atoms and equalities that its bindings must satisfy."""

    def __init__(self, action: Action, atoms: Sequence[Atom], problem: Problem) -> None:
        self.action = action
        self.atoms = tuple(atoms)
        self._equalities = list(_equalities(action))
        self._objects = {p.name: problem.objects_of(p.types) for p in action.params}
        self._domains = {name: frozenset(objects) for name, objects in self._objects.items()}

    def bindings(
        self, index: FactIndex, first: tuple[int, Fact] | None = None
    ) -> Iterator[JoinBinding]:
        """Yield every binding whose atoms are all in ``index``.

        With ``first = (i, fact)`` only those that match atom ``i`` with that fact.
        """
        if first is None:
            yield from self._extend({}, self.atoms, index)
            return
        position, fact = first
        binding = self._match(self.atoms[position], fact, {})
        if binding is not None:
            rest = self.atoms[:position] + self.atoms[position + 1 :]
            yield from self._extend(binding, rest, index)

    def _extend(
        self, binding: JoinBinding, atoms: tuple[Atom, ...], index: FactIndex
    ) -> Iterator[JoinBinding]:
        if not atoms:
            yield from self._free(binding)
            return
        options = [index.candidates(atom, binding) for atom in atoms]
        best = min(range(len(atoms)), key=lambda i: len(options[i]))
        rest = atoms[:best] + atoms[best + 1 :]
        for fact in options[best]:
            wider = self._match(atoms[best], fact, binding)
            if wider is not None:
                yield from self._extend(wider, rest, index)

    def _free(self, binding: JoinBinding) -> Iterator[JoinBinding]:
        missing = next((p.name for p in self.action.params if p.name not in binding), None)
        if missing is None:
            yield binding
            return
        pairs = [p for p in self._equalities if missing in p[:2]]
        for value in self._objects[missing]:
            wider = {**binding, missing: value}
            if all(_may_hold(pair, wider) for pair in pairs):
                yield from self._free(wider)

    def _match(self, atom: Atom, fact: Fact, binding: JoinBinding) -> JoinBinding | None:
        """Return the binding with the variables of an atom bound to a fact; None if it differs."""
        wider = binding
        for position, term in enumerate(atom.args, start=1):
            value = fact[position]
            bound_value = wider.get(term) if term[0] == "?" else term
            if bound_value is None:
                if value not in self._domains[term]:
                    return None
                if wider is binding:
                    wider = dict(binding)
                wider[term] = value
            elif bound_value != value:
                return None
        return wider


def _equalities(action: Action) -> Iterator[tuple[str, str, bool]]:
    """Yield the terms that an action compares, and whether they must be equal or differ."""
    for condition in action.conditions:
        for part in conjuncts(condition.formula):
            match part:
                case Equal(left, right):
                    yield left, right, True
                case Not(Equal(left, right)):
                    yield left, right, False


def _may_hold(pair: tuple[str, str, bool], binding: Mapping[str, str]) -> bool:
    """Return whether two terms compare as they must; True if one of them is not bound yet."""
    left, right = (binding.get(term, term) for term in pair[:2])
    unbound = left.startswith("?") or right.startswith("?")
    return unbound or (left == right) == pair[2]


def needed_atoms(action: Action, domain: Domain) -> tuple[Atom, ...]:
    """Return the atoms that must have been true before the action starts.

    What it needs later may come of its own start, or of other actions that this start allows.
    """
    early = _caused(action, domain)
    return tuple(
        part
        for condition in action.conditions
        for part in conjuncts(condition.formula)
        if isinstance(part, Atom) and (condition.when == "start" or part.name not in early)
    )


def _caused(action: Action, domain: Domain) -> set[str]:
    """Return the predicates of facts that may come of an action's start, while it runs."""
    names = {e.target.name for e in action.effects if e.kind == "add" and e.when == "start"}
    if not names or not action.durative:
        return names
    rules = [(set(_needed_names(other)), set(_added_names(other))) for other in domain.actions]
    size = 0
    while size < len(names):
        size = len(names)
        for needed, added in rules:
            if not names.isdisjoint(needed):
                names |= added
    return names


def _needed_names(action: Action) -> Iterator[str]:
    for condition in action.conditions:
        yield from lifted_names(condition.formula)
    for effect in action.effects:
        yield from lifted_names(effect.condition)
        yield from lifted_names(effect.start_condition)


def _added_names(action: Action) -> Iterator[str]:
    return (effect.target.name for effect in action.effects if effect.kind == "add")
