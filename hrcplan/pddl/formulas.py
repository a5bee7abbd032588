"""Trees to conditions, effects and numeric expressions; every fault is noted, none stops."""

from __future__ import annotations

from collections.abc import Iterator

from hrcplan.pddl.model import (
    DURATION,
    TOTAL_TIME,
    TRUE,
    And,
    Arithmetic,
    Atom,
    Compare,
    Condition,
    Constant,
    Effect,
    Equal,
    Expr,
    Formula,
    Function,
    Not,
    Or,
    Quantified,
)
from hrcplan.pddl.reader import Group, Node, Word
from hrcplan.pddl.scope import Scope, looks_numeric, to_number
from hrcplan.pddl.source import quote
from hrcplan.pddl.typed_lists import read_params

COMPARISONS = frozenset(["<", "<=", "=", ">=", ">"])
ARITHMETIC = frozenset("+-*/")
ASSIGNMENTS = frozenset(["assign", "increase", "decrease", "scale-up", "scale-down"])


def read_formula(node: Node, scope: Scope) -> Formula:
    """Return the condition that a tree stands for; a faulty part becomes ``TRUE``."""
    if isinstance(node, Word):
        scope.source.error(node.at, "not-a-condition", f"a condition is expected, not {quote(node)}")
        return TRUE
    match node.head:
        case "":
            if node:
                scope.source.error(node.at, "not-a-condition", "a condition is expected here")
            return TRUE
        case "and":
            return And(tuple(read_formula(part, scope) for part in node[1:]))
        case "or":
            return Or(tuple(read_formula(part, scope) for part in node[1:]))
        case "not":
            return Not(read_formula(node[1], scope)) if _has(node, 1, scope) else TRUE
        case "imply":
            return _implication(node, scope)
        case "forall" | "exists":
            return _quantified(node, scope)
        case "preference":
            scope.source.error(node.at, "unsupported", "preferences are not supported")
            return TRUE
        case head if head in COMPARISONS:
            return _comparison(node, scope)
    return read_atom(node, scope) or TRUE


def read_atom(node: Group, scope: Scope) -> Atom | None:
    """Return a predicate with its arguments, or None if anything about it is wrong."""
    head = node[0]
    assert isinstance(head, Word)
    signature = scope.signature(head, "predicate")
    if signature is None:
        _check_terms(node, scope)
        return None
    args = scope.arguments(node, signature)
    return None if args is None else Atom(str(head), args)


def read_conditions(node: Node, scope: Scope, durative: bool) -> Iterator[Condition]:
    """Yield the conditions of an action; those of a durative one say ``at`` or ``over`` when."""
    if not durative:
        yield Condition("start", read_formula(node, scope))
        return
    if isinstance(node, Group) and node.head == "and":
        for part in node[1:]:
            yield from read_conditions(part, scope, durative)
    elif isinstance(node, Group) and node.head == "forall" and len(node) == 3:
        params = read_params(node[1], scope)
        for inner in read_conditions(node[2], scope.binding(params), durative):
            yield Condition(inner.when, Quantified(True, params, inner.formula))
    elif isinstance(node, Group) and not node:
        return
    elif (when := _time(node)) is not None:
        assert isinstance(node, Group)
        yield Condition(when, read_formula(node[2], scope))
    elif isinstance(node, Group) and node.head == "preference":
        scope.source.error(node.at, "unsupported", "preferences are not supported")
    else:
        message = "a durative condition needs (at start …), (over all …) or (at end …)"
        scope.source.error(node.at, "no-time", message)


def read_effects(node: Node, scope: Scope, when: str | None) -> Iterator[Effect]:
    """Yield the effects of an action; ``when`` is None where a durative one must still say it."""
    if isinstance(node, Word):
        scope.source.error(node.at, "not-an-effect", f"an effect is expected, not {quote(node)}")
        return
    time = _time(node)
    if when is None and time in ("start", "end"):
        yield from read_effects(node[2], scope, time)
        return
    match node.head:
        case "":
            if node:
                scope.source.error(node.at, "not-an-effect", "an effect is expected here")
        case "and":
            for part in node[1:]:
                yield from read_effects(part, scope, when)
        case "forall":
            yield from _forall_effects(node, scope, when)
        case "when":
            yield from _conditional_effects(node, scope, when)
        case _ if when is None:
            message = "a durative effect needs (at start …) or (at end …)"
            scope.source.error(node.at, "no-time", message)
        case _:
            yield from _simple_effect(node, scope, when)


def read_expression(node: Node, scope: Scope) -> Expr:
    """Return a numeric expression; a faulty part becomes 0."""
    if isinstance(node, Word):
        return _number_or_name(node, scope)
    head = node[0] if node else None
    if isinstance(head, Word) and head in ARITHMETIC:
        if len(node) < 2:
            scope.source.error(node.at, "wrong-arity", f"{quote(head)} needs operands")
        return Arithmetic(str(head), tuple(read_expression(part, scope) for part in node[1:]))
    if isinstance(head, Word) and head == TOTAL_TIME and len(node) == 1:
        return Function(TOTAL_TIME)
    if isinstance(head, Word):
        return read_function(node, scope) or Constant(0)
    scope.source.error(node.at, "not-a-number", "a numeric expression is expected here")
    return Constant(0)


def read_function(node: Group, scope: Scope) -> Function | None:
    """Return a function with its arguments, or None if anything about it is wrong."""
    head = node[0]
    assert isinstance(head, Word)
    if head == "is-violated":
        scope.source.error(node.at, "unsupported", "preferences are not supported")
        return None
    signature = scope.signature(head, "function")
    if signature is None:
        _check_terms(node, scope)
        return None
    args = scope.arguments(node, signature)
    return None if args is None else Function(str(head), args)


def _number_or_name(word: Word, scope: Scope) -> Expr:
    value = to_number(word)
    if value is not None:
        return Constant(value)
    if word == DURATION and DURATION in scope.variables:
        return Function(DURATION)
    if word == TOTAL_TIME:
        return Function(TOTAL_TIME)
    if looks_numeric(word):
        scope.source.error(word.at, "bad-number", f"{quote(word)} is not a number")
    elif scope.signature(word, "function") is not None:
        group = Group(word.at)
        group.append(word)
        return read_function(group, scope) or Constant(0)
    return Constant(0)


def _has(node: Group, n_parts: int, scope: Scope) -> bool:
    if len(node) == n_parts + 1:
        return True
    message = f"{quote(node.head)} takes {n_parts}, not {len(node) - 1} parts"
    scope.source.error(node.at, "wrong-arity", message)
    return False


def _implication(node: Group, scope: Scope) -> Formula:
    if not _has(node, 2, scope):
        return TRUE
    return Or((Not(read_formula(node[1], scope)), read_formula(node[2], scope)))


def _quantified(node: Group, scope: Scope) -> Formula:
    if not _has(node, 2, scope):
        return TRUE
    params = read_params(node[1], scope)
    body = read_formula(node[2], scope.binding(params))
    return Quantified(node.head == "forall", params, body)


def _comparison(node: Group, scope: Scope) -> Formula:
    if not _has(node, 2, scope):
        return TRUE
    left, right = node[1], node[2]
    if node.head == "=" and isinstance(left, Word) and isinstance(right, Word):
        if _is_term(left, scope) or _is_term(right, scope):
            scope.types_of(left)
            scope.types_of(right)
            return Equal(str(left), str(right))
    return Compare(node.head, read_expression(left, scope), read_expression(right, scope))


def _is_term(word: Word, scope: Scope) -> bool:
    return word != DURATION and (word.startswith("?") or word in scope.objects)


def _check_terms(node: Group, scope: Scope) -> None:
    """Look at the arguments of an unknown name: they may hold faults of their own."""
    for term in node[1:]:
        if isinstance(term, Word):
            scope.types_of(term)


def _time(node: Node) -> str | None:
    if not isinstance(node, Group) or len(node) != 3:
        return None
    match (node[0], node[1]):
        case ("at", "start"):
            return "start"
        case ("at", "end"):
            return "end"
        case ("over", "all"):
            return "all"
    return None


def _forall_effects(node: Group, scope: Scope, when: str | None) -> Iterator[Effect]:
    if not _has(node, 2, scope):
        return
    params = read_params(node[1], scope)
    for effect in read_effects(node[2], scope.binding(params), when):
        yield Effect(effect.when, effect.kind, effect.target, effect.value,
                     params + effect.params, effect.given)  # fmt: skip


def _conditional_effects(node: Group, scope: Scope, when: str | None) -> Iterator[Effect]:
    if not _has(node, 2, scope):
        return
    if when is None:
        message = "conditional effects of durative actions are not supported outside (at …)"
        scope.source.error(node.at, "unsupported", message)
        return
    given = read_formula(node[1], scope)
    for effect in read_effects(node[2], scope, when):
        both = given if effect.given == TRUE else And((given, effect.given))
        yield Effect(effect.when, effect.kind, effect.target, effect.value, effect.params, both)


def _simple_effect(node: Group, scope: Scope, when: str) -> Iterator[Effect]:
    if node.head in ASSIGNMENTS:
        yield from _assignment(node, scope, when)
        return
    negated = node.head == "not"
    if negated and not (len(node) == 2 and isinstance(node[1], Group) and node[1].head):
        scope.source.error(node.at, "not-an-effect", "'not' takes one predicate in an effect")
        return
    inner = node[1] if negated else node
    assert isinstance(inner, Group)
    if inner.head in {"or", "imply", "exists", "not", "="}:
        scope.source.error(inner.at, "not-an-effect", f"{quote(inner.head)} cannot be an effect")
        return
    atom = read_atom(inner, scope)
    if atom is not None:
        yield Effect(when, "delete" if negated else "add", atom)


def _assignment(node: Group, scope: Scope, when: str) -> Iterator[Effect]:
    if not _has(node, 2, scope):
        return
    target = node[1]
    if isinstance(target, Word):
        group = Group(target.at)
        group.append(target)
        target = group
    value = read_expression(node[2], scope)
    if not target.head:
        scope.source.error(target.at, "not-an-effect", "a function is expected here")
        return
    function = read_function(target, scope)
    if function is not None:
        yield Effect(when, str(node.head), function, value)
