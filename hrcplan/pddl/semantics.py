"""What formulas and effects mean in a state: the lifted reading of PDDL, without grounding.

States are a set of facts and a mapping of function values. Validation replays plans with it,
and the bit representation of ``task`` is tested against it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from fractions import Fraction
from itertools import product

from hrcplan.core.numbers import Number, exact
from hrcplan.core.records import record
from hrcplan.errors import LimitError
from hrcplan.pddl.model import (
    Action,
    And,
    Arithmetic,
    Atom,
    Compare,
    Constant,
    Effect,
    Equal,
    Expr,
    Fact,
    FluentKey,
    Formula,
    Function,
    Not,
    Or,
    Param,
    Problem,
    Quantified,
)
from hrcplan.pddl.walks import functions_in, parts_of

MAX_INSTANCES = 1_000_000
MAX_BITS = 13_000  # of a number, about 3,900 digits: beyond that nothing prints it any more

Values = Mapping[FluentKey, Number]
Binding = Mapping[str, str]


class Undefined(ArithmeticError):  # noqa: N818  # a value that is missing, caught where it occurs
    """A function without a value, or a division by zero."""


@record
class LiftedState:
    """Facts that hold, and the values of functions."""

    facts: Set[Fact]
    values: Values


def ground_key(function: Function | Atom, binding: Binding) -> tuple[str, ...]:
    """Return ``(name, *objects)`` of a function or atom under a binding."""
    return (function.name, *[binding.get(arg, arg) for arg in function.args])


def evaluate(expression: Expr, values: Values, binding: Binding) -> Number:
    """Return the exact value of an expression.

    Raises:
        Undefined: if a function has no value, or something is divided by zero.
        LimitError: if a number grows beyond ``MAX_BITS``.
    """
    match expression:
        case Constant(value):
            return value
        case Function():
            key = ground_key(expression, binding)
            if key not in values:
                raise Undefined(f"({' '.join(key)}) has no value")
            return values[key]
        case Arithmetic(op, parts):
            return _apply(op, [evaluate(part, values, binding) for part in parts])


def _apply(op: str, numbers: Sequence[Number]) -> Number:
    if len(numbers) == 1:
        return -numbers[0] if op == "-" else numbers[0]
    total = numbers[0]
    for number in numbers[1:]:
        if op == "+":
            total = total + number
        elif op == "-":
            total = total - number
        elif op == "*":
            total = _check_size(total * number)
        elif number == 0:
            raise Undefined("division by zero")
        else:
            total = _check_size(Fraction(total) / number)
    return exact(total)


def _check_size(number: Number) -> Number:
    """Return a product, unless it has grown beyond what can be printed."""
    if max(number.numerator.bit_length(), number.denominator.bit_length()) > MAX_BITS:
        raise LimitError("a number grows beyond 3,900 digits", hint="scale the values down")
    return number


_COMPARE = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    "=": lambda a, b: a == b,
    ">=": lambda a, b: a >= b,
    ">": lambda a, b: a > b,
}


def holds(
    formula: Formula,
    state: LiftedState,
    binding: Binding,
    problem: Problem,
    positive: bool = True,
) -> bool:
    """Return whether a condition (or, if not ``positive``, its negation) is true in a state.

    A comparison that reads a function without a value is false, and so is its negation; what
    holds therefore never depends on the order of a disjunction's parts.
    """
    match formula:
        case Atom():
            return (ground_key(formula, binding) in state.facts) == positive
        case Not(body):
            return holds(body, state, binding, problem, not positive)
        case And(parts) | Or(parts):
            test = all if isinstance(formula, And) == positive else any
            return test(holds(part, state, binding, problem, positive) for part in parts)
        case Equal(left, right):
            return (binding.get(left, left) == binding.get(right, right)) == positive
        case Compare(op, left, right):
            try:
                numbers = [evaluate(side, state.values, binding) for side in (left, right)]
            except Undefined:
                return False
            return bool(_COMPARE[op](*numbers)) == positive
        case Quantified(universal, params, body):
            test = all if universal == positive else any
            return test(
                holds(body, state, inner, problem, positive)
                for inner in instances(params, binding, problem)
            )


def unmet(formula: Formula, state: LiftedState, binding: Binding, problem: Problem) -> str | None:
    """Return the first part of a condition that is false, as ground PDDL; None if all hold."""
    return next(unmet_parts(formula, state, binding, problem), None)


def unmet_parts(
    formula: Formula, state: LiftedState, binding: Binding, problem: Problem
) -> Iterator[str]:
    """Yield the parts of a condition that are false, as ground PDDL."""
    if isinstance(formula, And):
        for part in formula.parts:
            yield from unmet_parts(part, state, binding, problem)
    elif isinstance(formula, Quantified) and formula.universal:
        for inner in instances(formula.params, binding, problem):
            yield from unmet_parts(formula.body, state, inner, problem)
    elif not holds(formula, state, binding, problem):
        missing = _without_value(formula, state.values, binding)
        yield ground_text(formula, binding) + ("" if missing is None else f", but {missing}")


def _without_value(formula: Formula, values: Values, binding: Binding) -> str | None:
    """Return why a comparison (or its negation) cannot be made; None if it can."""
    inner = formula.body if isinstance(formula, Not) else formula
    if not isinstance(inner, Compare):
        return None
    try:
        for side in (inner.left, inner.right):
            evaluate(side, values, binding)
    except Undefined as error:
        return str(error)
    return None


def ground_text(formula: Formula, binding: Binding) -> str:
    """Return a formula as PDDL, with its variables replaced by objects where bound."""
    words = str(formula).replace("(", "( ").replace(")", " )").split()
    text = " ".join(binding.get(word, word) for word in words)
    return text.replace("( ", "(").replace(" )", ")")


def mentions(
    formula: Formula, binding: Binding, problem: Problem
) -> Iterator[tuple[bool, tuple[str, ...]]]:
    """Yield what a condition looks at: (True, fact) or (False, function) for each that it names."""
    match formula:
        case Atom():
            yield True, ground_key(formula, binding)
        case Compare(_, left, right):
            for side in (left, right):
                yield from ((False, ground_key(f, binding)) for f in functions_in(side))
        case Quantified(_, params, body):
            for inner in instances(params, binding, problem):
                yield from mentions(body, inner, problem)
        case _:
            for part in parts_of(formula):
                yield from mentions(part, binding, problem)


def instances(params: Sequence[Param], binding: Binding, problem: Problem) -> Iterator[Binding]:
    """Yield ``binding`` extended by every choice of objects for ``params``.

    Raises:
        LimitError: after ``MAX_INSTANCES`` of them.
    """
    if not params:
        yield binding
        return
    names = [param.name for param in params]
    choices = (problem.objects_of(param.types) for param in params)
    for count, objects in enumerate(product(*choices)):
        if count >= MAX_INSTANCES:
            message = f"a quantifier over {' '.join(names)} has over {MAX_INSTANCES:,} instances"
            raise LimitError(message, hint="fewer variables in one forall or exists")
        yield {**binding, **dict(zip(names, objects, strict=True))}


def bind(action: Action, args: Sequence[str], problem: Problem) -> Binding | str:
    """Return the parameters bound to ``args``, or what is wrong with them."""
    if len(args) != len(action.params):
        return f"'{action.name}' takes {len(action.params)} arguments, not {len(args)}"
    objects = problem.all_objects
    for param, arg in zip(action.params, args, strict=True):
        if arg not in objects:
            return f"there is no object '{arg}'"
        if not problem.domain.is_a(objects[arg], param.types):
            return f"'{arg}' is {objects[arg]}, but {param.name} must be {' or '.join(param.types)}"
    return {param.name: arg for param, arg in zip(action.params, args, strict=True)}


@record
class StateUpdate:
    """What effects do at one instant: facts deleted, then facts added, and new values."""

    adds: frozenset[Fact]
    deletes: frozenset[Fact]
    values: Mapping[FluentKey, Number]

    def apply(self, state: LiftedState) -> LiftedState:
        """Return the state after the changes; an add wins over a delete of the same fact."""
        return LiftedState(
            (state.facts - self.deletes) | self.adds, {**state.values, **self.values}
        )


def changes(
    effects: Sequence[Effect],
    state: LiftedState,
    binding: Binding,
    problem: Problem,
    at_start: LiftedState | None = None,
) -> StateUpdate:
    """Return what ``effects`` change in ``state``; all of them read the state before.

    ``at_start`` is the state in which their action started, if that is another one.

    Raises:
        Undefined: if an expression needs a function without a value.
    """
    adds: set[Fact] = set()
    deletes: set[Fact] = set()
    values: dict[FluentKey, Number] = {}
    happening: dict[tuple[object, ...], list[Binding]] = {}
    for effect in effects:
        group = effect.params, id(effect.condition), id(effect.start_condition)
        if group not in happening:  # "when C (and E F)" is two effects with one condition
            happening[group] = [
                inner
                for inner in instances(effect.params, binding, problem)
                if holds(effect.condition, state, inner, problem)
                and holds(effect.start_condition, at_start or state, inner, problem)
            ]
        for inner in happening[group]:
            key = ground_key(effect.target, inner)
            if effect.value is None:
                (adds if effect.kind == "add" else deletes).add(key)
            else:
                amount = evaluate(effect.value, state.values, inner)
                before = values.get(key, state.values.get(key))
                values[key] = assigned(effect.kind, key, before, amount)
    return StateUpdate(frozenset(adds), frozenset(deletes), values)


def assigned(kind: str, key: FluentKey, before: Number | None, amount: Number) -> Number:
    """Return the value of a function after an effect on it.

    Raises:
        Undefined: if it had none and is not simply assigned one, or is divided by zero.
    """
    if kind == "assign":
        return amount
    if before is None:
        raise Undefined(f"({' '.join(key)}) has no value")
    ops = {"increase": "+", "decrease": "-", "scale-up": "*", "scale-down": "/"}
    return _apply(ops[kind], [before, amount])
