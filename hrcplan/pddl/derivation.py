"""What follows from the facts of a state by the axioms of a domain."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import count, product

from hrcplan.core.records import record, replace
from hrcplan.pddl.axioms import levels, uses
from hrcplan.pddl.joins import FactIndex, Join, JoinBinding
from hrcplan.pddl.model import (
    Action,
    And,
    Arithmetic,
    Atom,
    Axiom,
    Compare,
    Equal,
    Expr,
    Fact,
    Formula,
    Function,
    Or,
    Param,
    Problem,
    Quantified,
)
from hrcplan.pddl.semantics import LiftedState, ground_key, holds
from hrcplan.pddl.walks import conjuncts, with_parts

MAX_RULES = 256  # that one axiom is split into; beyond that its disjunctions stay as they are


@record
class _Rule:
    """A part of an axiom: atoms to be joined, and what is tested of each of their bindings."""

    head: Atom
    join: Join
    tests: tuple[Formula, ...]
    waits: bool  # whether a test looks at a predicate of the same stratum


class Derivation:
    """The axioms of a problem's domain, ready to be applied to states.

    >>> from hrcplan.pddl.inputs import read
    >>> problem = read(
    ...     "(define (domain d) (:predicates (on ?x ?y) (up ?x ?y)) (:derived (up ?x ?y)"
    ...     " (or (on ?x ?y) (exists (?z) (and (on ?x ?z) (up ?z ?y))))))",
    ...     "(define (problem p) (:domain d) (:objects a b c)"
    ...     " (:init (on a b) (on b c)) (:goal (up a c)))",
    ... )
    >>> sorted(Derivation(problem).close(LiftedState(problem.facts, {})).facts)[2:]
    [('up', 'a', 'b'), ('up', 'a', 'c'), ('up', 'b', 'c')]
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        domain = problem.domain
        level = levels(domain.axioms)
        self._strata: list[list[_Rule]] = [[] for _ in range(max(level.values(), default=-1) + 1)]
        self._read = {name for axiom in domain.axioms for name, _ in uses(axiom.body)}
        for axiom in domain.axioms:
            stratum = level[axiom.name]
            same = {name for name, other in level.items() if other == stratum}
            self._strata[stratum] += (_rule(part, same, problem) for part in _parts(axiom))
        self._last: tuple[LiftedState, LiftedState] | None = None

    def close(self, state: LiftedState) -> LiftedState:
        """Return a state with the facts that follow from it; the same one if there are no axioms.

        A state of the same facts and values as the last one is not derived again.
        """
        if not self._strata:
            return state
        if self._last is not None and self._last[0] is state:
            return self._last[1]
        index = FactIndex(fact for fact in state.facts if fact[0] in self._read)
        facts: set[Fact] = set()
        for rules in self._strata:
            facts |= self._saturate(rules, index, state)
        closure = LiftedState(frozenset(state.facts | facts), state.values)
        self._last = state, closure
        return closure

    def _saturate(self, rules: Sequence[_Rule], index: FactIndex, state: LiftedState) -> set[Fact]:
        """Return what the rules of one stratum add, and put it into the index."""
        users: dict[str, list[tuple[_Rule, int]]] = defaultdict(list)
        for rule in rules:
            for position, atom in enumerate(rule.join.atoms):
                users[atom.name].append((rule, position))
        new_facts: set[Fact] = set()
        facts = set(state.facts) | index.facts
        partial = LiftedState(facts, state.values)
        first = list(rules)
        while first:
            before = len(new_facts)
            waiting = [fact for rule in first for fact in self._heads(rule, index, partial)]
            while waiting:
                fact = waiting.pop()
                if fact in facts:
                    continue
                new_facts.add(fact)
                facts.add(fact)
                index.add([fact])
                for rule, position in users[fact[0]]:
                    waiting += self._heads(rule, index, partial, (position, fact))
            first = [rule for rule in rules if rule.waits] if len(new_facts) > before else []
        return new_facts

    def _heads(
        self,
        rule: _Rule,
        index: FactIndex,
        state: LiftedState,
        first: tuple[int, Fact] | None = None,
    ) -> Iterator[Fact]:
        for binding in list(rule.join.bindings(index, first)):
            if self._passes(rule, state, binding):
                yield ground_key(rule.head, binding)

    def _passes(self, rule: _Rule, state: LiftedState, binding: JoinBinding) -> bool:
        return all(holds(test, state, binding, self.problem) for test in rule.tests)


def _rule(axiom: Axiom, same: Set[str], problem: Problem) -> _Rule:
    parts = list(conjuncts(axiom.body))
    atoms = [part for part in parts if isinstance(part, Atom)]
    tests = tuple(part for part in parts if not isinstance(part, Atom))
    head = Atom(axiom.name, tuple(p.name for p in axiom.params[: _n_own(axiom, problem)]))
    join = Join(Action(axiom.name, axiom.params, (), ()), atoms, problem)
    waits = any(name in same for test in tests for name, _ in uses(test))
    return _Rule(head, join, tests, waits)


def _n_own(axiom: Axiom, problem: Problem) -> int:
    """Return how many parameters the predicate has; the others come from ``exists``."""
    return len(problem.domain.predicates[axiom.name].params)


def _parts(axiom: Axiom) -> Iterator[Axiom]:
    """Yield axioms that mean the same together, with ``or`` and ``exists`` pulled out."""
    numbers = count()
    parts = _alternatives(axiom.body, numbers)
    if len(parts) > MAX_RULES:
        parts = [((), axiom.body)]
    for params, body in parts:
        yield replace(axiom, params=(*axiom.params, *params), body=body)


def _alternatives(
    formula: Formula, numbers: Iterator[int]
) -> list[tuple[tuple[Param, ...], Formula]]:
    """Return the alternatives of a formula, each with the variables that it needs."""
    match formula:
        case Or(parts):
            return [alternative for part in parts for alternative in _alternatives(part, numbers)]
        case And(parts):
            options = [_alternatives(part, numbers) for part in parts]
            if any(len(o) > MAX_RULES for o in options):
                return [((), formula)]
            n_all = 1
            for option in options:
                n_all *= len(option)
            if n_all > MAX_RULES:
                return [((), formula)]
            return [
                (tuple(p for params, _ in chosen for p in params), And(tuple(f for _, f in chosen)))
                for chosen in product(*options)
            ]
        case Quantified(False, params, body):
            names = {param.name: f"{param.name}-{next(numbers)}_" for param in params}
            inner = tuple(replace(param, name=names[param.name]) for param in params)
            alternative = _alternatives(substitute(body, names), numbers)
            return [((*inner, *more), part) for more, part in alternative]
        case _:
            return [((), formula)]


def substitute(formula: Formula, terms: Mapping[str, str]) -> Formula:
    """Return a formula with other terms for its free variables; they must not be bound in it."""

    def term(name: str) -> str:
        return terms.get(name, name)

    match formula:
        case Atom(name, args):
            return Atom(name, tuple(map(term, args)))
        case Equal(left, right):
            return Equal(term(left), term(right))
        case Compare(op, left_side, right_side):
            return Compare(op, _expression(left_side, terms), _expression(right_side, terms))
        case Quantified(universal, params, body):
            bound = {p.name for p in params}
            free = {old: new for old, new in terms.items() if old not in bound}
            return Quantified(universal, params, substitute(body, free))
        case _:
            return with_parts(formula, lambda part: substitute(part, terms))


def _expression(expression: Expr, terms: Mapping[str, str]) -> Expr:
    match expression:
        case Function(name, args):
            return Function(name, tuple(terms.get(arg, arg) for arg in args))
        case Arithmetic(op, parts):
            return Arithmetic(op, tuple(_expression(part, terms) for part in parts))
        case _:
            return expression
