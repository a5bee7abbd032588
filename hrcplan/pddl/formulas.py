"""Trees to conditions and numeric expressions; every fault is noted, none stops the reading."""

from __future__ import annotations

from collections.abc import Iterator, Set

from hrcplan.core.numbers import to_number
from hrcplan.core.text import quote
from hrcplan.pddl.cures import (
    ARITHMETIC,
    COMPARISONS,
    groups_of,
    has_parts,
    is_foreign,
    is_unsupported,
    report_loose,
)
from hrcplan.pddl.foreign import NO_ARITHMETIC, infix_cure
from hrcplan.pddl.model import (
    CONTINUOUS,
    DURATION,
    TRUE,
    VIOLATED,
    And,
    Arithmetic,
    Atom,
    Compare,
    Condition,
    Constant,
    Equal,
    Expr,
    Formula,
    Function,
    Not,
    Or,
    Quantified,
)
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope, decimal_cure, looks_numeric
from hrcplan.pddl.typed_lists import read_params

OBJECT_FLUENTS = (
    "functions with objects as values are not supported: use a predicate such as (f-is ?x ?value)"
)
_NO_NUMBERS = frozenset(["true", "false", "nil", "null", "none", "undefined"])
_TIMES = {("at", "start"): "start", ("at", "end"): "end", ("over", "all"): "all"}


def read_formula(node: ParseNode, scope: Scope) -> Formula:
    """Return the condition that a tree stands for; a faulty part becomes ``TRUE``."""
    atom = scope.plain_atom(node)
    if atom is not None:
        return atom
    head = "" if isinstance(node, WordNode) else node.head
    if isinstance(node, WordNode) or (node and not head):
        report_loose([node], scope, "condition")
        return TRUE
    match head:
        case "":
            return TRUE
        case _ if scope.is_atom(node):
            return read_atom(node, scope) or TRUE
        case "and":
            return And(_formulas(node, scope))
        case "or":
            scope.source.use(":disjunctive-preconditions", node.at)
            return Or(_formulas(node, scope))
        case "not":
            return _negation(node, scope)
        case "imply":
            return _implication(node, scope)
        case "forall" | "exists":
            return _quantifier(node, scope)
        case _ if head in COMPARISONS:
            return _comparison(node, scope)
    return read_atom(node, scope) or TRUE


def read_atom(node: GroupNode, scope: Scope) -> Atom | None:
    """Return a predicate with its arguments, or None if anything about it is wrong."""
    if is_unsupported(node, scope):
        return None
    if is_foreign(node, scope):
        return None
    if _has_time(node):
        message = "only a durative action says 'at start', 'over all' or 'at end', and only once"
        hint = "write what stands inside of it alone, or write (:durative-action …)"
        scope.source.error(node.at, "unexpected-time", message, hint)
        return None
    head = node[0]
    assert isinstance(head, WordNode)
    signature = scope.signature(head, "predicate")
    if signature is None:
        _check_terms(node, scope)
        return None
    args = scope.arguments(node, signature)
    return None if args is None else Atom(str(head), args)


def shown(node: GroupNode) -> str:
    """Return a group of words as text."""
    return f"({' '.join(word for word in node if isinstance(word, WordNode))})"


def _formulas(node: GroupNode, scope: Scope) -> tuple[Formula, ...]:
    return tuple([read_formula(part, scope) for part in groups_of(node[1:], scope, "condition")])


def _has_time(node: GroupNode) -> bool:
    """Whether a group says when a condition holds; ``(at start bob)`` is a predicate."""
    return time_of(node) is not None and isinstance(node[2], GroupNode)


def read_conditions(node: ParseNode, scope: Scope, durative: bool) -> Iterator[Condition]:
    """Yield the conditions of an action; those of a durative one say ``at`` or ``over`` when."""
    if not durative:
        yield Condition("start", read_formula(node, scope))
    elif isinstance(node, GroupNode) and node.head == "and":
        for part in groups_of(node[1:], scope, "condition"):
            yield from read_conditions(part, scope, durative)
    elif isinstance(node, GroupNode) and node.head == "forall" and len(node) == 3:
        scope.source.use(":universal-preconditions", node.at)
        params, inside = scope.quantifying(read_params(node[1], scope), node.at)
        for inner in read_conditions(node[2], inside, durative):
            yield Condition(inner.when, Quantified(True, params, inner.formula))
    elif (pair := time_of(node)) is not None:
        yield Condition(pair[0], read_formula(pair[1], scope))
    elif not (isinstance(node, GroupNode) and (not node or is_unsupported(node, scope))):
        message = "a durative condition needs (at start …), (over all …) or (at end …)"
        hint = "write (at start (p ?x)), and (over all (p ?x)) for what holds all the time"
        scope.source.error(node.at, "no-time", message, hint)


def time_of(node: ParseNode) -> tuple[str, ParseNode] | None:
    """Return ``start``, ``end`` or ``all`` and what holds then; None if the node says neither."""
    if not isinstance(node, GroupNode) or len(node) != 3:
        return None
    first, second, body = node
    if isinstance(first, WordNode) and isinstance(second, WordNode) and (first, second) in _TIMES:
        return _TIMES[first, second], body
    return None


def read_expression(node: ParseNode, scope: Scope) -> Expr:
    """Return a numeric expression; a faulty part becomes 0."""
    if isinstance(node, WordNode):
        return _number_or_name(node, scope)
    function = scope.plain_function(node)
    if function is not None:
        return function
    if node.head in ARITHMETIC and node.head:
        return _arithmetic(node, scope)
    if node.head in scope.numbers and len(node) == 1:
        return Function(str(node.head))
    if node.head == VIOLATED and scope.preferences is not None:
        return _violation_count(node, scope, scope.preferences)
    if node.head:
        return read_function(node, scope) or Constant(0)
    hint = infix_cure(node) or ("leave one pair of parentheses out" if len(node) == 1 else None)
    scope.source.error(node.at, "not-a-number", "a numeric expression is expected here", hint)
    return Constant(0)


def _violation_count(node: GroupNode, scope: Scope, preferences: Set[str]) -> Expr:
    name = node[1] if len(node) == 2 else node
    if not isinstance(name, WordNode):
        scope.source.error(node.at, "bad-preference", "(is-violated NAME) is expected here")
        return Constant(0)
    if name not in preferences:
        message = f"there is no preference {quote(name)}"
        otherwise = f"write (preference {name} …) in the goal"
        names = preferences
        scope.source.unknown(
            name.at, "unknown-preference", message, str(name), names, cure=otherwise
        )
        return Constant(0)
    return Function(VIOLATED, (str(name),))


def read_function(node: ParseNode, scope: Scope) -> Function | None:
    """Return a function with its arguments, or None if anything about it is wrong.

    A bare word stands for a function without arguments.
    """
    function = scope.plain_function(node)
    if function is not None:
        return function
    if isinstance(node, WordNode):
        alone = GroupNode(node.at)
        alone.append(node)
        node = alone
    head = node[0] if node else node
    if not isinstance(head, WordNode):
        scope.source.error(node.at, "not-a-function", "a function such as (f ?x) is expected here")
        return None
    if is_unsupported(node, scope) or is_foreign(node, scope):
        return None
    if len(node) == 1 and looks_numeric(head):
        if scope.source.text[node.at] != "(":
            return None  # a bracket, which is reported
        message = "a number stands without parentheses"
        scope.source.error(node.at, "not-a-function", message, f"write {head}")
        return None
    if head in NO_ARITHMETIC and head not in scope.domain.functions:
        message = f"PDDL has no {quote(head)} for numbers"
        scope.source.error(head.at, "foreign-operator", message, "it knows + - * / only")
        return None
    if head in scope.domain.predicates and head not in scope.domain.functions:
        message = f"{quote(head)} is a predicate, not a function"
        hint = f"write {shown(node)} or (not {shown(node)}), without a value"
        scope.source.error(head.at, "unknown-function", message, hint)
        return None
    signature = scope.signature(head, "function")
    if signature is None:
        _check_terms(node, scope)
        return None
    args = scope.arguments(node, signature)
    return None if args is None else Function(str(head), args)


def _arithmetic(node: GroupNode, scope: Scope) -> Expr:
    parts = tuple(read_expression(part, scope) for part in node[1:])
    if not parts:
        hint = f"write ({node.head} A B)"
        scope.source.error(node.at, "wrong-arity", f"{quote(node.head)} needs operands", hint)
        return Constant(0)
    if node.head == "/" and any(isinstance(n, WordNode) and to_number(n) == 0 for n in node[2:]):
        scope.source.error(node.at, "bad-number", "division by zero")
    return Arithmetic(str(node.head), parts)


def _number_or_name(word: WordNode, scope: Scope) -> Expr:
    value = to_number(word)
    if value is not None:
        return Constant(value)
    if word in scope.numbers:
        return Function(str(word))
    if word == CONTINUOUS:
        message = "#t is for effects of processes and untimed effects of durative actions only"
        scope.source.error(word.at, "unknown-function", message)
    elif looks_numeric(word):
        message = f"{quote(word)} is not a number"
        scope.source.error(word.at, "bad-number", message, decimal_cure(word))
    elif word in _NO_NUMBERS:
        message, hint = f"{quote(word)} is not a number", "a function has a number, such as 0 or 1"
        scope.source.error(word.at, "bad-number", message, hint)
    elif word == DURATION:
        scope.source.error(word.at, "unbound", "only a durative action has a ?duration")
    elif word.startswith("?") or word in scope.objects:
        message = f"{quote(word)} is an object, not a number"
        scope.source.error(word.at, "not-a-number", message, OBJECT_FLUENTS)
    else:
        return read_function(word, scope) or Constant(0)
    return Constant(0)


def _negation(node: GroupNode, scope: Scope) -> Formula:
    if not has_parts(node, 1, scope):
        return TRUE
    body = read_formula(node[1], scope)
    if not isinstance(body, Equal):
        scope.source.use(":negative-preconditions", node.at)
    return Not(body)


def _implication(node: GroupNode, scope: Scope) -> Formula:
    if not has_parts(node, 2, scope):
        return TRUE
    scope.source.use(":disjunctive-preconditions", node.at)
    return Or((Not(read_formula(node[1], scope)), read_formula(node[2], scope)))


def _quantifier(node: GroupNode, scope: Scope) -> Formula:
    if not has_parts(node, 2, scope):
        return TRUE
    universal = node.head == "forall"
    kind = "universal" if universal else "existential"
    scope.source.use(f":{kind}-preconditions", node.at)
    params, inside = scope.quantifying(read_params(node[1], scope), node.at)
    return Quantified(universal, params, read_formula(node[2], inside))


def _comparison(node: GroupNode, scope: Scope) -> Formula:
    if not has_parts(node, 2, scope):
        return TRUE
    left, right = node[1], node[2]
    for side, other in ((left, right), (right, left)):
        if isinstance(other, WordNode) and is_fact(side, scope):
            read_function(side, scope)
            return TRUE
    if node.head == "=" and _is_term(left, scope) and _is_term(right, scope):
        scope.source.use(":equality", node.at)
        for term in (left, right):
            assert isinstance(term, WordNode)
            scope.types_of(term)
        return Equal(scope.term(str(left)), scope.term(str(right)))
    scope.source.use(":numeric-fluents", node.at)
    return Compare(str(node.head), read_expression(left, scope), read_expression(right, scope))


def is_fact(node: ParseNode, scope: Scope) -> bool:
    """Whether a group is a predicate, which has no value to compare."""
    if not isinstance(node, GroupNode) or node.head in scope.domain.functions:
        return False
    return node.head in scope.domain.predicates


def _is_term(node: ParseNode, scope: Scope) -> bool:
    """Whether a word can only be a variable or object, known or not."""
    if not isinstance(node, WordNode) or node == DURATION:
        return False
    return node in scope.objects or not (looks_numeric(node) or node in scope.domain.functions)


def _check_terms(node: GroupNode, scope: Scope) -> None:
    """Look at the arguments of an unknown name: they may hold faults of their own."""
    for term in node[1:]:
        if isinstance(term, WordNode) and not looks_numeric(term):
            scope.types_of(term)
