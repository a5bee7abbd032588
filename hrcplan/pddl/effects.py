"""Trees to the effects of an action; every fault is noted, none stops the reading."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hrcplan.core.records import replace
from hrcplan.core.text import quote
from hrcplan.pddl.cures import COMPARISONS, groups_of, has_parts, is_unsupported, report_loose
from hrcplan.pddl.formulas import (
    is_fact,
    read_atom,
    read_conditions,
    read_expression,
    read_formula,
    read_function,
    time_of,
)
from hrcplan.pddl.model import CONTINUOUS, TOTAL_COST, TRUE, And, Effect, Formula
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.typed_lists import read_params

ASSIGNMENTS = frozenset(["assign", "increase", "decrease", "scale-up", "scale-down"])
_LOGIC = frozenset(["and", "forall", "when"])
_NO_EFFECTS = COMPARISONS | _LOGIC | {"or", "imply", "exists", "not", "over"}

_CURES = {
    "=": "write (assign (f) VALUE) to set a function",
    "imply": "write (when CONDITION EFFECT)",
    "or": "the effect of an action is certain: write one action for each",
    "exists": "write (forall …) for all of them, or make one of them a parameter",
    "over": "write (at start …) or (at end …)",
}
"""How to write what cannot be an effect."""


def read_effects(node: ParseNode, scope: Scope, when: str | None) -> Iterable[Effect]:
    """Return the effects of an action; ``when`` is None where a durative one must still say it."""
    atom = scope.plain_atom(node)
    if atom is not None and when in ("start", "end") and atom.name not in scope.derived:
        return (Effect(when, "add", atom),)
    head = node.head if isinstance(node, GroupNode) else ""
    if not isinstance(node, GroupNode) or (node and not head):
        report_loose([node], scope, "effect")
        return ()
    pair = time_of(node) if when is None else None
    if pair is not None and pair[0] != "all":
        return read_effects(pair[1], scope, pair[0])
    match head:
        case "":
            return ()
        case _ if when is not None and scope.is_atom(node):
            return _literal(node, scope, when)
        case "and":
            parts = groups_of(node[1:], scope, "effect")
            return [effect for part in parts for effect in read_effects(part, scope, when)]
        case "not" if when is not None:
            return _literal(node, scope, when)
        case "forall":
            return _for_all(node, scope, when)
        case "when":
            return _conditional(node, scope, when)
        case _ if is_unsupported(node, scope):
            return ()
        case _ if when is None and head in ASSIGNMENTS and _mentions(node, CONTINUOUS):
            scope.source.use(":continuous-effects", node.at)
            return _assignment(node, scope.knowing(CONTINUOUS), "all")
        case _ if when is None:
            message = "a durative effect needs (at start …) or (at end …)"
            scope.source.error(node.at, "no-time", message, "write (at end (p ?x))")
            return ()
        case _ if head in ASSIGNMENTS:
            return _assignment(node, scope, when)
        case _:
            return _literal(node, scope, when)


def _mentions(node: ParseNode, word: str) -> bool:
    if isinstance(node, GroupNode):
        return any(_mentions(part, word) for part in node)
    return node == word


def _for_all(node: GroupNode, scope: Scope, when: str | None) -> Iterator[Effect]:
    if not has_parts(node, 2, scope):
        return
    scope.source.use(":conditional-effects", node.at)
    params, inside = scope.quantifying(read_params(node[1], scope), node.at)
    for effect in read_effects(node[2], inside, when):
        yield replace(effect, params=params + effect.params)


def _conditional(node: GroupNode, scope: Scope, when: str | None) -> Iterator[Effect]:
    if not has_parts(node, 2, scope):
        return
    scope.source.use(":conditional-effects", node.at)
    if when is None:
        yield from _timed_conditional(node, scope)
        return
    condition = read_formula(node[1], scope)
    for effect in read_effects(node[2], scope, when):
        yield replace(effect, condition=_both(condition, effect.condition))


def _timed_conditional(node: GroupNode, scope: Scope) -> Iterator[Effect]:
    """Yield the effects of ``(when (at start c) (at end e))``: each part says when by itself."""
    parts = list(read_conditions(node[1], scope, durative=True))
    starts, ends = (And(tuple(c.formula for c in parts if c.when == w)) for w in ("start", "end"))
    if any(c.when == "all" for c in parts):
        message = "'over all' in the condition of an effect is not supported"
        scope.source.error(node.at, "unsupported", message, "a fact that the start sets can say it")
        return
    for effect in read_effects(node[2], scope, None):
        if effect.when == "start" and ends != TRUE:
            message = "an effect at the start cannot depend on the end"
            scope.source.error(node.at, "not-an-effect", message, "write (at end …) for the effect")
        elif effect.when == "start":
            yield replace(effect, condition=_both(_plain(starts), effect.condition))
        else:
            before = _both(_plain(starts), effect.start_condition)
            yield replace(
                effect, condition=_both(_plain(ends), effect.condition), start_condition=before
            )


def _plain(formula: And) -> Formula:
    """Return the one part of a conjunction that has just one."""
    return formula.parts[0] if len(formula.parts) == 1 else formula


def _both(outer: Formula, inner: Formula) -> Formula:
    if inner == TRUE or outer == TRUE:
        return inner if outer == TRUE else outer
    return And((outer, inner))


def _literal(node: GroupNode, scope: Scope, when: str) -> tuple[Effect, ...]:
    inner: ParseNode = node
    if node.head == "not" and len(node) == 2 and not scope.is_atom(node):
        inner = node[1]
    if inner is node and node.head == "=" and len(node) > 1 and is_fact(node[1], scope):
        read_function(node[1], scope)
        return ()
    atom = scope.plain_atom(inner)
    if atom is None:
        if not isinstance(inner, GroupNode) or not inner.head or _is_no_effect(inner, scope):
            message = "'not' takes one predicate in an effect"
            if isinstance(inner, GroupNode):
                message = f"{quote(inner.head)} cannot be an effect"
            scope.source.error(inner.at, "not-an-effect", message, _cure(node, inner))
            return ()
        atom = read_atom(inner, scope)
    if when == "all":
        message = "a process changes numbers only, such as (increase (f) (* #t 2))"
        scope.source.error(inner.at, "not-an-effect", message, "an event can change facts")
    elif atom is not None and atom.name in scope.derived:
        message = f"{quote(atom.name)} is derived: no action can change it"
        hint = "change what it is derived from"
        scope.source.error(inner.at, "derived-predicate", message, hint)
    elif atom is not None:
        return (Effect(when, "add" if inner is node else "delete", atom),)
    return ()


def _is_no_effect(node: GroupNode, scope: Scope) -> bool:
    return node.head in _NO_EFFECTS and not scope.is_atom(node)


def _cure(node: GroupNode, inner: ParseNode) -> str | None:
    """Return how to write what was meant, where that is plain."""
    if not isinstance(inner, GroupNode):
        return f"write (not ({' '.join(str(word) for word in node[1:])}))"
    if node.head == "not" and inner is not node and inner.head == "not":
        return "a fact that is not deleted is added: write (p)"
    if node.head == "not" and len(node) > 2 and isinstance(node[1], WordNode):
        return f"write (not ({' '.join(str(w) for w in node[1:] if isinstance(w, WordNode))}))"
    if node.head == "not" and (inner is node or inner.head in _LOGIC):
        return "'not' of an effect takes one fact: write (and (not (p)) (not (q)))"
    return _CURES.get(str(inner.head), "a condition belongs into :precondition or :condition")


def _assignment(node: GroupNode, scope: Scope, when: str) -> Iterator[Effect]:
    if not has_parts(node, 2, scope):
        return
    if is_fact(node[1], scope):
        read_function(node[1], scope)
        return
    value = read_expression(node[2], scope)
    function = read_function(node[1], scope)
    if function is not None:
        if function.name != TOTAL_COST:
            scope.source.use(":numeric-fluents", node.at)
        yield Effect(when, str(node.head), function, value)
