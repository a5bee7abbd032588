"""Goals out of reach: proven where not even the relaxed problem gets there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

from hrcplan.pddl.model import (
    Action,
    And,
    Atom,
    Axiom,
    Condition,
    Constant,
    Effect,
    Fact,
    Formula,
    Function,
    Not,
    Or,
    Problem,
    Quantified,
    TimedChange,
)
from hrcplan.pddl.semantics import Binding, LiftedState, ground_key, holds, instances
from hrcplan.pddl.walks import lifted_names
from hrcplan.task.reachable import reachable


def is_out_of_reach(problem: Problem, deadline: float = inf) -> bool:
    """Return whether the goal needs a fact that no plan can make true.

    Nothing that is true becomes false in this relaxation, and numbers that change have any value.
    Axioms, events and timed changes count as actions that may happen at any time; preferences and
    constraints are left out. So True is a proof, and False says nothing.

    Raises:
        LimitError: at the deadline, or if memory becomes short.
    """
    relaxation = _relax(problem)
    _, facts = reachable(relaxation, deadline)
    return not _Reach(relaxation, facts).may_hold(problem.goal, {})


def _relax(problem: Problem) -> Problem:
    """Return a problem in which whatever can change the state is an action."""
    domain = problem.domain
    actions = [*domain.actions, *domain.processes, *domain.events]
    actions += map(_axiom_action, domain.axioms)
    actions += map(_timed_action, problem.timed)
    unique = tuple(replace(action, name=f"{i}-{action.name}") for i, action in enumerate(actions))
    return replace(problem, domain=replace(domain, actions=unique))


def _axiom_action(axiom: Axiom) -> Action:
    head = Atom(axiom.name, tuple(param.name for param in axiom.params))
    body = Condition("start", axiom.body)
    return Action(axiom.name, axiom.params, (body,), (Effect("start", "add", head),))


def _timed_action(change: TimedChange) -> Action:
    name, *args = change.key
    if change.value is not None:
        target = Function(name, tuple(args))
        effect = Effect("start", "assign", target, Constant(change.value))
    else:
        kind = "add" if change.positive else "delete"
        effect = Effect("start", kind, Atom(name, tuple(args)))
    return Action(name, (), (), (effect,))


@dataclass(frozen=True)
class _Reach:
    """What conditions may hold, by the facts that can be reached."""

    problem: Problem
    facts: set[Fact]

    @cached_property
    def changing(self) -> frozenset[str]:
        """The predicates that actions delete, and the functions that they change."""
        effects = (effect for action in self.problem.domain.actions for effect in action.effects)
        return frozenset(effect.target.name for effect in effects if effect.kind != "add")

    def may_hold(self, formula: Formula, binding: Binding, positive: bool = True) -> bool:
        match formula:
            case Atom(name):
                key = ground_key(formula, binding)
                if positive:
                    return key in self.facts
                return key not in self.problem.facts or name in self.changing
            case Not(body):
                return self.may_hold(body, binding, not positive)
            case And(parts) | Or(parts):
                test = all if isinstance(formula, And) == positive else any
                return test(self.may_hold(part, binding, positive) for part in parts)
            case Quantified(universal, params, body):
                test = all if universal == positive else any
                inner = instances(params, binding, self.problem)
                return test(self.may_hold(body, one, positive) for one in inner)
            case _ if not self.changing.isdisjoint(lifted_names(formula)):
                return True
        state = LiftedState(self.problem.facts, self.problem.values)
        return holds(formula, state, binding, self.problem, positive)
