"""Functions that only the metric looks at, as total-cost: planners for costs can take the task.

Fuel that is counted, profit, or distances walked: where nothing but the metric reads such a
function, and actions only add to it or take from it, it is a cost under another name.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import prod

from hrcplan.core.numbers import Number
from hrcplan.pddl.dialect import with_effects
from hrcplan.pddl.model import (
    DURATION,
    TOTAL_COST,
    TOTAL_TIME,
    And,
    Arithmetic,
    Constant,
    Effect,
    Equal,
    Expr,
    FluentKey,
    Function,
    Problem,
    Signature,
)
from hrcplan.pddl.walks import formula_functions, functions_in
from hrcplan.task.numbers import linear

_Factors = Mapping[FluentKey, Number]


def with_total_cost(problem: Problem) -> Problem:
    """Return a problem without functions that actions change and that only the metric looks at.

    Plans and the value of the metric stay the same: their part in it is total-cost. A problem is
    returned as it is if there are none, or if the metric looks at others, too.

    >>> from hrcplan.pddl.inputs import read
    >>> problem = read("transport", "two-boxes")
    >>> with_total_cost(problem) is problem
    True
    """
    names = set(_meters(problem))
    if not names:
        return problem
    in_metric = {f.name for f in functions_in(problem.metric)} & problem.domain.changed_functions
    if in_metric <= {TOTAL_COST}:
        return _without(problem, names)
    factors = linear(problem.metric, {}) if problem.metric is not None else None
    if factors is None or not in_metric - {TOTAL_COST} <= names or not _only_grows(problem):
        return problem
    if any(key and _counts(key) and key not in problem.values for key in factors):
        return problem
    return _converted(problem, names, factors)


def _meters(problem: Problem) -> Iterator[str]:
    """Yield the functions that actions only add to, and that nothing but the metric reads."""
    domain = problem.domain
    special = domain.axioms or problem.constraints or problem.preferences or domain.constraints
    in_actions = any(action.preferences for action in domain.actions)
    changed = domain.changed_functions - {TOTAL_COST}
    if not changed or special or in_actions or problem.timed or domain.is_continuous:
        return
    counters = {f.name for f in functions_in(problem.metric) if not f.args}
    for name in sorted(changed.difference(_read(problem))):
        effects = [e for a in domain.actions for e in a.effects if e.target.name == name]
        grows = all(effect.kind in ("increase", "decrease") for effect in effects)
        is_sure = name in counters or all(_is_sure(problem, effect) for effect in effects)
        if grows and is_sure and _has_all_values(problem, name):
            yield name


def _only_grows(problem: Problem) -> bool:
    """Return whether actions do no more with total-cost than add to it, and nothing reads it."""
    effects = (effect for action in problem.domain.actions for effect in action.effects)
    kinds = {effect.kind for effect in effects if effect.target.name == TOTAL_COST}
    return kinds <= {"increase", "decrease"} and TOTAL_COST not in set(_read(problem))


def _without(problem: Problem, names: set[str]) -> Problem:
    """Return a problem without functions that nothing reads."""
    domain = with_effects(problem.domain, lambda effect: effect.target.name not in names)
    functions = {name: s for name, s in domain.functions.items() if name not in names}
    values = {key: value for key, value in problem.values.items() if key[0] not in names}
    return replace(problem, domain=replace(domain, functions=functions), values=values)


def _counts(key: FluentKey) -> bool:
    return key[0] not in (TOTAL_COST, TOTAL_TIME)


def _is_sure(problem: Problem, effect: Effect) -> bool:
    """Return whether the amount of an effect always has a value: where not, no action runs."""
    names = {function.name for function in functions_in(effect.value)} - {DURATION}
    return not _divides(effect.value) and all(_has_all_values(problem, name) for name in names)


def _divides(expression: Expr | None) -> bool:
    if not isinstance(expression, Arithmetic):
        return False
    return expression.op == "/" or any(map(_divides, expression.parts))


def _has_all_values(problem: Problem, name: str) -> bool:
    """Return whether a function has a value for all objects."""
    signature = problem.domain.functions[name]
    n_keys = prod(len(problem.objects_of(param.types)) for param in signature.params)
    return sum(key[0] == name for key in problem.values) == n_keys


def _read(problem: Problem) -> Iterator[str]:
    """Yield the functions that conditions, durations, amounts and the goal look at."""
    functions = list(formula_functions(problem.goal))
    for action in problem.domain.actions:
        for condition in action.conditions:
            functions += formula_functions(condition.formula)
        for effect in action.effects:
            functions += functions_in(effect.value)
            functions += formula_functions(effect.condition)
            functions += formula_functions(effect.start_condition)
        for _, duration in action.durations:
            functions += functions_in(duration)
    yield from (function.name for function in functions)


def _converted(problem: Problem, names: set[str], factors: _Factors) -> Problem:
    domain = problem.domain
    by_name: dict[str, dict[FluentKey, Number]] = defaultdict(dict)
    constant: Number = 0
    for key, factor in factors.items():
        if key and (key[0] in names or key[0] == TOTAL_COST):
            by_name[key[0]][key] = factor
            constant += factor * problem.values.get(key, 0)
        elif key[:1] != (TOTAL_TIME,):
            constant += factor * (problem.values[key] if key else 1)
    by_name.setdefault(TOTAL_COST, {(TOTAL_COST,): 0})
    actions = tuple(
        replace(a, effects=tuple(part for e in a.effects for part in _costs(e, names, by_name)))
        for a in domain.actions
    )
    rest = _without(replace(problem, domain=replace(domain, actions=actions)), names)
    functions = {**rest.domain.functions, TOTAL_COST: Signature(TOTAL_COST, ())}
    requirements = tuple(dict.fromkeys([*domain.requirements, ":action-costs"]))
    return replace(
        rest,
        domain=replace(rest.domain, requirements=requirements, functions=functions),
        values={**rest.values, (TOTAL_COST,): 0},
        metric=_sum(factors.get((TOTAL_TIME,), 0), constant),
    )


def _sum(time: Number, constant: Number) -> Expr:
    parts: list[Expr] = [Function(TOTAL_COST)]
    if time:
        parts.append(Arithmetic("*", (Constant(time), Function(TOTAL_TIME))))
    if constant:
        parts.append(Constant(constant))
    return parts[0] if len(parts) == 1 else Arithmetic("+", tuple(parts))


def _costs(effect: Effect, names: set[str], factors: Mapping[str, _Factors]) -> Iterator[Effect]:
    """Yield what stands for an effect: total-cost grows by the amount times the metric's factor."""
    target, value = effect.target, effect.value
    if value is None or target.name not in names | {TOTAL_COST}:
        yield effect
        return
    assert isinstance(target, Function)
    sign = 1 if effect.kind == "increase" else -1
    for key, factor in factors[target.name].items():
        same = [Equal(mine, theirs) for mine, theirs in zip(target.args, key[1:], strict=True)]
        amount = Arithmetic("*", (Constant(sign * factor), value))
        condition = And((effect.condition, *same)) if same else effect.condition
        yield replace(
            effect, kind="increase", target=Function(TOTAL_COST), value=amount, condition=condition
        )
