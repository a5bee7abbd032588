"""Domains and problems to PDDL text: what is read back is what was written.

Every planner is fed by this writer. unified-planning's drops domain constants that occur only in
costs, and ENHSP then "proves" a solvable task unsolvable.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import groupby

from hrcplan.core.json_values import JsonValue
from hrcplan.core.numbers import Number, decimal_of, exact, fraction_of, number_text
from hrcplan.pddl.dialect import symbolic, without_numbers
from hrcplan.pddl.model import (
    OBJECT,
    TRUE,
    Action,
    And,
    Arithmetic,
    Compare,
    Constant,
    Constraint,
    Domain,
    Effect,
    Expr,
    Fact,
    FluentKey,
    Formula,
    Not,
    Note,
    Or,
    Param,
    Preference,
    Problem,
    Quantified,
    Signature,
    TimedChange,
    Trajectory,
    fact_text,
)

WIDTH = 100
MAX_DECIMALS = 129  # of a number that our reader takes: 30, moved by an exponent of 99
_TIMES = {"start": "at start", "end": "at end", "all": "over all"}


def decimal_text(value: Number) -> str:
    """Return a number as PDDL text: exact up to 129 decimals, else rounded to twelve.

    What twelve decimals would round to zero has all of them.

    >>> from fractions import Fraction
    >>> decimal_text(Fraction(1, 2**20)), decimal_text(Fraction(1, 3))
    ('0.00000095367431640625', '0.333333333333')
    """
    is_exact = (value * 10**MAX_DECIMALS).denominator == 1
    if is_exact or (value and abs(Fraction(value)) < Fraction(1, 10**12)):
        return decimal_of(value, MAX_DECIMALS)
    return number_text(value)


def rounded_values(problem: Problem) -> dict[str, str]:
    """Return the initial values that `problem_text` has to round, as fractions by their function.

    No file has such values; callers may set them.

    >>> from fractions import Fraction
    >>> from hrcplan.pddl.inputs import read
    >>> problem = read("transport/two-boxes")
    >>> rounded_values(problem.with_values({("motivation", "human"): Fraction(1, 3)}))
    {'motivation human': '1/3'}
    """
    scale = 10**MAX_DECIMALS
    return {
        " ".join(key): str(value) for key, value in problem.values.items()
        if value.denominator != 1 and (value * scale).denominator != 1
    }  # fmt: skip


def with_rounded_values(problem: Problem, values: Mapping[str, JsonValue]) -> Problem:
    """Return a problem that was read from a text, with the values that the text has rounded.

    Raises:
        ValueError: if a value is no number.
    """
    numbers: dict[FluentKey, Number] = {}
    for name, text in values.items():
        number = fraction_of(text)
        if number is None:
            raise ValueError(f"{text!r} is no number")
        numbers[tuple(name.split(" "))] = exact(number)
    return replace(problem, values={**problem.values, **numbers}) if numbers else problem


def domain_text(domain: Domain, *, strip_costs: bool = False) -> str:
    """Return a domain as PDDL text.

    Args:
        domain: What to write; reading the text gives an equal domain, but for its path.
        strip_costs: Leave out all numbers, for readers of purely classical PDDL.

    Raises:
        UnsupportedError: if a condition or duration needs the numbers that are to be left out.
    """
    if strip_costs:
        domain = symbolic(domain)
    return "".join(f"{line}\n" for line in _domain_lines(domain))


def problem_text(problem: Problem, *, strip_costs: bool = False) -> str:
    """Return a problem as PDDL text, with its current function values.

    Args:
        problem: What to write; reading the text against the problem's domain gives an equal
            problem, but for its path and for numbers without an exact decimal.
        strip_costs: Leave out function values and metric.

    Raises:
        UnsupportedError: if the goal or the domain needs the numbers that are to be left out.
    """
    if strip_costs:
        problem = without_numbers(problem)
    return "".join(f"{line}\n" for line in _problem_lines(problem))


def _domain_lines(domain: Domain) -> Iterator[str]:
    for note in domain.notes:
        yield _note_line(note)
    yield f"(define (domain {domain.name})"
    if domain.requirements:
        yield f"  (:requirements {' '.join(domain.requirements)})"
    yield from _section("types", _typed_groups((n, parents) for n, parents in domain.types.items()))
    yield from _section("constants", _typed_groups((n, (t,)) for n, t in domain.constants.items()))
    yield from _section("predicates", map(_signature, domain.predicates.values()))
    yield from _section("functions", map(_signature, domain.functions.values()))
    for axiom in domain.axioms:
        head = f"({' '.join([axiom.name, _params(axiom.params)]).strip()})"
        yield f"  (:derived {head} {_formula(axiom.body)})"
    yield from _constraint_lines(domain.constraints)
    for action in domain.actions:
        yield ""
        yield from _durative_lines(action) if action.durative else _action_lines(action)
    for word, others in (("process", domain.processes), ("event", domain.events)):
        for other in others:
            yield ""
            yield from _action_lines(other, word)
    yield ")"


def _note_line(note: Note) -> str:
    values = [
        *map(decimal_text, note.numbers),
        *([", ".join(note.phrases)] if note.phrases else []),
    ]
    return f";; hrcplan: {' '.join([note.kind, note.name, *values])}"


def _problem_lines(problem: Problem) -> Iterator[str]:
    yield from map(_note_line, problem.notes)
    yield f"(define (problem {problem.name})"
    yield f"  (:domain {problem.domain.name})"
    yield from _section("objects", _typed_groups((n, (t,)) for n, t in problem.objects.items()))
    yield "  (:init"
    yield from _init_lines(problem)
    yield "  )"
    yield f"  (:goal {_with_preferences(problem.goal, problem.preferences)})"
    yield from _constraint_lines(problem.constraints)
    if problem.metric is not None:
        sense = "maximize" if problem.maximize else "minimize"
        yield f"  (:metric {sense} {_expression(problem.metric)})"
    yield ")"


def _section(name: str, entries: Iterable[str]) -> Iterator[str]:
    lines = [f"    {entry}" for entry in entries]
    if lines:
        yield f"  (:{name}"
        yield from lines
        yield "  )"


def _typed_groups(pairs: Iterable[tuple[str, tuple[str, ...]]]) -> Iterator[str]:
    """Yield ``a b - type`` for neighbors of one type; their order stays as it is."""
    for types, group in groupby(pairs, key=lambda pair: pair[1]):
        yield f"{' '.join(name for name, _ in group)} - {_types(types)}"


def _types(types: Sequence[str]) -> str:
    return types[0] if len(types) == 1 else f"(either {' '.join(types)})"


def _params(params: Sequence[Param]) -> str:
    return " ".join(_typed_groups((p.name, p.types) for p in params))


def _signature(signature: Signature) -> str:
    is_untyped = all(p.types == (OBJECT,) for p in signature.params)
    params = " ".join(p.name for p in signature.params) if is_untyped else _params(signature.params)
    return f"({signature.name} {params})" if params else f"({signature.name})"


def _init_lines(problem: Problem) -> Iterator[str]:
    """Yield facts and values, by predicate as declared and then by objects as declared."""
    domain = problem.domain
    rank = {name: i for i, name in enumerate(problem.all_objects)}

    def place(order: Mapping[str, int], key: Fact | FluentKey) -> tuple[int, list[int]]:
        return order[key[0]], [rank[arg] for arg in key[1:]]

    predicates = {name: i for i, name in enumerate(domain.predicates)}
    facts = sorted(problem.facts, key=lambda fact: place(predicates, fact))
    for _, group in groupby(facts, key=lambda fact: fact[0]):
        yield from _wrap(fact_text(fact) for fact in group)
    functions = {name: i for i, name in enumerate(domain.functions)}
    keys = sorted(problem.values, key=lambda key: place(functions, key))
    for _, group in groupby(keys, key=lambda key: key[0]):
        yield from _wrap(
            f"(= {fact_text(key)} {decimal_text(problem.values[key])})" for key in group
        )
    yield from _wrap(map(_timed_init, problem.timed))


def _constraint_lines(constraints: Sequence[Constraint]) -> Iterator[str]:
    if constraints:
        yield f"  (:constraints {_group('and', map(constraint_text, constraints))})"


def constraint_text(constraint: Constraint) -> str:
    """Return a trajectory constraint as PDDL."""
    parts = [_trajectory(trajectory) for trajectory in constraint.trajectories]
    text = parts[0] if len(parts) == 1 else _group("and", parts)
    if constraint.preference:
        text = f"(preference {constraint.preference} {text})"
    return f"(forall ({_params(constraint.params)}) {text})" if constraint.params else text


def _trajectory(trajectory: Trajectory) -> str:
    word = "at end" if trajectory.op == "at-end" else trajectory.op
    return _group(word, [*map(decimal_text, trajectory.times), *map(_formula, trajectory.parts)])


def _timed_init(change: TimedChange) -> str:
    fact = fact_text(change.key)
    if change.value is not None:
        fact = f"(= {fact} {decimal_text(change.value)})"
    elif not change.positive:
        fact = f"(not {fact})"
    return f"(at {decimal_text(change.time)} {fact})"


def _with_preferences(hard: Formula, preferences: Sequence[Preference]) -> str:
    if not preferences:
        return _formula(hard)
    parts = hard.parts if isinstance(hard, And) else (hard,)
    return _group("and", [*map(_formula, parts), *map(_preference, preferences)])


def _preference(preference: Preference) -> str:
    body = _formula(preference.formula)
    if preference.when:
        body = f"({_TIMES[preference.when]} {body})"
    text = f"(preference {preference.name} {body})"
    return f"(forall ({_params(preference.params)}) {text})" if preference.params else text


def _wrap(entries: Iterable[str]) -> Iterator[str]:
    line = "   "
    for entry in entries:
        if len(line) + len(entry) >= WIDTH and line.strip():
            yield line
            line = "   "
        line += f" {entry}"
    yield line


def _action_lines(action: Action, word: str = "action") -> Iterator[str]:
    yield f"  (:{word} {action.name}"
    yield f"    :parameters ({_params(action.params)})"
    formulas = [c.formula for c in action.conditions]
    hard = formulas[0] if len(formulas) == 1 else And(tuple(formulas))
    if formulas or action.preferences:
        wishes = [replace(preference, when="") for preference in action.preferences]
        yield f"    :precondition {_with_preferences(hard, wishes)}"
    yield from _part("effect", (_effect(effect) for effect in action.effects))
    yield "  )"


def _durative_lines(action: Action) -> Iterator[str]:
    yield f"  (:durative-action {action.name}"
    yield f"    :parameters ({_params(action.params)})"
    limits = [f"({op} ?duration {_expression(expr)})" for op, expr in action.durations]
    yield f"    :duration {limits[0] if len(limits) == 1 else _group('and', limits)}"
    conditions = [f"({_TIMES[c.when]} {_formula(c.formula)})" for c in action.conditions]
    yield from _part("condition", [*conditions, *map(_preference, action.preferences)])
    yield from _part("effect", (_timed_effect(effect) for effect in action.effects))
    yield "  )"


def _part(keyword: str, entries: Iterable[str]) -> Iterator[str]:
    lines = [f"      {entry}" for entry in entries]
    yield f"    :{keyword} (and"
    yield from lines
    yield "    )"


def _timed_effect(effect: Effect) -> str:
    time = _TIMES[effect.when]
    if effect.when == "all":
        return _effect(effect)
    if effect.start_condition == TRUE:
        text = f"({time} {_effect(replace(effect, params=()))})"
    else:
        condition = f"(at start {_formula(effect.start_condition)})"
        if effect.condition != TRUE:
            condition = f"(and {condition} ({time} {_formula(effect.condition)}))"
        text = f"(when {condition} ({time} {_effect(replace(effect, params=(), condition=TRUE))}))"
    return f"(forall ({_params(effect.params)}) {text})" if effect.params else text


def _effect(effect: Effect) -> str:
    if effect.value is not None:
        text = f"({effect.kind} {effect.target} {_expression(effect.value)})"
    else:
        text = str(effect.target) if effect.kind == "add" else f"(not {effect.target})"
    if effect.condition != TRUE:
        text = f"(when {_formula(effect.condition)} {text})"
    return f"(forall ({_params(effect.params)}) {text})" if effect.params else text


def _formula(formula: Formula) -> str:
    """Return a condition as PDDL; like ``str()``, but with exact numbers."""
    match formula:
        case Compare(op, left, right):
            return f"({op} {_expression(left)} {_expression(right)})"
        case Not(body):
            return f"(not {_formula(body)})"
        case And(parts) | Or(parts):
            word = "and" if isinstance(formula, And) else "or"
            return _group(word, map(_formula, parts))
        case Quantified(universal, params, body):
            return f"({'forall' if universal else 'exists'} ({_params(params)}) {_formula(body)})"
        case _:
            return str(formula)


def _expression(expression: Expr) -> str:
    match expression:
        case Constant(value):
            return decimal_text(value)
        case Arithmetic(op, parts):
            return _group(op, map(_expression, parts))
        case _:
            return str(expression)


def _group(word: str, parts: Iterable[str]) -> str:
    return f"({' '.join([word, *parts])})"
