"""Trees to conditions and numeric expressions; every fault is noted, none stops the reading."""

from __future__ import annotations

from collections.abc import Iterator, Set

from hrcplan.core.numbers import to_number
from hrcplan.core.text import plural, quote
from hrcplan.pddl.foreign import FOREIGN, NO_ARITHMETIC, OF_FACTS, PREFIXES, is_infix
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

COMPARISONS = frozenset(["<", "<=", "=", ">=", ">"])
ARITHMETIC = frozenset("+-*/")
UNSUPPORTED = {
    "preference": "preferences inside of another condition than and, forall",
    "is-violated": "preferences outside of the metric",
    "probabilistic": "probabilistic effects",
    "oneof": "non-deterministic effects",
    "always": "trajectory constraints",
    "sometime": "trajectory constraints",
    "within": "trajectory constraints",
    "at-most-once": "trajectory constraints",
    "sometime-after": "trajectory constraints",
    "sometime-before": "trajectory constraints",
    "always-within": "trajectory constraints",
    "hold-during": "trajectory constraints",
    "hold-after": "trajectory constraints",
}
_ONE_BODY = frozenset(["when", "forall", "exists", "not"])  # whose last part is one group
OBJECT_FLUENTS = (
    "functions with objects as values are not supported: use a predicate such as (f-is ?x ?value)"
)
_TIMES = {("at", "start"): "start", ("at", "end"): "end", ("over", "all"): "all"}


def read_formula(node: ParseNode, scope: Scope) -> Formula:
    """Return the condition that a tree stands for; a faulty part becomes ``TRUE``."""
    atom = scope.plain_atom(node)
    if atom is not None:
        return atom
    head = "" if isinstance(node, WordNode) else node.head
    if isinstance(node, WordNode) or (node and not head):
        message = "a condition such as (p ?x) is expected"
        scope.source.error(node.at, "not-a-condition", message, loose_cure(node, "conditions"))
        return TRUE
    match head:
        case "":
            return TRUE
        case _ if scope.is_atom(node):
            return read_atom(node, scope) or TRUE
        case "and":
            return And(tuple([read_formula(part, scope) for part in node[1:]]))
        case "or":
            scope.source.use(":disjunctive-preconditions", node.at)
            return Or(tuple(read_formula(part, scope) for part in node[1:]))
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
        scope.source.error(node.at, "unexpected-time", message)
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


def loose_cure(node: ParseNode, kind: str) -> str | None:
    """Return how to write what has no head: a bare word, or a group of groups."""
    if isinstance(node, WordNode):
        if node in FOREIGN or node in ("and", "or"):
            return FOREIGN.get(str(node), f"write ({node} A B)")
        return PREFIXES.get(str(node), f"write ({node})")
    if len(node) == 1:
        return "one pair of parentheses is too much"
    return f"put the {kind} in one (and …)"


def is_foreign(node: GroupNode, scope: Scope) -> bool:
    """Report an operator of another language, with what PDDL writes instead."""
    head = node.head
    cure = FOREIGN.get(head)
    if cure is None or head in scope.domain.predicates or head in scope.domain.functions:
        return _is_infix(node, scope)
    takes_terms = not any(isinstance(part, GroupNode) for part in node[1:])
    if takes_terms and head in OF_FACTS:
        return _is_infix(node, scope)
    scope.source.error(node[0].at, "foreign-operator", f"PDDL has no {quote(head)}", cure)
    return True


def _is_infix(node: GroupNode, scope: Scope) -> bool:
    """Report an operator between its operands."""
    if not is_infix(node) or node[1] in scope.objects:
        return False
    operator = node[1]
    assert isinstance(operator, WordNode)
    hint = FOREIGN.get(str(operator), f"write ({operator} A B)")
    scope.source.error(operator.at, "foreign-operator", "in PDDL the operator stands first", hint)
    return True


def _has_time(node: GroupNode) -> bool:
    """Whether a group says when a condition holds; ``(at start bob)`` is a predicate."""
    return time_of(node) is not None and isinstance(node[2], GroupNode)


def is_unsupported(node: GroupNode, scope: Scope) -> bool:
    """Report a construct that hrcplan does not know, unless its word is a predicate here."""
    head = node.head
    if head not in UNSUPPORTED or head in scope.domain.predicates or head in scope.domain.functions:
        return False
    scope.source.error(node.at, "unsupported", f"{UNSUPPORTED[head]} are not supported")
    return True


def read_conditions(node: ParseNode, scope: Scope, durative: bool) -> Iterator[Condition]:
    """Yield the conditions of an action; those of a durative one say ``at`` or ``over`` when."""
    if not durative:
        yield Condition("start", read_formula(node, scope))
    elif isinstance(node, GroupNode) and node.head == "and":
        for part in node[1:]:
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
        scope.source.error(node.at, "no-time", message)


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
    scope.source.error(node.at, "not-a-number", "a numeric expression is expected here")
    return Constant(0)


def _violation_count(node: GroupNode, scope: Scope, preferences: Set[str]) -> Expr:
    name = node[1] if len(node) == 2 else node
    if not isinstance(name, WordNode):
        scope.source.error(node.at, "bad-preference", "(is-violated NAME) is expected here")
        return Constant(0)
    if name not in preferences:
        message = f"there is no preference {quote(name)}"
        scope.source.unknown(name.at, "unknown-preference", message, str(name), preferences)
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
    if head in NO_ARITHMETIC and head not in scope.domain.functions:
        message = f"PDDL has no {quote(head)} for numbers"
        scope.source.error(head.at, "foreign-operator", message, "it knows + - * / only")
        return None
    if head in scope.domain.predicates and head not in scope.domain.functions:
        message = f"{quote(head)} is a predicate, not a function"
        hint = f"as a condition write {shown(node)} or (not {shown(node)}), without a value"
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
        scope.source.error(node.at, "wrong-arity", f"{quote(node.head)} needs operands")
        return Constant(0)
    if node.head == "/" and any(isinstance(n, WordNode) and to_number(n) == 0 for n in node[2:]):
        scope.source.error(node.at, "bad-number", "division by zero")
    return Arithmetic(str(node.head), parts)


def has_parts(node: GroupNode, n_parts: int, scope: Scope) -> bool:
    """Whether a group has ``n_parts`` elements after its head; if not, that is an error."""
    if len(node) == n_parts + 1:
        return True
    message = f"{quote(node.head)} takes {plural(n_parts, 'part')}, not {len(node) - 1}"
    hint = None
    if node.head in ("forall", "exists") and len(node) > 1 and isinstance(node[1], WordNode):
        hint = f"write ({node.head} (?x - type) …), the variables in parentheses"
    elif node.head in _ONE_BODY and len(node) > n_parts + 1:
        hint = "put them in one (and …)"
    scope.source.error(node.at, "wrong-arity", message, hint)
    return False


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
        if isinstance(other, WordNode) and _is_fact(side, scope):
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


def _is_fact(node: ParseNode, scope: Scope) -> bool:
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
        if isinstance(term, WordNode):
            scope.types_of(term)
