"""Numbers of a ground task: which functions may change, and costs as sums of function values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import product

from hrcplan.errors import UnsupportedError
from hrcplan.pddl.model import (
    TOTAL_COST,
    Action,
    Arithmetic,
    Constant,
    Domain,
    Effect,
    Expr,
    FluentKey,
    Formula,
    Function,
    Number,
    Problem,
    formula_functions,
    functions_in,
)
from hrcplan.pddl.semantics import Binding, Values, evaluate, ground_key
from hrcplan.task.reachable import Instance

MAX_VALUES = 16
Linear = Mapping[FluentKey, Number]
"""Coefficients by function; the constant stands under the empty key."""


def agent_state_functions(domain: Domain) -> frozenset[str]:
    """Return the functions that are agent state: first parameter an agent, part of a cost."""
    return frozenset(
        function.name
        for action in domain.actions
        for effect in action.effects
        if effect.target.name == TOTAL_COST
        for function in functions_in(effect.value)
        if _of_agent(domain, function.name)
    )


def _of_agent(domain: Domain, name: str) -> bool:
    signature = domain.functions[name]
    if "agent" not in domain.types or not signature.params:
        return False
    return all(domain.is_a(t, ("agent",)) for t in signature.params[0].types)


def check_supported(domain: Domain) -> None:
    """Raise unless bits can hold the task.

    Raises:
        UnsupportedError: naming the first function that an action changes and that is neither
            total-cost nor agent state, or a use of total-cost other than increasing it.
    """
    state = agent_state_functions(domain)
    for action in domain.actions:
        for effect in action.effects:
            name = effect.target.name
            if effect.value is None or name in state:
                continue
            if name != TOTAL_COST:
                message = f"'{action.name}' changes ({name} …), which is not agent state"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
            if effect.kind != "increase" or effect.given.parts or effect.params:  # type: ignore[union-attr]
                message = f"'{action.name}' does more with total-cost than increase it"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such costs")


def changing_values(
    problem: Problem, instances: list[Instance]
) -> dict[FluentKey, tuple[Number, ...]]:
    """Return every reachable value of each agent-state function that some action changes.

    Raises:
        UnsupportedError: if a function has more than ``MAX_VALUES`` reachable values.
    """
    changers = [
        (instance, effect)
        for instance in instances
        for effect in instance.action.effects
        if effect.value is not None and effect.target.name != TOTAL_COST
    ]
    keys = {ground_key(effect.target, instance.binding) for instance, effect in changers}
    reached = {key: {problem.values[key]} for key in sorted(keys) if key in problem.values}
    while any([_spread(problem, reached, i, e) for i, e in changers]):
        for key, values in reached.items():
            if len(values) > MAX_VALUES:
                message = f"({' '.join(key)}) takes more than {MAX_VALUES} values"
                raise UnsupportedError(message, hint="enhsp and kairos plan with such numbers")
    return {key: tuple(sorted(values)) for key, values in reached.items()}


def _spread(
    problem: Problem, reached: dict[FluentKey, set[Number]], instance: Instance, effect: Effect
) -> bool:
    """Add the values that one effect leads to; return whether any is new."""
    key = ground_key(effect.target, instance.binding)
    before = reached.setdefault(key, set())
    size = len(before)
    for values in variants(problem, reached, keys_read(instance.action, instance.binding)):
        before.add(changed(effect, key, values, instance.binding))
    return len(before) > size


def changed(effect: Effect, key: FluentKey, values: Values, binding: Binding) -> Number:
    """Return the value of ``key`` after a numeric effect."""
    assert effect.value is not None
    amount = evaluate(effect.value, values, binding)
    if effect.kind == "assign":
        return amount
    ops = {"increase": "+", "decrease": "-", "scale-up": "*", "scale-down": "/"}
    both = Arithmetic(ops[effect.kind], (Constant(values[key]), Constant(amount)))
    return evaluate(both, {}, {})


def keys_read(action: Action, binding: Binding) -> frozenset[FluentKey]:
    """Return the ground functions that an action's conditions, durations or effects look at."""
    return frozenset(ground_key(function, binding) for function in _functions(action))


def _functions(action: Action) -> Iterator[Function]:
    for effect in action.effects:
        yield from functions_in(effect.value)
        if effect.value is not None and effect.target.name != TOTAL_COST:
            assert isinstance(effect.target, Function)
            yield effect.target
    yield from structural_functions(action)


def structural_functions(action: Action) -> Iterator[Function]:
    """Yield the functions that decide when an action can run and how long it takes."""
    formulas: list[Formula] = [c.formula for c in action.conditions]
    formulas += [effect.given for effect in action.effects]
    for formula in formulas:
        yield from formula_functions(formula)
    for _, duration in action.durations:
        yield from functions_in(duration)


def variants(
    problem: Problem, reached: Mapping[FluentKey, object], keys: frozenset[FluentKey]
) -> Iterator[Values]:
    """Yield the problem's values with every combination of reached values of ``keys``."""
    moving = sorted(keys & reached.keys())
    options = [sorted(reached[key]) for key in moving]  # type: ignore[call-overload]
    for chosen in product(*options):
        yield {**problem.values, **dict(zip(moving, chosen, strict=True))}


def linear(expression: Expr, binding: Binding) -> Linear | None:
    """Return an expression as a weighted sum of functions, or None if it is not linear.

    >>> f, g = Function("f"), Function("g")
    >>> linear(Arithmetic("+", (f, Arithmetic("*", (Constant(2), g)), Constant(1))), {})
    {('f',): 1, ('g',): 2, (): 1}
    """
    match expression:
        case Constant(value):
            return {(): value}
        case Function():
            return {ground_key(expression, binding): 1}
        case Arithmetic(op, parts):
            found = [linear(part, binding) for part in parts]
            known = [part for part in found if part is not None]
            return _combine(op, known) if len(known) == len(found) else None


def _combine(op: str, parts: list[Linear]) -> Linear | None:
    if op == "-" and len(parts) == 1:
        return _scaled(parts[0], -1)
    total = parts[0]
    for part in parts[1:]:
        if op in "+-":
            total = _sum(total, _scaled(part, 1 if op == "+" else -1))
            continue
        factor, rest = (part, total) if _is_constant(part) else (total, part)
        if not _is_constant(factor) or (op == "/" and (rest is part or not factor.get((), 0))):
            return None
        number = factor.get((), 0)
        total = _scaled(rest, number if op == "*" else 1 / Fraction(number))
    return total


def _is_constant(part: Linear) -> bool:
    return all(key == () for key in part)


def _scaled(part: Linear, factor: Number) -> Linear:
    return {key: coefficient * factor for key, coefficient in part.items()}


def _sum(one: Linear, other: Linear) -> Linear:
    total = dict(one)
    for key, coefficient in other.items():
        total[key] = total.get(key, 0) + coefficient
    return total


def value_of(part: Linear, values: Values) -> Number:
    """Return the value of a weighted sum.

    Raises:
        KeyError: if a function has no value.
    """
    total: Number = 0
    for key, coefficient in part.items():
        total += coefficient * values[key] if key else coefficient
    return int(total) if isinstance(total, Fraction) and total.denominator == 1 else total
