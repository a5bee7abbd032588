"""A problem without ``(either …)`` and with one supertype per type, for planners that know no more.

A variable of several types gets the smallest type that covers them. Where that type has other
objects too, a static predicate ``is-TYPE-or-TYPE`` says which objects are meant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import count

from hrcplan.pddl.model import (
    OBJECT,
    TRUE,
    Action,
    And,
    Atom,
    Condition,
    Domain,
    Effect,
    Fact,
    Formula,
    Not,
    Or,
    Param,
    Problem,
    Quantified,
    Signature,
)
from hrcplan.pddl.walks import with_parts


def with_single_types(problem: Problem) -> Problem:
    """Return a problem with the same plans in which every variable has one type.

    Axioms, preferences and constraints keep their variables. It is the same object if no type has
    two supertypes and no variable two types.
    """
    split = _Split(problem, replace(problem, domain=_with_one_parent(problem.domain)))
    domain = split.domain()
    if domain == problem.domain:
        return problem
    goal = split.formula(problem.goal)
    predicates = {**domain.predicates, **split.signatures}
    domain = replace(domain, predicates=predicates)
    return replace(problem, domain=domain, goal=goal, facts=problem.facts | split.facts)


def _with_one_parent(domain: Domain) -> Domain:
    if all(len(parents) < 2 for parents in domain.types.values()):
        return domain
    return replace(domain, types={name: parents[:1] for name, parents in domain.types.items()})


@dataclass
class _Split:
    """The problem as it is, the same with a tree of types, and the predicates needed so far."""

    problem: Problem
    tree: Problem
    names: dict[tuple[str, ...], str] = field(default_factory=dict)

    @property
    def signatures(self) -> dict[str, Signature]:
        return {name: Signature(name, (Param("?x"),)) for name in self.names.values()}

    @property
    def facts(self) -> set[Fact]:
        return {
            (name, item)
            for types, name in self.names.items()
            for item in self.problem.objects_of(types)
        }

    def domain(self) -> Domain:
        domain = self.tree.domain
        return replace(
            domain,
            predicates={k: self._signature(s) for k, s in domain.predicates.items()},
            functions={k: self._signature(s) for k, s in domain.functions.items()},
            actions=tuple(map(self._action, domain.actions)),
            processes=tuple(map(self._action, domain.processes)),
            events=tuple(map(self._action, domain.events)),
        )

    def formula(self, formula: Formula) -> Formula:
        new = with_parts(formula, self.formula)
        if not isinstance(new, Quantified):
            return new
        guards = self._guards(new.params)
        body: Formula = new.body
        if guards and new.universal:
            body = Or((*map(Not, guards), body))
        elif guards:
            body = And((*guards, body))
        return Quantified(new.universal, self._params(new.params), body)

    def _signature(self, signature: Signature) -> Signature:
        return replace(signature, params=self._params(signature.params))

    def _action(self, action: Action) -> Action:
        conditions = [replace(c, formula=self.formula(c.formula)) for c in action.conditions]
        guards = self._guards(action.params)
        return replace(
            action,
            params=self._params(action.params),
            conditions=(*([Condition("start", And(guards))] if guards else ()), *conditions),
            effects=tuple(map(self._effect, action.effects)),
        )

    def _effect(self, effect: Effect) -> Effect:
        condition, guards = self.formula(effect.condition), self._guards(effect.params)
        if guards:
            condition = And((*guards, *(() if condition == TRUE else (condition,))))
        return replace(effect, params=self._params(effect.params), condition=condition)

    def _params(self, params: Sequence[Param]) -> tuple[Param, ...]:
        return tuple(replace(param, types=(self._cover(param.types),)) for param in params)

    def _guards(self, params: Sequence[Param]) -> tuple[Atom, ...]:
        """Return which objects are meant by variables whose new type has others too."""
        sizes = [(param, len(self.problem.objects_of(param.types))) for param in params]
        return tuple(
            Atom(self._name(param.types), (param.name,))
            for param, size in sizes
            if len(self.tree.objects_of((self._cover(param.types),))) > size
        )

    def _cover(self, types: tuple[str, ...]) -> str:
        """Return the smallest type that has all objects of some types."""
        wanted = set(self.problem.objects_of(types))
        candidates = dict.fromkeys((*types, *self.tree.domain.types, OBJECT))
        objects = {name: self.tree.objects_of((name,)) for name in candidates}
        return min(
            (name for name, items in objects.items() if wanted.issubset(items)),
            key=lambda name: len(objects[name]),
        )

    def _name(self, types: tuple[str, ...]) -> str:
        if types not in self.names:
            word = f"is-{'-or-'.join(types)}"
            in_use = {*self.problem.domain.predicates, *self.names.values()}
            numbered = (f"{word}{'' if i == 1 else f'-{i}'}" for i in count(1))
            self.names[types] = next(name for name in numbered if name not in in_use)
        return self.names[types]
