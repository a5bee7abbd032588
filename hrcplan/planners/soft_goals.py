"""Preferences of the goal compiled away, for planners without them (Keyder and Geffner, 2009).

Once a plan is done, each preference is either collected, which needs its condition, or given up,
which costs what the metric charges for a violation. So plans and their costs stay the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import count

from hrcplan.core.numbers import Number, exact
from hrcplan.pddl.constructs import PREFERENCES
from hrcplan.pddl.dialect import with_effects
from hrcplan.pddl.inlining import remaining
from hrcplan.pddl.model import (
    TOTAL_COST,
    TOTAL_TIME,
    TRUE,
    VIOLATED,
    Action,
    And,
    Arithmetic,
    Atom,
    Condition,
    Constant,
    Domain,
    Effect,
    Expr,
    Formula,
    Function,
    Problem,
    Signature,
)
from hrcplan.pddl.renaming import renamed
from hrcplan.pddl.semantics import instances
from hrcplan.plans import Plan
from hrcplan.task.numbers import linear

MAX_PREFERENCES = 1000


@dataclass(frozen=True)
class HardGoals:
    """A problem without preferences, and the actions that no plan of the original has."""

    problem: Problem
    extra: frozenset[str]

    def plan(self, plan: Plan) -> Plan:
        """Return a plan of the original problem."""
        return Plan(tuple(a for a in plan.actions if a.name not in self.extra))


@dataclass(frozen=True)
class _Weights:
    """What a metric adds up: cost, actions, a constant, and violations by preference."""

    cost: Number
    step: Number
    constant: Number
    violations: Mapping[str, Number]


def without_preferences(problem: Problem) -> HardGoals | None:
    """Return a classical problem without the preferences of its goal; None if that is not possible.

    They are compiled away if nothing else prevents a classical problem, and if the metric is to be
    minimized and charges violations with fixed amounts.
    """
    domain = problem.domain
    in_actions = any(action.preferences for action in domain.actions)
    if remaining(problem) != {PREFERENCES} or domain.is_temporal or in_actions or domain.axioms:
        return None
    weights = _weights(problem)
    conditions = list(_conditions(problem)) if weights else []
    if weights is None or len(conditions) > MAX_PREFERENCES:
        return None
    return _compiled(problem, weights, conditions)


def _weights(problem: Problem) -> _Weights | None:
    own = Function(TOTAL_COST if TOTAL_COST in problem.domain.functions else TOTAL_TIME)
    parts = linear(problem.metric or own, {})  # without a metric, what a plan costs is minimized
    if parts is None or problem.maximize:
        return None
    constant: Number = 0
    for key, factor in parts.items():
        if key[:1] in ((TOTAL_COST,), (TOTAL_TIME,), (VIOLATED,)):
            if factor < 0:
                return None
        elif key and (key[0] in problem.domain.changed_functions or key not in problem.values):
            return None
        else:
            constant += factor * (problem.values[key] if key else 1)
    violations = {key[1]: factor for key, factor in parts.items() if key[:1] == (VIOLATED,)}
    cost = parts.get((TOTAL_COST,), 0)
    return _Weights(cost, parts.get((TOTAL_TIME,), 0), constant, violations)


def _conditions(problem: Problem) -> Iterator[tuple[str, Formula]]:
    """Yield the name and the condition of each instance of a preference that the metric counts."""
    for preference in problem.preferences:
        for binding in instances(preference.params, {}, problem):
            yield preference.name, renamed(preference.formula, binding)


def _compiled(
    problem: Problem, weights: _Weights, conditions: list[tuple[str, Formula]]
) -> HardGoals:
    domain = problem.domain
    words = {*domain.predicates, *(action.name for action in domain.actions)}
    names = (name for i in count(1) if (name := f"soft-{i}") not in words)
    is_open, is_over = Atom(next(names), ()), Atom(next(names), ())
    finish = Action(next(names), (), _needs(is_open), (_set(is_over), _set(is_open, False)))
    extra, settled = [finish], list[Atom]()
    for name, formula in conditions:
        charge = weights.violations.get(name, 0)
        if charge:
            fact = Atom(next(names), ())
            price = exact(Fraction(charge) / (weights.cost or 1))
            settled.append(fact)
            extra.append(Action(next(names), (), _needs(is_over, formula), (_set(fact),)))
            cost = Effect("start", "increase", Function(TOTAL_COST), Constant(price))
            extra.append(Action(next(names), (), _needs(is_over), (_set(fact), cost)))
    counted = weights.cost or TOTAL_COST not in domain.functions
    base = domain if counted else with_effects(domain, lambda e: e.target.name != TOTAL_COST)
    actions = (
        replace(a, conditions=(Condition("start", is_open), *a.conditions)) for a in base.actions
    )
    atoms = (is_open, is_over, *settled)
    new_domain = _extended(base, atoms, (*actions, *extra))
    new_domain = replace(new_domain, constants=problem.all_objects)  # actions may name them
    result = replace(
        problem,
        domain=new_domain,
        objects={},
        facts=problem.facts | {(is_open.name,)},
        values={(TOTAL_COST,): 0, **problem.values}
        if weights.cost
        else {**problem.values, (TOTAL_COST,): 0},
        goal=And((problem.goal, is_over, *settled)),
        metric=_metric(weights, 1 + len(settled)),
        preferences=(),
    )
    return HardGoals(result, frozenset(action.name for action in extra))


def _extended(domain: Domain, atoms: tuple[Atom, ...], actions: tuple[Action, ...]) -> Domain:
    predicates = {atom.name: Signature(atom.name, ()) for atom in atoms}
    others = (flag for flag in domain.requirements if flag != ":preferences")
    return replace(
        domain,
        requirements=tuple(dict.fromkeys((*others, ":action-costs"))),
        predicates={**domain.predicates, **predicates},
        functions={**domain.functions, TOTAL_COST: Signature(TOTAL_COST, ())},
        actions=actions,
    )


def _metric(weights: _Weights, n_extra: int) -> Expr:
    """Return the metric; the actions that are added are not counted as steps."""
    constant = exact(Fraction(weights.constant - weights.step * n_extra))
    if (weights.cost or 1, weights.step, constant) == (1, 0, 0):
        return Function(TOTAL_COST)
    factors = {TOTAL_COST: weights.cost or 1, TOTAL_TIME: weights.step}
    parts = [Arithmetic("*", (Constant(f), Function(name))) for name, f in factors.items() if f]
    return Arithmetic("+", (*parts, Constant(constant)))


def _needs(*formulas: Formula) -> tuple[Condition, ...]:
    return tuple(Condition("start", formula) for formula in formulas if formula != TRUE)


def _set(atom: Atom, value: bool = True) -> Effect:
    return Effect("start", "add" if value else "delete", atom)
