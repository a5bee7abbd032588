"""Effects at the end of an action that depend on its start, with facts that remember the start."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import count

from hrcplan.pddl.model import TRUE, Action, And, Atom, Domain, Effect, Formula, Problem, Signature


def with_memory_facts(problem: Problem) -> Problem:
    """Return a problem in which no effect at the end reads a condition at the start.

    ``(when (and (at start C) (at end D)) (at end E))`` becomes an effect at the start that adds a
    fact where C holds, and one at the end that asks for the fact; at the end the fact goes. Plans
    stay the same. Instances of one action that overlap share the fact, so they are not exact.
    """
    domain = problem.domain
    effects = (effect for action in domain.actions for effect in action.effects)
    if all(effect.start_condition == TRUE for effect in effects):
        return problem
    return replace(problem, domain=_with_facts(domain))


def _with_facts(domain: Domain) -> Domain:
    names = (f"remember-{i}" for i in count(1) if f"remember-{i}" not in domain.predicates)
    predicates = dict(domain.predicates)
    actions = list[Action]()
    for action in domain.actions:
        changes = list[Effect]()
        memory = dict[tuple[object, Formula], Effect]()
        for effect in action.effects:
            if effect.start_condition == TRUE:
                changes.append(effect)
                continue
            key = effect.params, effect.start_condition
            if key not in memory:
                memory[key] = _at_start(action, effect, next(names))
                signature = Signature(memory[key].target.name, (*action.params, *effect.params))
                predicates[signature.name] = signature
            fact = memory[key].target
            assert isinstance(fact, Atom)
            parts = tuple(part for part in (fact, effect.condition) if part != TRUE)
            changes.append(replace(effect, condition=And(parts), start_condition=TRUE))
        actions.append(replace(action, effects=(*changes, *_kept(memory.values()))))
    return replace(domain, predicates=predicates, actions=tuple(actions))


def _at_start(action: Action, effect: Effect, name: str) -> Effect:
    """Return the effect that adds the fact: it names all objects of the action and of forall."""
    variables = tuple(param.name for param in (*action.params, *effect.params))
    condition = effect.start_condition
    return Effect("start", "add", Atom(name, variables), None, effect.params, condition)


def _kept(memory: Iterable[Effect]) -> Iterator[Effect]:
    """Yield the effects that add the facts at the start, and those that take them at the end."""
    for effect in memory:
        yield effect
        yield replace(effect, when="end", kind="delete", condition=TRUE)
