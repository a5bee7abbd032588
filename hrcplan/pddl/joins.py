"""Bindings of an action's parameters that are supported by facts: joins over its conditions.

Rows of objects grow atom by atom. What an atom adds to a row is one look-up in a table of its
facts, by the values that the row has already. Atoms with few matches come first.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from operator import itemgetter

from hrcplan.core.records import record
from hrcplan.pddl.model import (
    Action,
    Atom,
    Domain,
    Equal,
    Fact,
    Not,
    Problem,
)
from hrcplan.pddl.rows import Row, RowKey, picker
from hrcplan.pddl.walks import conjuncts, lifted_names

JoinBinding = dict[str, str]
_Key = Callable[[Row], Row | str]
_Table = Mapping[Row | str, Sequence[Row]]
_LOOK = 1024  # rows of a step between two looks at the clock


@record
class _Pattern:
    """Facts of a predicate as a table: by the values at some places, what is at others.

    ``same`` are places that hold equal values; ``domains`` are the objects that may be at the
    ``free`` places.
    """

    name: str
    bound: tuple[int, ...]
    free: tuple[int, ...]
    same: tuple[tuple[int, int], ...]
    domains: tuple[Set[str], ...]

    def table(self, facts: Iterable[Fact]) -> dict[Row | str, list[Row]]:
        """Return the table of facts of this predicate."""
        table: dict[Row | str, list[Row]] = {}
        self.fill(table, facts)
        return table

    def fill(self, table: dict[Row | str, list[Row]], facts: Iterable[Fact]) -> None:
        """Add facts of this predicate to its table."""
        key, rest = _key(self.bound), picker(self.free)
        for fact in facts:
            if all(fact[one] == fact[other] for one, other in self.same):
                new = rest(fact)
                if all(map(_is_in, new, self.domains)):
                    table.setdefault(key(fact), []).append(new)


def _is_in(value: str, domain: Set[str]) -> bool:
    return value in domain


def _key(places: Sequence[int]) -> _Key:
    """Return what makes the key of a table from a fact, or from a row."""
    return itemgetter(*places) if places else picker(())


class FactIndex:
    """Facts by predicate, and in the tables that joins ask for; growing, never shrinking."""

    def __init__(self, facts: Iterable[Fact] = ()) -> None:
        self.facts: set[Fact] = set()
        self._by_name: dict[str, list[Fact]] = defaultdict(list)
        self._tables: dict[str, dict[_Pattern, dict[Row | str, list[Row]]]] = defaultdict(dict)
        self._spreads: dict[tuple[str, int], tuple[int, int]] = {}
        for fact in facts:
            self.facts.add(fact)
            self._by_name[fact[0]].append(fact)

    def add(self, facts: Sequence[Fact]) -> None:
        """Take in new facts of one predicate."""
        name = facts[0][0]
        self.facts.update(facts)
        self._by_name[name] += facts
        for pattern, table in self._tables[name].items():
            pattern.fill(table, facts)

    def table(self, pattern: _Pattern) -> _Table:
        """Return the facts of a predicate as a table that grows with the index."""
        tables = self._tables[pattern.name]
        if pattern not in tables:
            tables[pattern] = pattern.table(self._by_name[pattern.name])
        return tables[pattern]

    def size(self, name: str) -> int:
        """Return how many facts of a predicate there are."""
        return len(self._by_name[name])

    def spread(self, name: str, place: int) -> int:
        """Return about how many different values facts of a predicate have at a place."""
        facts = self._by_name[name]
        size, spread = self._spreads.get((name, place), (0, 1))
        if size.bit_length() != len(facts).bit_length():
            spread = len({fact[place] for fact in facts})
            self._spreads[name, place] = len(facts), spread
        return spread


@record
class _Step:
    """What makes rows longer: a table of facts by a key of the row, or the objects of a type.

    Of the new rows those stay whose ``pairs`` of places are equal, or not.
    """

    pattern: _Pattern | None
    objects: _Table
    key: _Key
    pairs: tuple[tuple[int, int, bool], ...]


@record
class _Plan:
    """The order in which the atoms of a join are taken, and where its parameters are then."""

    steps: tuple[_Step, ...]
    args: RowKey


class Join:
    """An action's parameters, and the atoms and equalities that its bindings must satisfy."""

    def __init__(self, action: Action, atoms: Sequence[Atom], problem: Problem) -> None:
        self.action = action
        self.atoms = tuple(atoms)
        self.names = [param.name for param in action.params]
        self._types = {param.name: param.types for param in action.params}
        self._problem = problem
        self._pairs = list(_equalities(action))
        terms = [term for atom in atoms for term in atom.args]
        terms += [term for pair in self._pairs for term in pair[:2]]
        self._constants = tuple(dict.fromkeys(t for t in terms if t not in self._types))
        self._plans: dict[tuple[int, ...], _Plan] = {}

    def bindings(
        self, index: FactIndex, first: tuple[int, Fact] | None = None
    ) -> Iterator[JoinBinding]:
        """Yield every binding whose atoms are all in ``index``.

        With ``first = (i, fact)`` only those that match atom ``i`` with that fact.
        """
        position, facts = (-1, ()) if first is None else (first[0], first[1:])
        for args in self.rows(index, position, facts):
            yield dict(zip(self.names, args, strict=True))

    def rows(
        self,
        index: FactIndex,
        position: int = -1,
        facts: Sequence[Fact] = (),
        look: Callable[[], None] = lambda: None,
    ) -> Iterator[Row]:
        """Yield the objects of every binding whose atoms are all in ``index``.

        With a position only those that match the atom there with one of ``facts``. ``look`` is
        called every now and then.
        """
        plan = self._plan(index, position)
        rows: Iterator[Row] = iter([self._constants])
        for number, step in enumerate(plan.steps):
            table = step.objects
            if step.pattern is not None:
                own = number == 0 and position >= 0
                table = step.pattern.table(facts) if own else index.table(step.pattern)
            rows = _longer(rows, table, step.key, look)
            for one, other, equal in step.pairs:
                rows = _compared(rows, one, other, equal)
        return map(plan.args, rows)

    def _plan(self, index: FactIndex, position: int) -> _Plan:
        """Return the plan for an atom to begin with, another one whenever facts are doubled."""
        sizes = [index.size(atom.name).bit_length() for atom in self.atoms]
        key = (position, *sizes)
        if key not in self._plans:
            self._plans[key] = self._new_plan(index, position)
        return self._plans[key]

    def _new_plan(self, index: FactIndex, position: int) -> _Plan:
        places = {name: place for place, name in enumerate(self._constants)}
        pairs = list(self._pairs)
        steps = [_Step(None, {(): [()]}, picker(()), _ready(pairs, places))]
        rest = list(self.atoms)
        if position >= 0:
            steps = [self._step(rest.pop(position), places, pairs)]
        while rest:
            counts = [_matches(index, atom, places) for atom in rest]
            steps.append(self._step(rest.pop(counts.index(min(counts))), places, pairs))
        for name in self.names:
            if name not in places:
                objects = [(o,) for o in self._problem.objects_of(self._types[name])]
                places[name] = len(places)
                steps.append(_Step(None, {(): objects}, picker(()), _ready(pairs, places)))
        return _Plan(tuple(steps), picker([places[name] for name in self.names]))

    def _step(
        self, atom: Atom, places: dict[str, int], pairs: list[tuple[str, str, bool]]
    ) -> _Step:
        """Return the step of an atom; its new variables get places, ready pairs are taken out."""
        bound = {i: places[term] for i, term in enumerate(atom.args, 1) if term in places}
        free: dict[str, int] = {}
        same = list[tuple[int, int]]()
        for i, term in enumerate(atom.args, 1):
            if i not in bound:
                if term in free:
                    same.append((free[term], i))
                free.setdefault(term, i)
        domains = tuple(self._problem.object_set(self._types[term]) for term in free)
        for term in free:
            places[term] = len(places)
        pattern = _Pattern(atom.name, tuple(bound), tuple(free.values()), tuple(same), domains)
        return _Step(pattern, {}, _key(list(bound.values())), _ready(pairs, places))


def _longer(
    rows: Iterator[Row], table: _Table, key: _Key, look: Callable[[], None]
) -> Iterator[Row]:
    for count, row in enumerate(rows):
        if count % _LOOK == _LOOK - 1:
            look()
        for new in table.get(key(row), ()):
            yield row + new


def _compared(rows: Iterator[Row], one: int, other: int, equal: bool) -> Iterator[Row]:
    return (row for row in rows if (row[one] == row[other]) is equal)


def _matches(index: FactIndex, atom: Atom, places: Mapping[str, int]) -> float:
    """Return about how many facts match an atom whose terms with places are bound."""
    count: float = index.size(atom.name)
    for i, term in enumerate(atom.args, 1):
        if count and term in places:
            count /= index.spread(atom.name, i)
    return count


def _ready(
    pairs: list[tuple[str, str, bool]], places: Mapping[str, int]
) -> tuple[tuple[int, int, bool], ...]:
    """Take out the pairs whose terms both have a place, and return their places."""
    ready = [pair for pair in pairs if pair[0] in places and pair[1] in places]
    pairs[:] = [pair for pair in pairs if pair not in ready]
    return tuple((places[one], places[other], equal) for one, other, equal in ready)


def _equalities(action: Action) -> Iterator[tuple[str, str, bool]]:
    """Yield the terms that an action compares, and whether they must be equal or differ."""
    for condition in action.conditions:
        for part in conjuncts(condition.formula):
            match part:
                case Equal(left, right):
                    yield left, right, True
                case Not(Equal(left, right)):
                    yield left, right, False


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
